//! The frames: small scenes with each setting's values in turn, the others at random. Seeds are fixed, so that a driver
//! draws the same frames wherever it is checked.

mod axes;
mod groups;
mod world;

use std::path::Path;

use crate::conformance::random::Random;
use crate::plan::{Plan, Request};
use crate::scene::{self, Scene};
use crate::techniques::Techniques;

pub use groups::Group;

/// A frame in words, and its passes.
pub struct FrameToDraw {
    pub said: String,
    pub plan: Plan,
}

/// A scene that is being written.
pub struct Draft {
    pub text: String,
    pub said: String,
    pub request: Request,
}

macro_rules! files {
    ($($name:literal),*) => { &[$(($name, include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/frames/", $name)))),*] };
}

const PICTURES: &[(&str, &[u8])] =
    files!("gloss.png", "heights.png", "holes.png", "leaves.png", "normals.png", "slide.png", "tiles.png");
const MESHES: &[(&str, &[u8])] = files!("ball.obj", "ring.obj", "sheet.obj");

/// Scenes that are tried for one frame: settings that do not go together are refused.
const TRIES: usize = 40;

/// Frames of a group.
pub fn of_group(group: Group, plan: impl Fn(&Scene, Request) -> Option<Plan>) -> Vec<FrameToDraw> {
    let mut dice = Random::new(0x7_0000 + group as u64);
    let mut turns = axes::Turns::new(group.axes());
    let mut frames = Vec::new();
    for _ in 0..group.frames() {
        let mut chosen = turns.next(&mut dice);
        for _ in 0..TRIES {
            let draft = group.draft(&chosen, &mut dice);
            if let Some(plan) = loaded(&draft.text).and_then(|scene| plan(&scene, draft.request)) {
                frames.push(FrameToDraw { said: draft.said, plan });
                break;
            }
            turns.vary(&mut chosen, &mut dice);
        }
    }
    frames
}

/// The scene of a text; `None`: its settings do not go together.
fn loaded(text: &str) -> Option<Scene> {
    let result = scene::load_with_files(Path::new("frame.toml"), text, [PICTURES, MESHES], &Techniques);
    result.ok().map(|loaded| loaded.scene)
}
