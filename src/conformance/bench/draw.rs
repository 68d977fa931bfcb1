//! One bench draw: triangles under a complete state. And a table of inputs mapped through a fragment shader.

use std::cmp::Ordering;

use glow::HasContext;

use super::format::GlFormat;
use super::image::GlImage;
use super::mutation::Mutation;
use super::program::{Shader, build_stages};
use super::sampling::Sampling;
use super::state::{GlCompare, GlState, apply};
use super::surface::Surface;
use super::{Bench, Error};

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position in clip space, unless the shader says otherwise.
    pub position: [f32; 4],
    pub value: [f32; 4],
}

/// The value of a uniform; matrices by columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GlUniform {
    Int(i32),
    Float(f32),
    Vec2([f32; 2]),
    Vec3([f32; 3]),
    Vec4([f32; 4]),
    /// An array of vec4, by one call.
    Vec4s([[f32; 4]; 8]),
    Mat3([f32; 9]),
    Mat4([f32; 16]),
    /// By rows, with the transpose flag of glUniformMatrix.
    Mat3ByRows([f32; 9]),
    /// By rows, as before.
    Mat4ByRows([f32; 16]),
}

/// All that a draw takes.
#[derive(Clone, Copy)]
pub struct GlDraw<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub shader: Shader,
    /// Three for each triangle.
    pub vertices: &'a [Vertex],
    pub uniforms: &'a [(&'a str, GlUniform)],
    /// Images by sampler name; one that is compared is called `shadow`.
    pub images: &'a [(&'a str, &'a GlImage, Sampling)],
}

impl<'a> GlDraw<'a> {
    /// A draw without uniforms or images.
    pub fn plain(surface: &'a Surface, state: GlState, vertices: &'a [Vertex]) -> Self {
        Self { surface, state, shader: Shader::PLAIN, vertices, uniforms: &[], images: &[] }
    }
}

/// A triangle from clip-space positions, without values.
pub fn triangle(corners: [[f32; 4]; 3]) -> [Vertex; 3] {
    corners.map(|position| Vertex { position, value: [0.0; 4] })
}

/// A rectangle of normalised device coordinates from `low` to `high` at depth `z`, counter-clockwise, with one value.
pub fn rectangle(low: [f32; 2], high: [f32; 2], z: f32, value: [f32; 4]) -> [Vertex; 6] {
    let corner = |x: f32, y: f32| Vertex { position: [x, y, z, 1.0], value };
    let [a, b] = [corner(low[0], low[1]), corner(high[0], low[1])];
    let [c, d] = [corner(high[0], high[1]), corner(low[0], high[1])];
    [a, b, c, a, c, d]
}

/// The whole viewport at depth `z` of normalised device coordinates.
pub fn full(z: f32) -> [Vertex; 6] {
    rectangle([-1.0; 2], [1.0; 2], z, [0.0; 4])
}

/// Inputs of [`Bench::map`] a row.
const ROW: usize = 256;

impl Bench {
    /// Draws.
    ///
    /// # Errors
    ///
    /// A shader that is refused, and GL's errors.
    pub fn draw(&self, draw: &GlDraw) -> Result<(), Error> {
        let filter_first = self.mutation == Some(Mutation::FilterThenCompare);
        let program = self.program(draw.shader, filter_first)?;
        let gl = &self.gl;
        self.prepare(draw.surface, draw.state);
        // SAFETY: the context is current; the objects are not deleted; positions and values lie in turn, as the vertex array has it.
        unsafe {
            gl.use_program(Some(program));
            for (unit, &(name, image, sampling)) in draw.images.iter().enumerate() {
                self.bind_image(unit as u32, image, sampling)?;
                gl.uniform_1_i32(gl.get_uniform_location(program, name).as_ref(), unit as i32);
                if filter_first && let Some(compare) = sampling.compare {
                    let location = gl.get_uniform_location(program, "shadow_function");
                    gl.uniform_1_i32(location.as_ref(), function_bits(compare));
                }
            }
            for &(name, value) in draw.uniforms {
                let location = gl.get_uniform_location(program, name);
                set_uniform(gl, location.as_ref(), value);
            }
            self.submit(program, draw.vertices);
        }
        self.check("a draw")
    }

