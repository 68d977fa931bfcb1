//! Applies a complete draw state. What is already so is not set again.

use glow::HasContext;

use crate::pass::{Compare, DrawState, Face};

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
        gl.color_mask(state.color_write, state.color_write, state.color_write, state.color_write);
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
        if known.is_none() {
            gl.disable(glow::BLEND);
            gl.disable(glow::SCISSOR_TEST);
            gl.disable(glow::STENCIL_TEST);
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
        Compare::Less => glow::LESS,
        Compare::LessEqual => glow::LEQUAL,
        Compare::Equal => glow::EQUAL,
        Compare::GreaterEqual => glow::GEQUAL,
        Compare::Greater => glow::GREATER,
        Compare::Always => glow::ALWAYS,
    }
}
