//! Draws of any primitives with vertices of several vec4, under the state that there is, by programs of whole sources.

use std::rc::Rc;

use glow::HasContext;

use super::elements::{GlIndices, GlPrimitive};
use super::{Bench, Error, GlProgram, build, no};

/// A vertex array whose attributes are vec4 that lie in turn in one buffer, and an index buffer; deleted on drop.
pub struct GlStream {
    gl: Rc<glow::Context>,
    array: glow::VertexArray,
    vertices: glow::Buffer,
    indices: glow::Buffer,
    /// Floats of a vertex.
    floats: usize,
}

impl Drop for GlStream {
    fn drop(&mut self) {
        // SAFETY: the objects are its own and are not used again.
        unsafe {
            self.gl.bind_vertex_array(None);
            self.gl.delete_vertex_array(self.array);
            self.gl.delete_buffer(self.vertices);
            self.gl.delete_buffer(self.indices);
        }
    }
}

/// A program of whole sources.
pub struct GlWhole(GlProgram);

impl Bench {
    /// A program of these sources; attribute 0 is called `position`, outputs `result`, `second`, `third` and `fourth`.
    ///
    /// # Errors
    ///
    /// Sources that are refused.
    pub fn whole_program(&self, vertex: &str, fragment: &str) -> Result<GlWhole, Error> {
        build(&self.gl, vertex, fragment).map(GlWhole)
    }

    /// Makes a program the one that is used.
    pub fn use_whole(&self, program: &GlWhole) {
        // SAFETY: the context is current, and the program is in it.
        unsafe { self.gl.use_program(Some(program.0.name)) };
    }

    /// Sets an integer uniform of the program, which is in use.
    pub fn set_whole(&self, program: &GlWhole, name: &str, value: i32) {
        // SAFETY: as above.
        unsafe {
            let location = self.gl.get_uniform_location(program.0.name, name);
            self.gl.uniform_1_i32(location.as_ref(), value);
        }
    }

    /// A stream of vertices with so many vec4, bound.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn stream(&self, attributes: u32) -> Result<GlStream, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; what is made is deleted on drop.
        unsafe {
            let array = gl.create_vertex_array().map_err(no("vertex array"))?;
            let vertices = gl.create_buffer().map_err(no("buffer"))?;
            let indices = gl.create_buffer().map_err(no("buffer"))?;
            let stream = GlStream { gl: gl.clone(), array, vertices, indices, floats: 4 * attributes as usize };
            gl.bind_vertex_array(Some(array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(vertices));
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
            let vec4 = size_of::<[f32; 4]>() as i32;
            for index in 0..attributes {
                gl.enable_vertex_attrib_array(index);
                let (stride, offset) = (vec4 * attributes as i32, vec4 * index as i32);
                gl.vertex_attrib_pointer_f32(index, 4, glow::FLOAT, false, stride, offset);
            }
            self.check("a vertex array")?;
            Ok(stream)
        }
    }

    /// Draws vertices in turn, or by indices, under the state that there is.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn draw_stream(
        &self,
        stream: &GlStream,
        primitive: GlPrimitive,
        vertices: &[f32],
        indices: Option<GlIndices>,
    ) -> Result<(), Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; indices are of the vertices, as the caller gives them.
        unsafe {
            gl.bind_vertex_array(Some(stream.array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(stream.vertices));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(vertices), glow::STREAM_DRAW);
            match indices {
                None => gl.draw_arrays(primitive.code(), 0, (vertices.len() / stream.floats) as i32),
                Some(indices) => {
                    let (bytes, kind, count) = indices.bytes();
                    gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, bytes, glow::STREAM_DRAW);
                    gl.draw_elements(primitive.code(), count as i32, kind, 0);
                }
            }
        }
        self.check("a draw under the state that there is")
    }
}
