//! Clears under a state: by glClear, and by glClearBuffer as the device does.

use glow::HasContext;

use super::{Bench, Error, GlState, Surface};

/// Buffers that are cleared, each with its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GlClear {
    pub color: Option<[f32; 4]>,
    pub depth: Option<f32>,
    pub stencil: Option<u8>,
    /// By glClearBuffer; depth and stencil together by glClearBufferfi.
    pub by_buffer: bool,
}

impl Bench {
    /// Clears under the scissor and the masks of `state`.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn clear(&self, surface: &Surface, state: GlState, clear: GlClear) -> Result<(), Error> {
        self.prepare(surface, state);
        let gl = &self.gl;
        // SAFETY: the context is current and the surface is bound; only its own images are cleared.
        unsafe {
            // Clears go through the mask of front faces [GL 4.6, 17.4.3].
            if state.stencil.is_none() {
                gl.stencil_mask(0xFF);
            }
            if clear.by_buffer {
                if let Some(color) = clear.color {
                    gl.clear_buffer_f32_slice(glow::COLOR, 0, &color);
                }
                match (clear.depth, clear.stencil) {
                    (Some(depth), Some(stencil)) => {
                        gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, depth, i32::from(stencil));
                    }
                    (Some(depth), None) => gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]),
                    (None, Some(stencil)) => gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[i32::from(stencil)]),
                    (None, None) => {}
                }
            } else {
                let [red, green, blue, alpha] = clear.color.unwrap_or_default();
                gl.clear_color(red, green, blue, alpha);
                gl.clear_depth_f32(clear.depth.unwrap_or_default());
                gl.clear_stencil(i32::from(clear.stencil.unwrap_or_default()));
                let bits = [
                    (clear.color.is_some(), glow::COLOR_BUFFER_BIT),
                    (clear.depth.is_some(), glow::DEPTH_BUFFER_BIT),
                    (clear.stencil.is_some(), glow::STENCIL_BUFFER_BIT),
                ];
                gl.clear(bits.into_iter().filter(|(on, _)| *on).fold(0, |mask, (_, bit)| mask | bit));
            }
            gl.disable(glow::SCISSOR_TEST);
        }
        self.check("a clear")
    }
}
