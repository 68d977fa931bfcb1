//! Calls one at a time, under whatever state there is: what is between a state and its draw. And fixed function from arrays.

use glow::HasContext;

use super::fixed_function::FixedBench;
use super::{Bench, Error, GlClear, GlCompare, GlState, Shader, Surface, Vertex, no};
use crate::context::compatibility::raw;

impl Bench {
    /// Binds the surface and sets the whole state.
    pub fn set_state(&self, surface: &Surface, state: GlState) {
        self.prepare(surface, state);
    }

    /// Binds the surface, and sets nothing.
    pub fn bind_surface(&self, surface: &Surface) {
        // SAFETY: the context is current, and the framebuffer is not deleted.
        unsafe { self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name)) };
    }

    /// Draws under the state that there is.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn draw_as_it_is(&self, shader: Shader, vertices: &[Vertex]) -> Result<(), Error> {
        let program = self.program(shader, false)?;
        // SAFETY: the context is current, and the program is in it.
        unsafe { self.submit(program, vertices) };
        self.check("a draw under the state that there is")
    }

    /// Makes a program the one that is used.
    ///
    /// # Errors
    ///
    /// A shader that is refused.
    pub fn use_shader(&self, shader: Shader) -> Result<(), Error> {
        let program = self.program(shader, false)?;
        // SAFETY: as above.
        unsafe { self.gl.use_program(Some(program)) };
        Ok(())
    }

    /// Clears buffers of the surface that is bound, one by one, by glClearBuffer, under the state that there is.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn clear_as_it_is(&self, clear: GlClear) -> Result<(), Error> {
        // SAFETY: the context is current, and a framebuffer is bound.
        unsafe {
            if let Some(color) = clear.color {
                self.gl.clear_buffer_f32_slice(glow::COLOR, 0, &color);
            }
            if let Some(depth) = clear.depth {
                self.gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]);
            }
            if let Some(stencil) = clear.stencil {
                self.gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[i32::from(stencil)]);
            }
        }
        self.check("a clear under the state that there is")
    }
}

impl FixedBench {
    /// Draws positions in clip space with one colour under an alpha test, by glDrawElements from arrays in buffers.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn draw_tested(
        &self,
        bench: &Bench,
        surface: &Surface,
        state: GlState,
        (test, reference): (GlCompare, f32),
        color: [f32; 4],
        positions: &[[f32; 3]],
    ) -> Result<(), Error> {
        let indices: Vec<u32> = (0..positions.len() as u32).collect();
        bench.prepare(surface, state);
        let (gl, fixed) = (self.gl(), self.binding());
        // SAFETY: the context is current; arrays and indices are whole, and the buffers are deleted here.
        unsafe {
            let buffers = [gl.create_buffer().map_err(no("buffer"))?, gl.create_buffer().map_err(no("buffer"))?];
            gl.use_program(None);
            for off in [raw::LIGHTING, raw::FOG, glow::TEXTURE_2D] {
                gl.disable(off);
            }
            for mode in [raw::PROJECTION, raw::MODELVIEW] {
                fixed.MatrixMode(mode);
                fixed.LoadIdentity();
            }
            gl.enable(raw::ALPHA_TEST);
            fixed.AlphaFunc(test.code(), reference);
            fixed.Color4f(color[0], color[1], color[2], color[3]);
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffers[0]));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(positions), glow::STATIC_DRAW);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(buffers[1]));
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, bytemuck::cast_slice(&indices), glow::STATIC_DRAW);
            fixed.VertexPointer(3, glow::FLOAT, 0, std::ptr::null());
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            gl.draw_elements(glow::TRIANGLES, indices.len() as i32, glow::UNSIGNED_INT, 0);
            fixed.DisableClientState(raw::VERTEX_ARRAY);
            gl.disable(raw::ALPHA_TEST);
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
            buffers.into_iter().for_each(|buffer| gl.delete_buffer(buffer));
        }
        bench.check("an alpha test from arrays")
    }
}
