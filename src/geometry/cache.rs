//! The order of triangles and vertices that a driver's vertex cache likes, by meshoptimizer.

use super::Mesh;

impl Mesh {
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
            meshopt::optimize_vertex_cache_in_place(indices, (end - first) as usize);
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
            indices,
            parts: self.parts.clone(),
            materials: self.materials.clone(),
            bounds: self.bounds,
        }
    }
}
