//! Diagrams as SVG, each drawn from the numbers of an entry's scenes. A file a family; `svg.rs` writes elements.

mod svg;
mod texels;

use serde::Deserialize;

use super::draw::Shown;

/// Diagram of an entry.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum DiagramKind {
    /// A shadow map's texels as a stair against the surface [HSM, Figure 3].
    Texels,
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
    }
}
