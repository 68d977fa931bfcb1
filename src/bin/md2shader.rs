//! md2shader: a bump-mapped key-framed knight with stencil shadow volumes, in a room with one light. After the program of that
//! name that \[GDC\] ends with, of which only pictures are published; the scene is `data/scenes/md2shader.toml`, compiled in.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample_model::{self, KNIGHT, ModelSample};

const SAMPLE: ModelSample = ModelSample {
    name: "md2shader",
    about: "A bump-mapped key-framed knight with stencil shadow volumes, in a room with one light.",
    scene: KNIGHT,
    shadows: true,
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample_model::run(&SAMPLE)
}
