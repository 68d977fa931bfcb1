//! md2bump: the knight of md2shader without shadows, after the program of that name that [GDC, "More Information on
//! Texture-Space Bump Mapping"] lists.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample_model::{self, KNIGHT, ModelSample};

const SAMPLE: ModelSample = ModelSample {
    name: "md2bump",
    about: "A bump-mapped key-framed knight in a room with one light, without shadows.",
    scene: KNIGHT,
    shadows: false,
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample_model::run(&SAMPLE)
}
