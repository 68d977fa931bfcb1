//! A bench for measuring GL itself: images, surfaces and draws under any state, read back exactly. Raw GL behind plain
//! values; knows no pass, scene or rule.
//!
//! [`Bench::draw`] sets everything it depends on, and leaves the context's bindings and state changed.

#[cfg(feature = "check")]
pub mod arrays;
mod attach;
mod blend;
#[cfg(feature = "check")]
mod changes;
#[cfg(feature = "check")]
mod clear;
#[cfg(feature = "check")]
pub mod commands;
mod draw;
#[cfg(feature = "check")]
mod elements;
#[cfg(feature = "check")]
pub mod environment;
#[cfg(feature = "check")]
mod feed;
#[cfg(feature = "check")]
mod fixed_arrays;
#[cfg(feature = "check")]
pub mod fixed_commands;
#[cfg(feature = "check")]
pub mod fixed_function;
mod format;
mod image;
#[cfg(feature = "check")]
mod instances;
#[cfg(feature = "check")]
pub mod lit;
mod mutation;
#[cfg(feature = "check")]
mod mutation_units;
#[cfg(feature = "check")]
mod objects;
#[cfg(feature = "check")]
mod points;
mod program;
mod queries;
mod sampling;
#[cfg(feature = "check")]
mod sequence;
mod state;
#[cfg(feature = "check")]
mod stream;
mod surface;
#[cfg(feature = "check")]
mod targets;
#[cfg(feature = "check")]
mod texgen;
#[cfg(feature = "check")]
mod textures;
#[cfg(feature = "check")]
mod transfer;
#[cfg(feature = "check")]
mod values;

use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::c_void;
use std::rc::Rc;

use glow::HasContext;

pub use attach::{GlPart, GlPlace};
pub use blend::{GlBlend, GlEquation, GlFactor};
#[cfg(feature = "check")]
pub use changes::GlChange;
#[cfg(feature = "check")]
pub use clear::GlClear;
pub use draw::{GlDraw, GlUniform, Vertex, full, rectangle, triangle};
#[cfg(feature = "check")]
pub use elements::{GlAttribute, GlElements, GlIndices, GlPrimitive};
#[cfg(feature = "check")]
pub use feed::{GlArray, GlBuffer, GlCapture, GlCaptured, GlCurrent, GlPointer, GlRange, GlWrite};
pub use format::{Encoding, GlFormat};
pub use image::{GlImage, GlImageDesc, GlShape, GlUpload, level_size};
#[cfg(feature = "check")]
pub use instances::GlInstances;
#[doc(hidden)]
pub use mutation::Mutation;
#[cfg(feature = "check")]
pub use points::GlPoints;
pub use program::Shader;
#[cfg(feature = "check")]
pub(crate) use program::{GlProgram, build};
pub use sampling::{GlMipmap, GlSampledBy, GlSwizzle, GlWrap, Sampling};
pub use state::{GlCompare, GlFace, GlOffset, GlPolygonMode, GlState, GlStencil, GlStencilOp};
#[cfg(feature = "check")]
pub use stream::{GlStream, GlWhole};
pub use surface::Surface;
#[cfg(feature = "check")]
pub use texgen::GlTexgen;
#[cfg(feature = "check")]
pub use textures::{GlTexelPlace, GlTexels, GlTextureBench, GlTextureStep};
#[cfg(feature = "check")]
pub use transfer::{GlBlit, GlCopyTo, GlReading};
#[cfg(feature = "check")]
pub use values::GlValues;

use crate::context::{Context, Profile, error_name};

