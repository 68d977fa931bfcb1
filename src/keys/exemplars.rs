//! Scenes in which every key of a scene file is read: [`recorded`](super::recorded) notes what each may be.

use crate::scene::Embedded;

macro_rules! exemplar {
    ($name:literal) => {
        Embedded {
            path: concat!("data/keys/", $name),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/keys/", $name)),
            pictures: PICTURES,
            meshes: MESHES,
        }
    };
}

/// The one picture of the scenes.
const PICTURES: &[(&str, &[u8])] = &[("picture.png", include_bytes!("../../data/textures/barn-doors.png"))];

/// The one model of the scenes.
const MESHES: &[(&str, &[u8])] = &[("knight.md2", include_bytes!("../../data/meshes/knight.md2"))];

/// The scenes. No scene has every table, as some exclude each other.
pub const EXEMPLARS: [Embedded; 3] = [exemplar!("tables.toml"), exemplar!("lens.toml"), exemplar!("solid.toml")];
