//! The command line of the samples that show a key-framed model: in a window, or without one into a file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser};

use super::png_texts::scene_texts;
use super::scene_args::parse_size;
use super::{ContextArgs, Error};
use crate::context::{self, Choice, ContextInfo, Profile};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::output::{self, Output};
use crate::plan;
use crate::png_file::PngTexts;
use crate::scene::{Embedded, Scene};
use crate::viewer::{self, ModelCommand, ModelMode, ModelState, Show, Shown};
use crate::views::View;

/// The room of md2shader and md2bump, with its files.
pub const KNIGHT: Embedded = Embedded {
    path: "data/scenes/md2shader.toml",
    text: include_str!("../../data/scenes/md2shader.toml"),
    pictures: &[
        ("../textures/bricks.png", include_bytes!("../../data/textures/bricks.png")),
        ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
        ("../textures/knight.png", include_bytes!("../../data/textures/knight.png")),
        ("../textures/knight-gloss.png", include_bytes!("../../data/textures/knight-gloss.png")),
        ("../textures/knight-height.png", include_bytes!("../../data/textures/knight-height.png")),
    ],
    meshes: &[("../meshes/knight.md2", include_bytes!("../../data/meshes/knight.md2"))],
};

/// A sample program.
#[derive(Clone, Copy, Debug)]
pub struct ModelSample {
    pub name: &'static str,
    pub about: &'static str,
    /// One of its meshes is a key-framed model.
    pub scene: Embedded,
    /// False: the lights cast no shadows.
    pub shadows: bool,
}

#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Draws without a window, into the file of -o
    #[arg(long, requires = "output")]
    headless: bool,

    /// The picture's file: .png, or .exr or .npy with exact 32-bit values
    #[arg(short, long, value_name = "FILE", requires = "headless")]
    output: Option<PathBuf>,

    /// Opens the window, draws, writes what the window shows to this .png, and quits
    #[arg(long, value_name = "FILE", conflicts_with = "headless")]
    capture: Option<PathBuf>,

    /// The picture to begin with
    #[arg(long, value_name = "NAME", default_value = "scene", value_parser = PossibleValuesParser::new(ModelMode::names()))]
    mode: String,

    /// Key frame to begin with, from 0; 8.5 is halfway between 8 and the next of its animation
    #[arg(long, value_name = "X")]
    frame: Option<f64>,

    /// Draws the model's triangles as a wire frame over it
    #[arg(long)]
    wireframe: bool,

    /// Draws without shadows
    #[arg(long)]
    no_shadows: bool,

    /// The picture's or the window's size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,

    /// Changes a key of the scene, e.g. shading.bump=reference
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    context: ContextArgs,
}

/// Runs a sample program with the process's arguments: 0 for success, 1 for an error, 2 for wrong usage.
pub fn run(sample: &ModelSample) -> ExitCode {
    let help = viewer::help_of(viewer::model_help());
    let mut command = Arguments::command().name(sample.name).about(sample.about).after_help(help);
    if let Err(code) = super::begin() {
        return code;
    }
    let matches = command.try_get_matches_from_mut(std::env::args_os());
    let arguments = match matches.and_then(|matches| Arguments::from_arg_matches(&matches)) {
        Ok(arguments) => arguments,
        Err(error) => return super::usage(&error),
    };
    let chosen = arguments.context.request(Profile::Core33);
    if !arguments.headless && (chosen.device.is_some() || !matches!(chosen.choice, Choice::Auto | Choice::Window)) {
        let message = "a window has its display's context: --context and --device go with --headless -o FILE";
        return super::usage(&command.error(ErrorKind::ArgumentConflict, message));
    }
    let (mut state, warnings) = match begin(sample, &arguments) {
        Ok(begun) => begun,
        Err(error) => return super::exit_code(Err(error)),
    };
    if let Some(frame) = arguments.frame {
        let count = state.frame_count();
        if !(0.0..count as f64).contains(&frame) {
            let message = format!("--frame must be from 0 to below {count}, not {frame}");
            return super::usage(&command.error(ErrorKind::ValueValidation, message));
        }
        state.pose_at(frame);
    }
    if arguments.wireframe {
        state.apply(ModelCommand::Wireframe);
    }
    super::exit_code(show(sample, &arguments, state, &warnings))
}

/// The state to begin with, and the warnings of its scene.
fn begin(sample: &ModelSample, arguments: &Arguments) -> Result<(ModelState, Vec<String>), Error> {
    let file = arguments.output.as_ref().or(arguments.capture.as_ref());
    file.map(|path| output::check_path(path)).transpose()?;
    let mode = ModelMode::named(&arguments.mode).unwrap_or_default();
    Ok(ModelState::new(sample.scene, arguments.overrides(sample), mode)?)
}

fn show(sample: &ModelSample, arguments: &Arguments, state: ModelState, warnings: &[String]) -> Result<(), Error> {
    for warning in warnings {
        super::say(format_args!("warning: {warning}"));
    }
    // Errors are reported before there is a context.
    let (scene, request) = state.frame();
    plan::make(&scene, &request)?;
    let view = request.views.first().map(|wanted| wanted.view);
    let texts = |info: &ContextInfo| arguments.texts(sample, &scene, info);
    if let Some(path) = &arguments.output {
        let (pixels, info) = draw(&state, path, arguments)?;
        return write(path, &pixels, view, &texts(&info));
    }
    let shown = Shown { title: sample.name.to_owned(), capture: arguments.capture.is_some() };
    match (&arguments.capture, viewer::run(state, shown)?) {
        (Some(path), Some((pixels, info))) => write(path, &pixels, None, &texts(&info)),
        _ => Ok(()),
    }
}

/// One picture without a window, and its driver.
fn draw(state: &ModelState, path: &Path, arguments: &Arguments) -> Result<(Pixels, ContextInfo), Error> {
    let (scene, mut request) = state.frame();
    request.float_picture = output::check_path(path)?.is_exact();
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    let mut renderer = Renderer::new(&context);
    let plan = renderer.plan(&scene, &request)?;
    renderer.draw(&plan)?;
    let frame = renderer.read(&plan)?;
    Ok((frame.views.into_iter().next().unwrap_or(frame.picture), context.describe()))
}

fn write(path: &Path, pixels: &Pixels, view: Option<View>, texts: &PngTexts) -> Result<(), Error> {
    Ok(output::write_described(&[Output { path, pixels, view }], texts.as_slice())?)
}

impl Arguments {
    /// Overrides in order: none of its shadows, its size, then `--set`.
    fn overrides(&self, sample: &ModelSample) -> Vec<String> {
        let shadows = sample.shadows && !self.no_shadows;
        let unshadowed = (!shadows).then(|| String::from("light.shadow.technique=none"));
        let size = self.size.map(|[width, height]| format!("image.size=[{width}, {height}]"));
        unshadowed.into_iter().chain(size).chain(self.set.iter().cloned()).collect()
    }

    /// Texts of its PNG files.
    fn texts(&self, sample: &ModelSample, scene: &Scene, info: &ContextInfo) -> PngTexts {
        let overrides = self.overrides(sample).join(" ");
        scene_texts(sample.scene.path, overrides, scene, &info.driver())
            .with("Sample", sample.name)
            .with("Mode", self.mode.clone())
            .with("Frame", self.frame.map(|frame| frame.to_string()).unwrap_or_default())
            .with("Wireframe", if self.wireframe { "yes" } else { "" })
    }
}
