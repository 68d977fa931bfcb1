//! Draws by index buffers and vertex arrays of several buffers, as the device draws.

use std::rc::Rc;

use glow::HasContext;

use super::{Bench, Error, GlState, Shader, Surface, no};

/// An attribute: numbers in a buffer of its own.
#[derive(Clone, Copy, Debug)]
pub struct GlAttribute<'a> {
    pub location: u32,
    pub components: u32,
    pub numbers: &'a [f32],
    /// Bytes from one vertex to the next; 0: they lie close together.
    pub stride: u32,
    /// Bytes before the first vertex.
    pub offset: u32,
}

/// Indices of 32 or 16 bits.
#[derive(Clone, Copy, Debug)]
pub enum GlIndices<'a> {
    Long(&'a [u32]),
    Short(&'a [u16]),
}

/// Primitives of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlPrimitive {
    Points,
    Lines,
    LineStrip,
    LineLoop,
    Triangles,
    TriangleStrip,
    TriangleFan,
}

impl GlPrimitive {
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Points => glow::POINTS,
            Self::Lines => glow::LINES,
            Self::LineStrip => glow::LINE_STRIP,
            Self::LineLoop => glow::LINE_LOOP,
            Self::Triangles => glow::TRIANGLES,
            Self::TriangleStrip => glow::TRIANGLE_STRIP,
            Self::TriangleFan => glow::TRIANGLE_FAN,
        }
    }
}

impl<'a> GlIndices<'a> {
    /// Bytes, type, and number of the indices.
    pub(super) fn bytes(self) -> (&'a [u8], u32, usize) {
        match self {
            Self::Long(indices) => (bytemuck::cast_slice(indices), glow::UNSIGNED_INT, indices.len()),
            Self::Short(indices) => (bytemuck::cast_slice(indices), glow::UNSIGNED_SHORT, indices.len()),
        }
    }
}

/// A draw by glDrawElements.
#[derive(Clone, Copy)]
pub struct GlElements<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub shader: Shader,
    pub attributes: &'a [GlAttribute<'a>],
    pub indices: GlIndices<'a>,
    /// First index, and how many are drawn by [`Bench::draw_elements`].
    pub range: [u32; 2],
    pub primitive: GlPrimitive,
    /// Added to each index; 0: by glDrawElements, else by glDrawElementsBaseVertex.
    pub base: i32,
}

/// Buffers and a vertex array, deleted on drop.
struct Arrays {
    gl: Rc<glow::Context>,
    array: glow::VertexArray,
    buffers: Vec<glow::Buffer>,
}

impl Drop for Arrays {
    fn drop(&mut self) {
        // SAFETY: the objects are its own and are not used again.
        unsafe {
            self.gl.bind_vertex_array(None);
            self.gl.delete_vertex_array(self.array);
            self.buffers.iter().for_each(|buffer| self.gl.delete_buffer(*buffer));
        }
    }
}

impl Arrays {
    /// # Safety
    ///
    /// The context is current, and no vertex array is bound.
    unsafe fn upload(&mut self, target: u32, bytes: &[u8]) -> Result<glow::Buffer, Error> {
        // SAFETY: as the caller promises.
        unsafe {
            let buffer = self.gl.create_buffer().map_err(no("buffer"))?;
            self.buffers.push(buffer);
            self.gl.bind_buffer(target, Some(buffer));
            self.gl.buffer_data_u8_slice(target, bytes, glow::STATIC_DRAW);
            Ok(buffer)
        }
    }
}

impl Bench {
    /// Draws by an index buffer.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn draw_elements(&self, draw: &GlElements) -> Result<(), Error> {
        self.draw_ranges(draw, &[(draw.range, None)])
    }

    /// Draws ranges by an index buffer, one after the other. Before each the uniform vec3 `tint` may be set.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn draw_ranges(&self, draw: &GlElements, ranges: &[([u32; 2], Option<[f32; 3]>)]) -> Result<(), Error> {
        let program = self.program(draw.shader, false)?;
        let gl = &self.gl;
        self.prepare(draw.surface, draw.state);
        // SAFETY: the context is current; attributes and indices lie within their buffers, as the caller gives them.
        unsafe {
            let array = gl.create_vertex_array().map_err(no("vertex array"))?;
            let mut arrays = Arrays { gl: gl.clone(), array, buffers: Vec::new() };
            gl.bind_vertex_array(None);
            let mut buffers = Vec::new();
            for attribute in draw.attributes {
                buffers.push(arrays.upload(glow::ARRAY_BUFFER, bytemuck::cast_slice(attribute.numbers))?);
            }
            let (bytes, kind, count) = draw.indices.bytes();
            let size = bytes.len().checked_div(count).unwrap_or(0) as i32;
            let indices = arrays.upload(glow::ELEMENT_ARRAY_BUFFER, bytes)?;
            // Another buffer, bound outside of the vertex array, must not be the one that is read.
            arrays.upload(glow::ELEMENT_ARRAY_BUFFER, &vec![0; bytes.len()])?;
            gl.bind_vertex_array(Some(array));
            for (attribute, buffer) in draw.attributes.iter().zip(buffers) {
                let GlAttribute { location, components, stride, offset, .. } = *attribute;
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
                gl.enable_vertex_attrib_array(location);
                let (components, stride) = (components as i32, stride as i32);
                gl.vertex_attrib_pointer_f32(location, components, glow::FLOAT, false, stride, offset as i32);
            }
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, arrays.buffers.last().copied());
            gl.use_program(Some(program));
            gl.bind_vertex_array(Some(array));
            let mode = draw.primitive.code();
            let location = gl.get_uniform_location(program, "tint");
            for (range, value) in ranges {
                let [first, count] = range.map(|index| index as i32);
                if let Some([x, y, z]) = *value {
                    gl.uniform_3_f32(location.as_ref(), x, y, z);
                }
                match draw.base {
                    0 => gl.draw_elements(mode, count, kind, first * size),
                    base => gl.draw_elements_base_vertex(mode, count, kind, first * size, base),
                }
            }
            gl.use_program(None);
        }
        self.check("a draw by indices")
    }
}
