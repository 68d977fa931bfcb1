//! `--aov NAME`: views that are drawn, and `truth` and `difference`, which the ray tracer makes.

use super::Error;
use super::scene_args::parse_view;
use crate::device::Pixels;
use crate::frame::Frame;
use crate::judge::truth_pictures::TruthView;
use crate::plan::ViewRequest;
use crate::scene::Scene;

/// Value of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aov {
    /// A view that is drawn.
    Drawn(ViewRequest),
    /// The ray tracer's own picture, or differences of the picture from it.
    Traced(TruthView),
}

/// Reads `NAME` or `NAME@LIGHT`.
pub fn parse_aov(text: &str) -> Result<Aov, String> {
    let (name, light) = text.split_once('@').unwrap_or((text, "0"));
    let number = || light.parse().map_err(|_| format!("'{light}' is no number of a light"));
    match name {
        "truth" => Ok(Aov::Traced(TruthView { light: number()?, is_difference: false })),
        "difference" => Ok(Aov::Traced(TruthView { light: number()?, is_difference: true })),
        _ => parse_view(text, &["truth", "difference"]).map(Aov::Drawn),
    }
}

impl Aov {
    /// The name in a file's name.
    pub fn file_name(self) -> String {
        let (name, light) = match self {
            Self::Drawn(wanted) => (wanted.view.name(), wanted.light),
            Self::Traced(wanted) => (wanted.name(), wanted.light),
        };
        if light == 0 { name.to_owned() } else { format!("{name}.{light}") }
    }

    /// The view that is drawn for it; `None`: the picture suffices.
    pub fn drawn(self, scene: &Scene) -> Option<ViewRequest> {
        match self {
            Self::Drawn(wanted) => Some(wanted),
            Self::Traced(wanted) => wanted.drawn(scene),
        }
    }

    /// Its picture, if the ray tracer makes it; `drawn`: what was drawn for it. `is_exact`: for a format with 32-bit values.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot answer.
    pub fn picture(
        self,
        scene: &Scene,
        frame: &Frame,
        drawn: Option<&Pixels>,
        is_exact: bool,
    ) -> Result<Option<Pixels>, Error> {
        match self {
            Self::Drawn(_) => Ok(None),
            Self::Traced(wanted) => Ok(Some(wanted.picture(scene, &frame.picture, drawn, is_exact)?)),
        }
    }
}
