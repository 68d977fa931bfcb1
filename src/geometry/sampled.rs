//! Rays through a mesh's triangles, for decisions by sampling: every crossing of a ray, in no order, with the side that it
//! comes from. Model space, f64. `rays.rs` casts; this knows the mesh.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::derived::{Derived, Most};
use super::mesh::Mesh;
use super::rays::{Ray, Triangles};
use crate::process::work;

/// A range of a mesh's triangles in a box hierarchy.
pub struct SampledMesh(Arc<Triangles>);

/// Number of ranges whose hierarchies are kept, for a mesh of fewer parts.
const LEAST_RANGES: usize = 8;

/// Crossing of a ray and a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The parameter along the ray.
    pub t: f64,
    /// Triangle, counted from the range's first.
    pub triangle: u32,
    /// True if the ray comes from behind the front face.
    pub from_behind: bool,
}

impl SampledMesh {
    /// The triangles that `indices` holds, as `derived` keeps them; an index that the mesh does not have counts as its
    /// origin.
    pub fn new(mesh: &Arc<Mesh>, indices: Range<u32>, derived: &Derived) -> Self {
        let most = Most::OfMesh(mesh.parts.len().max(LEAST_RANGES));
        Self(derived.get(mesh, most, indices.clone(), || {
            let range = mesh.indices.get(indices.start as usize..indices.end as usize).unwrap_or_default();
            let corners = |corners: &[u32]| [0, 1, 2].map(|k| position(mesh, corners[k]));
            work::count_triangles(range.len());
            Arc::new(Triangles::new(range.chunks_exact(3).map(corners).collect()))
        }))
    }

    /// Calls `look` with every crossing of the ray, of both faces.
    pub fn crossings(&self, ray: &Ray, mut look: impl FnMut(Crossing)) {
        self.0.crossings(ray, |triangle, t| {
            let [a, b, c] = self.corners(triangle);
            look(Crossing { t, triangle, from_behind: (b - a).cross(c - a).dot(ray.way) > 0.0 });
        });
    }

    /// A triangle's corners.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        *self.0.corners(triangle)
    }
}

fn position(mesh: &Mesh, index: u32) -> DVec3 {
    mesh.positions.get(index as usize).map_or(DVec3::ZERO, |place| DVec3::from_array(place.map(f64::from)))
}
