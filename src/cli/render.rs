//! `glumbra render`: a scene to a picture, and the views beside it.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::path_text::{PathBytes, path_text};
use super::pipeline::Pipeline;
use super::scene_args::SceneArgs;
use super::text_keys;
use super::truth_views::{Aov, parse_aov};
use super::{ContextArgs, Error};
use crate::device::Pixels;
use crate::frame::{Frame, Renderer, Times};
use crate::output::{self, Output};
use crate::plan::{Request, Summary};
use crate::scene::{Light, Scene};
use crate::techniques::LightShadow;

/// Renders a scene or a model to a picture.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct RenderArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// The picture's file: .png, or .exr or .npy with exact 32-bit values; by default the scene's name with .png, here
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Also writes this view beside the picture (out.png: out.NAME.png); NAME@LIGHT for another light than the first
    #[arg(long, value_name = "NAME", value_parser = parse_aov)]
    aov: Vec<Aov>,

    /// Prints passes, times, bytes and what was left out as JSON
    #[arg(long)]
    json: bool,

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
  shade           the shadow term: white lit, black shadowed, transparent where the light does not reach
  depth           the camera's window-space depth
  light-depth     the shadow map
  light-view      the scene as the light sees it
  light-distance  r/q, each sample's planar distance from the light
  projected-map   the shadow map projected onto the scene
  texels-per-pixel  texels of the shadow map that a pixel's side shows; a PNG has them as colours with a legend
  stencil-count   the shadow volumes that hold each point, as counted: grey values are the integers
  stencil-colors  the same for the eye: green lit, red shadowed, with a legend
  volume          the shadow volumes over the scene: outsides orange, insides blue
  silhouette      the casters' possible silhouettes, as the light sees them
  truth           the ray tracer's picture: lit and shadowed; colours, of all lights, where light or a photograph is
                  projected
  difference      the picture's error against the truth; that of colours 16 times as large in a PNG; black where the
                  bounds of a colour at an edge allow it; grey where the truth is not certain
  (PNG stretches depths and distances for the eye; EXR and NPY have them as they are)
  `glumbra judge` holds any program's picture against the truth.

A PNG says in text chunks which scene, overrides, technique, driver and version made it; `glumbra compare` shows where two differ.

Examples:
  glumbra render data/scenes/main.toml -o statue.png
  glumbra render model.obj -o model.png --size 800x600 --set camera.fov_y=30
  glumbra render scene.toml -o out.exr --aov shade --aov light-depth
  glumbra render scene.toml --set light.shadow.filter=nearest --set light.shadow.size=256
  glumbra render data/scenes/hw_shadowmaps_simple.toml --pipeline fixed-function -o by-the-driver.png
  glumbra render scene.toml --set shading.passes=shadow --after-pass \"shade of light 0\" -o shade.png
  glumbra render scene.toml --frames 100 --json --set light.shadow.redraw=always";

/// Output of `--json`.
#[derive(Serialize)]
struct Report {
    scene: String,
    files: Vec<String>,
    /// The paths above that are not UTF-8.
    #[serde(skip_serializing_if = "PathBytes::is_empty")]
    path_bytes: PathBytes,
    context: String,
    renderer: String,
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

/// Renders.
pub fn run(arguments: &RenderArgs) -> Result<(), Error> {
    let path = arguments.output.clone().unwrap_or_else(|| default_output(&arguments.scene.scene));
    let format = output::check_path(&path)?;
    let views = each_once(&arguments.aov);
    let names = views.iter().map(|wanted| output::beside(&path, &wanted.file_name()));
    let files: Vec<PathBuf> = [path.clone()].into_iter().chain(names).collect();
    let start = Instant::now();
    let loaded = arguments.scene.load()?;
    let load_ms = start.elapsed().as_secs_f64() * 1e3;
    refuse_to_overwrite(&files, &arguments.scene.scene, &loaded.scene)?;
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
    let context = arguments.pipeline.open(&arguments.context)?;
    let mut renderer = Renderer::new(&context);
    renderer.accept(&mut plan)?;
    for warning in &plan.warnings {
        super::say(format_args!("warning: {warning}"));
    }
    let progress = progress(arguments.frames);
    let (frames, passes) = (arguments.frames, arguments.json);
    let drawn = arguments.pipeline.draw(&context, &mut renderer, &plan, frames, passes, || progress.inc(1));
    progress.finish_and_clear();
    let (times, mut frame) = drawn?;
    if plan.ends_in_alpha() {
        frame.picture = frame.picture.alpha_as_gray();
    }
    let traced = trace(&views, &loaded.scene, &frame, format.is_exact())?;
    let mut drawn = frame.views.iter();
    let views = views.iter().zip(&traced).filter_map(|(wanted, traced)| {
        let view = wanted.drawn(&loaded.scene).and_then(|wanted| Some((drawn.next()?, Some(wanted.view))));
        traced.as_ref().map(|pixels| (pixels, None)).or(view)
    });
    let pictures = [(&frame.picture, None)].into_iter().chain(views);
    let outputs: Vec<Output<'_>> =
        files.iter().zip(pictures).map(|(path, (pixels, view))| Output { path, pixels, view }).collect();
    let info = context.describe();
    let driver = format!("{}, OpenGL {}", info.renderer, info.version);
    output::write_described(&outputs, &arguments.texts(&loaded.scene, driver))?;
    if arguments.json {
        let mut path_bytes = PathBytes::new();
        let report = Report {
            scene: path_text(&arguments.scene.scene, &mut path_bytes),
            files: files.iter().map(|path| path_text(path, &mut path_bytes)).collect(),
            path_bytes,
            context: context.backend().to_owned(),
            renderer: format!("{}, {}", info.renderer, info.version),
            plan: plan.summary(),
            times: report_times(load_ms, times),
        };
        super::print_json(&report)?;
    }
    Ok(())
}

impl RenderArgs {
    /// Texts of a PNG: all that decides its pixels, and no time.
    fn texts(&self, scene: &Scene, driver: String) -> Vec<(&'static str, String)> {
        let technique = |light: &Light| LightShadow::of(&light.shadow).map_or("none", |shadow| shadow.technique.name());
        let techniques: Vec<&str> = scene.lights.iter().map(technique).collect();
        let mut texts = vec![
            ("Software", concat!("glumbra ", env!("CARGO_PKG_VERSION")).to_owned()),
            (text_keys::SCENE, self.scene.scene.display().to_string()),
            (text_keys::OVERRIDES, self.scene.changes.overrides().join(" ")),
            (text_keys::TECHNIQUE, techniques.join(", ")),
            (text_keys::DRIVER, driver),
        ];
        let pipeline = self.pipeline.to_possible_value().filter(|_| self.pipeline != Pipeline::default());
        texts.extend(pipeline.map(|pipeline| ("Pipeline", pipeline.get_name().to_owned())));
        texts.extend(self.after_pass.clone().map(|pass| ("After pass", pass)));
        texts.retain(|(_, text)| !text.is_empty());
        texts
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
    Path::new(scene.file_stem().unwrap_or(scene.as_os_str())).with_extension("png")
}

/// A bar on a terminal when there is time to look at it.
fn progress(frames: u32) -> ProgressBar {
    if frames < 10 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(u64::from(frames));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} frame {pos}/{len}, {eta} left") {
        bar.set_style(style);
    }
    bar
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
