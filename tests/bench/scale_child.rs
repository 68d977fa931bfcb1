//! One process of `ci/bench --scale`: draws a scene by the floor or by glumbra, and says how long each step took.

use std::path::Path;
use std::time::Instant;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::output::{self, Output};
use glumbra::plan::Request;
use serde::{Deserialize, Serialize};

use super::child::{median, ms, peak_kib};
use super::floor::Floor;
use super::kinds::Kind;
use super::scale_scene::{MODEL, POINT, Point, SCENE, read_places};
use super::{Arguments, Result, Who};

/// Output of a child.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ScaleSample {
    /// Median of the frames after the first, each with its read-back, in milliseconds.
    pub frame_ms: f64,
    /// The first plan, in milliseconds; 0 for the floor.
    pub plan_ms: f64,
    /// From the beginning of the process to its first picture, in milliseconds: files read, context, shaders, one frame.
    pub start_ms: f64,
    /// VmHWM.
    pub peak_kib: u64,
}

/// Frames are drawn until there are enough, or until they have taken this long in all.
const MOST_FRAMES: usize = 20;
const LONGEST_MS: f64 = 1500.0;

/// Draws the scene in `folder` and prints the [`ScaleSample`].
pub fn run(who: Who, folder: &Path, arguments: &Arguments) -> Result<()> {
    let start = Instant::now();
    let point: Point = serde_json::from_str(&std::fs::read_to_string(folder.join(POINT))?)?;
    let mut sample = match who {
        Who::Glumbra => glumbra(start, folder, arguments)?,
        _ => floor(start, &point, folder, arguments)?,
    };
    sample.peak_kib = peak_kib()?;
    println!("{}", serde_json::to_string(&sample)?);
    Ok(())
}

fn floor(start: Instant, point: &Point, folder: &Path, arguments: &Arguments) -> Result<ScaleSample> {
    let mut numbers = point.numbers();
    numbers.models = read_places(folder)?;
    let mut floor = Floor::new(numbers, Kind::Map, &folder.join(MODEL), false)?;
    // A map and a picture for each light, as a program draws that adds light after light.
    let mut frame = || {
        for _ in 0..point.lights {
            floor.depth_pass();
            floor.lit_pass();
        }
        floor.read();
        Ok(())
    };
    frame()?;
    let start_ms = ms(start);
    let frame_ms = repeated(frame)?;
    if let Some(path) = &arguments.output {
        floor.write_png(path)?;
    }
    Ok(ScaleSample { frame_ms, start_ms, ..ScaleSample::default() })
}

fn glumbra(start: Instant, folder: &Path, arguments: &Arguments) -> Result<ScaleSample> {
    let loaded = glumbra::load(&folder.join(SCENE), &[])?;
    let context = context::open(&ContextRequest::default())?;
    let mut renderer = Renderer::new(&context);
    let planning = Instant::now();
    let plan = renderer.plan(&loaded.scene, &Request { frames: MOST_FRAMES as u32, ..Request::default() })?;
    let plan_ms = ms(planning);
    let mut picture = None;
    let mut frame = || {
        // Counts in the stencil buffer are kept from frame to frame, too: all is drawn again.
        renderer.device().forget();
        renderer.draw(&plan)?;
        picture = Some(renderer.device().read(&plan.list, plan.picture)?);
        Ok(())
    };
    frame()?;
    let start_ms = ms(start);
    let frame_ms = repeated(frame)?;
    if let (Some(path), Some(pixels)) = (&arguments.output, &picture) {
        output::write_all(&[Output { path, pixels, view: None }])?;
    }
    Ok(ScaleSample { frame_ms, plan_ms, start_ms, ..ScaleSample::default() })
}

/// Median time of a frame that is drawn again and again.
fn repeated(mut frame: impl FnMut() -> Result<()>) -> Result<f64> {
    let (begin, mut times) = (Instant::now(), Vec::new());
    while times.is_empty() || (times.len() < MOST_FRAMES && ms(begin) < LONGEST_MS) {
        let start = Instant::now();
        frame()?;
        times.push(ms(start));
    }
    Ok(median(&mut times))
}
