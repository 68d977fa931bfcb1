//! `--pipeline`: shaders, or the driver's fixed functions.

use std::rc::Rc;

use clap::ValueEnum;

use super::{ContextArgs, Error};
use crate::context::{self, Context, Profile};
use crate::frame::{Frame, Renderer, Times};
use crate::plan::Plan;
use crate::png_file::PngTexts;

/// Pipeline that draws the passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Pipeline {
    /// Shaders
    #[default]
    Shaders,
    /// The driver's fixed functions (glTexGen, glTexEnv, glLight). A scene with passes that they cannot express is
    /// refused, with a list of these passes
    FixedFunction,
}

impl Pipeline {
    /// Adds its name to the texts of a PNG, unless it is the usual one.
    pub fn texts(self, texts: PngTexts) -> PngTexts {
        let name = self.to_possible_value().filter(|_| self != Self::default());
        texts.with("Pipeline", name.map(|name| name.get_name().to_owned()).unwrap_or_default())
    }

    /// Opens a context that this pipeline can use.
    ///
    /// # Errors
    ///
    /// None to be had.
    pub fn open(self, arguments: &ContextArgs) -> Result<Rc<dyn Context>, Error> {
        match self {
            Self::Shaders => Ok(context::open(&arguments.request(Profile::Core33))?),
            Self::FixedFunction => {
                context::open(&arguments.request(Profile::Compatibility)).map_err(Error::NoFixedFunction)
            }
        }
    }

    /// Draws `count` frames of a plan, times each, and reads the last. By shaders with `passes`, one more frame is
    /// drawn with its passes timed.
    ///
    /// # Errors
    ///
    /// Passes that this pipeline cannot draw.
    pub fn draw(
        self,
        context: &Rc<dyn Context>,
        renderer: &mut Renderer,
        plan: &Plan,
        count: u32,
        passes: bool,
        tick: impl FnMut(),
    ) -> Result<(Times, Frame), Error> {
        if self == Self::Shaders {
            let times = renderer.draw_timed(plan, count, passes, tick)?;
            return Ok((times, renderer.read(plan)?));
        }
        draw_fixed(context, plan, count, tick)
    }
}

/// Draws `count` frames of a plan by the driver's fixed functions, times each, and reads the last.
fn draw_fixed(
    context: &Rc<dyn Context>,
    plan: &Plan,
    count: u32,
    mut tick: impl FnMut(),
) -> Result<(Times, Frame), Error> {
    let _doing = crate::process::doing("drawing by the fixed-function pipeline");
    let mut fixed = crate::fixed_function::FixedFunction::new(context)?;
    let mut times = Times::default();
    for _ in 0..count {
        let start = std::time::Instant::now();
        fixed.run(&plan.list)?;
        fixed.finish();
        times.frames_ms.push(start.elapsed().as_secs_f64() * 1e3);
        tick();
    }
    let picture = fixed.read(&plan.list, plan.picture)?;
    let views = plan.views.iter().map(|(_, image)| fixed.read(&plan.list, *image)).collect::<Result<_, _>>()?;
    Ok((times, Frame { picture, views, warnings: plan.warnings.clone() }))
}
