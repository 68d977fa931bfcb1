//! Turns pass lists into OpenGL over glow. Knows pass data and a current context; no scene, technique or plan.
//!
//! GL objects are made when a list first needs them and kept while later lists do; programs are kept longer, up to
//! a fixed number. A pass whose target already holds its result is skipped
//! ([`WhenChanged`](crate::pass::Redraw::WhenChanged)).

mod compile_log;
#[doc(hidden)]
pub mod debug;
mod error;
#[cfg(feature = "fixed-function")]
mod for_fixed_function;
mod framebuffer;
mod image;
mod mesh;
mod present;
mod program;
#[doc(hidden)]
pub mod queries;
mod readback;
mod recent;
mod run;
mod state;

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext;

use crate::context::Context;
use crate::geometry::Mesh;
use crate::pass::{Attribute, ImageDesc, IndexOrder, Pass, Program, Sampler, Target};

pub use error::Error;
#[cfg(feature = "fixed-function")]
pub(crate) use image::{filter_codes, wrap_code};
pub use readback::Pixels;
#[doc(hidden)]
pub use run::Measure;
pub use run::PassTime;
#[cfg(feature = "fixed-function")]
pub(crate) use state::compare_code;

/// Programs kept although the current list does not use them. A software driver holds some hundred kilobytes of machine code
/// for each.
const MOST_PROGRAMS: usize = 200;

/// A GL context's objects, and the passes that they already hold.
#[doc(hidden)]
pub struct Device {
    gl: Rc<glow::Context>,
    meshes: HashMap<*const Mesh, mesh::GpuMesh>,
    programs: recent::Recent<Program, program::GpuProgram>,
    images: Vec<(ImageDesc, Rc<image::GpuImage>)>,
    framebuffers: HashMap<(Target, Vec<u32>), framebuffer::Framebuffer>,
    samplers: HashMap<Sampler, image::GpuSampler>,
    done: HashMap<String, run::Done>,
    state: Option<state::Applied>,
    debug: debug::Debug,
    timer: Option<queries::Timer>,
    /// Last, so that it goes after all objects.
    context: Rc<dyn Context>,
}

impl Drop for Device {
    fn drop(&mut self) {
        // The objects' names belong to their own context. If it cannot be made current again, they are deleted with it.
        let _ = self.make_current();
    }
}

impl Device {
    /// A device on `context`, which is current on this thread. The device keeps the context alive, and makes it current
    /// again before each frame, if another was made current meanwhile.
    pub fn new(context: &Rc<dyn Context>) -> Self {
        // Filters of cube maps look across the faces' seams [GL 4.6, 8.14.1]; for good, as nothing of ours wants it off.
        unsafe { context.gl().enable(glow::TEXTURE_CUBE_MAP_SEAMLESS) };
        Self {
            gl: context.gl().clone(),
            meshes: HashMap::new(),
            programs: recent::Recent::new(MOST_PROGRAMS),
            images: Vec::new(),
            framebuffers: HashMap::new(),
            samplers: HashMap::new(),
            done: HashMap::new(),
            state: None,
            debug: debug::Debug::new(context.as_ref()),
            timer: queries::Timer::new(context.as_ref()),
            context: context.clone(),
        }
    }

    /// Makes the device's context current on this thread, if it is not.
    ///
    /// # Errors
    ///
    /// A context that is current on another thread.
    pub fn make_current(&self) -> Result<(), Error> {
        if self.context.is_current() { Ok(()) } else { Ok(self.context.make_current()?) }
    }

    /// The driver in a line.
    pub fn driver(&self) -> String {
        self.context.describe().driver()
    }

    /// The largest image side that can be drawn into, and the textures that one fragment shader can read.
    pub fn limits(&self) -> (u32, u32) {
        let get = |name| unsafe { self.gl.get_parameter_i32(name) }.max(0) as u32;
        let mut viewport = [0; 2];
        unsafe { self.gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport) };
        let sides = [
            get(glow::MAX_TEXTURE_SIZE),
            get(glow::MAX_RENDERBUFFER_SIZE),
            viewport[0].max(0) as u32,
            viewport[1].max(0) as u32,
        ];
        (sides.into_iter().min().unwrap_or(0), get(glow::MAX_TEXTURE_IMAGE_UNITS))
    }

    /// Waits until GL has finished.
    pub fn finish(&self) {
        unsafe { self.gl.finish() };
    }

    /// GL itself, for calls beside the device's. The next pass sets all its state, whatever they leave.
    pub fn raw_gl(&mut self) -> &Rc<glow::Context> {
        self.state = None;
        &self.gl
    }

    /// Forgets which passes their targets hold and which state GL has, so that the next run draws them all, in case other
    /// code has used the context.
    pub fn forget(&mut self) {
        self.done.clear();
        self.state = None;
    }

    /// Any GL error since the last check, as an error of ours with the pass's label.
    pub(crate) fn check(&self, label: &str) -> Result<(), Error> {
        Ok(self.debug.check(label)?)
    }
}

/// Attributes and index order of a mesh's vertex array.
type MeshUse = (Vec<Attribute>, IndexOrder);

/// The key of a mesh's GL objects; the mesh is kept alive beside it.
fn mesh_key(mesh: &Arc<Mesh>) -> *const Mesh {
    Arc::as_ptr(mesh)
}

/// Tests whether `pass` with the same objects was the last to draw into its target.
fn unchanged(done: Option<&run::Done>, pass: &Pass, objects: &[u32]) -> bool {
    done.is_some_and(|done| done.pass == *pass && done.objects == objects)
}
