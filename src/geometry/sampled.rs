//! Rays through a mesh's triangles, for decisions by sampling: every crossing of a ray, in no order, with the side that it
//! comes from. Model space, f64. `rays.rs` casts; this knows the mesh.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::DVec3;

use super::Mesh;
use super::rays::{Ray, Triangles};

/// A range of a mesh's triangles in a box hierarchy.
pub struct SampledMesh(Arc<Triangles>);

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

/// A mesh by its address, which is unique while a `Weak` of it exists, and a range of its indices.
type Key = (usize, Range<u32>);

/// A hierarchy, and the mesh that it is of.
type Kept = (Weak<Mesh>, Arc<Triangles>);

/// Hierarchies, each kept as long as its mesh lives: a plan is made for every frame.
static CACHE: Mutex<Option<Cache>> = Mutex::new(None);

#[derive(Default)]
struct Cache {
    kept: HashMap<Key, Kept>,
    /// Number of trees to keep before those of dead meshes are dropped.
    room: usize,
}

/// Number of hierarchies that are always kept.
const LEAST_ROOM: usize = 32;

impl SampledMesh {
    /// The triangles that `indices` holds; an index that the mesh does not have counts as its origin.
    pub fn new(mesh: &Arc<Mesh>, indices: Range<u32>) -> Self {
        let key = (Arc::as_ptr(mesh) as usize, indices);
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        let cache = cache.get_or_insert_default();
        if let Some((_, triangles)) = cache.kept.get(&key) {
            return Self(triangles.clone());
        }
        // At twice the number of live ones, so that the search costs no more than the insertions.
        if cache.kept.len() >= cache.room {
            cache.kept.retain(|_, (mesh, _)| mesh.strong_count() > 0);
            cache.room = 2 * cache.kept.len() + LEAST_ROOM;
        }
        let range = mesh.indices.get(key.1.start as usize..key.1.end as usize).unwrap_or_default();
        let corners = |corners: &[u32]| [0, 1, 2].map(|k| position(mesh, corners[k]));
        let triangles = Arc::new(Triangles::new(range.chunks_exact(3).map(corners).collect()));
        cache.kept.insert(key, (Arc::downgrade(mesh), triangles.clone()));
        Self(triangles)
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
