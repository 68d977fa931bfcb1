//! Surfaces that coincide are lit once, by a stencil test in each pass that blends; and a proof that a picture has none, for
//! which the test is left out.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::BTreeSet;

use glam::DVec3;

use super::passes::Passes;
use super::projection::CameraProjection;
use crate::lights::sides::shows_no_back_face;
use crate::lights::{Drawable, Viewer};
use crate::math::Aabb;
use crate::math::frustum::{self, Overlap};
use crate::pass::{Clear, Compare, Stencil, StencilOp, StencilOps};

/// Stencil state that draws each pixel once. Its pass clears the stencil buffer to 0.
pub const ONCE: Stencil = Stencil {
    test: Compare::Equal,
    reference: 0,
    read_mask: 0xFF,
    write_mask: 0xFF,
    front: StencilOps { pass: StencilOp::Increment, ..StencilOps::KEEP },
    back: StencilOps { pass: StencilOp::Increment, ..StencilOps::KEEP },
};

/// Most items and most triangles of one that the proof looks at: it must cost less than it saves.
const MOST_ITEMS: usize = 64;
const MOST_TRIANGLES: usize = 64;

/// Most triangles of an item whose vertices are bounded.
const MOST_TRIANGLES_BOUND: usize = 1 << 16;

/// Steps of a depth buffer of 24 bits by which items must be apart, so that no rounding makes their depths equal.
const STEPS: f64 = 16.0;

/// Distances below this share of an item's size count as none: far above what f64 rounds.
const LEAST: f64 = 1e-9;

/// Need of a test that draws each pixel once: true where passes with depth EQUAL may meet two surfaces in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Once(pub bool);

impl Once {
    /// Finds it from the items in view: false only where each of them is one convex layer and their boxes are apart.
    pub fn find(passes: &Passes<'_>, lens: &CameraProjection) -> Self {
        let clip_from_world = lens.camera.clip_from_world();
        let is_single = |item: &&Drawable| {
            is_flat_quad(item)
                || (shows_no_back_face(item, &(clip_from_world * item.world_from_model)) && is_convex(item))
        };
        let proved = |seen: Seen<'_>| {
            seen.items.iter().all(is_single) && (0..seen.items.len()).all(|index| seen.is_alone(index, index + 1))
        };
        Self(passes.keep_all || !Seen::of(passes, lens).is_some_and(proved))
    }

    /// The items of the pass `label`, which blends; noted are those that it leaves out. These satisfy `is_idle`: the pass does
    /// not change their colours, because `why`. And no other item can pass the test for equal depth in their pixels.
    pub fn items<'a>(
        passes: &mut Passes<'a>,
        lens: &CameraProjection,
        (label, why): (&str, &str),
        is_idle: impl Fn(&Drawable) -> bool,
    ) -> Cow<'a, [Drawable]> {
        if passes.keep_all || !passes.items.iter().any(&is_idle) {
            return passes.cut_items(lens);
        }
        let Some(seen) = Seen::of(passes, lens) else { return passes.cut_items(lens) };
        let is_needed = |index: &usize| !is_idle(seen.items[*index]) || !seen.is_alone(*index, 0);
        let (needed, idle): (Vec<usize>, Vec<usize>) = (0..seen.items.len()).partition(is_needed);
        let names: BTreeSet<&str> = idle.iter().map(|index| seen.items[*index].label.as_str()).collect();
        if !names.is_empty() {
            let names = names.into_iter().collect::<Vec<_>>().join(", ");
            let why = format!("{why}, and no other surface in view is close");
            passes.notes.left_out(format!("{names} in pass \"{label}\""), why);
        }
        needed.into_iter().map(|index| seen.items[index].clone()).collect()
    }

    /// Stencil state of a pass that blends.
    pub fn stencil(self) -> Option<Stencil> {
        self.0.then_some(ONCE)
    }

    /// Clear of such a pass.
    pub fn clear(self) -> Clear {
        Clear { stencil: self.0.then_some(0), ..Clear::default() }
    }

    /// Notes that the test is left out.
    pub fn explain(self, passes: &mut Passes<'_>) {
        if !self.0 {
            let why = "no two surfaces in view can share a plane: each pixel is met once at its depth";
            passes.notes.left_out("stencil test of coincident surfaces", why);
        }
    }
}

/// The items in view, if they are few and none is cut: pieces of a cut surface may overlap by a rounding along the cut.
struct Seen<'a> {
    items: Vec<&'a Drawable>,
    /// Their bounds in world space, of their boxes' corners.
    boxes: Vec<Aabb>,
    /// The same, of their vertices.
    tight: OnceCell<Vec<Aabb>>,
    viewer: Viewer,
    near: f64,
}

