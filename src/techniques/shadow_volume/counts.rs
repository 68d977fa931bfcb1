//! The passes that count [GDC, "Stencil Inverting of Shadow Volume", "For Shadow Volumes With Intersecting Polygons",
//! "Alternative to Near Plane Capping: Carmack's Reverse"]: which faces change the stencil value, and when.

use super::choice::CountMethod;
use super::settings::Settings;
use super::shapes::Shape;
use crate::lights::LightView;
use crate::lights::light::{CountPass, Counted, VolumeDepths, VolumeDraw};
use crate::pass::{Compare, DrawState, Stencil, StencilOp, StencilOps};

/// The passes for all shapes, way by way. Sums modulo 256 do not depend on the order; if counts stop at 0, all passes that
/// count up come before all that count down.
///
/// A pass for one face has KEEP for the other, and culls none. llvmpipe culls by the area of the unrounded vertices, but
/// counts by that of the rounded ones. With culling, a side narrower than that rounding could be counted by neither pass.
pub fn passes(view: &LightView<'_>, shapes: &[Shape], settings: &Settings) -> Vec<CountPass> {
    let label = |what: &str| format!("light {}: {what}", view.index);
    let of =
        |ways: &[CountMethod]| -> Vec<&Shape> { shapes.iter().filter(|shape| ways.contains(&shape.way)).collect() };
    let sides = |ways: &[CountMethod]| of(ways).iter().map(|shape| shape.sides.clone()).collect::<Vec<_>>();
    let whole = |ways: &[CountMethod]| of(ways).iter().flat_map(|shape| shape.whole()).collect::<Vec<_>>();
    let (up, down) = match settings.wrap {
        true => (StencilOp::IncrementWrap, StencilOp::DecrementWrap),
        false => (StencilOp::Increment, StencilOp::Decrement),
    };
    let keep = StencilOps::KEEP;
    let pass = |op| StencilOps { pass: op, ..keep };
    let fail = |op| StencilOps { depth_fail: op, ..keep };
    let counted = |what: &str, front, back, draws: Vec<VolumeDraw>| CountPass {
        label: label(what),
        state: state(front, back, 0xFF),
        depths: VolumeDepths::Scene,
        counted: Counted::Volumes(draws),
    };
    let mut passes = Vec::new();
    let parity = CountPass {
        state: state(pass(StencilOp::Invert), pass(StencilOp::Invert), 0x01),
        ..counted("parity", keep, keep, sides(&[CountMethod::Parity]))
    };
    passes.push(parity);
    let drawn = sides(&[CountMethod::ZPass]);
    passes.push(counted("z-pass, front faces", pass(up), keep, drawn.clone()));
    passes.push(counted("z-pass, back faces", keep, pass(down), drawn));
    passes.push(counted("z-pass", pass(up), pass(down), sides(&[CountMethod::ZPassTwoSided])));
    let capped = of(&[CountMethod::ZPassCapped]);
    let near_caps = capped.iter().flat_map(|shape| shape.caps.clone()).collect();
    let ledge = counted("z-pass, sides", pass(up), pass(down), sides(&[CountMethod::ZPassCapped]));
    passes.push(CountPass { depths: VolumeDepths::Ledge, ..ledge });
    let caps = counted("z-pass, near caps", pass(up), pass(down), near_caps);
    passes.push(CountPass { depths: VolumeDepths::LedgeCap, ..caps });
    passes.push(counted("z-fail", fail(down), fail(up), whole(&[CountMethod::ZFail, CountMethod::ZFailTruncated])));
    let mut clamped = counted("z-fail, depth clamped", fail(down), fail(up), whole(&[CountMethod::ZFailClamped]));
    clamped.state.depth_clamp = true;
    passes.push(clamped);
    passes.retain(|pass| !matches!(&pass.counted, Counted::Volumes(draws) if draws.is_empty()));
    if settings.wrap {
        return passes;
    }
    let only = |op| passes.iter().flat_map(move |pass| counting_only(pass, op)).collect::<Vec<_>>();
    [StencilOp::Invert, up, down].into_iter().flat_map(only).collect()
}

/// The part of a pass that does `op`: all of it if both faces do, or one face.
fn counting_only(pass: &CountPass, op: StencilOp) -> Option<CountPass> {
    let stencil = pass.state.stencil?;
    let does = |ops: StencilOps| ops.pass == op || ops.depth_fail == op;
    match (does(stencil.front), does(stencil.back)) {
        (false, false) => None,
        (true, true) => Some(pass.clone()),
        (front, _) => {
            let keep = StencilOps::KEEP;
            let is_whole = [stencil.front, stencil.back].contains(&keep);
            let what = if front { "front faces" } else { "back faces" };
            let label = if is_whole { pass.label.clone() } else { format!("{}, {what}", pass.label) };
            let one = if front { Stencil { back: keep, ..stencil } } else { Stencil { front: keep, ..stencil } };
            Some(CountPass { label, state: DrawState { stencil: Some(one), ..pass.state }, ..pass.clone() })
        }
    }
}

/// Depth LESS: far caps lie at exactly 1 and fail against the cleared 1, a surface's own cap fails against itself.
fn state(front: StencilOps, back: StencilOps, write_mask: u8) -> DrawState {
    let stencil = Stencil { test: Compare::Always, reference: 0, read_mask: 0xFF, write_mask, front, back };
    DrawState { depth_write: false, stencil: Some(stencil), ..DrawState::DEPTH_ONLY }
}
