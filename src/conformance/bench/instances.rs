//! Draws of several instances, with an attribute that is the instance's own [GL 4.6, 10.3.4, 10.4].

use glow::HasContext;

use super::{Bench, Error, GlState, Shader, Surface, Vertex, no};

/// A draw by glDrawArraysInstanced, or by glDrawElementsInstanced with the indices in turn.
#[derive(Clone, Copy)]
pub struct GlInstances<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub shader: Shader,
    /// Three for each triangle of an instance.
    pub vertices: &'a [Vertex],
    /// Attribute 2, `each` in the shader.
    pub each: &'a [[f32; 4]],
    /// glVertexAttribDivisor of it: instances for one value; 0: a value for each vertex.
    pub divisor: u32,
    pub count: u32,
    pub by_index: bool,
}

impl Bench {
    /// Draws instances.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn draw_instances(&self, draw: &GlInstances) -> Result<(), Error> {
        let program = self.program(draw.shader, false)?;
        let gl = &self.gl;
        self.prepare(draw.surface, draw.state);
        let vertices: Vec<_> = draw.vertices.iter().flat_map(|vertex| [vertex.position, vertex.value]).collect();
        let indices: Vec<u32> = (0..draw.vertices.len() as u32).collect();
        let parts: [(u32, &[u8]); 3] = [
            (glow::ARRAY_BUFFER, bytemuck::cast_slice(&vertices)),
            (glow::ARRAY_BUFFER, bytemuck::cast_slice(draw.each)),
            (glow::ELEMENT_ARRAY_BUFFER, bytemuck::cast_slice(&indices)),
        ];
        // SAFETY: the context is current; attributes lie within their buffers; what is made is deleted here.
        unsafe {
            let array = gl.create_vertex_array().map_err(no("vertex array"))?;
            gl.bind_vertex_array(Some(array));
            let mut buffers = Vec::new();
            for (target, bytes) in parts {
                let buffer = gl.create_buffer().map_err(no("buffer"))?;
                buffers.push(buffer);
                gl.bind_buffer(target, Some(buffer));
                gl.buffer_data_u8_slice(target, bytes, glow::STATIC_DRAW);
            }
            let vec4 = size_of::<[f32; 4]>() as i32;
            for (location, buffer, stride, offset) in [(0, 0, 2 * vec4, 0), (1, 0, 2 * vec4, vec4), (2, 1, vec4, 0)] {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffers[buffer]));
                gl.enable_vertex_attrib_array(location);
                gl.vertex_attrib_pointer_f32(location, 4, glow::FLOAT, false, stride, offset);
            }
            gl.vertex_attrib_divisor(2, draw.divisor);
            gl.use_program(Some(program));
            let (length, count) = (draw.vertices.len() as i32, draw.count as i32);
            if draw.by_index {
                gl.draw_elements_instanced(glow::TRIANGLES, length, glow::UNSIGNED_INT, 0, count);
            } else {
                gl.draw_arrays_instanced(glow::TRIANGLES, 0, length, count);
            }
            gl.use_program(None);
            gl.bind_vertex_array(None);
            gl.delete_vertex_array(array);
            buffers.into_iter().for_each(|buffer| gl.delete_buffer(buffer));
        }
        self.check("a draw of instances")
    }
}
