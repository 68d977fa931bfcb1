//! One process of the bench: draws a scene some times and says how long it took.

use std::path::{Path, PathBuf};
use std::time::Instant;

use glumbra::context::{self, ContextRequest};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::output::{self, Output};
use glumbra::plan::Request;
use glumbra::scene;
use serde::{Deserialize, Serialize};

use super::floor::Floor;
use super::{Arguments, Redraw, Result, Scene, Who};

/// What a child prints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Sample {
    /// Medians in milliseconds: a frame with its read-back, and each pass waited for.
    pub frame_ms: f64,
    pub depth_ms: f64,
    pub lit_ms: f64,
    /// All passes that find shadows, in one frame: maps, counts in the stencil buffer.
    pub shadow_ms: f64,
    /// Processor time of all threads a frame after the first, which other processes disturb less.
    pub cpu_ms: f64,
    /// VmHWM.
    pub peak_kib: u64,
}

/// Frames whose passes are waited for, at the end.
const PASS_FRAMES: usize = 3;

/// Draws as `arguments` say and prints the [`Sample`].
pub fn run(who: Who, arguments: &Arguments) -> Result<()> {
    let scene = arguments.scene.unwrap_or(Scene::S1);
    let mut sample = match who {
        Who::Clear => return super::floor_gl::first_pixel(),
        Who::Floor => floor(scene, false, arguments)?,
        Who::Tuned => floor(scene, true, arguments)?,
        Who::Glumbra => glumbra(scene, arguments)?,
    };
    sample.peak_kib = peak_kib()?;
    println!("{}", serde_json::to_string(&sample)?);
    Ok(())
}

fn floor(scene: Scene, tuned: bool, arguments: &Arguments) -> Result<Sample> {
    let mut floor = Floor::new(scene, &model_file(arguments), tuned)?;
    let mut cpu = cpu_ms()?;
    let mut times = Vec::new();
    for frame in 0..arguments.frames {
        let start = Instant::now();
        if frame == 0 || arguments.redraw == Redraw::Always {
            floor.depth_pass();
        }
        floor.lit_pass();
        floor.read();
        times.push(ms(start));
        if frame == 0 {
            cpu = cpu_ms()?;
        }
    }
    let cpu_ms = (cpu_ms()? - cpu) / (arguments.frames - 1).max(1) as f64;
    if let Some(path) = &arguments.output {
        floor.write_png(path)?;
    }
    let mut sample = Sample { frame_ms: median(&mut times), cpu_ms, ..Sample::default() };
    if arguments.frames > 1 {
        let passes: Vec<(f64, f64)> = (0..PASS_FRAMES)
            .map(|_| (timed(&floor, |floor| floor.depth_pass()), timed(&floor, |floor| floor.lit_pass())))
            .collect();
        sample.depth_ms = median(&mut passes.iter().map(|pass| pass.0).collect::<Vec<_>>());
        sample.lit_ms = median(&mut passes.iter().map(|pass| pass.1).collect::<Vec<_>>());
    }
    Ok(sample)
}

fn timed(floor: &Floor, pass: impl Fn(&Floor)) -> f64 {
    floor.finish();
    let start = Instant::now();
    pass(floor);
    floor.finish();
    ms(start)
}

fn glumbra(scene: Scene, arguments: &Arguments) -> Result<Sample> {
    let redraw = match arguments.redraw {
        Redraw::Always => "light.shadow.redraw=always",
        Redraw::Once => "light.shadow.redraw=once",
    };
    let file = arguments.file.clone().unwrap_or_else(|| scene_file(scene));
    let sets: Vec<String> = [String::from(redraw)].into_iter().chain(arguments.set.iter().cloned()).collect();
    let loaded = scene::load(&file, &sets)?;
    let context = context::open(&ContextRequest::default())?;
    let mut renderer = Renderer::new(context.as_ref());
    let request = Request { frames: u32::try_from(arguments.frames)?, ..Request::default() };
    let plan = renderer.plan(&loaded.scene, &request)?;
    let mut times = Vec::new();
    let mut picture = None;
    let mut cpu = cpu_ms()?;
    for frame in 0..arguments.frames {
        let start = Instant::now();
        renderer.draw(&plan)?;
        let pictures = renderer.read(&plan)?;
        times.push(ms(start));
        picture = Some(pictures.picture);
        if frame == 0 {
            cpu = cpu_ms()?;
        }
    }
    let cpu_ms = (cpu_ms()? - cpu) / (arguments.frames - 1).max(1) as f64;
    if let (Some(path), Some(pixels)) = (&arguments.output, &picture) {
        write_png(path, pixels)?;
    }
    let mut sample = Sample { frame_ms: median(&mut times), cpu_ms, ..Sample::default() };
    if arguments.frames > 1 {
        let (mut depth, mut lit, mut shadow) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..PASS_FRAMES {
            renderer.device().forget();
            let mut sum = 0.0;
            for pass in renderer.device().run(&plan.list, Measure::Passes)? {
                if pass.label == "lit" { &mut lit } else { &mut depth }.push(pass.wall_ms);
                sum += if pass.label.starts_with("light 0: ") { pass.wall_ms } else { 0.0 };
            }
            shadow.push(sum);
        }
        (sample.depth_ms, sample.lit_ms) = (median(&mut depth), median(&mut lit));
        sample.shadow_ms = median(&mut shadow);
    }
    Ok(sample)
}

fn write_png(path: &Path, pixels: &Pixels) -> Result<()> {
    Ok(output::write_all(&[Output { path, pixels, view: None }])?)
}

/// The scene as a file.
pub fn scene_file(scene: Scene) -> PathBuf {
    let name = match scene {
        Scene::S1 => "data/scenes/bench_s1.toml",
        Scene::S2 => "data/scenes/bench_s2.toml",
    };
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The model that the scenes show.
pub fn model_file(arguments: &Arguments) -> PathBuf {
    arguments.model.clone().unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/dense.obj"))
}

fn ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// The middle value; 0 of none.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Processor time of this process so far, of all threads, in user and system mode.
fn cpu_ms() -> Result<f64> {
    /// USER_HZ, which is 100 on every Linux.
    const MS_A_TICK: f64 = 10.0;
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    // The second field is a name in brackets; utime and stime are the 14th and 15th.
    let (_, rest) = stat.rsplit_once(')').ok_or("no name in /proc/self/stat")?;
    let ticks =
        rest.split_ascii_whitespace().skip(11).take(2).map(str::parse::<f64>).sum::<std::result::Result<f64, _>>()?;
    Ok(MS_A_TICK * ticks)
}

fn peak_kib() -> Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM in /proc/self/status")?;
    Ok(line.trim().trim_end_matches(" kB").parse()?)
}
