//! The command line: one file a subcommand; arguments in, calls out, no logic.

mod answers;
mod check;
mod child_process;
mod compare;
mod context_args;
mod figures;
mod gallery;
mod generate;
mod info;
mod init;
mod json;
mod judge;
mod judge_report;
mod keys;
mod path_text;
mod pipeline;
mod plan;
mod png_texts;
mod reading_bar;
mod render;
mod repack;
mod repack_report;
mod report;
mod report_light;
mod result_files;
#[cfg(feature = "window")]
pub mod sample;
#[cfg(feature = "window")]
pub mod sample_model;
mod scene_args;
mod screen;
mod stress;
mod test;
mod truth_views;
mod tune;
#[cfg(feature = "window")]
mod view;

#[cfg(test)]
mod help_tests;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use context_args::ContextArgs;

use crate::conformance::probe;
use crate::context;

/// The version, and in a release build the commit and its date.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), env!("GLUMBRA_COMMIT"));

/// A headless OpenGL reference renderer of shadows and projected light.
#[derive(Debug, Parser)]
#[command(name = "glumbra", version = VERSION)]
struct Arguments {
    #[command(subcommand)]
    command: Command,

    #[command(flatten)]
    screen: screen::Screen,
}

#[derive(Debug, Subcommand)]
enum Command {
    Check(check::CheckArgs),
    Compare(compare::CompareArgs),
    Figures(figures::FiguresArgs),
    Gallery(gallery::GalleryArgs),
    /// Prints the context, its driver and limits, and what was measured of its depth formats.
    Info(info::InfoArgs),
    Init(init::InitArgs),
    Judge(judge::JudgeArgs),
    Keys(keys::KeysArgs),
    Plan(plan::PlanArgs),
    Render(render::RenderArgs),
    Repack(repack::RepackArgs),
    Report(report::ReportArgs),
    Stress(stress::StressArgs),
    Test(test::TestArgs),
    Tune(tune::TuneArgs),
    #[cfg(feature = "window")]
    View(view::ViewArgs),
    #[command(hide = true)]
    Generate(generate::GenerateArgs),
}

