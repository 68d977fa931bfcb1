//! glumbra against the floor: the same scene by the fewest GL calls, in processes taken in turn.
//! Prints medians of same-round ratios; absolute times hold on no other machine. `ci/bench` builds and runs it.

mod animation;
mod ball;
mod bumps;
mod child;
mod floor;
mod floor_bumps;
mod floor_dust;
mod floor_gl;
mod floor_layer;
mod floor_lens;
mod floor_maps;
mod floor_passes;
mod judge;
mod kinds;
mod model_files;
mod numbers;
mod pairs;
mod pictures;
mod rounds;
mod scale;
mod scale_child;
mod scale_plot;
mod scale_scene;
mod table;
mod techniques;
mod volumes;

use std::process::ExitCode;

use clap::{Parser, ValueEnum};

/// Draws scenes by glumbra and by the floor, in turn, and prints ratios.
#[derive(Clone, Debug, Parser)]
pub struct Arguments {
    /// Rounds; each starts every process once
    #[arg(long, default_value_t = 10)]
    rounds: usize,
    /// 3 rounds of few frames: shows that it runs, not how fast
    #[arg(long)]
    quick: bool,
    /// This scene only
    #[arg(long, value_enum)]
    scene: Option<Scene>,
    /// Draws in this process and prints one line of JSON (the bench starts itself with it)
    #[arg(long, value_enum)]
    child: Option<Who>,
    /// The child's frames that are timed
    #[arg(long, default_value_t = 1)]
    frames: usize,
    #[arg(long, value_enum, default_value_t = Redraw::Always)]
    redraw: Redraw,
    /// Another model than the dense one: a scan whose file order is its own
    #[arg(long, value_name = "OBJ")]
    model: Option<std::path::PathBuf>,
    /// The child's scene, with the model that is drawn
    #[arg(long, hide = true, value_name = "TOML")]
    file: Option<std::path::PathBuf>,
    /// Shadow volumes on the CPU instead: adjacency, outline, extrusion
    #[arg(long)]
    volumes: bool,
    /// A key-framed model on the CPU instead: positions, tangent bases, silhouettes
    #[arg(long)]
    animation: bool,
    /// Bump mapping against its floor, in one pass and in three, instead
    #[arg(long)]
    bumps: bool,
    /// The child draws the floor of bump mapping in so many passes
    #[arg(long, value_enum, hide = true, value_name = "PASSES")]
    bumps_floor: Option<bumps::Passes>,
    /// Each technique against the floor's shadow map, instead
    #[arg(long)]
    techniques: bool,
    /// Growth with the size of a scene, instead: time, planning, start-up and memory; `-o FILE.svg` plots them
    #[arg(long)]
    scale: bool,
    /// The child draws the scene of that in this folder
    #[arg(long, hide = true, value_name = "FOLDER")]
    scale_scene: Option<std::path::PathBuf>,
    /// Only those whose names contain this text: of techniques, or of what grows
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// glumbra against itself, instead: multiples, and what is saved by what is left out
    #[arg(long)]
    pairs: bool,
    /// Kind of picture that the floor draws
    #[arg(long, value_enum, default_value_t = kinds::Kind::Map)]
    floor: kinds::Kind,
    /// Parts that glumbra's child draws although it leaves them out otherwise
    #[arg(long, value_enum, default_value_t = child::Keep::Nothing)]
    keep: child::Keep,
    /// The child's overrides of the scene, as `glumbra render` takes them
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Where the child writes its picture, and `--scale` its plots
    #[arg(short, long)]
    output: Option<std::path::PathBuf>,
    /// Cargo passes it to every bench
    #[arg(long, hide = true)]
    bench: bool,
}

/// Scene to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scene {
    /// One dense model.
    S1,
    /// A hundred of it.
    S2,
}

/// Program that draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Who {
    /// The floor: the same picture by the fewest GL calls.
    Floor,
    /// The floor with its triangles in vertex-cache order and its heap kept: what a hand-tuned program reaches.
    Tuned,
    /// This project's command.
    Glumbra,
    /// The floor's context, one clear, one pixel read.
    Clear,
}

/// Frames in which the map is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Redraw {
    /// All of them.
    Always,
    /// The first.
    Once,
}

/// Whatever went wrong, in words.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.child {
        Some(_) if arguments.bumps_floor.is_some() => {
            arguments.bumps_floor.map_or(Ok(()), |passes| bumps::floor(passes, &arguments))
        }
        None if arguments.bumps => bumps::run(&arguments),
        None if arguments.scale => scale::run(&arguments),
        Some(who) => match &arguments.scale_scene {
            Some(folder) => scale_child::run(who, folder, &arguments),
            None => child::run(who, &arguments),
        },
        None if arguments.volumes => volumes::run(&arguments),
        None if arguments.animation => animation::run(&arguments),
        None if arguments.pairs => pairs::run(&arguments),
        None if arguments.techniques => techniques::run(&arguments),
        None => rounds::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