impl<'a> Seen<'a> {
    fn of(passes: &Passes<'a>, lens: &CameraProjection) -> Option<Self> {
        if matches!(passes.cut_items(lens), Cow::Owned(_)) {
            return None;
        }
        let clip_from_world = lens.camera.clip_from_world();
        let in_view = |item: &&Drawable| {
            frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) != Overlap::Outside
        };
        let items: Vec<&Drawable> = passes.items.iter().filter(in_view).take(MOST_ITEMS + 1).collect();
        let boxes = items.iter().map(|item| item.bounds.transformed(&item.world_from_model)).collect();
        let seen = Self { items, boxes, tight: OnceCell::new(), viewer: lens.camera, near: passes.scene.camera.near };
        (seen.items.len() <= MOST_ITEMS).then_some(seen)
    }

    /// Tests whether an item is apart from each other one from index `first` on.
    fn is_alone(&self, index: usize, first: usize) -> bool {
        let apart_in = |boxes: &[Aabb], other| apart(&boxes[index], &boxes[other], &self.viewer, self.near);
        let others = (first..self.boxes.len()).filter(|other| *other != index);
        let mut close = others.filter(|other| !apart_in(&self.boxes, *other));
        close.all(|other| apart_in(self.tight.get_or_init(|| self.tight_boxes()), other))
    }

    fn tight_boxes(&self) -> Vec<Aabb> {
        self.items.iter().zip(&self.boxes).map(|(item, bounds)| tight_box(item).unwrap_or(*bounds)).collect()
    }
}

/// Tests whether two boxes are farther from each other, along the eye's ray too, than depths round.
fn apart(one: &Aabb, other: &Aabb, viewer: &Viewer, near: f64) -> bool {
    let gap = (one.min - other.max).max(other.min - one.max).max_element();
    let depth = |corner: DVec3| -viewer.eye_from_world.transform_point3(corner).z;
    let farthest = one.corners().into_iter().chain(other.corners()).map(depth).fold(near, f64::max);
    // One step at this depth, and the part of a ray's length that is depth at the picture's corners.
    let step = farthest * farthest / (near * f64::from(1 << 24));
    let scale = viewer.clip_from_eye;
    let cosine = 1.0 / (1.0 + scale.x_axis.x.powi(-2) + scale.y_axis.y.powi(-2)).sqrt();
    gap * cosine > STEPS * step
}

/// The bounds of an item's vertices in world space; `None` for a large mesh, and where the vertex stage moves vertices.
fn tight_box(item: &Drawable) -> Option<Aabb> {
    let indices = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize)?;
    if indices.len() > 3 * MOST_TRIANGLES_BOUND || item.wave.is_some() {
        return None;
    }
    let place = |index: &u32| item.mesh.positions.get(*index as usize).map(|at| DVec3::from_array(at.map(f64::from)));
    let places = indices.iter().filter_map(place).map(|at| item.world_from_model.transform_point3(at));
    Some(Aabb::from_points(places)).filter(|bounds| !bounds.is_empty())
}

/// The corners of an item's triangles; `None` for a large mesh, and where the vertex stage moves vertices.
fn triangles(item: &Drawable) -> Option<Vec<[DVec3; 3]>> {
    let indices = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize)?;
    if indices.len() > 3 * MOST_TRIANGLES || item.wave.is_some() {
        return None;
    }
    let place = |index: u32| item.mesh.positions.get(index as usize).map(|at| DVec3::from_array(at.map(f64::from)));
    let corners = |triangle: &[u32; 3]| {
        let [a, b, c] = *triangle;
        Some([place(a)?, place(b)?, place(c)?])
    };
    indices.as_chunks::<3>().0.iter().map(corners).collect()
}

/// Tests whether the item is at most two triangles of one plane on both sides of an edge that they share.
fn is_flat_quad(item: &Drawable) -> bool {
    let Some(triangles) = triangles(item) else { return false };
    let [one, other] = triangles[..] else { return triangles.len() < 2 };
    let normal = (one[1] - one[0]).cross(one[2] - one[0]);
    let is_in_plane = other.iter().all(|at| normal.dot(*at - one[0]).abs() <= LEAST * normal.length());
    let is_shared = |at: &DVec3| other.contains(at);
    let (shared, own): (Vec<DVec3>, Vec<DVec3>) = one.iter().partition(|at| is_shared(at));
    let rest: Vec<DVec3> = other.iter().filter(|at| !one.contains(at)).copied().collect();
    let ([a, b], [p], [q]) = (&shared[..], &own[..], &rest[..]) else { return false };
    let side = |at: DVec3| (*b - *a).cross(at - *a).dot(normal);
    is_in_plane && side(*p) * side(*q) < 0.0
}

/// Tests whether all corners lie behind each triangle's plane or in it.
fn is_convex(item: &Drawable) -> bool {
    let Some(triangles) = triangles(item) else { return false };
    let corners: Vec<DVec3> = triangles.iter().flatten().copied().collect();
    let size = item.bounds.radius();
    triangles.iter().all(|[a, b, c]| {
        let normal = (*b - *a).cross(*c - *a);
        let most = LEAST * size * normal.length();
        corners.iter().all(|at| normal.dot(*at - *a) <= most)
    })
}
