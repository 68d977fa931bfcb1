//! The command `glumbra`: parses, calls, exits.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    glumbra::cli::run()
}
