//! GL-K13: exponents of highlights, up to the largest [GL 4.6 compatibility, 12.2.1.1].

use glam::{DMat4, DVec3};

use super::fixed;
use crate::conformance::bench::lit::{GlLight, GlLighting, LitDraw};
use crate::conformance::bench::{Error, GlFormat, GlState};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// GL-K13: a flat surface, the viewer far away along its normal, and a light beside it: (n . h)^s of the angle between.
pub fn exponents(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(pipeline) = fixed::pipeline(subject, findings, "exponents of highlights") else { return Ok(()) };
    let surface = subject.bench.surface([2, 2], Some(GlFormat::Rgba8), None)?;
    let positions = [[-1.0, -1.0, 0.0], [3.0, -1.0, 0.0], [-1.0, 3.0, 0.0]];
    let mut tally = GradeTally::default();
    for shininess in [0.0_f32, 0.5, 1.0, 7.0, 32.0, 63.0, 64.0, 65.0, 96.0, 127.0, 128.0] {
        for angle in [0.125_f32, 0.25, 0.5] {
            let lighting = GlLighting {
                scene_ambient: [0.0; 3],
                emission: [0.0; 3],
                ambient: [0.0; 3],
                diffuse: [0.0; 3],
                specular: [1.0, 0.5, 0.25],
                alpha: 1.0,
                shininess,
                lights: vec![GlLight {
                    position: [angle.sin(), 0.0, angle.cos(), 0.0],
                    ambient: [0.0; 3],
                    diffuse: [0.0; 3],
                    specular: [1.0; 3],
                    attenuation: [1.0, 0.0, 0.0],
                }],
            };
            surface.clear_color([0.0; 4]);
            let draw = LitDraw {
                surface: &surface,
                state: GlState { depth: None, ..GlState::WRITE },
                lighting: &lighting,
                scale: DVec3::ONE,
                offset: DVec3::ZERO,
                projection: DMat4::IDENTITY,
                positions: &positions,
                normals: &[[0.0, 0.0, 1.0]; 3],
            };
            pipeline.draw_lit(&subject.bench, &draw)?;
            // The half vector lies at half of the angle.
            let share = (f64::from(angle) / 2.0).cos().powf(f64::from(shininess));
            for color in surface.colors() {
                for (seen, part) in color.into_iter().zip([1.0, 0.5, 0.25]) {
                    let off = f64::from(seen) - 255.0 * part * share;
                    tally.add(verify::within(off, 1.0, 2.0), off);
                }
            }
        }
    }
    findings.tally("eleven exponents from 0 to 128, three angles", tally, "codes");
    Ok(())
}