/// Error of a subcommand.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Context(#[from] context::Error),
    #[error("--pipeline fixed-function needs OpenGL's compatibility profile. {0}")]
    NoFixedFunction(context::Error),
    #[error(transparent)]
    FixedFunction(#[from] crate::fixed_function::Error),
    #[error(transparent)]
    Probe(#[from] probe::Error),
    #[error(transparent)]
    Scene(#[from] crate::scene::Error),
    #[error(transparent)]
    Keys(#[from] crate::keys::Error),
    #[error(transparent)]
    NoSuchKey(#[from] crate::keys::NoSuchKey),
    #[error(transparent)]
    Plan(#[from] crate::plan::Error),
    #[error(transparent)]
    Frame(#[from] crate::frame::Error),
    #[error(transparent)]
    Truth(#[from] crate::truth::Error),
    #[error(transparent)]
    Difference(#[from] crate::judge::metrics::Error),
    #[error(transparent)]
    TruthPicture(#[from] crate::judge::truth_pictures::Error),
    #[cfg(feature = "window")]
    #[error(transparent)]
    Viewer(#[from] crate::viewer::Error),
    #[error(transparent)]
    File(#[from] crate::output::Error),
    #[error(transparent)]
    Figures(#[from] crate::figures::Error),
    #[error(transparent)]
    Gallery(#[from] crate::gallery::Error),
    #[error("--picture: one --entry is wanted, and {count} are given")]
    OneEntry { count: usize },
    #[error(transparent)]
    Repack(#[from] repack::Error),
    #[error(transparent)]
    Tune(#[from] crate::report::measure::tune::Error),
    #[error(transparent)]
    Grid(#[from] crate::report::measure::grid::Error),
    #[error(transparent)]
    Report(#[from] crate::report::measure::run::Error),
    #[error(transparent)]
    Journal(#[from] crate::report::store::journal::Error),
    #[error(transparent)]
    Pictures(#[from] crate::report::store::pictures::Error),
    #[error(transparent)]
    KeptPictures(#[from] crate::report::store::picture_files::Error),
    #[error(transparent)]
    Merge(#[from] crate::report::store::merge::Error),
    #[error(transparent)]
    ReportFiles(#[from] crate::report::store::write::Error),
    #[error("--case {name}: no case has that in its name; `glumbra stress --list` has all")]
    NoSuchCase { name: String },
    #[error("--case {name}: no case of the given files has that in its name; --list has all")]
    NoSuchFileCase { name: String },
    #[error("{path}: cannot be read: {error}", path = .path.display())]
    ReadFile { path: std::path::PathBuf, error: std::io::Error },
    #[error(transparent)]
    Cases(#[from] crate::cases::Error),
    /// The words of the process that runs cases.
    #[error("{0}")]
    NoCaseRun(String),
    #[error(transparent)]
    Stress(#[from] crate::stress::Error),
    #[error(transparent)]
    StressCases(#[from] crate::stress::named::Error),
    #[error("interrupted: {folder} holds a report of the rows so far; continue with --resume", folder = .folder.display())]
    Interrupted { folder: std::path::PathBuf },
    #[error("{failed} of {rows} settings could not be measured, row {row} for example: {why}; {folder} holds the others", folder = .folder.display())]
    FailedRows { failed: usize, rows: usize, row: usize, why: String, folder: std::path::PathBuf },
    #[error("--no-floor: {scene} is a scene; only a model is supplied with a floor", scene = .scene.display())]
    NoFloor { scene: std::path::PathBuf },
    #[error("standard input: {0}")]
    Input(std::io::Error),
    #[error("standard output: {0}")]
    Output(#[from] std::io::Error),
    #[error(transparent)]
    Filter(#[from] crate::conformance::UnknownFilter),
    #[error(transparent)]
    Waivers(#[from] crate::conformance::waivers::Error),
    #[error(transparent)]
    Baseline(#[from] crate::conformance::baseline::Error),
    #[error("the waivers: {0}")]
    WriteWaivers(#[from] toml::ser::Error),
    #[error(transparent)]
    Child(#[from] check::ChildError),
    #[error(transparent)]
    Reduce(#[from] crate::conformance::reduce::ReduceError),
    #[error("--reduce {pattern}: one rule is wanted, and that is {}", rules.join(", "))]
    ReduceOne { pattern: String, rules: Vec<&'static str> },
    #[error("JUnit: {0}")]
    JUnit(#[from] quick_junit::SerializeError),
    #[error("{path}: cannot be written: {error}", path = .path.display())]
    WriteFile { path: std::path::PathBuf, error: std::io::Error },
    #[error("{path}: the scene reads this file; name another for the {what}", path = .path.display())]
    Overwrites { path: std::path::PathBuf, what: &'static str },
    #[error("{path}: {first} and {second} name the same file", path = .path.display())]
    SameFile { path: std::path::PathBuf, first: &'static str, second: &'static str },
    #[error(transparent)]
    Picture(#[from] crate::pictures::Error),
    #[error("{actual} and {expected} cannot be compared: {what}", actual = .actual.display(), expected = .expected.display())]
    NotCompared { actual: std::path::PathBuf, expected: std::path::PathBuf, what: String },
    #[error("{picture} cannot be judged: {what}", picture = .picture.display())]
    NotJudged { picture: std::path::PathBuf, what: String },
    #[error("the picture of the differences: {0}")]
    DifferencePicture(String),
    #[cfg(feature = "window")]
    #[error("a window has its display's context: --context and --device go with --headless")]
    WindowContext,
    #[cfg(feature = "window")]
    #[error("--save-in {folder}: there is no such folder", folder = .folder.display())]
    NoSaveFolder { folder: std::path::PathBuf },
    #[error("{path}: this picture is a PNG: end its name in .png", path = .path.display())]
    NotPng { path: std::path::PathBuf },
    #[error("{path}: this file is read; name another for the picture of differences", path = .path.display())]
    IsRead { path: std::path::PathBuf },
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error("{path}: is there already; name another folder, or move the file away", path = .path.display())]
    Stands { path: std::path::PathBuf },
    #[error("{folder}: the folder cannot be made: {error}", folder = .folder.display())]
    MakeFolder { folder: std::path::PathBuf, error: std::io::Error },
    #[error("{file}: {first} and {second} would both be written there; render them one by one, with -o", file = .file.display(), first = .first.display(), second = .second.display())]
    SamePicture { file: std::path::PathBuf, first: std::path::PathBuf, second: std::path::PathBuf },
    #[error("-o {file}: is a file; several scenes are drawn into a folder", file = .0.display())]
    NotAFolder(std::path::PathBuf),
    #[error("-o -: standard output holds one picture and nothing else; leave out {0}")]
    OnePicture(&'static str),
    #[error(
        "--print-scene: a scene on standard input has no folder from which its files could be named; save it first"
    )]
    PrintStandardInput,
}

/// Runs the command with the process's arguments: 0 for success, 1 for an error, 2 for wrong usage.
pub fn run() -> ExitCode {
    if let Err(code) = begin() {
        return code;
    }
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage(&error),
    };
    let screen = arguments.screen;
    screen.apply();
    let result = match arguments.command {
        Command::Check(arguments) => return check::run(&arguments, screen),
        Command::Compare(arguments) => return compare::run(&arguments),
        Command::Figures(arguments) => figures::run(&arguments, screen),
        Command::Gallery(arguments) => gallery::run(&arguments, screen),
        Command::Info(arguments) => info::run(&arguments),
        Command::Init(arguments) => init::run(&arguments, screen),
        Command::Judge(arguments) => return judge::run(&arguments, screen),
        Command::Keys(arguments) => keys::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments, screen),
        Command::Render(arguments) => render::run(&arguments, screen),
        Command::Repack(arguments) => repack::run(&arguments),
        Command::Report(arguments) => report::run(&arguments, screen),
        Command::Stress(arguments) => return stress::run(&arguments, screen),
        Command::Test(arguments) => return test::run(&arguments, screen),
        Command::Tune(arguments) => tune::run(&arguments, screen),
        #[cfg(feature = "window")]
        Command::View(arguments) => view::run(&arguments),
        Command::Generate(arguments) => generate::run(&arguments, screen),
    };
    exit_code(result)
}

/// Set-up of every command. The error is its exit status, and has been printed.
fn begin() -> Result<(), ExitCode> {
    crate::process::guard();
    // rayon would do so at its first use, and panic where no thread can be had.
    rayon::ThreadPoolBuilder::new().build_global().map_err(|error| {
        say(format_args!("error: threads cannot be started: {error}; is their number limited (ulimit -u, ulimit -v)?"));
        ExitCode::FAILURE
    })
}

/// Help and version, which are no errors, and errors of usage.
fn usage(error: &clap::Error) -> ExitCode {
    match error.print() {
        // If standard error is closed, the message is lost.
        Err(lost) if !error.use_stderr() => exit_code(Err(lost.into())),
        _ => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2)),
    }
}

fn exit_code(result: Result<(), Error>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure(error, 1),
    }
}

/// Prints the error, and returns `status`.
fn failure(error: Error, status: u8) -> ExitCode {
    match error {
        // A reader that has seen enough (`glumbra info | head`) is no error.
        Error::Output(error) if error.kind() == std::io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        error => {
            say(format_args!("error: {error}"));
            ExitCode::from(status)
        }
    }
}

/// Writes a line on standard error. If that is closed or full, the line is lost.
fn say(line: impl std::fmt::Display) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Writes on standard output, to the last byte.
fn print(text: &str) -> Result<(), Error> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}
