//! Applies a complete draw state. State that GL already has is not set again.

use glow::HasContext;

use crate::pass::{Blend, Compare, DrawState, Face, Stencil, StencilOp};

/// The state that GL is known to have, and the winding of front faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Applied {
    pub state: DrawState,
    pub mirrored: bool,
}

/// Sets all of `state`, unless `known` says that GL has it.
pub fn apply(gl: &glow::Context, state: &DrawState, known: &mut Option<Applied>) {
    if known.is_some_and(|applied| applied.state == *state) {
        return;
    }
    unsafe {
        set_depth(gl, state);
        let [red, green, blue, alpha] = state.color_write.mask();
        gl.color_mask(red, green, blue, alpha);
        match state.cull {
            Some(face) => {
                gl.enable(glow::CULL_FACE);
                gl.cull_face(if face == Face::Front { glow::FRONT } else { glow::BACK });
            }
            None => gl.disable(glow::CULL_FACE),
        }
        match state.polygon_offset {
            Some(offset) => {
                gl.enable(glow::POLYGON_OFFSET_FILL);
                gl.polygon_offset(offset.factor, offset.units);
            }
            None => gl.disable(glow::POLYGON_OFFSET_FILL),
        }
        set_blend(gl, state.blend);
        set_stencil(gl, state.stencil);
        set_scissor(gl, state.scissor);
        if known.is_none() {
            gl.disable(glow::DITHER);
            gl.front_face(glow::CCW);
        }
    }
    let mirrored = known.is_some_and(|applied| applied.mirrored);
    *known = Some(Applied { state: *state, mirrored });
}

fn set_depth(gl: &glow::Context, state: &DrawState) {
    unsafe {
        match state.depth_test {
            Some(test) => {
                gl.enable(glow::DEPTH_TEST);
                gl.depth_func(compare_code(test));
            }
            None => gl.disable(glow::DEPTH_TEST),
        }
        gl.depth_mask(state.depth_write);
        gl.depth_range_f32(state.depth_range[0], state.depth_range[1]);
        enable(gl, glow::DEPTH_CLAMP, state.depth_clamp);
        enable(gl, glow::TEXTURE_CUBE_MAP_SEAMLESS, state.seamless);
        for distance in 0..DrawState::MOST_CLIP_DISTANCES {
            enable(gl, glow::CLIP_DISTANCE0 + u32::from(distance), distance < state.clip_distances);
        }
    }
}

fn enable(gl: &glow::Context, what: u32, on: bool) {
    unsafe { if on { gl.enable(what) } else { gl.disable(what) } }
}

fn set_blend(gl: &glow::Context, blend: Option<Blend>) {
    enable(gl, glow::BLEND, blend.is_some());
    let (source, destination) = match blend {
        None => return,
        Some(Blend::Add) => (glow::ONE, glow::ONE),
        Some(Blend::Over) => (glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA),
        Some(Blend::OverPremultiplied) => (glow::ONE, glow::ONE_MINUS_SRC_ALPHA),
        Some(Blend::AddByStoredAlpha) => (glow::DST_ALPHA, glow::ONE),
        Some(Blend::Multiply | Blend::MultiplyAndStoreAlpha) => (glow::DST_COLOR, glow::ZERO),
    };
    let alpha = match blend {
        Some(Blend::OverPremultiplied) => (source, destination),
        Some(Blend::MultiplyAndStoreAlpha) => (glow::ONE, glow::ZERO),
        _ => (glow::ZERO, glow::ONE),
    };
    unsafe {
        gl.blend_equation(glow::FUNC_ADD);
        gl.blend_func_separate(source, destination, alpha.0, alpha.1);
    }
}

fn set_stencil(gl: &glow::Context, stencil: Option<Stencil>) {
    enable(gl, glow::STENCIL_TEST, stencil.is_some());
    // Clears go through the mask even where the test is off.
    let Some(stencil) = stencil else { return unsafe { gl.stencil_mask(0xFF) } };
    unsafe {
        gl.stencil_mask(u32::from(stencil.write_mask));
        let test = compare_code(stencil.test);
        gl.stencil_func(test, i32::from(stencil.reference), u32::from(stencil.read_mask));
        for (face, ops) in [(glow::FRONT, stencil.front), (glow::BACK, stencil.back)] {
            let [fail, depth_fail, pass] = [ops.stencil_fail, ops.depth_fail, ops.pass].map(op_code);
            gl.stencil_op_separate(face, fail, depth_fail, pass);
        }
    }
}

fn op_code(op: StencilOp) -> u32 {
    match op {
        StencilOp::Keep => glow::KEEP,
        StencilOp::Zero => glow::ZERO,
        StencilOp::Replace => glow::REPLACE,
        StencilOp::Increment => glow::INCR,
        StencilOp::IncrementWrap => glow::INCR_WRAP,
        StencilOp::Decrement => glow::DECR,
        StencilOp::DecrementWrap => glow::DECR_WRAP,
        StencilOp::Invert => glow::INVERT,
    }
}

fn set_scissor(gl: &glow::Context, scissor: Option<[u32; 4]>) {
    enable(gl, glow::SCISSOR_TEST, scissor.is_some());
    if let Some([left, bottom, width, height]) = scissor.map(|sides| sides.map(|side| side as i32)) {
        unsafe { gl.scissor(left, bottom, width, height) };
    }
}

/// Front faces of a mirrored draw wind clockwise (GL 4.6, 14.8: facing is decided in window space).
pub fn set_mirrored(gl: &glow::Context, mirrored: bool, known: &mut Option<Applied>) {
    if let Some(applied) = known
        && applied.mirrored != mirrored
    {
        unsafe { gl.front_face(if mirrored { glow::CW } else { glow::CCW }) };
        applied.mirrored = mirrored;
    }
}

/// GL's code of a comparison.
pub fn compare_code(compare: Compare) -> u32 {
    match compare {
        Compare::Never => glow::NEVER,
        Compare::Less => glow::LESS,
        Compare::LessEqual => glow::LEQUAL,
        Compare::Equal => glow::EQUAL,
        Compare::NotEqual => glow::NOTEQUAL,
        Compare::GreaterEqual => glow::GEQUAL,
        Compare::Greater => glow::GREATER,
        Compare::Always => glow::ALWAYS,
    }
}
