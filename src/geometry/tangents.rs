//! Tangent bases of triangles from their texture coordinates, the skin [GDC, "Per-Polygon Tangent Space Basis"].
//!
//! On a triangle a point is linear in (s, t): its derivatives P_s and P_t are found from two edges. T = P_s / |P_s| and
//! B = P_t / |P_t| lie in the triangle, N is its outward normal. On a mirrored skin (s, t) runs the other way around: T × B
//! points inwards there, and N is turned outwards, while T and B stay, so that bumps stay bumps.

use std::collections::HashMap;

use glam::DVec3;

pub use super::bump::BasisFit;
use super::{Mesh, MeshTangents};

/// Area in (s, t), as a share of the product of two edges, below which a triangle has no direction on the skin.
pub(super) const LEAST_AREA: f64 = 1e-12;

/// Sine of 10 degrees: the angle between T and B, off a right angle, from which a triangle counts as skewed.
const SKEWED_SINE: f64 = 0.173_648_177_666_930_35;

/// A corner's basis in model space: unit vectors along s, along t, and outwards. T and B are zero where the triangle has no
/// direction on the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentBasis {
    pub tangent: DVec3,
    pub bitangent: DVec3,
    pub normal: DVec3,
}

/// Bases of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tangents {
    /// One for each of the mesh's indices.
    pub corners: Vec<TangentBasis>,
    /// Triangles whose skin is mirrored.
    pub mirrored: usize,
    /// Triangles whose T and B are more than 10 degrees off a right angle.
    pub skewed: usize,
    /// Triangles without an area, or without one on the skin: T and B are zero, and no bump tilts the normal.
    pub without: usize,
}

/// Directions of a triangle by the skin.
pub(super) struct Directions {
    /// P_s and P_t of unit length.
    pub tangent: DVec3,
    pub bitangent: DVec3,
    /// The outward normal, of unit length.
    pub normal: DVec3,
    pub is_mirrored: bool,
}

impl Tangents {
    /// The bases of a mesh's corners. `None`: it has no texture coordinates.
    pub fn of_skin(mesh: &Mesh, fit: BasisFit) -> Option<Self> {
        let texcoords = mesh.texcoords.as_ref()?;
        Some(Self::of_coordinates(mesh, |vertex| texcoords[vertex].map(f64::from), fit))
    }

    /// The same for any texture coordinates: those of a vertex by its number.
    pub fn of_coordinates(mesh: &Mesh, texcoord: impl Fn(usize) -> [f64; 2], fit: BasisFit) -> Self {
        let mut found = Self::default();
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let places = triangle.map(|index| DVec3::from_array(mesh.positions[index as usize].map(f64::from)));
            let skin = triangle.map(|index| texcoord(index as usize));
            let normals = triangle.map(|index| DVec3::from_array(mesh.normals[index as usize].map(f64::from)));
            match directions(places, skin) {
                Some(directions) => {
                    found.mirrored += usize::from(directions.is_mirrored);
                    found.skewed += usize::from(directions.is_skewed());
                    found.corners.extend(normals.map(|normal| directions.fitted(normal, fit)));
                }
                None => {
                    found.without += 1;
                    let facet = (places[1] - places[0]).cross(places[2] - places[0]).try_normalize();
                    let around = |normal: DVec3| match (fit, facet) {
                        (BasisFit::PerPolygon, Some(facet)) => TangentBasis::flat(facet),
                        _ => TangentBasis::flat(normal),
                    };
                    found.corners.extend(normals.map(around));
                }
            }
        }
        found
    }
}

/// Origin of a mesh's bases, and numbers of triangles to report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BasisCounts {
    pub triangles: usize,
    /// As in [`Tangents`]; 0 where the mesh brings its own directions.
    pub mirrored: usize,
    pub skewed: usize,
    pub without: usize,
    /// True if the mesh brought its own directions.
    pub from_mesh: bool,
}

