//! GL-F13: sums in targets of floats [GL 4.6, 17.3.6, 2.3.4].

use crate::conformance::bench::{Error, GlBlend, GlDraw, GlFormat, GlState, full};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// GL-F13: sums of many layers; above 1 and below 0 nothing is clamped.
pub fn sums(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for (format, bits) in [(GlFormat::Rgba32F, 23), (GlFormat::Rgba16F, 10)] {
        findings.part(|findings| {
            let surface = subject.bench.surface([4, 4], Some(format), None)?;
            surface.clear_color([0.0, 0.0, 0.0, 1.0]);
            let mut random = Random::new(401);
            let state = GlState { depth: None, blend: Some(GlBlend::Add), ..GlState::WRITE };
            let (mut sum, mut bound) = ([0.0, 0.0, 0.0, 1.0_f64], [0.0_f64; 4]);
            for _ in 0..24 {
                // Sixteenths: exact in either format.
                let mut color = [(); 4].map(|()| (random.between(-8.0, 24.0)).floor() / 16.0);
                // Blue is no dyadic number: each sum rounds.
                color[2] = random.unit();
                let vertices = full(0.0).map(|vertex| crate::conformance::bench::Vertex { value: color, ..vertex });
                subject.bench.draw(&GlDraw::plain(&surface, state, &vertices))?;
                for channel in 0..4 {
                    sum[channel] += f64::from(color[channel]);
                    // One step of the format at that size for each sum, and one for what is added.
                    let size = sum[channel].abs().max(1.0).log2().floor();
                    bound[channel] += 2.0 * (size - f64::from(bits)).exp2();
                }
            }
            let (mut exact, mut rounded) = (GradeTally::default(), GradeTally::default());
            for color in surface.floats() {
                for channel in [0, 1, 3] {
                    let off = f64::from(color[channel]) - sum[channel];
                    exact.add(verify::within(off, 0.0, 0.0), off);
                }
                let off = f64::from(color[2]) - sum[2];
                rounded.add(verify::within(off, 0.5 * bound[2], bound[2]), off);
            }
            findings.tally(format!("{}: 24 layers of sixteenths", format.name()), exact, "");
            findings.tally(format!("{}: 24 layers that round", format.name()), rounded, "");
            Ok(())
        });
    }
    Ok(())
}