    /// Draws the triangles into each of the surface's first `layers` layers by a geometry shader: into layer n at depth n / 8.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn draw_layers(&self, surface: &Surface, layers: u32, vertices: &[Vertex]) -> Result<(), Error> {
        const VERTEX: &str = "#version 150
in vec4 position;
void main() { gl_Position = position; }
";
        const FRAGMENT: &str = "#version 150
void main() {}
";
        let geometry = format!(
            "#version 150
layout(triangles) in;
layout(triangle_strip, max_vertices = {}) out;
void main() {{
    for (int layer = 0; layer < {layers}; layer++) {{
        for (int corner = 0; corner < 3; corner++) {{
            gl_Layer = layer;
            gl_Position = gl_in[corner].gl_Position;
            gl_Position.z = (float(layer) / 4.0 - 1.0) * gl_Position.w;
            EmitVertex();
        }}
        EndPrimitive();
    }}
}}
",
            3 * layers
        );
        let stages =
            [(glow::VERTEX_SHADER, VERTEX), (glow::GEOMETRY_SHADER, &geometry), (glow::FRAGMENT_SHADER, FRAGMENT)];
        let program = build_stages(&self.gl, &stages)?;
        self.prepare(surface, GlState { color_write: false, ..GlState::WRITE });
        // SAFETY: the context is current; the program lives until the draw is given.
        unsafe { self.submit(program.name, vertices) };
        self.check("a layered draw")
    }

    /// # Safety
    ///
    /// The context is current, and the program is in it.
    pub(super) unsafe fn submit(&self, program: glow::Program, vertices: &[Vertex]) {
        let gl = &self.gl;
        let floats: Vec<_> = vertices.iter().flat_map(|vertex| [vertex.position, vertex.value]).collect();
        // SAFETY: as the caller promises; positions and values lie in turn, as the vertex array has it.
        unsafe {
            gl.use_program(Some(program));
            gl.bind_vertex_array(Some(self.vertex_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.vertex_buffer));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(&floats), glow::STREAM_DRAW);
            gl.draw_arrays(glow::TRIANGLES, 0, vertices.len() as i32);
            gl.bind_vertex_array(None);
            gl.use_program(None);
        }
    }

    /// Binds the surface and sets the whole state.
    pub(crate) fn prepare(&self, surface: &Surface, state: GlState) {
        let state = self.mutation.map_or(state, |mutation| mutation.state(state));
        // SAFETY: the context is current, and the framebuffer is not deleted.
        unsafe { self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name)) };
        apply(&self.gl, self.offset_clamp, &state, surface.size);
    }

    /// Maps each of `inputs` by `fragment`: its body reads `at`, a vec4, and sets `result`, of float precision.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn map(
        &self,
        fragment: &'static str,
        inputs: &[[f32; 4]],
        images: &[(&str, &GlImage, Sampling)],
    ) -> Result<Vec<[f32; 4]>, Error> {
        self.map_by(Shader::of(fragment), inputs, images)
    }

    /// The same with declarations, and another version of GLSL.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn map_by(
        &self,
        shader: Shader,
        inputs: &[[f32; 4]],
        images: &[(&str, &GlImage, Sampling)],
    ) -> Result<Vec<[f32; 4]>, Error> {
        let size = [ROW.min(inputs.len()).max(1), inputs.len().div_ceil(ROW).max(1)].map(|side| side as u32);
        let surface = self.surface(size, Some(GlFormat::Rgba32F), None)?;
        self.map_into_by(&surface, GlState { depth: None, ..GlState::WRITE }, shader, inputs, images)?;
        let mut results = surface.floats();
        results.truncate(inputs.len());
        Ok(results)
    }

    /// The same as [`map`](Self::map) into a given surface and state: an input for each pixel, rows from below.
    ///
    /// # Errors
    ///
    /// As [`draw`](Self::draw).
    pub fn map_into(
        &self,
        surface: &Surface,
        state: GlState,
        fragment: &'static str,
        inputs: &[[f32; 4]],
        images: &[(&str, &GlImage, Sampling)],
    ) -> Result<(), Error> {
        self.map_into_by(surface, state, Shader::of(fragment), inputs, images)
    }

    fn map_into_by(
        &self,
        surface: &Surface,
        state: GlState,
        shader: Shader,
        inputs: &[[f32; 4]],
        images: &[(&str, &GlImage, Sampling)],
    ) -> Result<(), Error> {
        let mut padded = inputs.to_vec();
        padded.resize(surface.size[0] as usize * surface.size[1] as usize, [0.0; 4]);
        let inputs = self.float_image(surface.size, &padded)?;
        let images: Vec<_> = images.iter().copied().chain([("inputs", &inputs, Sampling::NEAREST)]).collect();
        self.draw(&GlDraw { shader, images: &images, ..GlDraw::plain(surface, state, &full(0.0)) })
    }
}

/// # Safety
///
/// The context is current, and the location is of the program in use.
pub(super) unsafe fn set_uniform(gl: &glow::Context, at: Option<&glow::UniformLocation>, value: GlUniform) {
    // SAFETY: as the caller promises.
    unsafe {
        match value {
            GlUniform::Int(value) => gl.uniform_1_i32(at, value),
            GlUniform::Float(value) => gl.uniform_1_f32(at, value),
            GlUniform::Vec2([x, y]) => gl.uniform_2_f32(at, x, y),
            GlUniform::Vec3([x, y, z]) => gl.uniform_3_f32(at, x, y, z),
            GlUniform::Vec4([x, y, z, w]) => gl.uniform_4_f32(at, x, y, z, w),
            GlUniform::Vec4s(values) => gl.uniform_4_f32_slice(at, values.as_flattened()),
            GlUniform::Mat3(value) => gl.uniform_matrix_3_f32_slice(at, false, &value),
            GlUniform::Mat4(value) => gl.uniform_matrix_4_f32_slice(at, false, &value),
            GlUniform::Mat3ByRows(value) => gl.uniform_matrix_3_f32_slice(at, true, &value),
            GlUniform::Mat4ByRows(value) => gl.uniform_matrix_4_f32_slice(at, true, &value),
        }
    }
}

/// Bits of the orders for which the function holds: less 1, equal 2, greater 4.
fn function_bits(compare: GlCompare) -> i32 {
    let orders = [Ordering::Less, Ordering::Equal, Ordering::Greater];
    orders.into_iter().enumerate().map(|(bit, order)| i32::from(compare.holds(order)) << bit).sum()
}
