//! The fixed-function side of the [bench](crate::conformance::bench): single draws by glTexGen, texture matrix, glTexEnv and
//! DEPTH_TEXTURE_MODE, or by a shader of GLSL 1.20 that reads the same state. Knows no pass and no scene.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

use glam::{DMat4, DVec4};
use glow::HasContext;

use super::environment::{GlCoordinates, GlUnit, set};
use super::fixed_arrays::{ArraysColors, ArraysFigure};
use super::texgen::GlTexgen;
use super::{Bench, Error, GlCompare, GlImage, GlProgram, GlState, Mutation, Sampling, Surface, Vertex, build};
use crate::context::Context;
use crate::context::compatibility::{Binding, BindingError, raw};

/// Channels that a depth texture's comparison is written to [GL 4.6 compatibility, 8.23.1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthMode {
    Luminance,
    Intensity,
    Alpha,
    Red,
}

/// One draw. The colour is replaced by the texture's, where there is one.
#[derive(Clone, Copy)]
pub struct FixedDraw<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub projection: DMat4,
    pub modelview: DMat4,
    pub texture_matrix: DMat4,
    /// `None`: coordinates are the vertices' values.
    pub texgen: Option<GlTexgen>,
    pub image: Option<(&'a GlImage, Sampling, DepthMode)>,
    pub color: [f32; 4],
    /// Function and reference of the alpha test.
    pub alpha_test: Option<(GlCompare, f32)>,
    /// Three for each triangle, positions in model space.
    pub vertices: &'a [Vertex],
    /// Vertex and fragment shader of GLSL 1.20 in place of the fixed stages; `map` is the image.
    pub shaders: Option<[&'static str; 2]>,
}

impl<'a> FixedDraw<'a> {
    /// Clip space as it comes, without a texture.
    pub fn plain(surface: &'a Surface, state: GlState, vertices: &'a [Vertex]) -> Self {
        Self {
            surface,
            state,
            projection: DMat4::IDENTITY,
            modelview: DMat4::IDENTITY,
            texture_matrix: DMat4::IDENTITY,
            texgen: None,
            image: None,
            color: [1.0; 4],
            alpha_test: None,
            vertices,
            shaders: None,
        }
    }
}

/// A draw through texture units, in clip space.
#[derive(Clone, Copy)]
pub struct UnitsDraw<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub units: &'a [GlUnit<'a>],
    /// The primary colour; `None`: each vertex's value.
    pub color: Option<[f32; 4]>,
    /// Three for each triangle.
    pub vertices: &'a [Vertex],
}

/// The fixed-function pipeline of the context that a bench is on.
pub struct FixedBench {
    gl: Rc<glow::Context>,
    binding: Binding,
    programs: RefCell<HashMap<[&'static str; 2], GlProgram>>,
    mutation: Option<Mutation>,
    /// Draws so far.
    drawn: Cell<u32>,
}

const COORDINATES: [(u32, u32); 4] = [
    (raw::S, raw::TEXTURE_GEN_S),
    (raw::T, raw::TEXTURE_GEN_T),
    (raw::R, raw::TEXTURE_GEN_R),
    (raw::Q, raw::TEXTURE_GEN_Q),
];

impl FixedBench {
    /// A bench on `context`, which is current and outlives it.
    ///
    /// # Errors
    ///
    /// A context without the fixed-function pipeline.
    pub fn new(context: &dyn Context, mutation: Option<Mutation>) -> Result<Self, BindingError> {
        let binding = Binding::load(context)?;
        Ok(Self { gl: context.gl().clone(), binding, programs: RefCell::default(), mutation, drawn: Cell::new(0) })
    }

    pub(super) fn gl(&self) -> &glow::Context {
        &self.gl
    }

    pub(super) fn binding(&self) -> &Binding {
        &self.binding
    }

    pub(super) fn load_matrix(&self, mode: u32, matrix: DMat4) {
        // SAFETY: the context is current; sixteen numbers, by columns.
        unsafe {
            self.binding.MatrixMode(mode);
            self.binding.LoadMatrixf(matrix.as_mat4().to_cols_array().as_ptr());
        }
    }

    /// Gives GL the planes as doubles, eye planes under their modelview.
    pub fn set_texgen(&self, texgen: &GlTexgen) {
        self.set_planes(texgen, |coordinate, name, plane| {
            // SAFETY: the context is current; four numbers.
            unsafe { self.binding.TexGendv(coordinate, name, plane.as_ptr()) };
        });
    }

