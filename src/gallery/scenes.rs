//! The scenes of the gallery, compiled into the program.

use crate::figures::embedded;
use crate::scene::Embedded;

static SCENES: [Embedded; 20] = [
    embedded!("offset.toml"),
    embedded!("layers.toml"),
    embedded!("boxes.toml"),
    embedded!("nested.toml"),
    embedded!("lamp.toml"),
    embedded!("swimming.toml"),
    embedded!("dusty_room.toml"),
    embedded!("boards.toml"),
    embedded!("plate.toml"),
    embedded!("lantern.toml"),
    embedded!("columns.toml"),
    embedded!("spotlight.toml"),
    embedded!("mirrored.toml"),
    embedded!("far-torus.toml"),
    embedded!("facade.toml"),
    embedded!("workshop.toml"),
    embedded!("stretched.toml"),
    embedded!("gallery/", "fence.toml"),
    embedded!("gallery/", "ring.toml"),
    embedded!("gallery/", "boxes-below.toml"),
];

/// The scene of this path in the repository; `None`: it is not compiled in.
pub fn find(path: &str) -> Option<&'static Embedded> {
    SCENES.iter().find(|scene| scene.path == path)
}
