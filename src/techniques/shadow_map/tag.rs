//! The comparison's result as a tag in the stencil buffer, for later passes [LEC, "Combining Shadow Mapping with other
//! Techniques"]. A tag is one bit: a filtered shade of one half or more is lit. As many pixels are on the wrong side of one
//! half as with a shader; the root mean square error of GL_LINEAR grows by a tenth (`glumbra report` on teapot.toml and
//! main.toml at 512 and 1024: 9 to 11 %), that of GL_NEAREST not at all.

use super::settings::{Outcome, Settings};
use crate::lights::LightView;
use crate::lights::light::{CountPass, Counted, Lighting, StencilCount, VolumeDepths};
use crate::pass::{Channels, Compare, DrawState, Redraw, Stencil, StencilOp, StencilOps};

/// The pass that tags shadowed pixels; `None`: the lit pass looks the shade up itself.
pub fn counting(view: &LightView<'_>, settings: &Settings) -> Option<StencilCount> {
    if settings.into == Outcome::Shade {
        return None;
    }
    // This replaces, and does not count: where surfaces tie, each may be tagged.
    let tag = StencilOps { pass: StencilOp::Replace, ..StencilOps::KEEP };
    let stencil =
        Stencil { test: Compare::Always, reference: 1, read_mask: 0xFF, write_mask: 0xFF, front: tag, back: tag };
    let pass = CountPass {
        label: format!("light {}: tag", view.index),
        state: DrawState { color_write: Channels::None, stencil: Some(stencil), ..DrawState::REPEAT },
        depths: VolumeDepths::Scene,
        counted: Counted::Shadowed,
    };
    Some(StencilCount {
        passes: vec![pass],
        redraw: Redraw::WhenChanged,
        of_all: false,
        infinite: false,
        clamped: false,
        casters: Vec::new(),
        ledge: None,
        lighting: Lighting::Added,
        scissor: if view.keep_all { None } else { view.camera.scissor(view.light(), view.scene.image.size) },
        volumes: Vec::new(),
        silhouettes: Vec::new(),
    })
}
