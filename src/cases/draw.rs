//! Draws a case's scene by glumbra: load, plan, run, read back. A GL error, or a message of high severity from the driver,
//! fails a drawing before its picture is looked at.

use std::path::Path;
use std::rc::Rc;

use super::outcome::Failure;
use crate::context::{self, Context, ContextRequest};
use crate::device::{self, Measure};
use crate::frame::{self, Renderer};
use crate::pass::{Clear, DrawPass, DrawState, ImageId, Pass, PassList, Redraw, Storage, Target, Work};
use crate::pictures::Raster;
use crate::plan::{Plan, Request, ViewRequest};
use crate::scene::Scene;
use crate::views::View;

/// Content of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wanted {
    /// RGB in 8 bits, as a PNG has it.
    Picture,
    /// RGB in 32-bit float.
    FloatPicture,
    /// A view of this light.
    View(View, usize),
}

/// A picture with the scene that it shows, and what the plan said.
#[derive(Clone, Debug)]
pub struct DrawnScene {
    /// The scene, resolved.
    pub scene: Scene,
    /// The picture that was wanted.
    pub picture: Raster,
    /// `what: why` of all that was left out.
    pub left_out: Vec<String>,
    /// Warnings of the scene and of the plan.
    pub warnings: Vec<String>,
    /// Glumbra's plan; none where a command has drawn.
    pub plan: Option<Rc<Plan>>,
}

/// A renderer with its context, opened when the first picture is wanted.
pub struct Drawer {
    request: ContextRequest,
    gl: Option<Result<Gl, String>>,
    between: Option<BetweenFrames>,
}

/// Work of another user of the context.
pub type BetweenFrames = Box<dyn FnMut(&mut Renderer)>;

struct Gl {
    renderer: Renderer,
    driver: String,
    context: Rc<dyn Context>,
}

impl Drawer {
    /// A renderer on a context of this kind, with GL's debug messages.
    pub fn new(request: ContextRequest) -> Self {
        Self { request: ContextRequest { debug: true, ..request }, gl: None, between: None }
    }

    fn gl(&mut self) -> Result<&mut Gl, Failure> {
        let request = &self.request;
        let gl = self.gl.get_or_insert_with(|| {
            let context = context::open(request).map_err(|error| error.to_string())?;
            let info = context.describe();
            let driver = info.driver();
            Ok(Gl { renderer: Renderer::new(&context), driver, context })
        });
        gl.as_mut().map_err(|error| error.clone().into())
    }

    /// GL_RENDERER and GL_VERSION.
    ///
    /// # Errors
    ///
    /// No context.
    pub fn driver(&mut self) -> Result<String, Failure> {
        Ok(self.gl()?.driver.clone())
    }

    /// The driver, if a context has been opened for a picture.
    pub fn used_driver(&self) -> Option<&str> {
        self.gl.as_ref()?.as_ref().ok().map(|gl| gl.driver.as_str())
    }

