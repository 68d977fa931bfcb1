//! A renderer that is not glumbra, for tests of `glumbra judge` and of cases that name a command.
//!
//! `cargo run --release --example other_renderer -- OUT.png [--no-bias] [--turn-light DEGREES]`; it draws the shade of
//! `tests/other_renderer/teapot.toml`.

#![deny(clippy::print_stdout, clippy::print_stderr)]

mod renderer;

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where standard error is closed there is nowhere left to say it.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    let mut faults = renderer::Faults::default();
    let mut picture = None;
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--no-bias" => faults.no_bias = true,
            "--turn-light" => faults.turned_degrees = words.next().ok_or("--turn-light DEGREES")?.parse()?,
            _ => picture = Some(PathBuf::from(word)),
        }
    }
    renderer::draw(faults, &picture.ok_or("usage: other_renderer OUT.png [--no-bias] [--turn-light DEGREES]")?)
}
