//! Rays through a mesh's triangles, for decisions by sampling: all that a ray crosses, in no order, with the side that it
//! comes from. Model space, f64.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::{DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode, TraversalAction};

use super::Mesh;

/// A range of a mesh's triangles in a box hierarchy.
pub struct Sampled {
    mesh: Arc<Mesh>,
    /// The first index of the range.
    first: usize,
    bvh: Bvh,
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

/// A part of the line `origin + t * way`, for t in [start, end].
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub way: DVec3,
    pub start: f64,
    pub end: f64,
}

struct Entry {
    mesh: Weak<Mesh>,
    indices: Range<u32>,
    bvh: Bvh,
}

/// As long as a mesh lives: a plan is made for every frame.
static CACHE: Mutex<Vec<Entry>> = Mutex::new(Vec::new());

impl Sampled {
    /// Of the triangles that `indices` holds; an index that the mesh does not have counts as the last vertex.
    pub fn new(mesh: &Arc<Mesh>, indices: Range<u32>) -> Self {
        let first = indices.start as usize;
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        cache.retain(|entry| entry.mesh.strong_count() > 0);
        let known = |entry: &&Entry| std::ptr::eq(entry.mesh.as_ptr(), Arc::as_ptr(mesh)) && entry.indices == indices;
        if let Some(entry) = cache.iter().find(known) {
            return Self { mesh: mesh.clone(), first, bvh: entry.bvh.clone() };
        }
        let range = mesh.indices.get(first..indices.end as usize).unwrap_or_default();
        let boxes: Vec<Aabb> = range.chunks_exact(3).map(|corners| bound(mesh, corners)).collect();
        let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        cache.push(Entry { mesh: Arc::downgrade(mesh), indices, bvh: bvh.clone() });
        Self { mesh: mesh.clone(), first, bvh }
    }

    /// Calls `look` with all that the ray crosses, both faces.
    pub fn crossings(&self, ray: &Ray, mut look: impl FnMut(Crossing)) {
        let inverse = ray.way.recip();
        let far = ray.origin.abs().max_element().max(self.mesh.bounds.radius());
        let pad = far * f64::EPSILON * 16.0;
        self.bvh.traverse(|node| {
            if !meets(node, ray, inverse, pad) {
                return TraversalAction::Prune;
            }
            if let Some(triangle) = node.leaf_data()
                && let Some((t, from_behind)) = cross(ray, &self.corners(triangle))
                && (ray.start..=ray.end).contains(&t)
            {
                look(Crossing { t, triangle, from_behind });
            }
            TraversalAction::Continue
        });
    }

    /// A triangle's corners.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.vertices(triangle).map(|index| position(&self.mesh, index))
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

fn bound(mesh: &Mesh, corners: &[u32]) -> Aabb {
    let [mut min, mut max] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for index in corners {
        let corner = position(mesh, *index);
        (min, max) = (min.min(corner), max.max(corner));
    }
    Aabb::new(Vector::from_array(min.to_array()), Vector::from_array(max.to_array()))
}

fn meets(node: &BvhNode, ray: &Ray, inverse: DVec3, pad: f64) -> bool {
    let min = (DVec3::from_array(node.mins().to_array()) - pad - ray.origin) * inverse;
    let max = (DVec3::from_array(node.maxs().to_array()) + pad - ray.origin) * inverse;
    // f64::min and max leave out a NaN (0 * infinity: on a padded face, which no triangle reaches).
    let near = min.x.min(max.x).max(min.y.min(max.y)).max(min.z.min(max.z));
    let far = min.x.max(max.x).min(min.y.max(max.y)).min(min.z.max(max.z));
    // Parameters round relative to themselves.
    let slack = 1e-12 * near.abs().max(far.abs()).min(f64::MAX);
    near <= far + slack && near <= ray.end + slack && far >= ray.start - slack
}

/// Where the ray meets the triangle, and whether from behind. Of two triangles with an edge in common at least one is met:
/// the products of an edge are the same for both but for their signs.
fn cross(ray: &Ray, corners: &[DVec3; 3]) -> Option<(f64, bool)> {
    let [a, b, c] = corners.map(|corner| corner - ray.origin);
    let (u, v, w) = (ray.way.dot(b.cross(c)), ray.way.dot(c.cross(a)), ray.way.dot(a.cross(b)));
    let from_behind = u >= 0.0 && v >= 0.0 && w >= 0.0;
    if !(from_behind || u <= 0.0 && v <= 0.0 && w <= 0.0) {
        return None;
    }
    let sum = u + v + w;
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let t = normal.dot(a) / normal.dot(ray.way);
    (sum != 0.0 && t.is_finite()).then_some((t, from_behind))
}