    /// The reason why no context could be opened, if one was wanted.
    pub fn no_context(&self) -> Option<&str> {
        self.gl.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// The renderer, for GL beside a case's own.
    ///
    /// # Errors
    ///
    /// No context.
    pub fn renderer(&mut self) -> Result<&mut Renderer, Failure> {
        Ok(&mut self.gl()?.renderer)
    }

    /// Has `act` called between the two frames of [`Drawer::draw_after`], as another user of the context might act there.
    pub fn between_frames(&mut self, act: Option<BetweenFrames>) {
        self.between = act;
    }

    /// Draws `frames` frames of `scene` with `set` applied, and reads what is wanted from the last. Nothing of an earlier
    /// picture is left to be met again: every image is overwritten and every pass drawn again.
    ///
    /// # Errors
    ///
    /// Any error of the library, as its user would read it; a GL error.
    pub fn draw(&mut self, scene: &Path, set: &[String], frames: u32, wanted: Wanted) -> Result<DrawnScene, Failure> {
        draw_planned(self.gl()?, scene, set, frames, wanted, true)
    }

    /// As [`Drawer::draw`] of one frame, on a renderer that has just drawn `first` and may keep what does not change.
    ///
    /// # Errors
    ///
    /// As [`Drawer::draw`].
    pub fn draw_after(
        &mut self,
        scene: &Path,
        first: &[String],
        set: &[String],
        wanted: Wanted,
    ) -> Result<DrawnScene, Failure> {
        draw_planned(self.gl()?, scene, first, 1, wanted, true)?;
        let mut between = self.between.take();
        let gl = self.gl()?;
        between.iter_mut().for_each(|act| act(&mut gl.renderer));
        let drawn = draw_planned(gl, scene, set, 1, wanted, false);
        self.between = between;
        drawn
    }
}

fn draw_planned(
    gl: &mut Gl,
    scene: &Path,
    set: &[String],
    frames: u32,
    wanted: Wanted,
    fresh: bool,
) -> Result<DrawnScene, Failure> {
    let loaded = crate::load(scene, set).map_err(|error| error.to_string())?;
    // An error that another user of the context has left would be some call's of ours.
    gl.renderer.device().check("what was done before").map_err(of_device)?;
    let views = match wanted {
        Wanted::View(view, light) => vec![ViewRequest { view, light }],
        Wanted::Picture | Wanted::FloatPicture => Vec::new(),
    };
    let request = Request { views, float_picture: wanted == Wanted::FloatPicture, frames, ..Request::default() };
    let plan = gl.renderer.plan(&loaded.scene, &request).map_err(of_frame)?;
    if fresh {
        scrub(&mut gl.renderer, &plan).map_err(of_device)?;
    }
    for _ in 0..frames {
        gl.renderer.draw(&plan).map_err(of_frame)?;
    }
    let frame = gl.renderer.read(&plan).map_err(of_frame)?;
    hear_driver(gl.context.as_ref())?;
    let shown = frame.views.first().unwrap_or(&frame.picture);
    Ok(DrawnScene {
        picture: Raster::of(shown, matches!(wanted, Wanted::View(View::Shade, _))),
        scene: loaded.scene,
        left_out: plan.left_out.iter().map(|left| format!("{}: {}", left.what, left.why)).collect(),
        warnings: loaded.warnings.into_iter().chain(plan.warnings.iter().cloned()).collect(),
        plan: Some(Rc::new(plan)),
    })
}

/// Fails for messages of high severity: the device has taken those that are errors.
fn hear_driver(context: &dyn Context) -> Result<(), Failure> {
    let messages = context.debug_log().map(context::DebugLog::take).unwrap_or_default();
    match messages.first() {
        Some(message) => Err(Failure::of_gl(format!("the driver says, with high severity: {}", message.text))),
        None => Ok(()),
    }
}

fn of_frame(error: frame::Error) -> Failure {
    match error {
        frame::Error::Device(error) => of_device(error),
        error => error.to_string().into(),
    }
}

fn of_device(error: device::Error) -> Failure {
    match &error {
        device::Error::Gl(gl) => Failure::of_gl(format!("GL error in {}: {}", gl.label, gl.messages.join("; "))),
        _ => error.to_string().into(),
    }
}

/// Fills the plan's images with nonsense. Without this a texture that nothing writes may lie where the last one's
/// right texels still are, and a skipped copy compares equal.
fn scrub(renderer: &mut Renderer, plan: &Plan) -> Result<(), device::Error> {
    let mut list = PassList { images: plan.list.images.clone(), ..PassList::default() };
    for (index, desc) in plan.list.images.iter().enumerate() {
        let (color, depth) = match (&desc.storage, desc.format) {
            (
                Storage::Uploaded(_)
                | Storage::Levels(_)
                | Storage::UnitVectors
                | Storage::Line(_)
                | Storage::Values(_),
                _,
            ) => continue,
            (_, format) if format.has_depth() => (None, Some(ImageId(index))),
            _ => (Some(ImageId(index)), None),
        };
        list.passes.push(Pass {
            label: format!("scrub {index}"),
            redraw: Redraw::Always,
            work: Work::Draw(DrawPass {
                target: Target { color, depth, level: 0, face: None },
                viewport: desc.size,
                clear: Clear { color: color.map(|_| [1.0, 0.0, 1.0, 0.5]), depth: depth.map(|_| 0.123), stencil: None },
                state: DrawState::OPAQUE,
                batches: Vec::new(),
            }),
        });
    }
    let device = renderer.device();
    device.run(&list, Measure::No)?;
    device.forget();
    Ok(())
}
