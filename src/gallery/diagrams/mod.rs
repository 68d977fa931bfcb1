//! Diagrams as SVG, each drawn from the numbers of an entry's scenes. A file a family; `svg.rs` writes elements, `section.rs`
//! cuts the scene by a plane.

mod comparison;
mod frustum;
mod ledge;
mod perspective;
mod projected;
mod section;
mod svg;
mod texels;
mod transforms;
mod volumes;

use std::fmt::Write;

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
            let fitted = shown.cure.plan.maps.first().map(|map| map.texel);
            frustum::draw(&shown.failure, false).into_iter().map(|diagram| fitted_too(diagram, fitted)).collect()
        }
        DiagramKind::BackProjection => frustum::draw(&shown.cure, true).into_iter().collect(),
        DiagramKind::Perspective => perspective::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Comparison => comparison::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Projected => projected::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Ledge => ledge::draw(&shown.cure).into_iter().collect(),
        DiagramKind::Volumes => volumes::draw(&shown.cure).into_iter().collect(),
    }
}

/// The diagram of a light's frustum, with the width of a texel where the cure's map is fitted.
fn fitted_too(mut diagram: Diagram, texel: Option<f64>) -> Diagram {
    if let Some(texel) = texel {
        let _ = write!(
            diagram.says,
            " Fitted to what casts and is seen, a texel is {texel:.4} wide for each unit of depth."
        );
    }
    diagram
}
