//! Casters: the connected parts of an object, with their adjacency, which is found once for each mesh.

use std::ops::Range;
use std::sync::Arc;

use glam::DMat4;

use crate::geometry::volume::Caster;
use crate::geometry::{Derived, Mesh, Most};
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
pub fn casting_objects(items: &[Drawable], derived: &Derived) -> Vec<CastingObject> {
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
            caster: adjacency(&first.mesh.0, ranges, derived),
            world_from_model: first.world_from_model,
            bounds: parts.iter().fold(Aabb::EMPTY, |bounds, part| bounds.union(part.bounds)),
            has_holes: parts.iter().any(Drawable::needs_alpha_test),
        });
    }
    casting
}

/// Number of lists of ranges whose adjacency is kept for one mesh: objects of one mesh may leave out different parts.
const MOST_RANGES: usize = 64;

/// The caster of a mesh: neither a moved light nor the next frame searches edges again.
fn adjacency(mesh: &Arc<Mesh>, ranges: Vec<Range<u32>>, derived: &Derived) -> Arc<Caster> {
    derived.get(mesh, Most::OfMesh(MOST_RANGES), ranges.clone(), || Arc::new(Caster::new(mesh, &ranges)))
}