    /// The same as floats, as a device does.
    fn set_texgen_by_floats(&self, texgen: &GlTexgen) {
        self.set_planes(texgen, |coordinate, name, plane| {
            // SAFETY: the context is current; four numbers.
            unsafe { self.binding.TexGenfv(coordinate, name, plane.map(|number| number as f32).as_ptr()) };
        });
    }

    fn set_planes(&self, texgen: &GlTexgen, set: impl Fn(u32, u32, [f64; 4])) {
        let transposed = self.mutation == Some(Mutation::PlanesTransposed);
        let planes = if transposed { texgen.planes.transpose() } else { texgen.planes };
        let wrong = self.mutation == Some(Mutation::PlanesUnderWrongModelview);
        self.load_matrix(raw::MODELVIEW, if wrong { DMat4::IDENTITY } else { texgen.modelview });
        let (mode, name) =
            if texgen.eye { (raw::EYE_LINEAR, raw::EYE_PLANE) } else { (raw::OBJECT_LINEAR, raw::OBJECT_PLANE) };
        for (row, (coordinate, _)) in COORDINATES.into_iter().enumerate() {
            let plane: [f64; 4] = planes.row(row).to_array();
            // SAFETY: the context is current.
            unsafe { self.binding.TexGeni(coordinate, raw::TEXTURE_GEN_MODE, mode as i32) };
            set(coordinate, name, plane);
        }
    }

