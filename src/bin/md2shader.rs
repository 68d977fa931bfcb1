//! md2shader: a bump-mapped key-framed knight with stencil shadow volumes, in a room with one light. After the program of that
//! name that \[GDC\] ends with, of which only pictures are published; the scene is `data/scenes/md2shader.toml`, compiled in.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample_model::{self, ModelSample};
use glumbra::scene::Embedded;

const SAMPLE: ModelSample = ModelSample {
    name: "md2shader",
    about: "A bump-mapped key-framed knight with stencil shadow volumes, in a room with one light.",
    scene: Embedded {
        path: "data/scenes/md2shader.toml",
        text: include_str!("../../data/scenes/md2shader.toml"),
        pictures: &[
            ("../textures/bricks.png", include_bytes!("../../data/textures/bricks.png")),
            ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
            ("../textures/knight.png", include_bytes!("../../data/textures/knight.png")),
            ("../textures/knight-gloss.png", include_bytes!("../../data/textures/knight-gloss.png")),
            ("../textures/knight-height.png", include_bytes!("../../data/textures/knight-height.png")),
        ],
        meshes: &[("../meshes/knight.md2", include_bytes!("../../data/meshes/knight.md2"))],
    },
    shadows: true,
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample_model::run(&SAMPLE)
}
