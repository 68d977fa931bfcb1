//! Scenes of figures, compiled into the program, and their panels.

use super::{Panel, PanelStage};
use crate::views::View;

/// Pictures that the figures' scenes name.
pub const PICTURES: &[(&str, &[u8])] = &[
    ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
    ("../textures/spot.png", include_bytes!("../../data/textures/spot.png")),
    ("../textures/slide.png", include_bytes!("../../data/textures/slide.png")),
    ("../textures/barn-doors.png", include_bytes!("../../data/textures/barn-doors.png")),
    ("../textures/head-light.png", include_bytes!("../../data/textures/head-light.png")),
    ("../textures/bricks.png", include_bytes!("../../data/textures/bricks.png")),
    ("../textures/facade.png", include_bytes!("../../data/textures/facade.png")),
];

/// OBJ files that the figures' scenes name.
pub const MESHES: &[(&str, &[u8])] = &[
    ("../meshes/facade-wall.obj", include_bytes!("../../data/meshes/facade-wall.obj")),
    ("../meshes/facade-stone.obj", include_bytes!("../../data/meshes/facade-stone.obj")),
    ("../meshes/facade-wood.obj", include_bytes!("../../data/meshes/facade-wood.obj")),
    ("../meshes/facade-glass.obj", include_bytes!("../../data/meshes/facade-glass.obj")),
    ("../meshes/facade-iron.obj", include_bytes!("../../data/meshes/facade-iron.obj")),
];

/// The scene of a file in `data/figures/`.
macro_rules! embedded {
    ($name:literal) => {
        $crate::scene::Embedded {
            path: concat!("data/figures/", $name),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/figures/", $name)),
            pictures: $crate::figures::panels::PICTURES,
            meshes: $crate::figures::panels::MESHES,
        }
    };
}
pub(crate) use embedded;

/// A panel of the picture, or of a view of the first light.
pub const fn panel(title: &'static str, set: &'static [&'static str], view: Option<View>) -> Panel {
    Panel { title, set, view, counts: None, stage: None }
}

/// A panel that shows a part of how the picture comes about.
pub const fn stage(title: &'static str, set: &'static [&'static str], stage: PanelStage) -> Panel {
    Panel { title, set, view: None, counts: None, stage: Some(stage) }
}
