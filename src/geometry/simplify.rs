//! Fewer triangles within an error, by meshoptimizer: for resolutions that do not show the others.

use std::ops::Range;

use super::topology::weld;
use super::{Mesh, Part};

impl Mesh {
    /// The triangles of `indices` with positions alone, as few as lie within `error` of the surface, in the mesh's own
    /// units and by quadrics: a vertex may lie a little farther where the surface bends. Vertices at one place stay
    /// connected, whatever their normals are.
    pub fn simplified(&self, indices: Range<u32>, error: f32) -> Mesh {
        let (places, count) = weld(&self.positions);
        let mut positions = vec![[0.0_f32; 3]; count];
        self.positions.iter().zip(&places).for_each(|(position, place)| positions[*place as usize] = *position);
        let welded: Vec<u32> = self.indices[indices.start as usize..indices.end as usize]
            .iter()
            .map(|index| places[*index as usize])
            .collect();
        let fewer = fewer(&positions, welded, error);
        let (positions, indices) = compact(&positions, &fewer);
        let part =
            Part { name: self.name.clone(), indices: 0..indices.len() as u32, material: None, bounds: self.bounds };
        let mut mesh = Mesh {
            name: format!("{}, simplified", self.name),
            normals: vec![[0.0, 0.0, 1.0]; positions.len()],
            positions,
            indices,
            parts: vec![part],
            origin: self.origin,
            ..Mesh::default()
        };
        mesh.update_bounds();
        mesh
    }
}

/// Fewer of the triangles of `indices`, within `error`.
#[cfg(feature = "meshopt")]
fn fewer(positions: &[[f32; 3]], indices: Vec<u32>, error: f32) -> Vec<u32> {
    use meshopt::{SimplifyOptions, VertexDataAdapter};
    // An adapter fails for strides and offsets that do not fit; three floats do. Without it nothing is left out.
    match VertexDataAdapter::new(bytemuck::cast_slice(positions), 12, 0) {
        Ok(vertices) => meshopt::simplify(&indices, &vertices, 3, error, SimplifyOptions::ErrorAbsolute, None),
        Err(_) => indices,
    }
}

/// All triangles, where meshoptimizer is not compiled in.
#[cfg(not(feature = "meshopt"))]
fn fewer(_: &[[f32; 3]], indices: Vec<u32>, _: f32) -> Vec<u32> {
    indices
}

/// The vertices that are used, in the order of their first use, and indices into them.
fn compact(positions: &[[f32; 3]], indices: &[u32]) -> (Vec<[f32; 3]>, Vec<u32>) {
    const UNUSED: u32 = u32::MAX;
    let mut new_from_old = vec![UNUSED; positions.len()];
    let mut kept = Vec::new();
    let renumber = |old: &u32| {
        let new = &mut new_from_old[*old as usize];
        if *new == UNUSED {
            *new = kept.len() as u32;
            kept.push(positions[*old as usize]);
        }
        *new
    };
    let indices = indices.iter().map(renumber).collect();
    (kept, indices)
}

#[cfg(test)]
mod tests {
    use super::super::primitive;

    #[test]
    fn a_sphere_keeps_its_shape_within_the_error() {
        let mesh = primitive("sphere").unwrap();
        let all = 0..mesh.indices.len() as u32;
        for error in [1e-3_f32, 1e-2, 0.05] {
            let fewer = mesh.simplified(all.clone(), error);
            println!("error {error}: {} of {} triangles", fewer.triangle_count(), mesh.triangle_count());
            assert!(fewer.triangle_count() < mesh.triangle_count() && fewer.is_closed(), "{error}");
            // By quadrics the error is a mean: no middle of a triangle lies three times as deep.
            for triangle in fewer.indices.as_chunks::<3>().0 {
                let middle =
                    triangle.map(|i| glam::Vec3::from(fewer.positions[i as usize])).iter().sum::<glam::Vec3>() / 3.0;
                assert!(1.0 - middle.length() < 3.0 * error + 3e-3, "{error}: {middle}");
            }
        }
        let same = mesh.simplified(all, 0.0);
        assert!(same.triangle_count() <= mesh.triangle_count() && same.is_closed());
    }
}
