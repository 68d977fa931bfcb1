//! `glumbra render`: a scene to a picture, and the views beside it.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Instant;

use clap::Args;
use indicatif::ProgressBar;
use serde::Serialize;

use super::json::{JsonArgs, is_standard_stream};
use super::path_text::{PathBytes, path_text};
use super::pipeline::Pipeline;
use super::png_texts::scene_texts;
use super::scene_args::SceneChanges;
use super::screen::Screen;
use super::truth_views::{Aov, parse_aov};
use super::{ContextArgs, Error};
use crate::context::{Context, ContextInfo};
use crate::device::Pixels;
use crate::frame::{Frame, Renderer, Times};
use crate::output::{self, FileFormat, Output};
use crate::plan::{Plan, Request, Summary};
use crate::png_file::PngTexts;
use crate::scene::Scene;

/// Renders a scene or a model to a picture.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct RenderArgs {
    /// Scenes (.toml; - is one on standard input), or models (.obj, .md2, .gltf, .glb, .ply, .stl) around which a floor, a
    /// spotlight and a camera are supplied
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,

    #[command(flatten)]
    changes: SceneChanges,

    /// The picture's file: .png, or .exr or .npy with exact 32-bit values; by default the scene's name with .png, here.
    /// For several scenes it names the folder, made if it is not there; - is a PNG on standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Also writes this view beside the picture (out.png: out.NAME.png); NAME@LIGHT for another light than the first
    #[arg(long, value_name = "NAME", value_parser = parse_aov)]
    aov: Vec<Aov>,

    #[command(flatten)]
    json: JsonArgs,

    /// Draws this many frames (and times each, for --json)
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,

    /// Draws the picture as it stands after this pass: its number in `glumbra plan`, or its name. After a pass that writes
    /// alpha alone, the alpha is shown as grey
    #[arg(long, value_name = "PASS", conflicts_with = "aov")]
    after_pass: Option<String>,

    /// Pipeline that draws the passes
    #[arg(long, value_enum, default_value_t)]
    pipeline: Pipeline,

    #[command(flatten)]
    context: ContextArgs,
}

const HELP: &str = "\
Views for --aov:
  shade             white lit, black shadowed, transparent beyond the light
  depth             the camera's window-space depth
  light-depth       the shadow map
  light-view        the scene as the light sees it
  light-distance    r/q, each sample's planar distance from the light
  projected-map     the shadow map projected onto the scene
  texels-per-pixel  texels of the map that a pixel's side shows, as colours
  stencil-count     the shadow volumes that hold each point: grey is the count
  stencil-colors    the same for the eye: green lit, red shadowed
  volume            the shadow volumes: outsides orange, insides blue
  silhouette        the casters' possible silhouettes, as the light sees them
  truth             the ray tracer's picture: lit and shadowed; colours, of all
                    lights, where light or a photograph is projected
  difference        the picture's error against the truth; black where the
                    bounds of a colour at an edge allow it, grey where the truth
                    is not certain. A PNG has those of colours 16 times as large
A PNG stretches depths and distances for the eye. EXR and NPY have them as they are. \
`glumbra judge` holds any program's picture against the truth.

A PNG says in text chunks which scene, overrides, technique, driver and version made it; \
`glumbra compare` shows where two differ.

Examples:
  glumbra render data/scenes/main.toml -o statue.png
  glumbra render model.obj -o model.png --size 800x600 --set camera.fov_y=30
  glumbra render scene.toml -o out.exr --aov shade --aov light-depth
  glumbra render scene.toml --set light.shadow.filter=nearest
  glumbra render scene.toml --pipeline fixed-function -o by-the-driver.png
  glumbra render scene.toml --set shading.passes=shadow --after-pass 2
  glumbra render scene.toml --frames 100 --json -
  glumbra render a.toml b.toml -o out --quiet
  generate-scene | glumbra render - -o - --quiet | display -";

