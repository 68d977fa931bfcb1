//! Draws a case's scene with the product: load, plan, run, read back.

use std::cell::RefCell;
use std::path::Path;

use glumbra::context::{self, Choice, ContextRequest, Profile};
use glumbra::device::Measure;
use glumbra::frame::Renderer;
use glumbra::pass::{Clear, DrawPass, DrawState, ImageId, Pass, PassList, Redraw, Storage, Target, Work};
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::views::View;

use super::picture::Picture;

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
pub struct Drawn {
    pub scene: Scene,
    pub picture: Picture,
    /// `what: why` of all that was left out.
    pub left_out: Vec<String>,
    pub warnings: Vec<String>,
}

/// One thread's renderer and its context, kept until the process ends: drivers differ in what they bear when a thread ends.
struct Gpu {
    renderer: &'static mut Renderer,
    driver: String,
}

thread_local! {
    static GPU: RefCell<Option<Result<Gpu, String>>> = const { RefCell::new(None) };
}

fn open() -> Result<Gpu, String> {
    let request =
        ContextRequest { choice: Choice::Auto, device: None, profile: Profile::Core33, debug: cfg!(debug_assertions) };
    let context = context::open(&request).map_err(|error| error.to_string())?;
    let info = context.describe();
    let driver = format!("{}, OpenGL {}", info.renderer, info.version);
    let renderer = Box::leak(Box::new(Renderer::new(&context)));
    Ok(Gpu { renderer, driver })
}

fn with_gpu<T>(act: impl FnOnce(&mut Gpu) -> Result<T, String>) -> Result<T, String> {
    GPU.with_borrow_mut(|gpu| match gpu.get_or_insert_with(open) {
        Ok(gpu) => act(gpu),
        Err(error) => Err(error.clone()),
    })
}

/// GL_RENDERER and GL_VERSION, or why there is no context.
pub fn driver() -> String {
    with_gpu(|gpu| Ok(gpu.driver.clone())).unwrap_or_else(|error| error)
}

/// Draws `frames` frames of `scene` with `set` applied, and reads what is wanted from the last. Nothing of an earlier
/// picture is left to be met again: every image is overwritten and every pass drawn again.
///
/// # Errors
///
/// Any error of the product, as its user would read it.
pub fn draw(scene: &Path, set: &[String], frames: u32, wanted: Wanted) -> Result<Drawn, String> {
    with_gpu(|gpu| draw_planned(gpu, scene, set, frames, wanted, true))
}

/// As [`draw`] of one frame, on a renderer that has just drawn `first` and may keep what does not change.
pub fn draw_after(scene: &Path, first: &[String], set: &[String], wanted: Wanted) -> Result<Drawn, String> {
    with_gpu(|gpu| {
        draw_planned(gpu, scene, first, 1, wanted, true)?;
        draw_planned(gpu, scene, set, 1, wanted, false)
    })
}

fn draw_planned(
    gpu: &mut Gpu,
    scene: &Path,
    set: &[String],
    frames: u32,
    wanted: Wanted,
    fresh: bool,
) -> Result<Drawn, String> {
    let loaded = glumbra::load(scene, set).map_err(|error| error.to_string())?;
    let views = match wanted {
        Wanted::View(view, light) => vec![ViewRequest { view, light }],
        Wanted::Picture | Wanted::FloatPicture => Vec::new(),
    };
    let request = Request { views, float_picture: wanted == Wanted::FloatPicture, frames, ..Request::default() };
    let plan = gpu.renderer.plan(&loaded.scene, &request).map_err(|error| error.to_string())?;
    if fresh {
        scrub(gpu.renderer, &plan)?;
    }
    for _ in 0..frames {
        gpu.renderer.draw(&plan).map_err(|error| error.to_string())?;
    }
    let frame = gpu.renderer.read(&plan).map_err(|error| error.to_string())?;
    let shown = frame.views.first().unwrap_or(&frame.picture);
    Ok(Drawn {
        picture: Picture::of(shown, matches!(wanted, Wanted::View(View::Shade, _))),
        scene: loaded.scene,
        left_out: plan.left_out.iter().map(|left| format!("{}: {}", left.what, left.why)).collect(),
        warnings: loaded.warnings.into_iter().chain(plan.warnings).collect(),
    })
}

/// Fills the plan's images with nonsense. Without this a texture that nothing writes may lie where the last one's
/// right texels still are, and a skipped copy compares equal.
fn scrub(renderer: &mut Renderer, plan: &Plan) -> Result<(), String> {
    let mut list = PassList { images: plan.list.images.clone(), passes: Vec::new() };
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
    device.run(&list, Measure::No).map_err(|error| error.to_string())?;
    device.forget();
    Ok(())
}
