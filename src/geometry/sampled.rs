//! Rays through a mesh's triangles, for decisions by sampling: all that a ray crosses, in no order, with the side that it
//! comes from. Model space, f64. `rays.rs` casts; this knows the mesh.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::{DVec2, DVec3};

use super::Mesh;
use super::rays::{Ray, Triangles};

/// A range of a mesh's triangles in a box hierarchy.
pub struct Sampled {
    mesh: Arc<Mesh>,
    /// The first index of the range.
    first: usize,
    triangles: Arc<Triangles>,
}

/// Where a ray crosses a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The parameter along the ray.
    pub t: f64,
    /// Counted from the range's first.
    pub triangle: u32,
    /// Whether the ray comes from behind the front face.
    pub from_behind: bool,
}

struct Entry {
    mesh: Weak<Mesh>,
    indices: Range<u32>,
    triangles: Arc<Triangles>,
}

/// Hierarchies, each kept as long as its mesh lives: a plan is made for every frame.
static CACHE: Mutex<Vec<Entry>> = Mutex::new(Vec::new());

impl Sampled {
    /// The triangles that `indices` holds; an index that the mesh does not have counts as its origin.
    pub fn new(mesh: &Arc<Mesh>, indices: Range<u32>) -> Self {
        let first = indices.start as usize;
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        cache.retain(|entry| entry.mesh.strong_count() > 0);
        let known = |entry: &&Entry| std::ptr::eq(entry.mesh.as_ptr(), Arc::as_ptr(mesh)) && entry.indices == indices;
        if let Some(entry) = cache.iter().find(known) {
            return Self { mesh: mesh.clone(), first, triangles: entry.triangles.clone() };
        }
        let range = mesh.indices.get(first..indices.end as usize).unwrap_or_default();
        let corners = |corners: &[u32]| [0, 1, 2].map(|k| position(mesh, corners[k]));
        let triangles = Arc::new(Triangles::new(range.chunks_exact(3).map(corners).collect()));
        cache.push(Entry { mesh: Arc::downgrade(mesh), indices, triangles: triangles.clone() });
        Self { mesh: mesh.clone(), first, triangles }
    }

    /// Calls `look` with all that the ray crosses, both faces.
    pub fn crossings(&self, ray: &Ray, mut look: impl FnMut(Crossing)) {
        self.triangles.crossings(ray, |triangle, t| {
            let [a, b, c] = self.corners(triangle);
            look(Crossing { t, triangle, from_behind: (b - a).cross(c - a).dot(ray.way) > 0.0 });
        });
    }

    /// A triangle's corners.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        *self.triangles.corners(triangle)
    }

    /// The mesh's texture coordinates where `point` lies in the triangle's plane; `None` where it has none.
    pub fn texcoord(&self, triangle: u32, point: DVec3) -> Option<DVec2> {
        let texcoords = self.mesh.texcoords.as_ref()?;
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a);
        let share = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / normal.length_squared();
        let weights = [share(b, c), share(c, a), share(a, b)];
        let at = |index: u32| {
            texcoords.get(index as usize).map_or(DVec2::ZERO, |[s, t]| DVec2::new(f64::from(*s), f64::from(*t)))
        };
        let corners = self.vertices(triangle);
        Some((0..3).map(|k| weights[k] * at(corners[k])).sum())
    }

    fn vertices(&self, triangle: u32) -> [u32; 3] {
        let first = self.first + 3 * triangle as usize;
        [0, 1, 2].map(|k| self.mesh.indices.get(first + k).copied().unwrap_or_default())
    }
}

fn position(mesh: &Mesh, index: u32) -> DVec3 {
    mesh.positions.get(index as usize).map_or(DVec3::ZERO, |place| DVec3::from_array(place.map(f64::from)))
}
