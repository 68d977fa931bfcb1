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
];

/// The scene of a file in `data/figures/`.
macro_rules! embedded {
    ($name:literal) => {
        $crate::scene::Embedded {
            path: concat!("data/figures/", $name),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/figures/", $name)),
            pictures: $crate::figures::panels::PICTURES,
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
