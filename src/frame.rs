//! The loop: plan a scene, run the passes on the device, read the pictures back.

use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Instant;

use crate::conformance::probe;
use crate::context::{self, Context, ContextRequest};
use crate::device::{self, Device, Measure, PassTime, Pixels};
use crate::geometry::{Derived, Texture};
use crate::pass::{DepthFormat, Format};
use crate::plan::{self, Limits, Plan, Request, ViewRequest};
use crate::process::doing;
use crate::scene::Scene;
use crate::views::View;

/// Reason why a frame could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be planned, or the driver's limits are too low for its plan.
    #[error(transparent)]
    Plan(#[from] plan::Error),
    /// The driver failed, or the plan breaks one of GL's rules.
    #[error(transparent)]
    Device(#[from] device::Error),
    /// The depth formats could not be measured.
    #[error(transparent)]
    Probe(#[from] probe::Error),
}

/// Name of this work in the message of a crash.
const DRAWING: &str = "drawing";

/// Draws scenes on one context.
pub struct Renderer {
    device: Device,
    limits: Limits,
    /// Kept from plan to plan.
    derived: Derived,
}

/// Does `work` for each of 0..`count` on `jobs` threads, each with a context and a renderer of its own, until all is done
/// or `stop` is set. `finished` is called on the caller's thread with each number and its result, in no order.
///
/// # Errors
///
/// A context that cannot be had.
#[doc(hidden)]
pub fn on_contexts<T: Send>(
    request: &ContextRequest,
    [count, jobs]: [usize; 2],
    stop: &AtomicBool,
    work: impl Fn(usize, &mut Renderer) -> T + Sync,
    mut finished: impl FnMut(usize, T),
) -> Result<(), context::Error> {
    let next = AtomicUsize::new(0);
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, count.max(1)) {
            let (send, next, work) = (send.clone(), &next, &work);
            scope.spawn(move || {
                let context = match context::open(request) {
                    Ok(context) => context,
                    Err(error) => {
                        let _ = send.send(Err(error)); // the receiver outlives the senders
                        return;
                    }
                };
                let mut renderer = Renderer::new(&context);
                while !stop.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count || send.send(Ok((index, work(index, &mut renderer)))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(send);
        for result in receive {
            let (index, result) = result?;
            finished(index, result);
        }
        Ok(())
    })
}

/// A planned scene's pictures.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Frame {
    /// The picture, 8 bits a channel or float as [`Request::float_picture`] says.
    pub picture: Pixels,
    /// Views in the request's order.
    pub views: Vec<Pixels>,
    /// Errors that the picture shows, as the plan foresees them: [`Plan::warnings`].
    pub warnings: Vec<String>,
}

/// Times of frames.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Times {
    /// Each frame from its first call to the return of glFinish, in milliseconds. The first one uploads and compiles.
    pub frames_ms: Vec<f64>,
    /// The passes of one more frame, redrawn, each waited for.
    pub passes: Vec<PassTime>,
}

impl Renderer {
    /// A renderer on `context`, which is current on this thread. The renderer keeps the context alive; either may be
    /// dropped first.
    pub fn new(context: &Rc<dyn Context>) -> Self {
        let device = Device::new(context);
        let (max_image_size, max_inputs) = device.limits();
        Self { device, limits: Limits { max_image_size, max_inputs }, derived: Derived::default() }
    }

    /// Plans `scene`, draws it and reads the pictures: what a test of pixels needs.
    ///
    /// # Errors
    ///
    /// See [`plan::make_with`] and [`Device::run`].
    pub fn render(&mut self, scene: &Scene, request: &Request) -> Result<Frame, Error> {
        let plan = self.plan(scene, request)?;
        self.draw(&plan)?;
        self.read(&plan)
    }

    /// Plans `scene` within the driver's limits.
    ///
    /// # Errors
    ///
    /// See [`plan::make_with`].
    pub fn plan(&mut self, scene: &Scene, request: &Request) -> Result<Plan, Error> {
        let mut plan = plan::make_with(scene, &Request { limits: self.limits, ..request.clone() }, &self.derived)?;
        self.warn_of_formats(&mut plan)?;
        Ok(plan)
    }

    /// Checks a plan that was made without a context against the driver, and adds warnings of the driver's formats.
    ///
    /// # Errors
    ///
    /// A plan beyond the driver's limits.
    pub fn accept(&mut self, plan: &mut Plan) -> Result<(), Error> {
        plan.check(&self.limits)?;
        self.warn_of_formats(plan)
    }

    /// Draws one frame of a plan; waits for nothing.
    ///
    /// # Errors
    ///
    /// See [`Device::run`].
    pub fn draw(&mut self, plan: &Plan) -> Result<(), Error> {
        let _doing = doing(DRAWING);
        self.device.run(&plan.list, Measure::No)?;
        Ok(())
    }

    /// Draws `count` frames and times each. With `passes`, one more frame is drawn with each of its passes timed.
    ///
    /// # Errors
    ///
    /// See [`Device::run`].
    pub fn draw_timed(
        &mut self,
        plan: &Plan,
        count: u32,
        passes: bool,
        mut tick: impl FnMut(),
    ) -> Result<Times, Error> {
        let _doing = doing(DRAWING);
        let mut times = Times::default();
        for _ in 0..count {
            let start = Instant::now();
            self.draw(plan)?;
            self.device.finish();
            times.frames_ms.push(start.elapsed().as_secs_f64() * 1e3);
            tick();
        }
        if passes {
            self.device.forget();
            times.passes = self.device.run(&plan.list, Measure::Passes)?;
        }
        Ok(times)
    }

    /// Reads the pictures of the plan that was drawn last.
    ///
    /// # Errors
    ///
    /// See [`Device::read`].
    pub fn read(&mut self, plan: &Plan) -> Result<Frame, Error> {
        let _doing = doing("reading pictures");
        let picture = self.device.read(&plan.list, plan.picture)?;
        let views = plan.views.iter().map(|(wanted, image)| match wanted.view.is_stencil() {
            true => self.device.read_stencil(&plan.list, *image),
            false => self.device.read(&plan.list, *image),
        });
        let views = views.collect::<Result<_, _>>()?;
        Ok(Frame { picture, views, warnings: plan.warnings.clone() })
    }

    /// Copies the picture of the plan that was drawn last into the window that the context belongs to.
    ///
    /// # Errors
    ///
    /// See [`Device::present`].
    pub fn present(&mut self, plan: &Plan, window: [u32; 2]) -> Result<(), Error> {
        Ok(self.device.present(&plan.list, plan.picture, window)?)
    }

    /// Copies a sheet over that, `place` pixels from the window's left and upper edge.
    ///
    /// # Errors
    ///
    /// See [`Device::present_sheet`].
    pub fn present_sheet(&mut self, sheet: &Arc<Texture>, place: [u32; 2], window: [u32; 2]) -> Result<(), Error> {
        Ok(self.device.present_sheet(sheet, place, window)?)
    }

    /// Reads what [`Renderer::present`] put into the window.
    ///
    /// # Errors
    ///
    /// See [`Device::read_window`].
    pub fn read_window(&mut self, window: [u32; 2]) -> Result<Pixels, Error> {
        Ok(self.device.read_window(window)?)
    }

    /// The driver in a line: GL_RENDERER and GL_VERSION.
    #[doc(hidden)]
    pub fn driver(&self) -> String {
        self.device.driver()
    }

    /// The device, for its own functions.
    #[doc(hidden)]
    pub fn device(&mut self) -> &mut Device {
        &mut self.device
    }

    /// Warns if the driver changes DEPTH_COMPONENT32, which is optional, or if the unsized DEPTH_COMPONENT does not follow
    /// the picture's depth buffer.
    fn warn_of_formats(&mut self, plan: &mut Plan) -> Result<(), Error> {
        let depth32 = Format::Depth(DepthFormat::Depth32);
        for format in [depth32, Format::UnsizedDepth] {
            if !plan.list.images.iter().any(|desc| desc.format == format) {
                continue;
            }
            let name = format.to_string();
            let Some(&measured) = probe::FORMATS.iter().find(|known| known.name() == name) else { continue };
            let facts = probe::depth_format(self.device.raw_gl(), measured)?;
            if format == depth32 || !follows_the_picture(&facts) {
                plan.warnings.push(facts.in_words());
            }
        }
        Ok(())
    }
}

/// A rendered shade: how much of the light's diffuse and specular terms reaches each pixel, in [0, 1]. Row 0 is the top.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadeImage {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width * height` values, 0: shadow, 1: full light. Only values of drawn pixels are used.
    pub shade: Vec<f32>,
    /// True if the picture shows a surface there that lies in the light's cone or frustum.
    pub covered: Vec<bool>,
}

