//! hw_shadowmaps_simple: a teapot over a floor in a projected spotlight, shadowed by a depth map that the texture unit
//! compares. A port of the sample program of that name (NVSDK, 2000) and its public facts; the scene itself is
//! `data/scenes/hw_shadowmaps_simple.toml`, compiled in.

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample::{self, Sample};
use glumbra::scene::Embedded;

const SAMPLE: Sample = Sample {
    name: "hw_shadowmaps_simple",
    about: "A teapot in a projected spotlight, with and without the shadow of a hardware-compared depth map.",
    scene: Embedded {
        path: "data/scenes/hw_shadowmaps_simple.toml",
        text: include_str!("../../data/scenes/hw_shadowmaps_simple.toml"),
        pictures: &[
            ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
            ("../textures/spot.png", include_bytes!("../../data/textures/spot.png")),
        ],
        meshes: &[],
    },
    techniques: &[],
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample::run(&SAMPLE)
}
