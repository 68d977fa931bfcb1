//! Draws of points, each of one pixel and with attributes of its own, by a program of whole sources.

use glow::HasContext;

use super::draw::set_uniform;
use super::program::{GlProgram, build_named};
use super::{Bench, Error, GlBlend, GlImage, GlState, GlUniform, Sampling, Surface, no};

/// A draw by glDrawArrays: a point for each vector of the attributes, which are all as many.
#[derive(Clone, Copy)]
pub struct GlPoints<'a> {
    pub surface: &'a Surface,
    /// By location.
    pub attributes: &'a [&'a [[f32; 4]]],
    pub uniforms: &'a [(&'a str, GlUniform)],
    pub images: &'a [(&'a str, &'a GlImage, Sampling)],
}

impl Bench {
    /// A program whose attributes have these names, by location.
    ///
    /// # Errors
    ///
    /// A shader that is refused.
    pub(crate) fn points_program(&self, vertex: &str, fragment: &str, attributes: &[&str]) -> Result<GlProgram, Error> {
        let stages = [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)];
        build_named(&self.gl, &stages, attributes)
    }

    /// Draws points.
    ///
    /// # Errors
    ///
    /// GL's.
    pub(crate) fn draw_points(&self, program: &GlProgram, points: &GlPoints) -> Result<(), Error> {
        let gl = &self.gl;
        // By way of the blender: some drivers compile a shader twice where a pixel is written whole.
        self.prepare(points.surface, GlState { depth: None, blend: Some(GlBlend::Replace), ..GlState::WRITE });
        let count = points.attributes.first().map_or(0, |attribute| attribute.len());
        let all = points.attributes.concat();
        // SAFETY: the context is current; each attribute's vectors lie in the buffer, behind those of the one before.
        unsafe {
            gl.use_program(Some(program.name));
            for (unit, &(name, image, sampling)) in points.images.iter().enumerate() {
                self.bind_image(unit as u32, image, sampling)?;
                gl.uniform_1_i32(gl.get_uniform_location(program.name, name).as_ref(), unit as i32);
            }
            for &(name, value) in points.uniforms {
                set_uniform(gl, gl.get_uniform_location(program.name, name).as_ref(), value);
            }
            let array = gl.create_vertex_array().map_err(no("vertex array"))?;
            let buffer = gl.create_buffer().inspect_err(|_| gl.delete_vertex_array(array)).map_err(no("buffer"))?;
            gl.bind_vertex_array(Some(array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(&all), glow::STATIC_DRAW);
            for index in 0..points.attributes.len() {
                gl.enable_vertex_attrib_array(index as u32);
                let offset = index * count * size_of::<[f32; 4]>();
                gl.vertex_attrib_pointer_f32(index as u32, 4, glow::FLOAT, false, 0, offset as i32);
            }
            gl.draw_arrays(glow::POINTS, 0, count as i32);
            gl.bind_vertex_array(None);
            gl.delete_vertex_array(array);
            gl.delete_buffer(buffer);
            gl.use_program(None);
        }
        self.check("a draw of points")
    }
}
