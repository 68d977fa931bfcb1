//! The same passes that the device draws with shaders, through the driver's own fixed-function pipeline in a
//! compatibility context [GL 4.6 compatibility, 12 and 16]: the second reader of every pass list.
//!
//! It reads what a batch *means* ([`crate::pass::FixedFunctionDesc`]) and never its shaders: [`reading`] turns that into
//! layers of primary colour, texture units and combiners, [`FixedFunction`] draws them. Texture coordinates are left to
//! glTexGen with the planes and the modelview of the scene's set-up, so that GL itself multiplies by the inverse; lighting
//! to glLight. Anything that the pipeline cannot express is an error with the pass's name.
//!
//! Images, framebuffers and raster state are the device's own; so are copies.

mod bounds;
mod draw;
mod driver;
mod error;
pub mod layer;
mod lighting;
pub mod listing;
mod masks;
mod primary;
pub mod reading;
mod stack;
mod tangent_vectors;
mod units;

use std::rc::Rc;

use glow::HasContext;

pub use error::{Error, Inexpressible};

use crate::context::Context;
pub use crate::context::compatibility::BindingError;
use crate::context::compatibility::{Binding, raw};
use crate::device::{Device, Pixels};
use crate::pass::{
    Batch, Compare, DrawPass, DrawState, FixedFunctionDesc, ImageId, PassList, Stencil, StencilOp, StencilOps, Work,
};

/// The fixed-function pipeline of one compatibility context.
pub struct FixedFunction {
    gl: Rc<glow::Context>,
    binding: Binding,
    device: Device,
    masks: masks::Masks,
    /// GL_MAX_TEXTURE_UNITS.
    most_units: usize,
    /// GL_MAX_LIGHTS.
    most_lights: usize,
    /// Last, so that it goes after all objects.
    _context: Rc<dyn Context>,
}

impl FixedFunction {
    /// A reader on `context`, which is current on this thread. The reader keeps the context alive.
    ///
    /// # Errors
    ///
    /// A context that has no fixed-function pipeline.
    pub fn new(context: &Rc<dyn Context>) -> Result<Self, Error> {
        let binding = Binding::load(context.as_ref())?;
        let gl = context.gl().clone();
        // SAFETY: the context is current.
        let limit = |name| unsafe { gl.get_parameter_i32(name) }.max(0) as usize;
        let (most_units, most_lights) = (limit(raw::MAX_TEXTURE_UNITS), limit(raw::MAX_LIGHTS));
        let (device, masks) = (Device::new(context), masks::Masks::new(&gl));
        Ok(Self { gl, binding, device, masks, most_units, most_lights, _context: context.clone() })
    }

    /// Everything in the list that the pipeline cannot compute; empty: it draws all of it.
    pub fn inexpressible(&self, list: &PassList) -> Vec<Inexpressible> {
        let mut found = Vec::new();
        for pass in &list.passes {
            let Work::Draw(draw) = &pass.work else { continue };
            for batch in &draw.batches {
                if let Err(why) = check_state(list, draw, batch).and_then(|()| self.layers(draw, batch)) {
                    found.push(Inexpressible { pass: pass.label.clone(), what: names(batch), why });
                }
            }
        }
        found
    }

    /// Draws every pass of the list, whatever its targets hold.
    ///
    /// # Errors
    ///
    /// Passes that the pipeline cannot compute, before anything is drawn; else as [`Device::run`].
    pub fn run(&mut self, list: &PassList) -> Result<(), Error> {
        let inexpressible = self.inexpressible(list);
        if !inexpressible.is_empty() {
            return Err(Error::Inexpressible(inexpressible));
        }
        self.device.make_current()?;
        self.device.prepare_images(list)?;
        for pass in &list.passes {
            match &pass.work {
                Work::Draw(draw) => self.draw(list, &pass.label, draw)?,
                Work::CopyDepth { .. } => self.device.copy(list, pass)?,
            }
            self.device.check(&pass.label)?;
        }
        Ok(())
    }

    /// Waits until GL has finished.
    pub fn finish(&self) {
        self.device.finish();
    }

    /// Reads an image of the list that was run last.
    ///
    /// # Errors
    ///
    /// See [`Device::read`].
    pub fn read(&mut self, list: &PassList, image: ImageId) -> Result<Pixels, Error> {
        Ok(self.device.read(list, image)?)
    }