impl ShadeImage {
    /// The shade in RGBA texels of [`View::Shade`], for a picture of this size in pixels.
    pub fn of_view([width, height]: [u32; 2], texels: &[f32]) -> Self {
        Self {
            width,
            height,
            shade: texels.chunks_exact(4).map(|texel| texel[0].clamp(0.0, 1.0)).collect(),
            covered: texels.chunks_exact(4).map(|texel| texel[3] > 0.0).collect(),
        }
    }
}

/// The shade of one light as GL draws it.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn draw_shade(scene: &Scene, light: usize, renderer: &mut Renderer) -> Result<ShadeImage, Error> {
    let views = vec![ViewRequest { view: View::Shade, light }];
    let request = Request { views, views_only: true, sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request)?;
    renderer.draw(&plan)?;
    let texels = match renderer.read(&plan)?.views.pop() {
        Some(Pixels::RgbaF32 { data, .. }) => data,
        _ => Vec::new(),
    };
    Ok(ShadeImage::of_view(scene.image.size, &texels))
}

/// Tests whether a format has the bits of the picture's depth buffer, which is fixed-point.
fn follows_the_picture(facts: &probe::DepthFacts) -> bool {
    let bits = DepthFormat::Depth24.bits();
    facts.measured.as_ref().is_some_and(|measured| measured.depth_bits == bits && !measured.float)
}
