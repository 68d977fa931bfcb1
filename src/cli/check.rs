//! `glumbra check`: GL's rules for shadows and bump mapping on the driver at hand.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::rc::Rc;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::{ContextArgs, Error};
use crate::conformance::{self, Checked, DriverUnderTest, waivers};
use crate::context::{self, Context, Profile};
use crate::output;

/// Runs GL's rules for shadows and bump mapping on the driver at hand: does it do what the specification says?
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct CheckArgs {
    /// Only rules with this id, kind or word: GL-C1, s, stencil; may be given again
    #[arg(long, value_name = "PATTERN")]
    filter: Vec<String>,

    /// Writes a JUnit report, for continuous integration
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Writes all measurements as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Known deviations (TOML), in place of those that come with glumbra
    #[arg(long, value_name = "FILE")]
    waivers: Option<PathBuf>,

    /// Lists checks that pass, too
    #[arg(short, long)]
    verbose: bool,

    /// Uses a core context, where rules of the fixed-function pipeline cannot be tested
    #[arg(long)]
    core: bool,

    #[command(flatten)]
    context: ContextArgs,
}

const HELP: &str = "\
A rule passes, has a quality warning (it is allowed, but good drivers do better), fails, or cannot be
tested here. Verdicts come from bounds on what the specification allows, never from a picture.

Rules: C comparison, T coordinates, D depth, O polygon offset, S stencil, R raster, I invariance,
F framebuffers, E texture environments, M cube maps, L levels and filters of textures,
U uploads and read-backs, B blending, masks and clears, G GLSL, V vertices, Q queries.

A waiver names a deviation that is known, by driver, versions, rule and check:
  [[waiver]]
  renderer = \"llvmpipe\"         # a part of GL_RENDERER
  version = \"Mesa \"            # a part of GL_VERSION
  from = \"22.3\"               # the first such version, by the number behind it; may be absent
  until = \"27\"                # the first that is sound again; may be absent
  rule = \"GL-O1\"
  finding = \"DEPTH_COMPONENT32: one unit\"
  reason = \"f32 has 24 bits\"
One that no longer applies is a failure.

Exit status: 0 nothing fails, 1 a rule fails, 2 nothing could be run.

Examples:
  glumbra check
  glumbra check --filter stencil --filter GL-O1 --verbose
  glumbra check --junit out/check.xml --json out/check.json
  GALLIUM_DRIVER=softpipe glumbra check --context egl";

/// Checks, prints, writes.
pub fn run(arguments: &CheckArgs) -> ExitCode {
    match check(arguments) {
        Ok(checked) if checked.is_empty() => ExitCode::from(2),
        Ok(checked) => ExitCode::from(u8::from(checked.fails())),
        Err(error) => super::failure(error, 2),
    }
}

fn check(arguments: &CheckArgs) -> Result<Checked, Error> {
    refuse_one_file_for_two(arguments)?;
    let rules = conformance::choose(&arguments.filter)?;
    let waivers = waivers::load(arguments.waivers.as_deref())?;
    let context = open(arguments)?;
    let subject = DriverUnderTest::new(context.as_ref(), None)?;
    let bar = ProgressBar::new(rules.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} rules  {msg}") {
        bar.set_style(style);
    }
    let mut outcomes = conformance::run(&subject, &rules, |outcome| {
        bar.inc(1);
        bar.set_message(format!("{} {}: {}", outcome.id, outcome.title, outcome.verdict));
    });
    bar.finish_and_clear();
    let stale_waivers = waivers::apply(&waivers, &subject.info, &mut outcomes);
    let checked = Checked { context: subject.info, outcomes, stale_waivers };
    write(arguments, &checked)?;
    print(&checked, arguments.verbose)?;
    Ok(checked)
}

/// A compatibility context, or a core one where there is none.
fn open(arguments: &CheckArgs) -> Result<Rc<dyn Context>, Error> {
    if !arguments.core
        && let Ok(context) = context::open(&arguments.context.request(Profile::Compatibility))
    {
        return Ok(context);
    }
    Ok(context::open(&arguments.context.request(Profile::Core33))?)
}

fn print(checked: &Checked, verbose: bool) -> Result<(), Error> {
    const UNKNOWN_WIDTH: u16 = 160;
    let width = terminal_size::terminal_size().map_or(UNKNOWN_WIDTH, |(width, _)| width.0);
    super::print(&conformance::print(checked, width, verbose))
}

fn refuse_one_file_for_two(arguments: &CheckArgs) -> Result<(), Error> {
    let files = [("--json", &arguments.json), ("--junit", &arguments.junit), ("--waivers", &arguments.waivers)];
    let files: Vec<(&'static str, &PathBuf)> =
        files.into_iter().filter_map(|(name, path)| path.as_ref().map(|path| (name, path))).collect();
    for (index, (first, path)) in files.iter().enumerate() {
        if let Some((second, _)) = files[index + 1..].iter().find(|(_, other)| output::is_same_file(path, other)) {
            return Err(Error::SameFile { path: (*path).clone(), first, second });
        }
    }
    Ok(())
}

/// Writes all requested files, or none.
fn write(arguments: &CheckArgs, checked: &Checked) -> Result<(), Error> {
    let mut files: Vec<(&Path, String)> = Vec::new();
    if let Some(path) = &arguments.json {
        files.push((path, conformance::json(checked)?));
    }
    if let Some(path) = &arguments.junit {
        files.push((path, conformance::junit(checked)?));
    }
    let paths: Vec<&Path> = files.iter().map(|(path, _)| *path).collect();
    let written = output::atomic_write::write_all(&paths, |index, path| std::fs::write(path, &files[index].1));
    written.map_err(|(index, error)| Error::WriteFile { path: paths[index].to_owned(), error })
}