/// Output of `--json`.
#[derive(Serialize)]
struct Results {
    context: String,
    renderer: String,
    /// In the order of the arguments.
    scenes: Vec<Report>,
}

#[derive(Serialize)]
struct Report {
    scene: String,
    files: Vec<String>,
    /// The paths above that are not UTF-8.
    #[serde(skip_serializing_if = "PathBytes::is_empty")]
    path_bytes: PathBytes,
    #[serde(flatten)]
    plan: Summary,
    times: TimesReport,
}

#[derive(Serialize)]
struct TimesReport {
    /// Loading the scene.
    load_ms: f64,
    /// Each frame, waited for; the first one uploads and compiles.
    frames_ms: Vec<f64>,
    /// The median of the frames after the first, or the only one.
    frame_median_ms: f64,
    /// One more frame with every pass redrawn and waited for; absent for fixed function.
    passes: Vec<PassReport>,
}

#[derive(Serialize)]
struct PassReport {
    label: String,
    wall_ms: f64,
    gpu_ms: Option<f64>,
}

impl RenderArgs {
    /// The folder of the pictures, where several scenes are drawn.
    fn folder(&self) -> Option<&Path> {
        self.output.as_deref().filter(|_| self.scenes.len() > 1)
    }
}

/// A scene that is to be drawn, and its files: the picture's first.
struct Job {
    path: PathBuf,
    scene: Scene,
    files: Vec<PathBuf>,
    plan: Plan,
    load_ms: f64,
}

/// Renders.
///
/// # Errors
///
/// Every scene is read and planned before the first is drawn: a scene that cannot be drawn leaves no picture.
pub fn run(arguments: &RenderArgs, screen: Screen) -> Result<(), Error> {
    let views = each_once(&arguments.aov);
    let jobs = jobs(arguments, &views, screen)?;
    let context = arguments.pipeline.open(&arguments.context)?;
    if let Some(folder) = arguments.folder() {
        std::fs::create_dir_all(folder).map_err(|error| Error::MakeFolder { folder: folder.to_owned(), error })?;
    }
    screen.driver(context.as_ref());
    let mut renderer = Renderer::new(&context);
    let bar = progress(arguments.frames.saturating_mul(jobs.len() as u32), screen);
    let mut results = Results { context: context.backend().to_owned(), renderer: String::new(), scenes: Vec::new() };
    let info = context.describe();
    results.renderer = format!("{}, {}", info.renderer, info.version);
    for job in jobs {
        let drawn = draw(job, arguments, &views, (&context, &mut renderer), screen, || bar.inc(1));
        if drawn.is_err() {
            bar.finish_and_clear();
        }
        results.scenes.push(drawn?);
    }
    bar.finish_and_clear();
    arguments.json.write("render", &results)
}

/// Reads and plans all scenes, and finds a name for every file.
fn jobs(arguments: &RenderArgs, views: &[Aov], screen: Screen) -> Result<Vec<Job>, Error> {
    if arguments.output.as_deref().is_some_and(is_standard_stream) {
        let others = [
            (arguments.scenes.len() > 1, "the other scenes"),
            (!views.is_empty(), "--aov"),
            (arguments.json.takes_standard_output(), "--json -"),
        ];
        if let Some((_, what)) = others.into_iter().find(|(is_there, _)| *is_there) {
            return Err(Error::OnePicture(what));
        }
    }
    let pictures = pictures(arguments)?;
    arguments.scenes.iter().zip(pictures).map(|(path, picture)| job(arguments, views, path, picture, screen)).collect()
}

