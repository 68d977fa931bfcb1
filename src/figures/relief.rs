//! Surfaces that are really displaced by a height field: the truth that a bump map imitates. Knows meshes and heights, and
//! nothing of tangent bases.

use glam::{DVec2, DVec3};

use crate::geometry::bump::{Bump, BumpSource};
use crate::geometry::normal_map::{HeightField, HeightWrap, NormalLevel};
use crate::geometry::{Mesh, Part};
use crate::math::Aabb;

/// Parts that a triangle's side is cut into.
const FINE: usize = 256;

/// The normals of level 0.
pub fn normals(source: &BumpSource, border: HeightWrap) -> NormalLevel {
    match source {
        BumpSource::Heights { field, scale, difference } => field.normals(*scale, *difference, border),
        BumpSource::Normals { normals, .. } => normals.clone(),
    }
}

/// A triangle of the flat surface, and how it is moved.
struct Patch<'a> {
    places: [DVec3; 3],
    normals: [DVec3; 3],
    skin: [DVec2; 3],
    field: &'a HeightField,
    /// Length on the surface of a height of 1.
    tallness: f64,
}

/// The mesh cut into small triangles and moved outwards by its bump map's heights; as it is, where that has none.
pub fn displaced(mesh: &Mesh, bump: &Bump) -> Mesh {
    let (BumpSource::Heights { field, scale, .. }, Some(texcoords)) = (&bump.source, &mesh.texcoords) else {
        return mesh.clone();
    };
    let mut fine = Mesh { name: mesh.name.clone(), texcoords: Some(Vec::new()), ..Mesh::default() };
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let vector = |all: &[[f32; 3]], index: u32| DVec3::from_array(all[index as usize].map(f64::from));
        let skin = triangle.map(|index| DVec2::from_array(texcoords[index as usize].map(f64::from)));
        let places = triangle.map(|index| vector(&mesh.positions, index));
        let normals = triangle.map(|index| vector(&mesh.normals, index));
        // A texel's side on the surface; the heights are in texels.
        let texel = length_of_s(places, skin) / f64::from(field.width);
        Patch { places, normals, skin, field, tallness: scale * texel }.add_to(&mut fine);
    }
    let points = fine.positions.iter().map(|place| DVec3::from_array(place.map(f64::from)));
    fine.bounds = Aabb::from_points(points);
    let name = mesh.name.clone();
    fine.parts = vec![Part { name, indices: 0..fine.indices.len() as u32, material: None, bounds: fine.bounds }];
    fine
}

/// Length on a triangle of a unit of s; zero where it has no direction.
fn length_of_s([a, b, c]: [DVec3; 3], skin: [DVec2; 3]) -> f64 {
    let (first, second) = (skin[1] - skin[0], skin[2] - skin[0]);
    let area = first.perp_dot(second);
    if area == 0.0 { 0.0 } else { (((b - a) * second.y - (c - a) * first.y) / area).length() }
}

impl Patch<'_> {
    /// The displaced point at shares of the second and the third corner.
    fn point(&self, [v, w]: [f64; 2]) -> DVec3 {
        let weights = [1.0 - v - w, v, w];
        let mix = |all: &[DVec3; 3]| (0..3).map(|corner| weights[corner] * all[corner]).sum::<DVec3>();
        let st: DVec2 = (0..3).map(|corner| weights[corner] * self.skin[corner]).sum();
        mix(&self.places) + self.tallness * height(self.field, st) * mix(&self.normals).normalize_or_zero()
    }

    /// Adds the small triangles. Their normals are cross products of differences on the displaced surface itself.
    fn add_to(&self, mesh: &mut Mesh) {
        let first = mesh.positions.len() as u32;
        let step = 1.0 / FINE as f64;
        for row in 0..=FINE {
            for column in 0..=FINE - row {
                let [v, w] = [column as f64 * step, row as f64 * step];
                let along_v = self.point([v + step, w]) - self.point([v - step, w]);
                let along_w = self.point([v, w + step]) - self.point([v, w - step]);
                mesh.positions.push(self.point([v, w]).as_vec3().to_array());
                mesh.normals.push(along_v.cross(along_w).normalize_or(DVec3::Y).as_vec3().to_array());
                let st = self.skin[0] + v * (self.skin[1] - self.skin[0]) + w * (self.skin[2] - self.skin[0]);
                mesh.texcoords.iter_mut().for_each(|all| all.push(st.as_vec2().to_array()));
            }
        }
        // Rows become shorter by one.
        let at =
            |row: usize, column: usize| first + (row * (FINE + 1) - row * row.saturating_sub(1) / 2 + column) as u32;
        for row in 0..FINE {
            for column in 0..FINE - row {
                mesh.indices.extend([at(row, column), at(row, column + 1), at(row + 1, column)]);
                if column + 1 < FINE - row {
                    mesh.indices.extend([at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)]);
                }
            }
        }
    }
}

/// A height at (s, t) by a bilinear filter that repeats.
fn height(field: &HeightField, st: DVec2) -> f64 {
    let at = st * DVec2::new(f64::from(field.width), f64::from(field.height)) - 0.5;
    let (first, part) = (at.floor(), at - at.floor());
    let texel = |x: f64, y: f64| {
        let inside = |at: f64, count: u32| at.rem_euclid(f64::from(count)).min(f64::from(count - 1)) as usize;
        f64::from(field.heights[inside(y, field.height) * field.width as usize + inside(x, field.width)])
    };
    let row = |y: f64| texel(first.x, y) * (1.0 - part.x) + texel(first.x + 1.0, y) * part.x;
    row(first.y) * (1.0 - part.y) + row(first.y + 1.0) * part.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::bump::NormalFormat;
    use crate::geometry::normal_map::{Difference, MipColors};
    use crate::geometry::primitive;
    use crate::geometry::tangents::BasisFit;

    /// A slope of one texel a texel on a square of 2 × 2 becomes a roof of 45 degrees, whose corners are where they belong.
    #[test]
    fn a_height_is_as_long_as_its_texels() {
        let heights = (0..64 * 64).map(|texel| (texel % 64) as f32 / 64.0).collect();
        let field = HeightField { name: String::from("slope"), width: 64, height: 64, heights };
        let source = BumpSource::Heights { field, scale: 64.0, difference: Difference::Central };
        let bump = Bump::new(source, NormalFormat::Signed, MipColors::Mean, HeightWrap::Repeat, BasisFit::Orthogonal);
        let quad = primitive("quad").unwrap();
        let fine = displaced(&quad, &bump);
        assert_eq!(fine.triangle_count(), 2 * FINE * FINE);
        let mut checked = 0;
        for (place, normal) in fine.positions.iter().zip(&fine.normals) {
            let [x, y, z] = place.map(f64::from);
            assert!(x.abs() < 1.0001 && z.abs() < 1.0001);
            if x.abs() < 0.95 {
                // Texel i has its middle at (i + 1/2) / 64 and a height of i / 64.
                assert!((y - (x + 1.0 - 1.0 / 64.0)).abs() < 1e-5, "{place:?}");
                assert!(
                    DVec3::from_array(normal.map(f64::from)).distance(DVec3::new(-1.0, 1.0, 0.0).normalize()) < 1e-4
                );
                checked += 1;
            }
        }
        assert!(checked > 50_000);
    }
}
