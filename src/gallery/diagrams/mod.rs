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

use super::draw::ShownEntry;
use super::entry::DiagramKind;

/// An SVG element, and a sentence below it.
#[derive(Clone, Debug)]
pub struct Diagram {
    pub svg: String,
    pub says: String,
}

/// Draws a diagram; empty: the scenes have nothing to show in it.
pub fn draw(kind: DiagramKind, shown: &ShownEntry) -> Vec<Diagram> {
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