/// The picture's file of each scene.
fn pictures(arguments: &RenderArgs) -> Result<Vec<PathBuf>, Error> {
    let scenes = &arguments.scenes;
    let file = match (&arguments.output, scenes.len()) {
        (Some(file), 1) if !file.is_dir() => return Ok(vec![file.clone()]),
        (Some(file), _) if file.is_file() => return Err(Error::NotAFolder(file.clone())),
        (folder, _) => |scene: &PathBuf| folder.as_deref().unwrap_or(Path::new("")).join(default_output(scene)),
    };
    let files: Vec<PathBuf> = scenes.iter().map(file).collect();
    for (index, file) in files.iter().enumerate() {
        if let Some(other) = files[..index].iter().position(|other| other == file) {
            let [first, second] = [other, index].map(|index| scenes[index].clone());
            return Err(Error::SamePicture { file: file.clone(), first, second });
        }
    }
    Ok(files)
}

fn job(arguments: &RenderArgs, views: &[Aov], path: &Path, picture: PathBuf, screen: Screen) -> Result<Job, Error> {
    let is_png = arguments.folder().is_some() || is_standard_stream(&picture);
    let format = if is_png { FileFormat::Png } else { output::check_path(&picture)? };
    let names = views.iter().map(|wanted| output::beside(&picture, &wanted.file_name()));
    let files: Vec<PathBuf> = [picture.clone()].into_iter().chain(names).collect();
    let start = Instant::now();
    let loaded = arguments.changes.load(path, screen)?;
    let load_ms = start.elapsed().as_secs_f64() * 1e3;
    if !is_standard_stream(&picture) {
        refuse_to_overwrite(&files, path, &loaded.scene)?;
    }
    let request = Request {
        views: views.iter().filter_map(|wanted| wanted.drawn(&loaded.scene)).collect(),
        float_picture: format.is_exact(),
        frames: arguments.frames,
        ..Request::default()
    };
    // A scene that cannot be planned needs no context to be refused.
    let mut plan = crate::plan::make(&loaded.scene, &request)?;
    if let Some(pass) = &arguments.after_pass {
        plan = plan.after_pass(pass)?;
    }
    Ok(Job { path: path.to_owned(), scene: loaded.scene, files, plan, load_ms })
}

/// Draws a scene, and writes its files: all or none.
fn draw(
    job: Job,
    arguments: &RenderArgs,
    views: &[Aov],
    (context, renderer): (&Rc<dyn Context>, &mut Renderer),
    screen: Screen,
    tick: impl FnMut(),
) -> Result<Report, Error> {
    let Job { path, scene, files, mut plan, load_ms } = job;
    renderer.accept(&mut plan)?;
    for warning in &plan.warnings {
        super::say(format_args!("warning: {warning}"));
    }
    for left in &plan.left_out {
        screen.detail(format_args!("left out: {}: {}", left.what, left.why));
    }
    let passes = arguments.json.is_wanted() || screen.is_verbose();
    let (times, mut frame) = arguments.pipeline.draw(context, renderer, &plan, arguments.frames, passes, tick)?;
    if plan.ends_in_alpha() {
        frame.picture = frame.picture.alpha_as_gray();
    }
    let is_exact = matches!(frame.picture, Pixels::RgbaF32 { .. });
    let traced = trace(views, &scene, &frame, is_exact)?;
    let mut drawn = frame.views.iter();
    let shown = views.iter().zip(&traced).filter_map(|(wanted, traced)| {
        let view = wanted.drawn(&scene).and_then(|wanted| Some((drawn.next()?, Some(wanted.view))));
        traced.as_ref().map(|pixels| (pixels, None)).or(view)
    });
    let pictures = [(&frame.picture, None)].into_iter().chain(shown);
    let outputs: Vec<Output<'_>> =
        files.iter().zip(pictures).map(|(path, (pixels, view))| Output { path, pixels, view }).collect();
    let info = context.describe();
    let texts = arguments.texts(&path, &scene, &info);
    if is_standard_stream(&files[0]) {
        let mut out = std::io::stdout().lock();
        out.write_all(&output::to_png(&outputs[0], texts.as_slice())?)?;
        out.flush()?;
    } else {
        output::write_described(&outputs, texts.as_slice())?;
    }
    for (index, output) in outputs.iter().enumerate() {
        let [width, height] = output.pixels.size();
        let what = index.checked_sub(1).map_or("picture".to_owned(), |view| views[view].file_name());
        screen.wrote(output.path, format_args!("{what}, {width} x {height}"));
    }
    let times = report_times(load_ms, times);
    for pass in &times.passes {
        screen.detail(format_args!("pass {}: {:.3} ms", pass.label, pass.wall_ms));
    }
    let mut path_bytes = PathBytes::new();
    Ok(Report {
        scene: path_text(&path, &mut path_bytes),
        files: files.iter().map(|path| path_text(path, &mut path_bytes)).collect(),
        path_bytes,
        plan: plan.summary(),
        times,
    })
}

