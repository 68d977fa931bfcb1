//! Uniforms of every type, set as they come, and uniform blocks [GL 4.6, 7.6].

use glow::HasContext;

use super::feed::GlCapture;
use super::{Bench, Error};

/// Values for a uniform or for some elements of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum GlValues {
    /// Components of an element, then numbers.
    Floats(u32, Vec<f32>),
    Signed(u32, Vec<i32>),
    Unsigned(u32, Vec<u32>),
    /// Columns and rows, whether they come by rows, then numbers.
    Matrices([u32; 2], bool, Vec<f32>),
}

impl Bench {
    /// Links a program again.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn link_again(&self, capture: &GlCapture) -> Result<(), Error> {
        // SAFETY: the context is current, and the program is in it.
        unsafe { self.gl.link_program(capture.program.name) };
        self.check("a program that is linked again")
    }

    /// Gives a uniform block of a program its binding point.
    pub fn bind_block(&self, capture: &GlCapture, name: &str, binding: u32) {
        // SAFETY: as above.
        unsafe {
            if let Some(index) = self.gl.get_uniform_block_index(capture.program.name, name) {
                self.gl.uniform_block_binding(capture.program.name, index, binding);
            }
        }
    }

    /// Bytes that the offset of a range of a uniform buffer is a multiple of.
    pub fn block_alignment(&self) -> usize {
        // SAFETY: a query of one integer.
        unsafe { self.gl.get_parameter_i32(glow::UNIFORM_BUFFER_OFFSET_ALIGNMENT) }.max(1) as usize
    }

    /// Sets a uniform of a program, which is used from then on; single ones by calls without arrays if `single`.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn set_values(&self, capture: &GlCapture, name: &str, values: &GlValues, single: bool) -> Result<(), Error> {
        let gl = &self.gl;
        // SAFETY: the context is current, and the program is in it; slices have whole elements.
        unsafe {
            gl.use_program(Some(capture.program.name));
            let location = gl.get_uniform_location(capture.program.name, name);
            let at = location.as_ref();
            match values {
                GlValues::Floats(1, list) if single => gl.uniform_1_f32(at, list[0]),
                GlValues::Floats(2, list) if single => gl.uniform_2_f32(at, list[0], list[1]),
                GlValues::Floats(3, list) if single => gl.uniform_3_f32(at, list[0], list[1], list[2]),
                GlValues::Floats(4, list) if single => gl.uniform_4_f32(at, list[0], list[1], list[2], list[3]),
                GlValues::Floats(1, list) => gl.uniform_1_f32_slice(at, list),
                GlValues::Floats(2, list) => gl.uniform_2_f32_slice(at, list),
                GlValues::Floats(3, list) => gl.uniform_3_f32_slice(at, list),
                GlValues::Floats(_, list) => gl.uniform_4_f32_slice(at, list),
                GlValues::Signed(1, list) if single => gl.uniform_1_i32(at, list[0]),
                GlValues::Signed(2, list) if single => gl.uniform_2_i32(at, list[0], list[1]),
                GlValues::Signed(3, list) if single => gl.uniform_3_i32(at, list[0], list[1], list[2]),
                GlValues::Signed(4, list) if single => gl.uniform_4_i32(at, list[0], list[1], list[2], list[3]),
                GlValues::Signed(1, list) => gl.uniform_1_i32_slice(at, list),
                GlValues::Signed(2, list) => gl.uniform_2_i32_slice(at, list),
                GlValues::Signed(3, list) => gl.uniform_3_i32_slice(at, list),
                GlValues::Signed(_, list) => gl.uniform_4_i32_slice(at, list),
                GlValues::Unsigned(1, list) if single => gl.uniform_1_u32(at, list[0]),
                GlValues::Unsigned(2, list) if single => gl.uniform_2_u32(at, list[0], list[1]),
                GlValues::Unsigned(3, list) if single => gl.uniform_3_u32(at, list[0], list[1], list[2]),
                GlValues::Unsigned(4, list) if single => gl.uniform_4_u32(at, list[0], list[1], list[2], list[3]),
                GlValues::Unsigned(1, list) => gl.uniform_1_u32_slice(at, list),
                GlValues::Unsigned(2, list) => gl.uniform_2_u32_slice(at, list),
                GlValues::Unsigned(3, list) => gl.uniform_3_u32_slice(at, list),
                GlValues::Unsigned(_, list) => gl.uniform_4_u32_slice(at, list),
                GlValues::Matrices([2, 2], by_rows, list) => gl.uniform_matrix_2_f32_slice(at, *by_rows, list),
                GlValues::Matrices([2, 3], by_rows, list) => gl.uniform_matrix_2x3_f32_slice(at, *by_rows, list),
                GlValues::Matrices([2, 4], by_rows, list) => gl.uniform_matrix_2x4_f32_slice(at, *by_rows, list),
                GlValues::Matrices([3, 2], by_rows, list) => gl.uniform_matrix_3x2_f32_slice(at, *by_rows, list),
                GlValues::Matrices([3, 3], by_rows, list) => gl.uniform_matrix_3_f32_slice(at, *by_rows, list),
                GlValues::Matrices([3, 4], by_rows, list) => gl.uniform_matrix_3x4_f32_slice(at, *by_rows, list),
                GlValues::Matrices([4, 2], by_rows, list) => gl.uniform_matrix_4x2_f32_slice(at, *by_rows, list),
                GlValues::Matrices([4, 3], by_rows, list) => gl.uniform_matrix_4x3_f32_slice(at, *by_rows, list),
                GlValues::Matrices(_, by_rows, list) => gl.uniform_matrix_4_f32_slice(at, *by_rows, list),
            }
        }
        self.check("a uniform")
    }
}
