//! Vertices as a vertex shader receives them: buffers, vertex arrays and draws one call at a time, and what transform
//! feedback captures [GL 4.6, 10.3, 10.4, 13.3].

use std::rc::Rc;

use glow::HasContext;

use super::elements::GlPrimitive;
use super::{Bench, Error, GlProgram, no};

/// A buffer, deleted on drop.
pub struct GlBuffer {
    gl: Rc<glow::Context>,
    name: glow::Buffer,
}

impl Drop for GlBuffer {
    fn drop(&mut self) {
        // SAFETY: the buffer is its own and is not used again.
        unsafe { self.gl.delete_buffer(self.name) };
    }
}

/// A vertex array, deleted on drop.
pub struct GlArray {
    gl: Rc<glow::Context>,
    name: glow::VertexArray,
}

impl Drop for GlArray {
    fn drop(&mut self) {
        // SAFETY: the vertex array is its own and is not used again.
        unsafe { self.gl.delete_vertex_array(self.name) };
    }
}

/// A program whose outputs are captured, and the bytes of a vertex.
pub struct GlCapture {
    pub(super) program: GlProgram,
    pub bytes: usize,
}

/// Ways to write bytes of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlWrite {
    /// glBufferSubData.
    SubData,
    /// glMapBufferRange, whose content is or is not given up.
    Map(bool),
    /// The same with glFlushMappedBufferRange.
    MapAndFlush,
    /// glBufferData of nothing, then glBufferSubData.
    Orphan,
}

/// glVertexAttribPointer or glVertexAttribIPointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlPointer {
    pub location: u32,
    /// 1 to 4, or GL_BGRA.
    pub size: u32,
    pub kind: u32,
    pub normalized: bool,
    /// The shader's attribute is an integer.
    pub integer: bool,
    pub stride: u32,
    pub offset: u32,
}

/// Vertices of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlRange {
    /// First vertex.
    Arrays(u32),
    /// Type of the indices, bytes before the first, and what is added to each.
    Elements { kind: u32, offset: u32, base: i32 },
}

/// A draw that is captured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlCaptured {
    pub primitive: GlPrimitive,
    pub range: GlRange,
    pub count: u32,
    /// `None`: no call for instances.
    pub instances: Option<u32>,
    /// The first instance; 0: by calls that know none.
    pub first_instance: u32,
}