/// An error of the driver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    #[error("the driver makes no {what}: {reason}")]
    Object { what: &'static str, reason: String },
    #[error("the bench's shader: {0}")]
    Shader(String),
    #[error("{format} is refused by the driver ({reason})")]
    Refused { format: &'static str, reason: String },
    #[error("{what} makes {codes}")]
    Gl { what: &'static str, codes: String },
}

pub(super) fn no(what: &'static str) -> impl FnOnce(String) -> Error {
    move |reason| Error::Object { what, reason }
}

type ProvokingVertex = unsafe extern "system" fn(u32);

/// GL objects that every draw needs. The context must be current in every call, and outlive the bench.
pub struct Bench {
    gl: Rc<glow::Context>,
    programs: RefCell<HashMap<(Shader, bool), program::GlProgram>>,
    vertex_array: glow::VertexArray,
    vertex_buffer: glow::Buffer,
    /// Sampler objects that are bound, by unit.
    samplers: RefCell<HashMap<u32, glow::Sampler>>,
    offset_clamp: Option<state::OffsetClamp>,
    /// glBeginConditionalRender and glEndConditionalRender.
    conditional: Option<(queries::BeginConditional, queries::EndConditional)>,
    provoking_vertex: Option<ProvokingVertex>,
    compatibility: bool,
    mutation: Option<Mutation>,
}

/// glGetError keeps one flag a kind of error; a context that is lost reports the same one without end.
const MOST_FLAGS: usize = 8;

impl Bench {
    /// A bench on the current context, whose functions `gl` is.
    ///
    /// # Errors
    ///
    /// A driver that makes no vertex array or buffer.
    pub fn new(gl: &Rc<glow::Context>) -> Result<Self, Error> {
        // SAFETY: the context is current; what is made is deleted on drop or on failure.
        let (vertex_array, vertex_buffer) = unsafe {
            let vertex_array = gl.create_vertex_array().map_err(no("vertex array"))?;
            let vertex_buffer = gl.create_buffer().inspect_err(|_| gl.delete_vertex_array(vertex_array));
            let vertex_buffer = vertex_buffer.map_err(no("buffer"))?;
            gl.bind_vertex_array(Some(vertex_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(vertex_buffer));
            for (index, offset) in [(0, 0), (1, size_of::<[f32; 4]>())] {
                gl.enable_vertex_attrib_array(index);
                let stride = 2 * size_of::<[f32; 4]>() as i32;
                gl.vertex_attrib_pointer_f32(index, 4, glow::FLOAT, false, stride, offset as i32);
            }
            gl.bind_vertex_array(None);
            (vertex_array, vertex_buffer)
        };
        Ok(Self {
            gl: gl.clone(),
            programs: RefCell::default(),
            vertex_array,
            vertex_buffer,
            samplers: RefCell::default(),
            offset_clamp: None,
            conditional: None,
            provoking_vertex: None,
            compatibility: false,
            mutation: None,
        })
    }

    /// A bench on `context`, which is current, with the functions that glow lacks.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn of(context: &dyn Context) -> Result<Self, Error> {
        let mut bench = Self::new(context.gl())?;
        let extensions = context.gl().supported_extensions();
        let name = match () {
            () if extensions.contains("GL_ARB_polygon_offset_clamp") => Some(c"glPolygonOffsetClamp"),
            () if extensions.contains("GL_EXT_polygon_offset_clamp") => Some(c"glPolygonOffsetClampEXT"),
            () => None,
        };
        let address = name.map_or(std::ptr::null(), |name| context.address_of(name));
        if !address.is_null() {
            // SAFETY: the extension is there, and its function has this signature.
            let function = unsafe { std::mem::transmute::<*const c_void, state::OffsetClamp>(address) };
            bench.offset_clamp = Some(function);
        }
        let [begin, end, provoking] = [c"glBeginConditionalRender", c"glEndConditionalRender", c"glProvokingVertex"]
            .map(|name| context.address_of(name));
        if !begin.is_null() && !end.is_null() {
            // SAFETY: the functions are there, with these signatures.
            bench.conditional = Some(unsafe {
                (
                    std::mem::transmute::<*const c_void, queries::BeginConditional>(begin),
                    std::mem::transmute::<*const c_void, queries::EndConditional>(end),
                )
            });
        }
        if !provoking.is_null() {
            // SAFETY: as above.
            bench.provoking_vertex = Some(unsafe { std::mem::transmute::<*const c_void, ProvokingVertex>(provoking) });
        }
        bench.compatibility = context.profile() == Profile::Compatibility;
        Ok(bench)
    }

    /// The same bench, which makes one mistake at every draw.
    #[doc(hidden)]
    #[must_use]
    pub fn with_mutation(mut self, mutation: Option<Mutation>) -> Self {
        self.mutation = mutation;
        self
    }

    /// The mistake that it makes.
    #[doc(hidden)]
    pub fn mutation(&self) -> Option<Mutation> {
        self.mutation
    }

    /// GL's functions.
    pub(crate) fn raw(&self) -> &Rc<glow::Context> {
        &self.gl
    }

    /// Tests whether glPolygonOffsetClamp exists.
    pub fn has_offset_clamp(&self) -> bool {
        self.offset_clamp.is_some()
    }

    /// Takes flat varyings from the first vertex, or from the last as at the start: glProvokingVertex, if it is there.
    pub fn provoke(&self, first: bool) -> bool {
        let Some(function) = self.provoking_vertex else { return false };
        // SAFETY: the context is current; sets state.
        unsafe { function(if first { glow::FIRST_VERTEX_CONVENTION } else { glow::LAST_VERTEX_CONVENTION }) };
        true
    }

    /// Tests whether the context has the functions that the core profile removed.
    pub fn is_compatible(&self) -> bool {
        self.compatibility
    }

    /// Tests for a version of OpenGL, or an extension that has its functions.
    pub fn has(&self, version: (u32, u32), extension: &str) -> bool {
        let there = self.gl.version();
        (there.major, there.minor) >= version || self.gl.supported_extensions().contains(extension)
    }

    /// Tests whether the stencil part of a packed format can be sampled.
    pub fn reads_stencil(&self) -> bool {
        self.has((4, 3), "GL_ARB_stencil_texturing")
    }

    /// GL_MAX_SAMPLES.
    pub fn most_samples(&self) -> u32 {
        // SAFETY: a query of one integer.
        unsafe { self.gl.get_parameter_i32(glow::MAX_SAMPLES) }.max(0) as u32
    }

    /// GL_SUBPIXEL_BITS: what the driver says of its raster.
    pub fn subpixel_bits(&self) -> u32 {
        // SAFETY: a query of one integer.
        unsafe { self.gl.get_parameter_i32(glow::SUBPIXEL_BITS) }.max(0) as u32
    }

    /// The largest side that textures and viewports share.
    pub fn largest_side(&self) -> u32 {
        let mut viewport = [0; 2];
        // SAFETY: queries of one integer and of two.
        let texture = unsafe {
            self.gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport);
            self.gl.get_parameter_i32(glow::MAX_TEXTURE_SIZE)
        };
        viewport.into_iter().chain([texture]).min().unwrap_or(0).max(0) as u32
    }

    /// Fails if GL has noted an error.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), Error> {
        self.take_errors().map_or(Ok(()), |codes| Err(Error::Gl { what, codes }))
    }

    /// Names of the errors that GL has recorded.
    fn take_errors(&self) -> Option<String> {
        // SAFETY: reads and clears the context's error flags.
        let next = || match unsafe { self.gl.get_error() } {
            glow::NO_ERROR => None,
            code => Some(error_name(code)),
        };
        let mut names: Vec<String> = std::iter::from_fn(next).take(MOST_FLAGS).collect();
        names.dedup();
        (!names.is_empty()).then(|| names.join(", "))
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        // SAFETY: the objects are the bench's own and are not used again.
        unsafe {
            for (unit, sampler) in self.samplers.borrow_mut().drain() {
                self.gl.bind_sampler(unit, None);
                self.gl.delete_sampler(sampler);
            }
            self.gl.use_program(None);
            self.gl.bind_vertex_array(None);
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            self.gl.delete_vertex_array(self.vertex_array);
            self.gl.delete_buffer(self.vertex_buffer);
        }
    }
}