impl Mesh {
    /// The same surface with a basis at each vertex: vertices whose triangles differ in theirs are split. A mesh that
    /// brings its own directions keeps them if the fit is orthogonal and `texcoord` is `None`.
    ///
    /// `texcoord`: coordinates of a vertex by its number; `None`: the mesh's own. `None` is returned where there are none.
    pub fn with_bases(
        &self,
        fit: BasisFit,
        texcoord: Option<&dyn Fn(usize) -> [f64; 2]>,
    ) -> Option<(Self, BasisCounts)> {
        let triangles = self.triangle_count();
        if self.tangents.is_some() && fit == BasisFit::Orthogonal && texcoord.is_none() {
            return Some((self.clone(), BasisCounts { triangles, from_mesh: true, ..BasisCounts::default() }));
        }
        let bases = match texcoord {
            Some(texcoord) => Tangents::of_coordinates(self, texcoord, fit),
            None => Tangents::of_skin(self, fit)?,
        };
        let mut known = HashMap::new();
        let (mut old, mut indices) = (Vec::new(), Vec::with_capacity(self.indices.len()));
        let mut mesh = Self { normals: Vec::new(), ..self.clone() };
        let mut directions = MeshTangents::default();
        for (index, corner) in self.indices.iter().zip(&bases.corners) {
            let [t, b, n] = [corner.tangent, corner.bitangent, corner.normal].map(|way| way.as_vec3().to_array());
            let key = (*index, [t, b, n].map(|way| way.map(f32::to_bits)));
            let vertex = *known.entry(key).or_insert(old.len() as u32);
            if vertex as usize == old.len() {
                old.push(*index as usize);
                directions.tangents.push(t);
                directions.bitangents.push(b);
                mesh.normals.push(n);
            }
            indices.push(vertex);
        }
        mesh.positions = old.iter().map(|index| self.positions[*index]).collect();
        mesh.texcoords = self.texcoords.as_ref().map(|all| old.iter().map(|index| all[*index]).collect());
        mesh.indices = indices;
        mesh.tangents = Some(directions);
        // Also those that a vertex's normal lies in.
        let is_lost = |corners: &&[TangentBasis; 3]| corners.iter().any(|corner| corner.tangent == DVec3::ZERO);
        let without = bases.corners.as_chunks::<3>().0.iter().filter(is_lost).count();
        let Tangents { mirrored, skewed, .. } = bases;
        Some((mesh, BasisCounts { triangles, mirrored, skewed, without, from_mesh: false }))
    }
}

impl TangentBasis {
    /// A normal without directions on the skin: T and B are zero, and no bump tilts it.
    pub(super) fn flat(normal: DVec3) -> Self {
        Self { tangent: DVec3::ZERO, bitangent: DVec3::ZERO, normal }
    }

    /// A vector of model space in tangent space: its dot products with T, B and N.
    pub fn tangent_from_model(&self, vector: DVec3) -> DVec3 {
        DVec3::new(vector.dot(self.tangent), vector.dot(self.bitangent), vector.dot(self.normal))
    }

    /// A vector of tangent space in model space.
    pub fn model_from_tangent(&self, vector: DVec3) -> DVec3 {
        vector.x * self.tangent + vector.y * self.bitangent + vector.z * self.normal
    }
}

impl Directions {
    pub fn is_skewed(&self) -> bool {
        self.tangent.dot(self.bitangent).abs() > SKEWED_SINE
    }

    /// The basis at a corner with this normal.
    #[inline]
    pub fn fitted(&self, normal: DVec3, fit: BasisFit) -> TangentBasis {
        let Self { tangent, bitangent, .. } = *self;
        let in_plane = |vector: DVec3| (vector - vector.dot(normal) * normal).try_normalize();
        let fitted =
            match fit {
                BasisFit::PerPolygon => Some(TangentBasis { tangent, bitangent, normal: self.normal }),
                BasisFit::Orthogonal => in_plane(tangent).map(|tangent| {
                    let across = normal.cross(tangent);
                    TangentBasis { tangent, bitangent: if self.is_mirrored { -across } else { across }, normal }
                }),
                BasisFit::Skewed => in_plane(tangent)
                    .zip(in_plane(bitangent))
                    .map(|(tangent, bitangent)| TangentBasis { tangent, bitangent, normal }),
            };
        // None: a vertex's normal in the triangle's plane.
        fitted.unwrap_or_else(|| TangentBasis::flat(normal))
    }
}

