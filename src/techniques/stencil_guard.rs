//! `guard = "stencil"`: tags everything behind a spotlight in the stencil buffer [LEC, "Careful about Back Projecting
//! Shadow Maps"], by counting one volume, the light's own frustum mirrored at the light. The light is added, shadow and
//! all, where the count is 0.

use std::sync::Arc;

use crate::geometry::Mesh;
use crate::lights::guard::{Guard, LightPlane, Side};
use crate::lights::light::{CountPass, Counted, Lighting, StencilCount, VolumeDepths, VolumeDraw, VolumeSpace};
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::{Compare, DrawState, MeshRef, Primitive, Redraw, Stencil, StencilOp, StencilOps};
use crate::scene::Frustum;

/// Gives `term` the `guard` that the light's keys choose. Nothing is counted if no visible item needs it.
pub fn guard(view: &LightView<'_>, guard: Guard, term: &mut LightTerm, notes: &mut Notes) {
    term.guard = guard;
    let (Guard::Stencil, Some(frustum)) = (guard, view.light().frustum()) else { return };
    if !view.keep_all && !anything_behind(view, term) {
        let why = "nothing that is seen lies behind the light, or across its plane";
        notes.left_out(format!("tags behind light {}", view.index), why);
        term.guard = Guard::Auto;
        return;
    }
    term.counting = Some(counting(view, frustum));
}

fn anything_behind(view: &LightView<'_>, term: &LightTerm) -> bool {
    let viewer = &view.camera.viewer;
    let Some(plane) = LightPlane::of(term.coordinates.as_ref(), true, viewer) else { return true };
    view.camera.visible.iter().any(|item| plane.side(item, viewer) != Side::Before)
}

/// The count of the volume by z-fail, so that the eye may be in it; its end is at infinity, and so is the far plane.
fn counting(view: &LightView<'_>, frustum: &Frustum) -> StencilCount {
    let ops = |depth_fail| StencilOps { depth_fail, ..StencilOps::KEEP };
    let stencil = Stencil {
        test: Compare::Always,
        reference: 0,
        read_mask: 0xFF,
        write_mask: 0xFF,
        front: ops(StencilOp::DecrementWrap),
        back: ops(StencilOp::IncrementWrap),
    };
    let volume = volume(view, frustum);
    let pass = CountPass {
        label: format!("light {}: behind it", view.index),
        state: DrawState { depth_write: false, stencil: Some(stencil), ..DrawState::DEPTH_ONLY },
        depths: VolumeDepths::Scene,
        counted: Counted::Volumes(vec![volume.clone()]),
    };
    StencilCount {
        passes: vec![pass],
        // One volume costs less than to keep its count.
        redraw: Redraw::Always,
        of_all: true,
        infinite: true,
        clamped: false,
        casters: Vec::new(),
        ledge: None,
        lighting: Lighting::Added,
        scissor: None,
        volumes: vec![volume],
        silhouettes: Vec::new(),
    }
}

/// Factor by which the volume is wider than the wrongly lit region, so that rounding of depths does not show at its sides:
/// they meet the light's reach only at the light itself.
const WIDER: f64 = 1.02;

/// The pyramid with its tip in the light and its base at infinity behind it, in the light's space, faces outwards.
fn volume(view: &LightView<'_>, frustum: &Frustum) -> VolumeDraw {
    let clip_from_view = frustum.clip_from_view();
    let [x, y] = [clip_from_view.x_axis.x, clip_from_view.y_axis.y].map(|scale| (WIDER / scale) as f32);
    let homogeneous =
        vec![[0.0, 0.0, 0.0, 1.0], [x, y, 1.0, 0.0], [-x, y, 1.0, 0.0], [-x, -y, 1.0, 0.0], [x, -y, 1.0, 0.0]];
    let indices = vec![0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 1, 2, 3, 1, 3, 4];
    let count = indices.len() as u32;
    let label = format!("space behind light {}", view.index);
    VolumeDraw {
        mesh: MeshRef(Arc::new(Mesh { name: label.clone(), homogeneous, indices, ..Mesh::default() })),
        label,
        primitive: Primitive::Triangles,
        indices: 0..count,
        space: VolumeSpace::Model { world_from_model: frustum.view_from_world().inverse() },
        reversed: false,
    }
}