    /// The eye planes that GL holds, as rows.
    pub fn eye_planes(&self) -> DMat4 {
        let rows = COORDINATES.map(|(coordinate, _)| {
            let mut plane = [0.0; 4];
            // SAFETY: the context is current; four numbers are written.
            unsafe { self.binding.GetTexGendv(coordinate, raw::EYE_PLANE, plane.as_mut_ptr()) };
            DVec4::from_array(plane)
        });
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    /// Draws.
    ///
    /// # Errors
    ///
    /// A shader that is refused, and GL's errors.
    pub fn draw(&self, bench: &Bench, draw: &FixedDraw) -> Result<(), Error> {
        let program = draw.shaders.map(|shaders| self.program(shaders)).transpose()?;
        bench.prepare(draw.surface, draw.state);
        if let Some(texgen) = &draw.texgen {
            self.set_texgen(texgen);
        }
        self.load_matrix(glow::TEXTURE, draw.texture_matrix);
        self.load_matrix(raw::PROJECTION, draw.projection);
        self.load_matrix(raw::MODELVIEW, draw.modelview);
        let enable = |what, on| unsafe { if on { self.gl.enable(what) } else { self.gl.disable(what) } };
        // SAFETY: the context is current; the image and the program are not deleted.
        unsafe {
            for (_, coordinate) in COORDINATES {
                enable(coordinate, draw.texgen.is_some());
            }
            for off in [raw::LIGHTING, raw::FOG, raw::ALPHA_TEST] {
                self.gl.disable(off);
            }
            if let Some((function, reference)) = draw.alpha_test {
                self.gl.enable(raw::ALPHA_TEST);
                self.binding.AlphaFunc(function.code(), reference);
            }
            if let Some((image, sampling, mode)) = draw.image {
                bench.bind_image(0, image, sampling)?;
                let mode = match mode {
                    DepthMode::Luminance => raw::LUMINANCE,
                    DepthMode::Intensity => raw::INTENSITY,
                    DepthMode::Alpha => glow::ALPHA,
                    DepthMode::Red => glow::RED,
                };
                self.gl.tex_parameter_i32(glow::TEXTURE_2D, raw::DEPTH_TEXTURE_MODE, mode as i32);
                self.binding.TexEnvi(raw::TEXTURE_ENV, raw::TEXTURE_ENV_MODE, glow::REPLACE as i32);
            }
            enable(glow::TEXTURE_2D, draw.image.is_some());
            self.gl.use_program(program);
            if let Some(program) = program {
                self.gl.uniform_1_i32(self.gl.get_uniform_location(program, "map").as_ref(), 0);
            }
            self.submit(bench, draw)?;
            self.gl.use_program(None);
            self.gl.disable(glow::TEXTURE_2D);
            self.gl.disable(raw::ALPHA_TEST);
        }
        bench.check("a fixed-function draw")
    }

    fn submit(&self, bench: &Bench, draw: &FixedDraw) -> Result<(), Error> {
        let FixedDraw { vertices, color, .. } = *draw;
        let coordinates = vec![vertices.iter().map(|vertex| vertex.value).collect()];
        self.draw_figure(bench, vertices, ArraysColors::Current(color), coordinates)
    }

    fn draw_figure(
        &self,
        bench: &Bench,
        vertices: &[Vertex],
        colors: ArraysColors,
        coordinates: Vec<Vec<[f32; 4]>>,
    ) -> Result<(), Error> {
        let positions = vertices.iter().map(|vertex| vertex.position).collect();
        let place = self.drawn.get();
        self.drawn.set(place.wrapping_add(1));
        ArraysFigure { positions, colors, coordinates, fixed: &self.binding }.draw(bench, place)
    }

    /// DEPTH_SCALE and DEPTH_BIAS of uploads, copies and read-backs.
    pub fn set_depth_transfer(&self, scale: f32, bias: f32) {
        // SAFETY: the context is current; sets state.
        unsafe {
            self.binding.PixelTransferf(raw::DEPTH_SCALE, scale);
            self.binding.PixelTransferf(raw::DEPTH_BIAS, bias);
        }
    }

    /// GL_MAX_TEXTURE_UNITS.
    pub fn most_units(&self) -> usize {
        // SAFETY: a query of one integer.
        unsafe { self.gl.get_parameter_i32(raw::MAX_TEXTURE_UNITS) }.max(0) as usize
    }

    /// Draws through texture units.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn draw_units(&self, bench: &Bench, draw: &UnitsDraw) -> Result<(), Error> {
        let units = self.mutation.map_or_else(|| draw.units.to_vec(), |mutation| mutation.units(draw.units));
        bench.prepare(draw.surface, draw.state);
        // SAFETY: the context is current; images are not deleted.
        unsafe {
            self.gl.use_program(None);
            for off in [raw::LIGHTING, raw::FOG, raw::ALPHA_TEST] {
                self.gl.disable(off);
            }
            for (index, unit) in (0..).zip(&units) {
                bench.bind_image(index, unit.image, unit.sampling)?;
                let (texgen, matrix) = match unit.coordinates {
                    GlCoordinates::Generated(texgen, matrix) => (Some(texgen), matrix),
                    _ => (None, DMat4::IDENTITY),
                };
                self.load_matrix(glow::TEXTURE, matrix);
                if let Some(texgen) = &texgen {
                    self.set_texgen_by_floats(texgen);
                }
                let switch = if texgen.is_some() { glow::Context::enable } else { glow::Context::disable };
                COORDINATES.iter().for_each(|(_, coordinate)| switch(&self.gl, *coordinate));
                self.gl.enable(unit.image.shape.target());
                set(&self.binding, &unit.environment);
            }
            self.load_matrix(raw::PROJECTION, DMat4::IDENTITY);
            self.load_matrix(raw::MODELVIEW, DMat4::IDENTITY);
            self.submit_units(bench, draw, &units)?;
            for (index, unit) in (0..).zip(&units) {
                self.gl.active_texture(glow::TEXTURE0 + index);
                COORDINATES.iter().for_each(|(_, coordinate)| self.gl.disable(*coordinate));
                self.load_matrix(glow::TEXTURE, DMat4::IDENTITY);
                self.gl.disable(unit.image.shape.target());
            }
            self.gl.active_texture(glow::TEXTURE0);
        }
        bench.check("a draw through texture units")
    }

    fn submit_units(&self, bench: &Bench, draw: &UnitsDraw, units: &[GlUnit]) -> Result<(), Error> {
        let square = |vertex: &Vertex| {
            let [x, y, _, w] = vertex.position;
            [0.5 * (x / w) + 0.5, 0.5 * (y / w) + 0.5, 0.0, 1.0]
        };
        let coordinates = units.iter().map(|unit| {
            let is_square = unit.coordinates == GlCoordinates::Square;
            draw.vertices.iter().map(|vertex| if is_square { square(vertex) } else { vertex.value }).collect()
        });
        let each = || ArraysColors::Each(draw.vertices.iter().map(|vertex| vertex.value).collect());
        let colors = draw.color.map_or_else(each, ArraysColors::Current);
        self.draw_figure(bench, draw.vertices, colors, coordinates.collect())
    }

    fn program(&self, shaders: [&'static str; 2]) -> Result<glow::Program, Error> {
        if let Some(known) = self.programs.borrow().get(&shaders) {
            return Ok(known.name);
        }
        let program = build(&self.gl, shaders[0], shaders[1])?;
        let name = program.name;
        self.programs.borrow_mut().insert(shaders, program);
        Ok(name)
    }
}
