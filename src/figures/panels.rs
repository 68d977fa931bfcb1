//! Scenes of figures, compiled into the program, and their panels.

use super::{Measured, Panel, PanelStage};
use crate::views::View;

/// Pictures that the figures' scenes name.
pub const PICTURES: &[(&str, &[u8])] = &[
    ("../textures/checker.png", include_bytes!("../../data/textures/checker.png")),
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
    Panel { title, note: "", set, view, counts: None, stage: None, measured: Measured::Nothing, map: None, span: 1 }
}

/// A panel that shows a part of how the picture comes about, or something measured.
pub const fn stage(title: &'static str, set: &'static [&'static str], stage: PanelStage) -> Panel {
    Panel { stage: Some(stage), ..panel(title, set, None) }
}

impl Panel {
    /// The panel with a sentence or two below its title.
    pub const fn note(self, note: &'static str) -> Self {
        Self { note, ..self }
    }

    /// The panel with the wrong share of its picture below it.
    pub const fn wrong(self) -> Self {
        Self { measured: Measured::Wrong, ..self }
    }

    /// The panel with its difference from the same picture by many samples a pixel below it.
    pub const fn against_fine(self) -> Self {
        Self { measured: Measured::AgainstFine, ..self }
    }

    /// The panel with a map of so many texels a side at scale 1, and as many times more at another.
    pub const fn map(self, texels: u32) -> Self {
        Self { map: Some(texels), ..self }
    }

    /// The panel over two columns.
    pub const fn wide(self) -> Self {
        Self { span: 2, ..self }
    }
}
