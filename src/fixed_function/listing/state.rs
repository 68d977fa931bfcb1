//! Clears and raster state.

use super::c::{self, Text, boolean, float, floats};
use crate::pass::{Blend, Clear, DrawState, Stencil};

/// State that GL has been set to.
#[derive(Clone, Copy)]
pub struct ListingState {
    pub state: DrawState,
    /// Front faces wind clockwise.
    pub mirrored: bool,
}

impl ListingState {
    pub fn of(state: DrawState) -> Self {
        Self { state, mirrored: false }
    }
}

/// Clears the whole target.
pub fn clear(out: &mut Text, clear: &Clear) {
    let mut buffers = Vec::new();
    if let Some(color) = clear.color {
        out.call("glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE)");
        out.call(&format!("glClearColor({})", floats(&color)));
        buffers.push("GL_COLOR_BUFFER_BIT");
    }
    if let Some(depth) = clear.depth {
        out.call("glDepthMask(GL_TRUE)");
        out.call(&format!("glClearDepth({depth:?})"));
        buffers.push("GL_DEPTH_BUFFER_BIT");
    }
    if let Some(stencil) = clear.stencil {
        out.call("glStencilMask(0xFF)");
        out.call(&format!("glClearStencil({stencil})"));
        buffers.push("GL_STENCIL_BUFFER_BIT");
    }
    if !buffers.is_empty() {
        out.call("glDisable(GL_SCISSOR_TEST)");
        out.call(&format!("glClear({})", buffers.join(" | ")));
    }
}

/// Sets the parts of `next` that differ from `last`; all of it where the state is unknown.
pub fn set(out: &mut Text, last: Option<&DrawState>, next: &DrawState) {
    let changed = |differs: &dyn Fn(&DrawState) -> bool| last.is_none_or(differs);
    if changed(&|last| last.depth_test != next.depth_test) {
        out.enable("GL_DEPTH_TEST", next.depth_test.is_some());
        next.depth_test.iter().for_each(|test| out.call(&format!("glDepthFunc({})", c::compare(*test))));
    }
    if changed(&|last| last.depth_write != next.depth_write) {
        out.call(&format!("glDepthMask({})", boolean(next.depth_write)));
    }
    if changed(&|last| last.color_write != next.color_write) {
        let [red, green, blue, alpha] = next.color_write.mask().map(boolean);
        out.call(&format!("glColorMask({red}, {green}, {blue}, {alpha})"));
    }
    if changed(&|last| last.cull != next.cull) {
        out.enable("GL_CULL_FACE", next.cull.is_some());
        next.cull.iter().for_each(|face| out.call(&format!("glCullFace({})", c::face(*face))));
    }
    if changed(&|last| last.polygon_offset != next.polygon_offset) {
        out.enable("GL_POLYGON_OFFSET_FILL", next.polygon_offset.is_some());
        if let Some(offset) = next.polygon_offset {
            out.call(&format!("glPolygonOffset({}, {})", float(offset.factor), float(offset.units)));
        }
    }
    if changed(&|last| last.depth_range != next.depth_range) {
        out.call(&format!("glDepthRange({:?}, {:?})", next.depth_range[0], next.depth_range[1]));
    }
    if changed(&|last| last.depth_clamp != next.depth_clamp) {
        out.enable("GL_DEPTH_CLAMP", next.depth_clamp);
    }
    for distance in 0..DrawState::MOST_CLIP_DISTANCES {
        let is_on = distance < next.clip_distances;
        // At first all are off.
        let was_on = last.is_some_and(|last| distance < last.clip_distances);
        if is_on != was_on {
            out.enable(&format!("GL_CLIP_DISTANCE{distance}"), is_on);
        }
    }
    if changed(&|last| last.stencil != next.stencil) {
        set_stencil(out, next.stencil);
    }
    if changed(&|last| last.blend != next.blend) {
        set_blend(out, next.blend);
    }
    if changed(&|last| last.scissor != next.scissor) {
        out.enable("GL_SCISSOR_TEST", next.scissor.is_some());
        if let Some([left, bottom, width, height]) = next.scissor {
            out.call(&format!("glScissor({left}, {bottom}, {width}, {height})"));
        }
    }
}

fn set_stencil(out: &mut Text, stencil: Option<Stencil>) {
    out.enable("GL_STENCIL_TEST", stencil.is_some());
    let Some(stencil) = stencil else { return };
    let Stencil { test, reference, read_mask, write_mask, front, back } = stencil;
    out.call(&format!("glStencilFunc({}, {reference}, 0x{read_mask:02X})", c::compare(test)));
    out.call(&format!("glStencilMask(0x{write_mask:02X})"));
    for (face, ops) in [("GL_FRONT", front), ("GL_BACK", back)] {
        let [fail, depth_fail, pass] = [ops.stencil_fail, ops.depth_fail, ops.pass].map(c::stencil_op);
        out.call(&format!("glStencilOpSeparate({face}, {fail}, {depth_fail}, {pass})"));
    }
}

fn set_blend(out: &mut Text, blend: Option<Blend>) {
    out.enable("GL_BLEND", blend.is_some());
    let factors = match blend {
        None => return,
        Some(Blend::Add) => "GL_ONE, GL_ONE",
        Some(Blend::AddByStoredAlpha) => "GL_DST_ALPHA, GL_ONE",
        Some(Blend::Multiply | Blend::MultiplyAndStoreAlpha) => "GL_DST_COLOR, GL_ZERO",
        Some(Blend::Over) => "GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA",
        Some(Blend::OverPremultiplied) => "GL_ONE, GL_ONE_MINUS_SRC_ALPHA",
    };
    let alpha = match blend {
        Some(Blend::OverPremultiplied) => factors,
        Some(Blend::MultiplyAndStoreAlpha) => "GL_ONE, GL_ZERO",
        _ => "GL_ZERO, GL_ONE",
    };
    out.call("glBlendEquation(GL_FUNC_ADD)");
    out.call(&format!("glBlendFuncSeparate({factors}, {alpha})"));
}
