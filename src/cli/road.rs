//! `--road`: who turns a plan's passes into pictures.

use std::time::Instant;

use clap::ValueEnum;

use super::{ContextArgs, Error};
use crate::context::{self, Context, Profile};
use crate::fixed_function::FixedFunction;
use crate::frame::{Frame, Renderer, Times};
use crate::plan::Plan;
use crate::process;

/// How the passes are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Road {
    /// By shaders, the product
    #[default]
    Shaders,
    /// By the driver's own fixed-function pipeline (glTexGen, glTexEnv, glLight), which the shaders are held against;
    /// what that cannot draw is named, and nothing is written
    FixedFunction,
}

impl Road {
    /// A context that the road can be gone on.
    ///
    /// # Errors
    ///
    /// None to be had.
    pub fn open(self, arguments: &ContextArgs) -> Result<Box<dyn Context>, Error> {
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
    /// What the road cannot draw.
    pub fn draw(
        self,
        context: &dyn Context,
        renderer: &mut Renderer,
        plan: &Plan,
        count: u32,
        passes: bool,
        mut tick: impl FnMut(),
    ) -> Result<(Times, Frame), Error> {
        if self == Self::Shaders {
            let times = renderer.draw_timed(plan, count, passes, tick)?;
            return Ok((times, renderer.read(plan)?));
        }
        let _doing = process::doing("drawing by the fixed-function pipeline");
        let mut fixed = FixedFunction::new(context)?;
        let mut times = Times::default();
        for _ in 0..count {
            let start = Instant::now();
            fixed.run(&plan.list)?;
            fixed.finish();
            times.frames_ms.push(start.elapsed().as_secs_f64() * 1e3);
            tick();
        }
        let picture = fixed.read(&plan.list, plan.picture)?;
        let views = plan.views.iter().map(|(_, image)| fixed.read(&plan.list, *image)).collect::<Result<_, _>>()?;
        Ok((times, Frame { picture, views }))
    }
}
