//! GL-K8: the alpha test on what is drawn from arrays [GL 4.6 compatibility, 17.3.2].

use super::fixed;
use crate::conformance::bench::{Error, GlCompare, GlFormat, GlState, GlStencil, GlStencilOp};
use crate::conformance::{DriverUnderTest, Findings};

/// The whole viewport at depth 0.25.
const POSITIONS: [[f32; 3]; 6] =
    [[-1.0, -1.0, -0.5], [1.0, -1.0, -0.5], [1.0, 1.0, -0.5], [-1.0, -1.0, -0.5], [1.0, 1.0, -0.5], [-1.0, 1.0, -0.5]];

/// GL-K8: what fails leaves colour, depth and stencil alone, with depth writes and stencil on and off.
pub fn from_arrays(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const REFERENCE: f32 = 0.5;
    let Some(fixed) = fixed::pipeline(subject, findings, "the alpha test from arrays") else { return Ok(()) };
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    let side = GlStencil { reference: 7, ..GlStencil::on_pass(GlStencilOp::Replace) };
    let depth = Some(GlCompare::Less);
    let states = [
        ("depth", GlState { depth, ..GlState::WRITE }),
        ("depth and stencil", GlState { depth, stencil: Some([side; 2]), ..GlState::WRITE }),
        ("depth that is not written", GlState { depth, depth_write: false, ..GlState::WRITE }),
        ("depth without colour", GlState { depth, color_write: false, ..GlState::WRITE }),
    ];
    for (name, state) in states {
        let (mut wrong, mut count) = (0, 0);
        for compare in [GlCompare::GreaterEqual, GlCompare::Less] {
            for alpha in [0.25, REFERENCE, 0.75] {
                surface.clear_color([0.0; 4]);
                surface.clear_depth(0.75);
                surface.clear_stencil(3);
                let test = (compare, REFERENCE);
                fixed.draw_tested(&subject.bench, &surface, state, test, [1.0, 1.0, 1.0, alpha], &POSITIONS)?;
                let passes = compare.holds(alpha.total_cmp(&REFERENCE));
                let red = if passes && state.color_write { 255 } else { 0 };
                let depth = if passes && state.depth_write { 0.25 } else { 0.75 };
                let stencil = if passes && state.stencil.is_some() { 7 } else { 3 };
                let colors = surface.colors().into_iter().filter(|color| color[0] != red).count();
                let depths = surface.depths().into_iter().filter(|seen| (seen - depth).abs() > 1e-6).count();
                let stencils = surface.stencils().into_iter().filter(|seen| *seen != stencil).count();
                wrong += usize::from(colors + depths + stencils > 0);
                count += 1;
            }
        }
        findings.none_wrong(format!("GEQUAL and LESS, {name}"), wrong, count);
    }
    Ok(())
}
