//! Splits an item's triangles by a plane: those before it, those across it and those behind it, each a range of one mesh
//! [LEC, "Careful about Back Projecting Shadow Maps"].

use std::sync::Arc;

use glam::DVec3;

use crate::geometry::{Derived, Mesh, Most};
use crate::lights::Drawable;
use crate::lights::guard::{ModelPlane, Side};
use crate::math::Aabb;
use crate::pass::MeshRef;
use crate::process::work;

/// The item's triangles before, across and behind the plane; `None` for a part without any. `None` for an item whose
/// vertices the vertex stage moves.
pub fn partition(item: &Drawable, plane: &ModelPlane, derived: &Derived) -> Option<[Option<Drawable>; 3]> {
    if item.wave.is_some() {
        return None;
    }
    let (plane, most) = (plane.rounded(), MOST_PLANES * item.mesh.parts.len().max(1));
    let key = (item.indices.clone(), plane);
    let parts = derived.get(&item.mesh.0, Most::OfMesh(most), key, || part(item, &plane));
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

/// Number of planes kept for each part of a mesh. A moving light adds a plane in every frame.
const MOST_PLANES: usize = 8;

fn part(item: &Drawable, plane: &ModelPlane) -> Parts {
    let mut lists: [Vec<u32>; 3] = Default::default();
    let range = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize).unwrap_or_default();
    let point = |index: &u32| item.mesh.positions.get(*index as usize).map(|at| DVec3::from_array(at.map(f64::from)));
    work::count_triangles(range.len());
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
        colors: item.mesh.colors.clone(),
        tangents: item.mesh.tangents.clone(),
        indices: lists.concat(),
        bounds: item.bounds,
        ..Mesh::default()
    };
    Parts { mesh: Arc::new(mesh), ends }
}
