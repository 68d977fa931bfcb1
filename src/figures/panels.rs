//! Scenes of figures, compiled into the program, and their panels.

use super::{Measured, Panel, PanelStage, SceneChange};
use crate::views::View;

/// Pictures that the figures' scenes name. A static is in the program once, a constant wherever it is used.
pub static PICTURES: [(&str, &[u8]); 13] = [
    ("../meshes/fence.png", include_bytes!("../../data/meshes/fence.png")),
    ("../textures/checker.png", include_bytes!("../../data/textures/checker.png")),
    ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
    ("../textures/spot.png", include_bytes!("../../data/textures/spot.png")),
    ("../textures/slide.png", include_bytes!("../../data/textures/slide.png")),
    ("../textures/barn-doors.png", include_bytes!("../../data/textures/barn-doors.png")),
    ("../textures/head-light.png", include_bytes!("../../data/textures/head-light.png")),
    ("../textures/bricks.png", include_bytes!("../../data/textures/bricks.png")),
    ("../textures/facade.png", include_bytes!("../../data/textures/facade.png")),
    ("../textures/studs.png", include_bytes!("../../data/textures/studs.png")),
    ("../textures/knight.png", include_bytes!("../../data/textures/knight.png")),
    ("../textures/knight-gloss.png", include_bytes!("../../data/textures/knight-gloss.png")),
    ("../textures/knight-height.png", include_bytes!("../../data/textures/knight-height.png")),
];

/// Models that the figures' scenes name.
pub static MESHES: [(&str, &[u8]); 8] = [
    ("../meshes/facade-wall.obj", include_bytes!("../../data/meshes/facade-wall.obj")),
    ("../meshes/facade-stone.obj", include_bytes!("../../data/meshes/facade-stone.obj")),
    ("../meshes/facade-wood.obj", include_bytes!("../../data/meshes/facade-wood.obj")),
    ("../meshes/facade-glass.obj", include_bytes!("../../data/meshes/facade-glass.obj")),
    ("../meshes/facade-iron.obj", include_bytes!("../../data/meshes/facade-iron.obj")),
    ("../meshes/plate.obj", include_bytes!("../../data/meshes/plate.obj")),
    ("../meshes/mirrored-plate.obj", include_bytes!("../../data/meshes/mirrored-plate.obj")),
    ("../meshes/knight.md2", include_bytes!("../../data/meshes/knight.md2")),
];

/// The scene of a file in `data/figures/`, or in another folder of `data/`.
macro_rules! embedded {
    ($name:literal) => {
        $crate::figures::panels::embedded!("figures/", $name)
    };
    ($folder:literal, $name:literal) => {
        $crate::scene::Embedded {
            path: concat!("data/", $folder, $name),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/", $folder, $name)),
            pictures: &$crate::figures::panels::PICTURES,
            meshes: &$crate::figures::panels::MESHES,
        }
    };
}
pub(crate) use embedded;

/// A panel of the picture, or of a view of the first light.
pub const fn panel(title: &'static str, set: &'static [&'static str], view: Option<View>) -> Panel {
    let (change, counts, stage, map) = (None, None, None, None);
    Panel { title, note: "", set, change, view, counts, stage, measured: Measured::Nothing, map, span: 1 }
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

    /// The panel with its mean brightness below it, and that by many samples a pixel.
    pub const fn brightness(self) -> Self {
        Self { measured: Measured::Brightness, ..self }
    }

    /// The panel with its difference from another panel's picture below it.
    pub const fn from(self, panel: usize) -> Self {
        Self { measured: Measured::From(panel), ..self }
    }

    /// The panel with a number below it that says how far its decal is pre-lit.
    pub const fn follows_up(self) -> Self {
        Self { measured: Measured::FollowsUp, ..self }
    }

    /// The panel of a changed scene.
    pub const fn changed(self, change: SceneChange) -> Self {
        Self { change: Some(change), ..self }
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