impl RenderArgs {
    /// Texts of its PNG files.
    fn texts(&self, path: &Path, scene: &Scene, info: &ContextInfo) -> PngTexts {
        let overrides = self.changes.overrides().join(" ");
        let texts = scene_texts(&path.display().to_string(), overrides, scene, &info.driver());
        self.pipeline.texts(texts).with("After pass", self.after_pass.clone().unwrap_or_default())
    }
}

/// Pictures of the views that the ray tracer makes; `None`: of those that were drawn.
fn trace(views: &[Aov], scene: &Scene, frame: &Frame, is_exact: bool) -> Result<Vec<Option<Pixels>>, Error> {
    let mut drawn = frame.views.iter();
    let picture = |wanted: &Aov| {
        let drawn = wanted.drawn(scene).and_then(|_| drawn.next());
        wanted.picture(scene, frame, drawn, is_exact)
    };
    views.iter().map(picture).collect()
}

/// Views in the order of the arguments. A repeated one is one file.
fn each_once(wanted: &[Aov]) -> Vec<Aov> {
    let mut views: Vec<Aov> = Vec::new();
    for view in wanted {
        if views.contains(view) {
            let name = output::beside(Path::new("PICTURE"), &view.file_name());
            super::say(format_args!("warning: --aov names {} twice; it is written once", name.display()));
        } else {
            views.push(*view);
        }
    }
    views
}

/// Refuses a picture that would take the place of the scene or of a texture.
fn refuse_to_overwrite(files: &[PathBuf], path: &Path, scene: &Scene) -> Result<(), Error> {
    let textures = scene.textures().map(|texture| Path::new(&texture.name));
    let read: Vec<&Path> = [path].into_iter().chain(textures).collect();
    for (index, file) in files.iter().enumerate() {
        if read.iter().any(|read| output::is_same_file(file, read)) {
            let what = if index == 0 { "picture" } else { "picture, after which views are named" };
            return Err(Error::Overwrites { path: file.clone(), what });
        }
    }
    Ok(())
}

fn default_output(scene: &Path) -> PathBuf {
    if is_standard_stream(scene) {
        return PathBuf::from("scene.png");
    }
    Path::new(scene.file_stem().unwrap_or(scene.as_os_str())).with_extension("png")
}

/// A bar on a terminal when there is time to look at it.
fn progress(frames: u32, screen: Screen) -> ProgressBar {
    match frames {
        0..10 => ProgressBar::hidden(),
        _ => screen.bar(u64::from(frames), "{bar:40} frame {pos}/{len}, {eta} left"),
    }
}

fn report_times(load_ms: f64, times: Times) -> TimesReport {
    let steady = if times.frames_ms.len() > 1 { &times.frames_ms[1..] } else { &times.frames_ms[..] };
    let mut sorted = steady.to_vec();
    sorted.sort_by(f64::total_cmp);
    let frame_median_ms = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let passes = times.passes.into_iter().map(|pass| PassReport {
        label: pass.label,
        wall_ms: pass.wall_ms,
        gpu_ms: pass.gpu_ms,
    });
    TimesReport { load_ms, frames_ms: times.frames_ms, frame_median_ms, passes: passes.collect() }
}