    /// A batch's layers, within the driver's limits.
    fn layers(&self, pass: &DrawPass, batch: &Batch) -> Result<Vec<layer::Layer>, String> {
        let layers = reading::layers(batch, pass.state.blend)?;
        for layer in &layers {
            let (units, most) = (layer.units.len(), self.most_units);
            if units > most {
                return Err(format!("\"{}\" takes {units} texture units, the driver has {most}", layer.name));
            }
            if let layer::Primary::Lighting(lighting) = &layer.primary
                && lighting.sources.len() > self.most_lights
            {
                let (lights, most) = (lighting.sources.len(), self.most_lights);
                return Err(format!("\"{}\" takes {lights} lights, the driver has {most}", layer.name));
            }
        }
        Ok(layers)
    }
}

/// A lit surface takes several layers, which share positions with one another, and with another pass only where both go
/// through eye space.
fn check_state(list: &PassList, pass: &DrawPass, batch: &Batch) -> Result<(), String> {
    let layered = batch.meaning.clip_from_eye().is_some();
    let repeats = pass.state.depth_test == Some(Compare::Equal);
    let shares = repeats && is_placed(batch) && writes_placed_depths(list, pass);
    // The stencil buffer only draws each pixel once: the reason is the surface's own.
    if let FixedFunctionDesc::Shader(why) = batch.meaning
        && draws_once(pass)
    {
        return Err(String::from(why));
    }
    let why = match &pass.state {
        DrawState { stencil: Some(_), .. } if repeats && !(shares && draws_once(pass)) => {
            "a count or tag in the stencil buffer at depth EQUAL to another pass, whose positions fixed function may \
             compute otherwise"
        }
        _ if repeats && !shares => "depth EQUAL to another pass, whose positions fixed function may compute otherwise",
        DrawState { stencil: Some(_), .. } if !repeats => {
            "a count in the stencil buffer: volumes have no modelview of their own, by which fixed function would put their \
             caps where it puts the surfaces"
        }
        DrawState { stencil: Some(_), .. } if !has_equal_layers(pass) => {
            "surfaces that are drawn once by a stencil test, of several numbers of layers, which cannot be told apart"
        }
        _ if batch.clip_planes > 0 => "a clip plane of the vertex stage's own",
        DrawState { blend: Some(_), .. } if layered && !shares => "a pass that blends, as its own layers do",
        _ => return Ok(()),
    };
    Err(String::from(why))
}

/// Tests whether projection and modelview are two matrices.
fn is_placed(batch: &Batch) -> bool {
    batch.meaning.clip_from_eye().is_some() && batch.draws.iter().all(|draw| draw.eye_from_model.is_some())
}

/// Tests whether all depths that the pass may meet are those of such batches.
fn writes_placed_depths(list: &PassList, pass: &DrawPass) -> bool {
    let draws = list.passes.iter().filter_map(|other| match &other.work {
        Work::Draw(draw) => Some(draw),
        Work::CopyDepth { .. } => None,
    });
    let mut writing = draws.filter(|other| other.target.depth == pass.target.depth && other.state.depth_write);
    writing.all(|other| other.batches.iter().all(is_placed))
}

/// Tests whether a stencil test lets each pixel of a pass through once.
fn draws_once(pass: &DrawPass) -> bool {
    let once = StencilOps { pass: StencilOp::Increment, ..StencilOps::KEEP };
    let counts = |stencil: Stencil| stencil.test == Compare::Equal && [stencil.front, stencil.back] == [once; 2];
    pass.clear.stencil == Some(0) && pass.state.stencil.is_some_and(counts)
}

/// Tests whether all batches of a pass take equally many layers: then no layer of one passes where another has drawn.
fn has_equal_layers(pass: &DrawPass) -> bool {
    let numbers = pass.batches.iter().filter_map(|batch| Some(reading::layers(batch, pass.state.blend).ok()?.len()));
    let mut numbers = numbers.filter(|number| *number > 0); // others draw nothing
    let first = numbers.next();
    numbers.all(|number| Some(number) == first)
}

/// The names of what a batch draws, each once.
fn names(batch: &Batch) -> String {
    let mut names: Vec<&str> = batch.draws.iter().map(|draw| draw.label.as_str()).collect();
    names.dedup();
    names.join(", ")
}
