//! `glumbra view`: any scene in a window, or led by a script of keys without one.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::json::is_standard_stream;
use super::scene_args::SceneArgs;
use super::{ContextArgs, Error};
use crate::context::{self, Choice, Profile};
use crate::frame::Renderer;
use crate::output::{self, FileFormat, SheetFile};
use crate::png_file::PngTexts;
use crate::viewer::explore::{self, Explorer, Sources, Step, parse_steps};
use crate::viewer::{self, Shown};

/// Shows a scene in a window to walk around in, with what its shadows are made of.
#[derive(Debug, Args)]
#[command(after_help = help())]
pub struct ViewArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// Opens no window: does the steps of --keys, and writes what a window would show then to the file of -o
    #[arg(long)]
    headless: bool,

    /// Steps without a window: keys by the names below, and drag(X,Y), right-drag(X,Y), middle-drag(X,Y) in pixels to the
    /// right and down, wheel(N), size(W,H), wait or wait(SECONDS) until a file of the scene changes
    #[arg(long, value_name = "STEPS", requires = "headless", value_parser = parse_script)]
    keys: Option<Script>,

    /// The last picture's file, a .png
    #[arg(short, long, value_name = "FILE", requires = "headless")]
    output: Option<PathBuf>,

    /// Turns the camera once around in N frames after the steps, and prints their times
    #[arg(long, value_name = "N", requires = "headless", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    time: Option<u32>,

    /// Folder of what the key s saves: NAME-view-1.png and NAME-view-1.toml, then 2, and so on
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    save_in: PathBuf,

    #[command(flatten)]
    context: ContextArgs,
}

/// Steps of `--keys`.
#[derive(Clone, Debug)]
struct Script(Vec<Step>);

fn parse_script(text: &str) -> Result<Script, String> {
    parse_steps(text).map(Script)
}

fn help() -> String {
    let keys = viewer::help_of(explore::explore_help());
    format!(
        "{keys}

The scene is read again when one of its files changes: the scene, what it includes, \
meshes, materials and pictures. While a file has an error, the error is shown over \
the last picture. Nothing is drawn while nothing changes. A scene on standard input, \
-, is read once, and its files are not watched.

A saved scene has absolute paths, and `glumbra render` draws it to the saved picture.

Examples:
  glumbra view data/scenes/teapot.toml
  glumbra view model.obj --size 800x600
  glumbra view scene.toml --headless --keys \"l t drag(40,0) s\" -o last.png
  glumbra view scene.toml --headless --keys \"v v n h\" -o volumes.png
  glumbra view scene.toml --headless --time 100"
    )
}

/// Opens the window, or does the script.
///
/// # Errors
///
/// A scene that cannot be read, a file or folder that cannot be written to, no display, no context.
pub fn run(arguments: &ViewArgs) -> Result<(), Error> {
    let start = Instant::now();
    arguments.check()?;
    let path = &arguments.scene.scene;
    arguments.scene.changes.check(path)?;
    let overrides = arguments.scene.changes.overrides();
    let (sources, loaded) = match is_standard_stream(path) {
        true => {
            let text = std::io::read_to_string(std::io::stdin()).map_err(Error::Input)?;
            super::say(format_args!("standard input: read once; changes of the files that it names are not seen"));
            Sources::of_text("stdin", text, overrides)?
        }
        false => Sources::load(path, overrides)?,
    };
    for warning in &loaded.warnings {
        super::say(format_args!("warning: {warning}"));
    }
    // A scene that cannot be drawn needs no window to be refused.
    let request = crate::plan::Request { sampled_warnings: false, ..crate::plan::Request::default() };
    crate::plan::make(&loaded.scene, &request)?;
    let mut state = Explorer::new(sources, loaded.scene, arguments.save_in.clone())?;
    if !arguments.headless {
        let title = format!("glumbra view {}", path.display());
        viewer::run(state, Shown { title, capture: false })?;
        return Ok(());
    }
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    let mut renderer = Renderer::new(&context);
    let steps = arguments.keys.as_ref().map_or(&[][..], |script| &script.0);
    let mut first_ms = None;
    let mut failed = None;
    let done = explore::run_steps(&mut state, steps, &mut renderer, |line| {
        first_ms.get_or_insert_with(|| start.elapsed().as_secs_f64() * 1e3);
        failed = failed.take().or(super::print(&format!("{line}\n")).err());
    })?;
    if let Some(error) = failed {
        return Err(error);
    }
    if let Some(path) = &arguments.output {
        let texts = PngTexts::default()
            .with(PngTexts::SCENE, arguments.scene.scene.display().to_string())
            .with(PngTexts::DRIVER, renderer.driver());
        output::write_sheets(&[SheetFile { path: path.clone(), canvas: done.canvas, texts }], &[])?;
    }
    super::print(&format!("frames drawn: {}\n", done.frames))?;
    if let Some(count) = arguments.time {
        let mut times = explore::turn(&mut state, count, &mut renderer)?;
        times.sort_by(f64::total_cmp);
        let median = times.get(times.len() / 2).copied().unwrap_or(0.0);
        let (rate, first) = (1e3 / median.max(1e-6), first_ms.unwrap_or(0.0));
        super::print(&format!(
            "first frame after {first:.0} ms; median of {count} frames {median:.1} ms, {rate:.1} a second\n"
        ))?;
    }
    Ok(())
}

impl ViewArgs {
    /// Refuses arguments that do not go together, before anything is read.
    fn check(&self) -> Result<(), Error> {
        let chosen = self.context.request(Profile::Core33);
        if !self.headless && (chosen.device.is_some() || !matches!(chosen.choice, Choice::Auto | Choice::Window)) {
            return Err(Error::WindowContext);
        }
        if let Some(path) = &self.output
            && output::check_path(path)? != FileFormat::Png
        {
            return Err(Error::NotPng { path: path.clone() });
        }
        if !self.save_in.is_dir() {
            return Err(Error::NoSaveFolder { folder: self.save_in.clone() });
        }
        Ok(())
    }
}
