//! md2bump: the knight of md2shader without shadows, after the program of that name that [GDC, "More Information on
//! Texture-Space Bump Mapping"] lists.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample_model::{self, ModelSample};
use glumbra::scene::Embedded;

const SAMPLE: ModelSample = ModelSample {
    name: "md2bump",
    about: "A bump-mapped key-framed knight in a room with one light, without shadows.",
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
    shadows: false,
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample_model::run(&SAMPLE)
}
