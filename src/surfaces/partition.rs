//! Splits an item's triangles by a plane: those before it, those across it and those behind it, each a range of one mesh
//! [LEC, "Careful about Back Projecting Shadow Maps"].

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::DVec3;

use crate::geometry::Mesh;
use crate::lights::Drawable;
use crate::lights::guard::{ModelPlane, Side};
use crate::math::Aabb;
use crate::pass::MeshRef;

/// The item's triangles before, across and behind the plane; `None` for a part without any. `None` for an item whose
/// vertices the vertex stage moves.
pub fn partition(item: &Drawable, plane: &ModelPlane) -> Option<[Option<Drawable>; 3]> {
    if item.wave.is_some() {
        return None;
    }
    let parts = cached(item, &plane.rounded());
    let mut start = 0;
    Some(parts.ends.map(|(end, bounds)| {
        let indices = start..end;
        start = end;
        let mesh = MeshRef(parts.mesh.clone());
        (!indices.is_empty()).then(|| Drawable { mesh, indices, bounds, ..item.clone() })
    }))
}

/// The mesh in its new order, and where each part ends, with its bounds.
#[derive(Clone)]
struct Parts {
    mesh: Arc<Mesh>,
    ends: [(u32, Aabb); 3],
}

/// Partitions of a mesh, kept as long as it lives: a plan is made for every frame, and lights and objects mostly stand
/// still.
struct Entry {
    source: Weak<Mesh>,
    indices: Range<u32>,
    plane: ModelPlane,
    parts: Parts,
}

static CACHE: Mutex<Vec<Entry>> = Mutex::new(Vec::new());

/// Number of planes kept for one mesh; the oldest goes first. A moving light adds a plane in every frame.
const MOST_PLANES: usize = 8;

fn cached(item: &Drawable, plane: &ModelPlane) -> Parts {
    let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
    cache.retain(|entry| entry.source.strong_count() > 0);
    let is_range =
        |entry: &Entry| entry.indices == item.indices && std::ptr::eq(entry.source.as_ptr(), Arc::as_ptr(&item.mesh.0));
    if let Some(entry) = cache.iter().find(|entry| is_range(entry) && entry.plane == *plane) {
        return entry.parts.clone();
    }
    let parts = part(item, plane);
    if cache.iter().filter(|entry| is_range(entry)).count() >= MOST_PLANES
        && let Some(oldest) = cache.iter().position(is_range)
    {
        cache.remove(oldest);
    }
    let (source, indices) = (Arc::downgrade(&item.mesh.0), item.indices.clone());
    cache.push(Entry { source, indices, plane: *plane, parts: parts.clone() });
    parts
}

fn part(item: &Drawable, plane: &ModelPlane) -> Parts {
    let mut lists: [Vec<u32>; 3] = Default::default();
    let range = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize).unwrap_or_default();
    let point = |index: &u32| item.mesh.positions.get(*index as usize).map(|at| DVec3::from_array(at.map(f64::from)));
    for triangle in range.chunks_exact(3) {
        let points: Vec<DVec3> = triangle.iter().filter_map(point).collect();
        let list = match plane.of(&points) {
            Side::Before => &mut lists[0],
            Side::Across => &mut lists[1],
            Side::Behind => &mut lists[2],
        };
        list.extend_from_slice(triangle);
    }
    let mut end = 0;
    let ends = [0, 1, 2].map(|part: usize| {
        end += lists[part].len() as u32;
        (end, Aabb::from_points(lists[part].iter().filter_map(point)))
    });
    let mesh = Mesh {
        name: format!("{}, parted", item.mesh.name),
        positions: item.mesh.positions.clone(),
        normals: item.mesh.normals.clone(),
        texcoords: item.mesh.texcoords.clone(),
        indices: lists.concat(),
        bounds: item.bounds,
        ..Mesh::default()
    };
    Parts { mesh: Arc::new(mesh), ends }
}
