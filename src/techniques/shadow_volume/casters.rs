//! Casters: the connected parts of an object, with their adjacency, which is found once for each mesh.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::DMat4;

use crate::geometry::Mesh;
use crate::geometry::volume::Caster;
use crate::lights::Drawable;
use crate::math::Aabb;

/// An object that casts.
pub struct CastingObject {
    pub label: String,
    /// Index into the scene's objects.
    pub object: usize,
    pub caster: Arc<Caster>,
    pub world_from_model: DMat4,
    /// Bounds in model space, of the parts that cast.
    pub bounds: Aabb,
    /// True if the alpha test makes holes in its surface; its volume has none.
    pub has_holes: bool,
}

/// The objects of `items` that cast, each with all its parts: a surface may be closed only across them.
pub fn casting_objects(items: &[Drawable]) -> Vec<CastingObject> {
    let mut casting = Vec::new();
    for parts in items.chunk_by(|a, b| a.object == b.object) {
        let [first, ..] = parts else { continue };
        if !first.casts_shadow {
            continue;
        }
        let ranges: Vec<Range<u32>> = parts.iter().map(|part| part.indices.clone()).collect();
        casting.push(CastingObject {
            label: first.label.clone(),
            object: first.object,
            caster: adjacency(&first.mesh.0, ranges),
            world_from_model: first.world_from_model,
            bounds: parts.iter().fold(Aabb::EMPTY, |bounds, part| bounds.union(part.bounds)),
            has_holes: parts.iter().any(Drawable::needs_alpha_test),
        });
    }
    casting
}

struct Known {
    mesh: Weak<Mesh>,
    ranges: Vec<Range<u32>>,
    caster: Arc<Caster>,
}

/// Casters of every mesh that is still alive: neither a moved light nor the next frame searches edges again.
static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());

fn adjacency(mesh: &Arc<Mesh>, ranges: Vec<Range<u32>>) -> Arc<Caster> {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.retain(|entry| entry.mesh.strong_count() > 0);
    let same = |entry: &&Known| std::ptr::eq(entry.mesh.as_ptr(), Arc::as_ptr(mesh)) && entry.ranges == ranges;
    if let Some(found) = known.iter().find(same) {
        return found.caster.clone();
    }
    let caster = Arc::new(Caster::new(mesh, &ranges));
    known.push(Known { mesh: Arc::downgrade(mesh), ranges, caster: caster.clone() });
    caster
}
