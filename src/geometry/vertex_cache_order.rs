//! Orders triangles and vertices for a driver's vertex cache, by meshoptimizer.

use super::Mesh;

/// Number of triangles that a software driver transforms at once, roughly, each vertex in them once.
const WINDOW: usize = 1024;

/// Vertices per triangle in such windows: 0.5 at best, 0.65 in a mesh that is ordered well, 3 in one that is shuffled.
const WELL_ORDERED: f64 = 0.8;

impl Mesh {
    /// Tests whether triangles that follow one another share so few vertices that sorting them pays. A shadow volume, whose
    /// parts are ranges of its indices, is never sorted.
    pub fn is_scattered(&self) -> bool {
        if self.parts.is_empty() {
            return false;
        }
        let mut last_window = vec![usize::MAX; self.positions.len()];
        let mut transformed = 0;
        for (window, indices) in self.indices.chunks(3 * WINDOW).enumerate() {
            for index in indices {
                let last = &mut last_window[*index as usize];
                transformed += usize::from(*last != window);
                *last = window;
            }
        }
        transformed as f64 > WELL_ORDERED * self.triangle_count() as f64
    }

    /// [`Mesh::indices`] with the triangles of each part in an order that reuses vertices soon. Each triangle keeps
    /// its winding, each part its range.
    pub fn cache_ordered(&self) -> Vec<u32> {
        let mut ordered = self.indices.clone();
        for part in &self.parts {
            let indices = &mut ordered[part.indices.start as usize..part.indices.end as usize];
            // Counted from the part's first vertex: the time taken grows with the largest index.
            let first = indices.iter().copied().min().unwrap_or(0);
            let end = indices.iter().copied().max().map_or(0, |last| last + 1);
            indices.iter_mut().for_each(|index| *index -= first);
            reorder(indices, (end - first) as usize);
            indices.iter_mut().for_each(|index| *index += first);
        }
        ordered
    }

    /// The same mesh with triangles as in [`Mesh::cache_ordered`] and vertices in the order of their first use;
    /// vertices that no triangle uses are gone.
    pub fn cache_optimized(&self) -> Mesh {
        const UNUSED: u32 = u32::MAX;
        let mut indices = self.cache_ordered();
        let mut new_from_old = vec![UNUSED; self.positions.len()];
        let mut old_from_new = Vec::with_capacity(self.positions.len());
        for index in &mut indices {
            let new = &mut new_from_old[*index as usize];
            if *new == UNUSED {
                *new = old_from_new.len() as u32;
                old_from_new.push(*index as usize);
            }
            *index = *new;
        }
        Mesh {
            name: self.name.clone(),
            positions: old_from_new.iter().map(|old| self.positions[*old]).collect(),
            normals: old_from_new.iter().map(|old| self.normals[*old]).collect(),
            texcoords: self
                .texcoords
                .as_ref()
                .map(|texcoords| old_from_new.iter().map(|old| texcoords[*old]).collect()),
            colors: self.colors.as_ref().map(|colors| old_from_new.iter().map(|old| colors[*old]).collect()),
            tangents: self.tangents.as_ref().map(|tangents| tangents.picked(&old_from_new)),
            indices,
            parts: self.parts.clone(),
            materials: self.materials.clone(),
            bounds: self.bounds,
            origin: self.origin,
            ..Mesh::default()
        }
    }
}

#[cfg(feature = "meshopt")]
use meshopt::optimize_vertex_cache_in_place as reorder;

/// Leaves the triangles as they are, where meshoptimizer is not compiled in; a plan then says that it asks for no order.
#[cfg(not(feature = "meshopt"))]
fn reorder(_: &mut [u32], _: usize) {}

#[cfg(test)]
mod tests {
    use crate::geometry::primitive;

    #[test]
    fn a_sphere_is_scattered_only_when_shuffled() {
        let mut mesh = primitive("sphere").unwrap();
        assert!(!mesh.is_scattered());
        let triangles = mesh.indices.as_chunks::<3>().0.to_vec();
        // A stride that has no divisor in common with any count of triangles that a sphere of ours has.
        let stride = 7919;
        assert_ne!(triangles.len() % stride, 0);
        mesh.indices = (0..triangles.len()).flat_map(|k| triangles[k * stride % triangles.len()]).collect();
        assert!(mesh.triangle_count() <= 1024 || mesh.is_scattered());
    }
}
