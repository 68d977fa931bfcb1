//! Makes the files in `data/` that no one drew: `meshes/dense.obj`, `meshes/facade-*.obj` and the pictures in `textures/`. A
//! test makes them anew and compares.
//!
//! `cargo run --release --example generate_data [FOLDER]`; the default folder is `data`.

#![deny(clippy::print_stdout, clippy::print_stderr)]

#[path = "made.rs"]
mod made;

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "data".into()));
    match made::write_all(&folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where standard error is closed there is nowhere left to say it.
            let _ = writeln!(std::io::stderr(), "{}: {error}", folder.display());
            ExitCode::FAILURE
        }
    }
}
