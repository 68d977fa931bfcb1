//! GL-R5: what is switched off again does nothing, whatever its values are [GL 4.6, 13.7, 14.6.1, 14.6.5, 17.3].

use crate::conformance::bench::{
    Error, GlBlend, GlCompare, GlDraw, GlEquation, GlFace, GlFactor, GlFormat, GlOffset, GlState, GlStencil,
    GlStencilOp, Surface, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 8;

/// Codes of the draw under the state, and of the draw after it.
const UNDER: [u8; 4] = [40, 80, 120, 160];
const AFTER: [u8; 4] = [200, 60, 20, 90];

/// A state, and what is left of it once it is off.
struct Switch {
    name: &'static str,
    on: GlState,
    /// Normalised depth of what is drawn.
    z: f32,
    /// Colour, window depth and stencil value that are due after the second draw.
    due: ([u8; 4], f64, u8),
}

/// Without any test: the state of the second draw, but for a switch's own.
const OFF: GlState = GlState { depth: None, stale_values: true, ..GlState::WRITE };

fn switches() -> Vec<Switch> {
    let inverted =
        GlStencil { compare: GlCompare::Never, ops: [GlStencilOp::Invert; 3], ..GlStencil::on_pass(GlStencilOp::Keep) };
    // The stored colour stays.
    let kept = GlBlend::By([GlFactor::Zero, GlFactor::One, GlFactor::Zero, GlFactor::One], GlEquation::Add);
    let smallest = GlBlend::By([GlFactor::One, GlFactor::One, GlFactor::One, GlFactor::One], GlEquation::Min);
    let offset = GlOffset { factor: 1.0, units: 65536.0, clamp: 0.0 };
    let all = (AFTER, 0.75, 3);
    let plain = |name, on| Switch { name, on, z: 0.0, due: all };
    let off = GlState { stale_values: false, ..OFF };
    vec![
        plain("SCISSOR_TEST, a rectangle", GlState { scissor: Some([2, 3, 3, 2]), ..off }),
        plain("SCISSOR_TEST, nothing", GlState { scissor: Some([0; 4]), ..off }),
        plain("BLEND, ONE and ONE", GlState { blend: Some(GlBlend::Add), ..off }),
        plain("BLEND, ZERO and ONE", GlState { blend: Some(kept), ..off }),
        plain("BLEND, MIN", GlState { blend: Some(smallest), ..off }),
        plain("DEPTH_TEST, NEVER", GlState { depth: Some(GlCompare::Never), ..off }),
        Switch { due: (AFTER, 0.5, 3), ..plain("DEPTH_TEST, LESS", GlState { depth: Some(GlCompare::Less), ..off }) },
        Switch { due: (AFTER, 0.75, !3), ..plain("STENCIL_TEST", GlState { stencil: Some([inverted; 2]), ..off }) },
        plain("CULL_FACE", GlState { cull: Some(GlFace::Front), ..off }),
        Switch {
            due: (AFTER, 0.5, 3),
            ..plain("POLYGON_OFFSET_FILL", GlState { offset: Some(offset), ..GlState::WRITE })
        },
        // Beyond the far plane: clamped to it, then clipped away.
        Switch {
            due: (UNDER, 1.0, 3),
            z: 1.5,
            ..plain("DEPTH_CLAMP", GlState { depth_clamp: true, ..GlState::WRITE })
        },
    ]
}

/// GL-R5: a draw under each state, one after it with the state off and its values left, then the same again.
pub fn switched_off(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    for switch in switches() {
        let mut wrong = 0;
        for _ in 0..2 {
            surface.clear_color([0.0; 4]);
            surface.clear_depth(0.75);
            surface.clear_stencil(3);
            let quad =
                |color: [u8; 4]| rectangle([-1.0; 2], [1.0; 2], switch.z, color.map(|code| f32::from(code) / 255.0));
            subject.bench.draw(&GlDraw::plain(&surface, switch.on, &quad(UNDER)))?;
            // An offset shows in depths alone.
            let depth = switch.on.offset.and(switch.on.depth);
            subject.bench.draw(&GlDraw::plain(&surface, GlState { depth, ..OFF }, &quad(AFTER)))?;
            wrong += differ(&surface, switch.due);
        }
        findings.none_wrong(switch.name, wrong, 2 * (SIDE * SIDE) as usize);
    }
    Ok(())
}

fn differ(surface: &Surface, (color, depth, stencil): ([u8; 4], f64, u8)) -> usize {
    let rest = surface.depths().into_iter().zip(surface.stencils());
    let same = |(seen, (seen_depth, seen_stencil)): &([u8; 4], (f64, u8))| {
        *seen == color && (seen_depth - depth).abs() < 1e-6 && *seen_stencil == stencil
    };
    surface.colors().into_iter().zip(rest).filter(|pixel| !same(pixel)).count()
}
