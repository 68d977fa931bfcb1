//! The command line: one file a subcommand; arguments in, calls out, no logic.

mod context_args;
mod info;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use context_args::ContextArgs;

use crate::context;
use crate::device::probe;

/// A headless OpenGL reference renderer of shadows and projected light.
#[derive(Debug, Parser)]
#[command(name = "glumbra", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Prints the context, its driver and limits, and what was measured of its depth formats.
    Info(info::InfoArgs),
}

/// Why a subcommand failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Context(#[from] context::Error),
    #[error(transparent)]
    Probe(#[from] probe::Error),
    #[error("standard output: {0}")]
    Output(#[from] std::io::Error),
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Runs the command with the process's arguments: 0 for success, 1 for an error of ours, 2 for one of usage.
pub fn run() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Info(arguments) => info::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that has seen enough (`glumbra info | head`) is no error.
        Err(Error::Output(error)) if error.kind() == std::io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
