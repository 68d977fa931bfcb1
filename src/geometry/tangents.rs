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
        mesh.colors = self.colors.as_ref().map(|all| old.iter().map(|index| all[*index]).collect());
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
#[path = "tangents_tests.rs"]
mod tests;
