//! Diagrams as SVG, each drawn from the numbers of an entry's scenes. A file a family; `svg.rs` writes elements, `section.rs`
//! cuts the scene by a plane.

mod frustum;
mod ledge;
mod perspective;
mod section;
mod svg;
mod texels;
mod transforms;
mod volumes;

use serde::Deserialize;

use super::draw::Shown;

/// Diagram of an entry.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum DiagramKind {
    /// A shadow map's texels as a stair against the surface [HSM, Figure 3].
    Texels,
    /// The chain of matrices, with the numbers of a point [HSM, Figures 7 and 8].
    Transforms,
    /// A cut through shadow volumes with their counts.
    Volumes,
    /// The light's frustum along its axis [HSM, Figure 1].
    Frustum,
    /// The same with the mirrored frustum behind the light.
    BackProjection,
    /// Equal steps on the screen, and on a surface [Segal 1992, Figures 1 and 2].
    Perspective,
    /// The two depth ranges of the ledge.
    Ledge,
}

/// An SVG element, and a sentence below it.
#[derive(Clone, Debug)]
pub struct Diagram {
    pub svg: String,
    pub says: String,
}

/// Draws a diagram; empty: the scenes have nothing to show in it.
pub fn draw(kind: DiagramKind, shown: &Shown) -> Vec<Diagram> {
    match kind {
        DiagramKind::Texels => [&shown.failure, &shown.cure].into_iter().filter_map(texels::draw).collect(),
        DiagramKind::Transforms => transforms::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Frustum => {
            [&shown.failure, &shown.cure].into_iter().filter_map(|side| frustum::draw(side, false)).collect()
        }
        DiagramKind::BackProjection => frustum::draw(&shown.cure, true).into_iter().collect(),
        DiagramKind::Perspective => perspective::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Ledge => ledge::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Volumes => volumes::draw(&shown.cure).into_iter().collect(),
    }
}
