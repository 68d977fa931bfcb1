//! The command line: one file a subcommand; arguments in, calls out, no logic.

#[cfg(not(all(feature = "check", feature = "report")))]
mod absent;
#[cfg(feature = "check")]
mod check;
mod context_args;
#[cfg(feature = "report")]
mod figures;
mod info;
mod path_text;
mod pipeline;
mod plan;
mod render;
mod repack;
mod repack_report;
#[cfg(feature = "report")]
mod report;
#[cfg(feature = "report")]
mod report_light;
#[cfg(feature = "window")]
pub mod sample;
#[cfg(feature = "window")]
pub mod sample_model;
mod scene_args;
#[cfg(feature = "report")]
mod stress;
mod truth_views;
#[cfg(feature = "report")]
mod tune;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use context_args::ContextArgs;

use crate::conformance::probe;
use crate::context;

/// A headless OpenGL reference renderer of shadows and projected light.
#[derive(Debug, Parser)]
#[command(name = "glumbra", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[cfg(feature = "check")]
    Check(check::CheckArgs),
    #[cfg(not(feature = "check"))]
    Check(absent::AbsentArgs),
    #[cfg(feature = "report")]
    Figures(figures::FiguresArgs),
    #[cfg(not(feature = "report"))]
    Figures(absent::AbsentArgs),
    /// Prints the context, its driver and limits, and what was measured of its depth formats.
    Info(info::InfoArgs),
    Plan(plan::PlanArgs),
    Render(render::RenderArgs),
    Repack(repack::RepackArgs),
    #[cfg(feature = "report")]
    Report(report::ReportArgs),
    #[cfg(not(feature = "report"))]
    Report(absent::AbsentArgs),
    #[cfg(feature = "report")]
    Stress(stress::StressArgs),
    #[cfg(not(feature = "report"))]
    Stress(absent::AbsentArgs),
    #[cfg(feature = "report")]
    Tune(tune::TuneArgs),
    #[cfg(not(feature = "report"))]
    Tune(absent::AbsentArgs),
}

/// Error of a subcommand.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Context(#[from] context::Error),
    #[cfg(feature = "fixed-function")]
    #[error("--pipeline fixed-function needs OpenGL's compatibility profile. {0}")]
    NoFixedFunction(context::Error),
    #[cfg(feature = "fixed-function")]
    #[error(transparent)]
    FixedFunction(#[from] crate::fixed_function::Error),
    #[error(transparent)]
    Probe(#[from] probe::Error),
    #[error(transparent)]
    Scene(#[from] crate::scene::Error),
    #[error(transparent)]
    Plan(#[from] crate::plan::Error),
    #[error(transparent)]
    Frame(#[from] crate::frame::Error),
    #[error(transparent)]
    Truth(#[from] crate::truth::Error),
    #[error(transparent)]
    Difference(#[from] crate::report::measure::metrics::Error),
    #[cfg(feature = "window")]
    #[error(transparent)]
    Viewer(#[from] crate::viewer::Error),
    #[error(transparent)]
    File(#[from] crate::output::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Figures(#[from] crate::figures::Error),
    #[error(transparent)]
    Repack(#[from] repack::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Tune(#[from] crate::report::measure::tune::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Grid(#[from] crate::report::measure::grid::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Report(#[from] crate::report::measure::run::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Journal(#[from] crate::report::store::journal::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Pictures(#[from] crate::report::store::pictures::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    KeptPictures(#[from] crate::report::store::picture_files::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    Merge(#[from] crate::report::store::merge::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    ReportFiles(#[from] crate::report::store::write::Error),
    #[cfg(feature = "report")]
    #[error("--case {name}: no case has that in its name; `glumbra stress --list` has all")]
    NoSuchCase { name: String },
    #[cfg(feature = "report")]
    #[error(transparent)]
    Stress(#[from] crate::stress::Error),
    #[cfg(feature = "report")]
    #[error(transparent)]
    StressCases(#[from] crate::stress::named::Error),
    #[cfg(feature = "report")]
    #[error("interrupted: {folder} holds a report of the rows so far; continue with --resume", folder = .folder.display())]
    Interrupted { folder: std::path::PathBuf },
    #[cfg(feature = "report")]
    #[error("{failed} of {rows} settings could not be measured, row {row} for example: {why}; {folder} holds the others", folder = .folder.display())]
    FailedRows { failed: usize, rows: usize, row: usize, why: String, folder: std::path::PathBuf },
    #[error("--no-floor: {scene} is a scene; only a model (.obj) is supplied with a floor", scene = .scene.display())]
    NoFloor { scene: std::path::PathBuf },
    #[error("standard output: {0}")]
    Output(#[from] std::io::Error),
    #[cfg(feature = "check")]
    #[error(transparent)]
    Filter(#[from] crate::conformance::UnknownFilter),
    #[cfg(feature = "check")]
    #[error(transparent)]
    Waivers(#[from] crate::conformance::waivers::Error),
    #[cfg(feature = "check")]
    #[error(transparent)]
    Baseline(#[from] crate::conformance::baseline::Error),
    #[cfg(feature = "check")]
    #[error("the waivers: {0}")]
    WriteWaivers(#[from] toml::ser::Error),
    #[cfg(feature = "check")]
    #[error(transparent)]
    Child(#[from] check::ChildError),
    #[cfg(feature = "check")]
    #[error(transparent)]
    Reduce(#[from] crate::conformance::reduce::ReduceError),
    #[cfg(feature = "check")]
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
    #[error("{what} is not compiled in: build glumbra with the cargo feature `{feature}`")]
    NotBuilt { what: &'static str, feature: &'static str },
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
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
    let result = match arguments.command {
        #[cfg(feature = "check")]
        Command::Check(arguments) => return check::run(&arguments),
        #[cfg(not(feature = "check"))]
        Command::Check(_) => absent::refuse("check", "check"),
        #[cfg(feature = "report")]
        Command::Figures(arguments) => figures::run(&arguments),
        #[cfg(not(feature = "report"))]
        Command::Figures(_) => absent::refuse("figures", "report"),
        Command::Info(arguments) => info::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Repack(arguments) => repack::run(&arguments),
        #[cfg(feature = "report")]
        Command::Report(arguments) => report::run(&arguments),
        #[cfg(not(feature = "report"))]
        Command::Report(_) => absent::refuse("report", "report"),
        #[cfg(feature = "report")]
        Command::Stress(arguments) => return stress::run(&arguments),
        #[cfg(not(feature = "report"))]
        Command::Stress(_) => absent::refuse("stress", "report"),
        #[cfg(feature = "report")]
        Command::Tune(arguments) => tune::run(&arguments),
        #[cfg(not(feature = "report"))]
        Command::Tune(_) => absent::refuse("tune", "report"),
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

/// Pretty JSON and a line's end on standard output.
fn print_json(value: &impl serde::Serialize) -> Result<(), Error> {
    print(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// Writes on standard output, to the last byte.
fn print(text: &str) -> Result<(), Error> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// A spinner with a message, for work without a known length.
#[cfg_attr(not(feature = "report"), allow(dead_code, reason = "for commands that take long"))]
fn spinner(template: &str) -> indicatif::ProgressBar {
    let bar = indicatif::ProgressBar::new_spinner();
    if let Ok(style) = indicatif::ProgressStyle::with_template(&format!("{{spinner}} {template}")) {
        bar.set_style(style);
    }
    bar
}
