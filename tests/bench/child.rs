//! One process of the bench: draws a scene some times and says how long it took.

use std::path::{Path, PathBuf};
use std::time::Instant;

use glumbra::context::{self, ContextRequest};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::output::{self, Output};
use glumbra::pass::{Attribute, Channels, DrawPass, Format, ImageDesc, ImageId, PassList, Storage, Work};
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::views::View;
use serde::{Deserialize, Serialize};

use super::floor::Floor;
use super::numbers::numbers;
use super::{Arguments, Redraw, Result, Scene, Who};

/// Output of a child.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Sample {
    /// Medians in milliseconds: a frame with its read-back, and each pass waited for.
    pub frame_ms: f64,
    pub depth_ms: f64,
    pub lit_ms: f64,
    /// Processor time of all threads a frame after the first, which other processes disturb less.
    pub cpu_ms: f64,
    /// The same of the passes alone that find shadows: maps, counts in the stencil buffer.
    pub shadow_cpu_ms: f64,
    /// VmHWM.
    pub peak_kib: u64,
}

/// Parts that are drawn although glumbra leaves them out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Keep {
    #[default]
    Nothing,
    /// All casters and faces of the map.
    Casters,
    /// A colour buffer of the passes that draw maps.
    Color,
    /// Normals in them.
    Normals,
    /// The parts that their scissors remove.
    Scissor,
    /// All that a plan can leave out.
    All,
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
    let mut floor = Floor::new(numbers(scene), arguments.floor, &model_file(arguments), tuned)?;
    let mut cpu = processor_ms();
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
            cpu = processor_ms();
        }
    }
    let cpu_ms = (processor_ms() - cpu) / (arguments.frames - 1).max(1) as f64;
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
        let start = processor_ms();
        for _ in 0..arguments.frames {
            timed(&floor, |floor| floor.depth_pass());
        }
        sample.shadow_cpu_ms = (processor_ms() - start) / arguments.frames as f64;
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
    let loaded = glumbra::load(&file, &sets)?;
    let context = context::open(&ContextRequest::default())?;
    let mut renderer = Renderer::new(&context);
    let keep_all = arguments.keep == Keep::All;
    let views = match arguments.keep {
        Keep::Casters => vec![ViewRequest { view: View::LightDepth, light: 0 }],
        _ => Vec::new(),
    };
    let request = Request { frames: u32::try_from(arguments.frames)?, keep_all, views, ..Request::default() };
    let mut plan = renderer.plan(&loaded.scene, &request)?;
    keep(&mut plan, arguments.keep);
    let mut times = Vec::new();
    let mut picture = None;
    let mut cpu = processor_ms();
    for frame in 0..arguments.frames {
        let start = Instant::now();
        renderer.draw(&plan)?;
        picture = Some(renderer.device().read(&plan.list, plan.picture)?);
        times.push(ms(start));
        if frame == 0 {
            cpu = processor_ms();
        }
    }
    let cpu_ms = (processor_ms() - cpu) / (arguments.frames - 1).max(1) as f64;
    if let (Some(path), Some(pixels)) = (&arguments.output, &picture) {
        write_png(path, pixels)?;
    }
    let mut sample = Sample { frame_ms: median(&mut times), cpu_ms, ..Sample::default() };
    if arguments.frames > 1 {
        let (mut depth, mut lit) = (Vec::new(), Vec::new());
        for _ in 0..PASS_FRAMES {
            renderer.device().forget();
            for pass in renderer.device().run(&plan.list, Measure::Passes)? {
                if pass.label == "lit" { &mut lit } else { &mut depth }.push(pass.wall_ms);
            }
        }
        (sample.depth_ms, sample.lit_ms) = (median(&mut depth), median(&mut lit));
        sample.shadow_cpu_ms = shadow_cpu(&mut renderer, &plan.list, arguments.frames)?;
    }
    Ok(sample)
}

/// Puts what is to be kept back into the passes of light 0.
fn keep(plan: &mut Plan, keep: Keep) {
    let PassList { images, passes, .. } = &mut plan.list;
    for pass in passes.iter_mut().filter(|pass| pass.label.starts_with("light 0: ")) {
        let Work::Draw(pass) = &mut pass.work else { continue };
        match keep {
            Keep::Scissor => {
                pass.state.scissor = None;
                pass.batches.dedup_by(|next, batch| next.scissor.is_some() && batch.scissor.is_some());
                pass.batches.iter_mut().for_each(|batch| batch.scissor = None);
            }
            Keep::Color => {
                let (label, size) = (String::from("colour"), pass.viewport);
                images.push(ImageDesc { label, size, format: Format::Rgba8, storage: Storage::Renderbuffer });
                pass.target.color = Some(ImageId(images.len() - 1));
                pass.clear.color = Some([0.0; 4]);
                pass.state.color_write = Channels::All;
            }
            Keep::Normals => read_normals(pass),
            Keep::Nothing | Keep::Casters | Keep::All => {}
        }
    }
}

/// Moves every vertex by so little of its normal that it stays where it is: no compiler can leave the normals out.
fn read_normals(pass: &mut DrawPass) {
    for batch in &mut pass.batches {
        batch.program.attributes.push(Attribute::Normal);
        let position = &mut batch.program.vertex[0].text;
        let moved =
            position.replace("clip_from_model * position;", "clip_from_model * position + 1e-30 * vec4(normal, 0.0);");
        *position = format!("layout(location = 1) in vec3 normal;\n{moved}").into();
    }
}

/// Processor time of the passes that find light 0's shadows, drawn alone, again and again.
fn shadow_cpu(renderer: &mut Renderer, list: &PassList, frames: usize) -> Result<f64> {
    let mut alone = list.clone();
    alone.passes.retain(|pass| pass.label.starts_with("light 0: "));
    let device = renderer.device();
    device.finish();
    let start = processor_ms();
    for _ in 0..frames {
        device.forget();
        device.run(&alone, Measure::No)?;
        device.finish();
    }
    Ok((processor_ms() - start) / frames as f64)
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

/// Time since `start`, in milliseconds.
pub fn ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// The middle value; 0 of none.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Processor time of this process so far, of all threads, in user and system mode.
pub fn processor_ms() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the clock is one that every Linux has, and `time` is there to be written.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
}

/// VmHWM of this process.
pub fn peak_kib() -> Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM in /proc/self/status")?;
    Ok(line.trim().trim_end_matches(" kB").parse()?)
}