/// Twice the signed area of a triangle on the skin. `None`: it has no direction there.
pub(super) fn skin_area(skin: [[f64; 2]; 3]) -> Option<f64> {
    let [[s1, t1], [s2, t2]] = skin_edges(skin);
    let area = s1 * t2 - s2 * t1;
    // A comparison that is false for NaN.
    (area.abs() > LEAST_AREA * (s1.hypot(t1) * s2.hypot(t2))).then_some(area)
}

/// P_s and P_t from edges e = Δs P_s + Δt P_t, and the area of [`skin_area`].
pub(super) fn derivatives(edges: [DVec3; 2], skin: [[f64; 2]; 3], area: f64) -> [DVec3; 2] {
    let [[s1, t1], [s2, t2]] = skin_edges(skin);
    [(edges[0] * t2 - edges[1] * t1) / area, (edges[1] * s1 - edges[0] * s2) / area]
}

fn skin_edges(skin: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
    [1, 2].map(|corner| [skin[corner][0] - skin[0][0], skin[corner][1] - skin[0][1]])
}

/// Directions of a triangle. `None`: it has no area, or none on the skin.
fn directions(places: [DVec3; 3], skin: [[f64; 2]; 3]) -> Option<Directions> {
    let edges = [places[1] - places[0], places[2] - places[0]];
    let normal = edges[0].cross(edges[1]).try_normalize()?;
    let area = skin_area(skin)?;
    let [tangent, bitangent] = derivatives(edges, skin, area).map(DVec3::normalize_or_zero);
    Some(Directions { tangent, bitangent, normal, is_mirrored: area < 0.0 })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::Part;
    use crate::math::Aabb;

    /// A mesh of a grid of (s, t) in [0, 1]², `columns` by `rows`, each vertex by a function of its place.
    fn grid(
        [columns, rows]: [usize; 2],
        place: impl Fn(f64, f64) -> DVec3,
        normal: impl Fn(f64, f64) -> DVec3,
        skin: impl Fn(f64, f64) -> [f64; 2],
    ) -> Mesh {
        let at = |row: usize, column: usize| (column as f64 / columns as f64, row as f64 / rows as f64);
        let vertices: Vec<(f64, f64)> =
            (0..=rows).flat_map(|row| (0..=columns).map(move |column| at(row, column))).collect();
        let index = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
        let indices: Vec<u32> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .flat_map(|(row, column)| {
                let [a, b] = [index(row, column), index(row, column + 1)];
                let [c, d] = [index(row + 1, column), index(row + 1, column + 1)];
                [a, b, d, a, d, c]
            })
            .collect();
        let part = Part { name: String::new(), indices: 0..indices.len() as u32, material: None, bounds: Aabb::EMPTY };
        Mesh {
            positions: vertices.iter().map(|(u, v)| place(*u, *v).as_vec3().to_array()).collect(),
            normals: vertices.iter().map(|(u, v)| normal(*u, *v).as_vec3().to_array()).collect(),
            texcoords: Some(vertices.iter().map(|(u, v)| skin(*u, *v).map(|part| part as f32)).collect()),
            indices,
            parts: vec![part],
            ..Mesh::default()
        }
    }

    #[test]
    fn edges_are_what_the_derivatives_say() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut number = || 2.0 * random.f64() - 1.0;
        for _ in 0..2000 {
            let places = [(); 3].map(|()| DVec3::new(number(), number(), number()));
            let skin = [(); 3].map(|()| [number(), number()]);
            let Some(found) = directions(places, skin) else { continue };
            let edges = [1, 2].map(|corner| places[corner] - places[0]);
            let [by_s, by_t] = derivatives(edges, skin, skin_area(skin).unwrap());
            for (edge, [s, t]) in edges.into_iter().zip(skin_edges(skin)) {
                let size = s.abs() * by_s.length() + t.abs() * by_t.length();
                assert!(edge.distance(s * by_s + t * by_t) < 1e-12 * size);
            }
            // T × B is outwards where the skin is not mirrored.
            let side = by_s.cross(by_t).dot(found.normal);
            assert!(side != 0.0 && (side < 0.0) == found.is_mirrored);
        }
    }

    /// A torus around y, s around the axis and t around the tube: T and B are the unit derivatives of its formula. A triangle
    /// of a grid is half a cell: its derivatives are those of a place beside its middle, and the error falls with its size.
    #[test]
    fn bases_of_a_torus_are_those_of_its_formula() {
        let place = |u: f64, v: f64| {
            let around = 1.0 + 0.4 * (TAU * v).cos();
            DVec3::new(around * (TAU * u).cos(), 0.4 * (TAU * v).sin(), -around * (TAU * u).sin())
        };
        let along_s = |u: f64| DVec3::new(-(TAU * u).sin(), 0.0, -(TAU * u).cos());
        let along_t = |u: f64, v: f64| {
            let (sine, cosine) = (TAU * v).sin_cos();
            DVec3::new(-sine * (TAU * u).cos(), cosine, sine * (TAU * u).sin())
        };
        let normal = |u: f64, v: f64| along_s(u).cross(along_t(u, v));
        let worst = |segments: usize| {
            let mesh = grid([2 * segments, segments], place, normal, |u, v| [u, v]);
            let skin = mesh.texcoords.as_ref().unwrap();
            let tangents = Tangents::of_skin(&mesh, BasisFit::PerPolygon).unwrap();
            assert_eq!((tangents.mirrored, tangents.without), (0, 0));
            let triangles = mesh.indices.as_chunks::<3>().0.iter().zip(tangents.corners.as_chunks::<3>().0);
            let error = triangles.map(|(triangle, corners)| {
                let middle = |axis: usize| {
                    triangle.iter().map(|index| f64::from(skin[*index as usize][axis])).sum::<f64>() / 3.0
                };
                let (u, v) = (middle(0), middle(1));
                let [own, exact] = [corners[0].tangent, along_s(u)];
                own.angle_between(exact)
                    .max(corners[0].bitangent.angle_between(along_t(u, v)))
                    .max(corners[0].normal.angle_between(normal(u, v)))
            });
            error.fold(0.0, f64::max)
        };
        let errors = [16, 32, 64, 128].map(worst);
        println!("{errors:.5?} radians at 16, 32, 64, 128 segments");
        for pair in errors.windows(2) {
            assert!(pair[0] / pair[1] > 1.9, "{errors:?}");
        }
    }

    /// A square whose left half has its skin mirrored, and a slope of 1/2 along s: the true normal of the displaced surface
    /// leans against the way that the height grows, which is +x on the right and -x on the left.
    #[test]
    fn a_mirrored_skin_has_its_bumps_outwards() {
        let skin = |u: f64, v: f64| [(2.0 * u - 1.0).abs(), v];
        let mesh = grid([2, 1], |u, v| DVec3::new(2.0 * u - 1.0, v, 0.0), |_, _| DVec3::Z, skin);
        for fit in [BasisFit::PerPolygon, BasisFit::Orthogonal, BasisFit::Skewed] {
            let tangents = Tangents::of_skin(&mesh, fit).unwrap();
            assert_eq!((tangents.mirrored, tangents.skewed, tangents.without), (2, 0, 0));
            let bump = DVec3::new(-0.5, 0.0, 1.0).normalize();
            for (index, corner) in tangents.corners.iter().enumerate() {
                let is_left = index / 6 == 0;
                let expected = DVec3::new(if is_left { 0.5 } else { -0.5 }, 0.0, 1.0).normalize();
                assert!(corner.model_from_tangent(bump).distance(expected) < 1e-6, "{fit:?} {index}: {corner:?}");
                assert!(corner.tangent_from_model(expected).distance(bump) < 1e-6);
            }
        }
    }

    /// A second judge: the surface is really moved along its normal by a small height. Its normals are those of the bump map
    /// to first order, on a sheet whose skin is turned, stretched and mirrored.
    #[test]
    fn bumps_are_those_of_a_displaced_surface() {
        let mut random = fastrand::Rng::with_seed(5);
        for round in 0..40 {
            // Orthogonal skins of any turn, size and sense.
            let angle = TAU * random.f64();
            let [along_s, along_t] = [0.5 + random.f64(), 0.5 + random.f64()];
            let sense = if round % 2 == 0 { 1.0 } else { -1.0 };
            let by_s = along_s * DVec3::new(angle.cos(), angle.sin(), 0.0);
            let by_t = sense * along_t * DVec3::new(-angle.sin(), angle.cos(), 0.0);
            let places = [DVec3::ZERO, by_s, by_t];
            let order = if sense > 0.0 { [0, 1, 2] } else { [0, 2, 1] };
            let skin = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
            let found = directions(order.map(|corner| places[corner]), order.map(|corner| skin[corner])).unwrap();
            let basis = found.fitted(DVec3::Z, BasisFit::Orthogonal);
            assert_eq!(found.is_mirrored, sense < 0.0);
            let [slope_s, slope_t] = [random.f64() - 0.5, random.f64() - 0.5];
            let mut errors = Vec::new();
            for height in [1e-1, 1e-2, 1e-3] {
                // The surface P(s, t) + height (slope_s s + slope_t t) N.
                let moved = (by_s + height * slope_s * DVec3::Z).cross(by_t + height * slope_t * DVec3::Z);
                let expected = (sense * moved).normalize();
                // The map's slopes are for lengths on the surface: divided by |P_s| and |P_t|.
                let bump = DVec3::new(-height * slope_s / along_s, -height * slope_t / along_t, 1.0).normalize();
                errors.push(basis.model_from_tangent(bump).angle_between(expected));
            }
            assert!(errors.iter().all(|error| *error < 1e-7), "{errors:?}");
        }
    }

    #[test]
    fn corners_keep_the_normals_of_their_vertices() {
        let place = |u: f64, v: f64| DVec3::new(u + 0.3 * v, v, 0.2 * u * u);
        let normal = |u: f64, _: f64| DVec3::new(-0.4 * u, 0.1, 1.0).normalize();
        let mesh = grid([4, 4], place, normal, |u, v| [u, v]);
        for fit in [BasisFit::Orthogonal, BasisFit::Skewed] {
            let tangents = Tangents::of_skin(&mesh, fit).unwrap();
            assert!(tangents.skewed > 0, "sheared by 17 degrees");
            for (index, corner) in mesh.indices.iter().zip(&tangents.corners) {
                let vertex = DVec3::from_array(mesh.normals[*index as usize].map(f64::from));
                assert_eq!(corner.normal, vertex);
                // f32 normals are unit vectors to 1e-7.
                assert!(corner.tangent.dot(vertex).abs() < 1e-6 && corner.bitangent.dot(vertex).abs() < 1e-6);
                if fit == BasisFit::Orthogonal {
                    assert!(corner.tangent.dot(corner.bitangent).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn triangles_without_a_direction_are_counted() {
        let flat = |skin: fn(f64, f64) -> [f64; 2]| grid([2, 2], |u, v| DVec3::new(u, v, 0.0), |_, _| DVec3::Z, skin);
        for (mesh, without) in [
            (flat(|_, _| [0.5, 0.5]), 8),
            (flat(|u, _| [u, u]), 8),
            (flat(|u, v| [u, v]), 0),
            (grid([2, 2], |u, _| DVec3::new(u, 0.0, 0.0), |_, _| DVec3::Y, |u, v| [u, v]), 8),
        ] {
            for fit in [BasisFit::PerPolygon, BasisFit::Orthogonal, BasisFit::Skewed] {
                let tangents = Tangents::of_skin(&mesh, fit).unwrap();
                assert_eq!(tangents.without, without);
                assert!(tangents.corners.iter().all(|corner| {
                    // No direction on the skin: none in space.
                    let length = if without > 0 { 0.0 } else { 1.0 };
                    let is_long = |vector: DVec3, length: f64| (vector.length() - length).abs() < 1e-6;
                    is_long(corner.tangent, length) && is_long(corner.bitangent, length) && is_long(corner.normal, 1.0)
                }));
            }
        }
        assert_eq!(Tangents::of_skin(&Mesh::default(), BasisFit::Orthogonal), None);
    }
}