impl Bench {
    /// A buffer of these bytes.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn feed_buffer(&self, bytes: &[u8], usage: u32) -> Result<GlBuffer, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the buffer is deleted on drop.
        unsafe {
            let buffer = GlBuffer { gl: gl.clone(), name: gl.create_buffer().map_err(no("buffer"))? };
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(buffer.name));
            gl.buffer_data_u8_slice(glow::COPY_WRITE_BUFFER, bytes, usage);
            self.check("a buffer")?;
            Ok(buffer)
        }
    }

    /// A vertex array.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn feed_array(&self) -> Result<GlArray, Error> {
        // SAFETY: the context is current; the vertex array is deleted on drop.
        let name = unsafe { self.gl.create_vertex_array() }.map_err(no("vertex array"))?;
        Ok(GlArray { gl: self.gl.clone(), name })
    }

    /// A program of one vertex shader, whose outputs of these names are captured in turn; each is of so many bytes.
    ///
    /// # Errors
    ///
    /// A shader that is refused.
    pub fn capture(&self, vertex: &str, outputs: &[&str], bytes: usize) -> Result<GlCapture, Error> {
        // SAFETY: the context is current; outputs are named before the program is linked.
        let program = super::program::build_with(&self.gl, &[(glow::VERTEX_SHADER, vertex)], |gl, program| unsafe {
            gl.transform_feedback_varyings(program, outputs, glow::INTERLEAVED_ATTRIBS);
        })?;
        Ok(GlCapture { program, bytes })
    }

    /// Binds a vertex array.
    pub fn bind_feed(&self, array: &GlArray) {
        // SAFETY: the context is current, and the vertex array is not deleted.
        unsafe { self.gl.bind_vertex_array(Some(array.name)) };
    }

    /// Points an attribute of the bound vertex array into a buffer.
    pub fn point_feed(&self, buffer: &GlBuffer, pointer: GlPointer) {
        let GlPointer { location, size, kind, normalized, integer, stride, offset } = pointer;
        let (size, stride, offset) = (size as i32, stride as i32, offset as i32);
        // SAFETY: the context is current, and the buffer is not deleted.
        unsafe {
            self.gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer.name));
            match integer {
                true => self.gl.vertex_attrib_pointer_i32(location, size, kind, stride, offset),
                false => self.gl.vertex_attrib_pointer_f32(location, size, kind, normalized, stride, offset),
            }
            self.gl.bind_buffer(glow::ARRAY_BUFFER, None);
        }
    }

    /// Switches an attribute's array on or off.
    pub fn enable_feed(&self, location: u32, on: bool) {
        // SAFETY: the context is current; only state is set.
        unsafe {
            match on {
                true => self.gl.enable_vertex_attrib_array(location),
                false => self.gl.disable_vertex_attrib_array(location),
            }
        }
    }

    /// Sets an attribute's divisor.
    pub fn divide_feed(&self, location: u32, divisor: u32) {
        // SAFETY: as above.
        unsafe { self.gl.vertex_attrib_divisor(location, divisor) };
    }

    /// Sets an attribute's current value, of floats (1 to 4 of them), or of integers by their bits.
    pub fn current_feed(&self, location: u32, value: GlCurrent) {
        let gl = &self.gl;
        // SAFETY: as above.
        unsafe {
            match value {
                GlCurrent::Floats([x, ..], 1) => gl.vertex_attrib_1_f32(location, x),
                GlCurrent::Floats([x, y, ..], 2) => gl.vertex_attrib_2_f32(location, x, y),
                GlCurrent::Floats([x, y, z, _], 3) => gl.vertex_attrib_3_f32(location, x, y, z),
                GlCurrent::Floats([x, y, z, w], _) => gl.vertex_attrib_4_f32(location, x, y, z, w),
                GlCurrent::Signed([x, y, z, w]) => gl.vertex_attrib_4_i32(location, x, y, z, w),
                GlCurrent::Unsigned([x, y, z, w]) => gl.vertex_attrib_4_u32(location, x, y, z, w),
            }
        }
    }

    /// Binds the index buffer of the bound vertex array.
    pub fn index_feed(&self, buffer: &GlBuffer) {
        // SAFETY: the context is current, and the buffer is not deleted.
        unsafe { self.gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(buffer.name)) };
    }

    /// Binds bytes of a buffer to a uniform block's binding point.
    pub fn block_feed(&self, binding: u32, buffer: &GlBuffer, offset: usize, bytes: usize) {
        // SAFETY: as above.
        unsafe {
            let (offset, bytes) = (offset as i32, bytes as i32);
            self.gl.bind_buffer_range(glow::UNIFORM_BUFFER, binding, Some(buffer.name), offset, bytes);
        }
    }

    /// Writes `whole[range]` into the buffer, whose content is `whole` then.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn write_feed(
        &self,
        buffer: &GlBuffer,
        whole: &[u8],
        range: std::ops::Range<usize>,
        how: GlWrite,
    ) -> Result<(), Error> {
        const TARGET: u32 = glow::COPY_WRITE_BUFFER;
        let gl = &self.gl;
        let (offset, length) = (range.start as i32, range.len() as i32);
        // SAFETY: the context is current; mapped bytes are as many as are written.
        unsafe {
            gl.bind_buffer(TARGET, Some(buffer.name));
            match how {
                GlWrite::SubData => gl.buffer_sub_data_u8_slice(TARGET, offset, &whole[range]),
                GlWrite::Orphan => {
                    gl.buffer_data_size(TARGET, whole.len() as i32, glow::STREAM_DRAW);
                    gl.buffer_sub_data_u8_slice(TARGET, 0, whole);
                }
                GlWrite::Map(_) | GlWrite::MapAndFlush => {
                    let more = match how {
                        GlWrite::Map(true) => glow::MAP_INVALIDATE_RANGE_BIT,
                        GlWrite::MapAndFlush => glow::MAP_FLUSH_EXPLICIT_BIT,
                        _ => 0,
                    };
                    let at = gl.map_buffer_range(TARGET, offset, length, glow::MAP_WRITE_BIT | more);
                    if !at.is_null() {
                        at.copy_from_nonoverlapping(whole[range].as_ptr(), length as usize);
                    }
                    if how == GlWrite::MapAndFlush {
                        gl.flush_mapped_buffer_range(TARGET, 0, length);
                    }
                    gl.unmap_buffer(TARGET);
                }
            }
        }
        self.check("a write into a buffer")
    }

    /// Copies bytes from one buffer to another.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn copy_feed(&self, from: &GlBuffer, to: &GlBuffer, offsets: [usize; 2], bytes: usize) -> Result<(), Error> {
        let gl = &self.gl;
        let [read, write] = offsets.map(|offset| offset as i32);
        // SAFETY: the context is current, and the buffers are not deleted.
        unsafe {
            gl.bind_buffer(glow::COPY_READ_BUFFER, Some(from.name));
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(to.name));
            gl.copy_buffer_sub_data(glow::COPY_READ_BUFFER, glow::COPY_WRITE_BUFFER, read, write, bytes as i32);
        }
        self.check("a copy between buffers")
    }

    /// Draws from the bound vertex array; the bytes of all vertices of all primitives in turn, at most `most` vertices.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn captured(&self, capture: &GlCapture, draw: &GlCaptured, most: usize) -> Result<Vec<u8>, Error> {
        let gl = &self.gl;
        // What no vertex writes keeps these bytes.
        let mut bytes = vec![0xA5; most * capture.bytes];
        let into = self.feed_buffer(&bytes, glow::STREAM_READ)?;
        let GlCaptured { primitive, range, count, instances, first_instance } = *draw;
        let (mode, count) = (primitive.code(), count as i32);
        let captured = match primitive {
            GlPrimitive::Points => glow::POINTS,
            GlPrimitive::Lines | GlPrimitive::LineStrip | GlPrimitive::LineLoop => glow::LINES,
            _ => glow::TRIANGLES,
        };
        // SAFETY: the context is current; the range is within the buffers, as the caller gives it.
        unsafe {
            gl.use_program(Some(capture.program.name));
            gl.enable(glow::RASTERIZER_DISCARD);
            gl.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, Some(into.name));
            gl.begin_transform_feedback(captured);
            let number = instances.unwrap_or(1) as i32;
            match range {
                GlRange::Arrays(first) => {
                    let first = first as i32;
                    match (instances, first_instance) {
                        (None, _) => gl.draw_arrays(mode, first, count),
                        (_, 0) => gl.draw_arrays_instanced(mode, first, count, number),
                        (_, from) => gl.draw_arrays_instanced_base_instance(mode, first, count, number, from),
                    }
                }
                GlRange::Elements { kind, offset, base } => {
                    let offset = offset as i32;
                    match (instances, first_instance, base) {
                        (None, _, 0) => gl.draw_elements(mode, count, kind, offset),
                        (None, ..) => gl.draw_elements_base_vertex(mode, count, kind, offset, base),
                        (_, 0, 0) => gl.draw_elements_instanced(mode, count, kind, offset, number),
                        (_, 0, _) => gl.draw_elements_instanced_base_vertex(mode, count, kind, offset, number, base),
                        (_, from, _) => gl.draw_elements_instanced_base_vertex_base_instance(
                            mode, count, kind, offset, number, base, from,
                        ),
                    }
                }
            }
            gl.end_transform_feedback();
            gl.disable(glow::RASTERIZER_DISCARD);
            gl.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, None);
            gl.bind_buffer(glow::COPY_READ_BUFFER, Some(into.name));
            gl.get_buffer_sub_data(glow::COPY_READ_BUFFER, 0, &mut bytes);
        }
        self.check("a draw that is captured")?;
        Ok(bytes)
    }
}

/// Current value of an attribute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GlCurrent {
    /// Numbers, and how many of them are given.
    Floats([f32; 4], u32),
    Signed([i32; 4]),
    Unsigned([u32; 4]),
}
