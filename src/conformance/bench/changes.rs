//! State of the pipeline that is set one piece at a time, and stays as it is until it is set again.

use glow::HasContext;

use super::state::{GlCompare, GlOffset, GlPolygonMode};
use super::{Bench, Error, Surface};

/// One call that sets state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GlChange {
    /// glEnable or glDisable.
    Switch(u32, bool),
    /// x, y, width, height.
    Viewport([i32; 4]),
    Scissor([i32; 4]),
    /// By glDepthRange, or by glDepthRangef.
    DepthRange([f64; 2], bool),
    DepthFunction(GlCompare),
    DepthWrite(bool),
    ColorWrite([bool; 4]),
    /// GL_FRONT, GL_BACK or GL_FRONT_AND_BACK.
    CullFace(u32),
    /// glFrontFace, clockwise or not.
    FrontFace(bool),
    /// glPolygonMode of both faces.
    Mode(GlPolygonMode),
    Offset(GlOffset),
    /// glBlendFunc.
    Blend([u32; 2]),
    /// glProvokingVertex, the first or the last.
    Provoke(bool),
}

impl Bench {
    /// Sets one piece of state.
    pub fn change(&self, change: GlChange) {
        let gl = &self.gl;
        // SAFETY: the context is current; only state is set; glPolygonOffsetClamp has the signature that it was loaded with.
        unsafe {
            match change {
                GlChange::Switch(what, true) => gl.enable(what),
                GlChange::Switch(what, false) => gl.disable(what),
                GlChange::Viewport([x, y, width, height]) => gl.viewport(x, y, width, height),
                GlChange::Scissor([x, y, width, height]) => gl.scissor(x, y, width, height),
                GlChange::DepthRange([near, far], false) => gl.depth_range(near, far),
                GlChange::DepthRange([near, far], true) => gl.depth_range_f32(near as f32, far as f32),
                GlChange::DepthFunction(compare) => gl.depth_func(compare.code()),
                GlChange::DepthWrite(on) => gl.depth_mask(on),
                GlChange::ColorWrite([red, green, blue, alpha]) => gl.color_mask(red, green, blue, alpha),
                GlChange::CullFace(face) => gl.cull_face(face),
                GlChange::FrontFace(clockwise) => gl.front_face(if clockwise { glow::CW } else { glow::CCW }),
                GlChange::Mode(mode) => gl.polygon_mode(glow::FRONT_AND_BACK, mode.code()),
                GlChange::Offset(GlOffset { factor, units, clamp }) => match self.offset_clamp {
                    Some(function) if clamp != 0.0 => function(factor, units, clamp),
                    _ => gl.polygon_offset(factor, units),
                },
                GlChange::Blend([source, destination]) => gl.blend_func(source, destination),
                GlChange::Provoke(first) => {
                    self.provoke(first);
                }
            }
        }
    }

    /// Clears every colour buffer that is drawn into, and depth, under the state that there is.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn clear_outputs_as_it_is(&self, outputs: u32, color: [f32; 4], depth: f32) -> Result<(), Error> {
        // SAFETY: the context is current, and a framebuffer is bound.
        unsafe {
            for output in 0..outputs {
                self.gl.clear_buffer_f32_slice(glow::COLOR, output, &color);
            }
            self.gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]);
        }
        self.check("a clear under the state that there is")
    }
}

impl Surface {
    /// Every colour of the colour image at an attachment, of floats, rows from below.
    pub fn floats_of(&self, attachment: u32) -> Vec<[f32; 4]> {
        self.read_from(attachment);
        self.floats()
    }
}
