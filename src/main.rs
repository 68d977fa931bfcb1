//! The command `glumbra`: parses, calls, exits.

use std::process::ExitCode;

fn main() -> ExitCode {
    glumbra::cli::run()
}
