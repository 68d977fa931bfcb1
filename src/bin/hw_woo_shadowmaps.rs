//! hw_woo_shadowmaps: the scene of hw_shadowmaps_simple shadowed by Woo's midpoint map, which needs no polygon offset; a
//! key switches to polygon offset and back. After the sample program of that name (NVSDK), of which only the idea is
//! published [HSM, "Advantages and Limitations"].

#![deny(clippy::print_stdout, clippy::print_stderr)]

use std::process::ExitCode;

use glumbra::cli::sample::{self, Sample};
use glumbra::scene::Embedded;

const SAMPLE: Sample = Sample {
    name: "hw_woo_shadowmaps",
    about: "A teapot in a projected spotlight, shadowed by Woo's midpoint map or by one with polygon offset.",
    scene: Embedded {
        path: "data/scenes/hw_shadowmaps_simple.toml",
        text: include_str!("../../data/scenes/hw_shadowmaps_simple.toml"),
        pictures: &[
            ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
            ("../textures/spot.png", include_bytes!("../../data/textures/spot.png")),
        ],
        meshes: &[],
    },
    techniques: &["midpoint", "shadow-map"],
};

#[global_allocator]
static MEMORY: glumbra::process::Memory = glumbra::process::Memory;

fn main() -> ExitCode {
    sample::run(&SAMPLE)
}
