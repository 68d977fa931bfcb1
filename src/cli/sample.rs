//! The command line of a sample program: its scene in a window, or without one into a file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, FromArgMatches, Parser, ValueEnum};

use super::pipeline::Pipeline;
use super::png_texts::scene_texts;
use super::scene_args::parse_size;
use super::{ContextArgs, Error};
use crate::context::{Choice, ContextInfo, Profile};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::output::{self, Output};
use crate::plan::Request;
use crate::png_file::PngTexts;
use crate::scene::{Embedded, Scene};
use crate::viewer::{self, Mode, Shown, State};

/// A sample program.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub name: &'static str,
    pub about: &'static str,
    pub scene: Embedded,
    /// Shadow techniques to choose from, in place of the scene's own; the first is the one to begin with. Empty: only the
    /// scene's own.
    pub techniques: &'static [&'static str],
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

    /// The picture to begin with; space switches to the next
    #[arg(long, value_enum, default_value_t = ModeName::Shadowed)]
    mode: ModeName,

    /// The picture's or the window's size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,

    /// Changes a key of the scene, e.g. light.shadow.size=2048
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    tweaks: TweakArgs,

    /// Pipeline that draws
    #[arg(long, value_enum, default_value_t, requires = "headless")]
    pipeline: Pipeline,

    #[command(flatten)]
    context: ContextArgs,
}

/// The tweaks that keys step in the window.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tweaks")]
struct TweakArgs {
    /// Scale of r in the texture matrix
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    r_scale: Option<f64>,
    /// Bias of r in the texture matrix
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    r_bias: Option<f64>,
    /// glPolygonOffset's factor while the map is drawn
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    offset_factor: Option<f64>,
    /// glPolygonOffset's units while the map is drawn
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    offset_units: Option<f64>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ModeName {
    /// From the camera, without shadows
    Camera,
    /// From the camera, with shadows
    Shadowed,
    /// From the light, in the largest square of a power of two that fits
    Light,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Camera => Self::Camera,
            ModeName::Shadowed => Self::Shadowed,
            ModeName::Light => Self::Light,
        }
    }
}

/// Runs a sample program with the process's arguments: 0 for success, 1 for an error, 2 for wrong usage.
pub fn run(sample: &Sample) -> ExitCode {
    let mut command =
        Arguments::command().name(sample.name).about(sample.about).after_help(viewer::help(sample.techniques));
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
    super::exit_code(show(sample, &arguments))
}

fn show(sample: &Sample, arguments: &Arguments) -> Result<(), Error> {
    let file = arguments.output.as_ref().or(arguments.capture.as_ref());
    file.map(|path| output::check_path(path)).transpose()?;
    let loaded = crate::techniques::load_embedded(&sample.scene, &arguments.overrides(sample))?;
    for warning in &loaded.warnings {
        super::say(format_args!("warning: {warning}"));
    }
    // Errors are reported in every mode, and before there is a context: the frame with shadows, then the mode's.
    crate::plan::make(&loaded.scene, &Request { sampled_warnings: false, ..Request::default() })?;
    let mode = Mode::from(arguments.mode);
    let (scene, request) = mode.frame(&loaded.scene, loaded.scene.image.size);
    crate::plan::make(&scene, &Request { sampled_warnings: false, ..request.clone() })?;
    let texts = |info: &ContextInfo| arguments.texts(sample, &scene, info);
    if let Some(path) = &arguments.output {
        let (pixels, info) = draw(&scene, request, path, arguments)?;
        return write(path, &pixels, &texts(&info));
    }
    let shown = Shown { title: sample.name.to_owned(), capture: arguments.capture.is_some() };
    let captured = viewer::run(State::new(loaded.scene, mode).with_techniques(sample.techniques), shown)?;
    match (&arguments.capture, captured) {
        (Some(path), Some((pixels, info))) => write(path, &pixels, &texts(&info)),
        _ => Ok(()),
    }
}

/// One picture without a window, and its driver.
fn draw(
    scene: &Scene,
    mut request: Request,
    path: &Path,
    arguments: &Arguments,
) -> Result<(Pixels, ContextInfo), Error> {
    request.float_picture = output::check_path(path)?.is_exact();
    let context = arguments.pipeline.open(&arguments.context)?;
    let mut renderer = Renderer::new(&context);
    let plan = renderer.plan(scene, &request)?;
    let (_, frame) = arguments.pipeline.draw(&context, &mut renderer, &plan, 1, false, || {})?;
    Ok((frame.picture, context.describe()))
}

fn write(path: &Path, pixels: &Pixels, texts: &PngTexts) -> Result<(), Error> {
    Ok(output::write_described(&[Output { path, pixels, view: None }], texts.as_slice())?)
}

impl Arguments {
    /// Texts of its PNG files.
    fn texts(&self, sample: &Sample, scene: &Scene, info: &ContextInfo) -> PngTexts {
        let mode = self.mode.to_possible_value().map(|mode| mode.get_name().to_owned()).unwrap_or_default();
        let overrides = self.overrides(sample).join(" ");
        let texts = scene_texts(sample.scene.path, overrides, scene, &info.driver());
        self.pipeline.texts(texts).with("Sample", sample.name).with("Mode", mode)
    }

    /// Overrides in order: the sample's technique, size and tweaks, then `--set`.
    fn overrides(&self, sample: &Sample) -> Vec<String> {
        let technique = sample.techniques.first().map(|name| format!("light.shadow.technique={name}"));
        let size = self.size.map(|[width, height]| format!("image.size=[{width}, {height}]"));
        let tweaks = [
            ("r.scale", self.tweaks.r_scale),
            ("r.bias", self.tweaks.r_bias),
            ("offset.factor", self.tweaks.offset_factor),
            ("offset.units", self.tweaks.offset_units),
        ];
        let tweaks =
            tweaks.into_iter().filter_map(|(key, value)| value.map(|value| format!("light.shadow.{key}={value:?}")));
        technique.into_iter().chain(size).chain(tweaks).chain(self.set.iter().cloned()).collect()
    }
}
