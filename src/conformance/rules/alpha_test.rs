//! GL-D6's part of the fixed-function pipeline: the alpha test [GL 4.6 compatibility, 17.3.2].

use super::fixed;
use crate::conformance::bench::fixed_function::FixedDraw;
use crate::conformance::bench::{Error, GlCompare, GlFormat, GlState, GlStencil, GlStencilOp, full};
use crate::conformance::{DriverUnderTest, Findings};

/// Eight functions on alphas below, at and above the reference: what fails leaves colour, depth and stencil alone.
pub fn leaves_alone(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = fixed::pipeline(subject, findings, "the alpha test") else { return Ok(()) };
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    let side = GlStencil { reference: 7, ..GlStencil::on_pass(GlStencilOp::Replace) };
    let state = GlState { depth: Some(GlCompare::Less), stencil: Some([side; 2]), ..GlState::WRITE };
    let vertices = full(-0.5);
    let (mut wrong, mut count) = (0, 0);
    for compare in GlCompare::ALL {
        for reference in [0.5_f32, 0.125, 0.0, 1.0] {
            for alpha in [0.25, reference, 0.75] {
                surface.clear_color([0.0; 4]);
                surface.clear_depth(0.75);
                surface.clear_stencil(3);
                let draw = FixedDraw {
                    color: [1.0, 1.0, 1.0, alpha],
                    alpha_test: Some((compare, reference)),
                    ..FixedDraw::plain(&surface, state, &vertices)
                };
                fixed.draw(&subject.bench, &draw)?;
                let (red, depth, stencil) =
                    if compare.holds(alpha.total_cmp(&reference)) { (255, 0.25, 7) } else { (0, 0.75, 3) };
                let colors = surface.colors().into_iter().filter(|color| color[0] != red).count();
                let depths = surface.depths().into_iter().filter(|seen| (seen - depth).abs() > 1e-6).count();
                let stencils = surface.stencils().into_iter().filter(|value| *value != stencil).count();
                wrong += usize::from(colors + depths + stencils > 0);
                count += 1;
            }
        }
    }
    findings.none_wrong("the alpha test, 8 functions", wrong, count);
    // Without the test all is drawn, even after one that nothing passes.
    let never = Some((GlCompare::Never, 0.5));
    fixed.draw(&subject.bench, &FixedDraw { alpha_test: never, ..FixedDraw::plain(&surface, state, &vertices) })?;
    surface.clear_color([0.0; 4]);
    surface.clear_depth(0.75);
    fixed.draw(
        &subject.bench,
        &FixedDraw { color: [1.0, 1.0, 1.0, 0.0], ..FixedDraw::plain(&surface, state, &vertices) },
    )?;
    let missed = surface.colors().into_iter().filter(|color| color[0] != 255).count();
    findings.none_wrong("alpha 0 without the alpha test", missed, 16);
    Ok(())
}
