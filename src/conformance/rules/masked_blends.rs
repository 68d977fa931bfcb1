//! GL-K5: what a colour mask keeps from being written is read as a factor all the same [GL 4.6, 17.3.6, 17.4.2].

use crate::conformance::bench::{Error, GlBlend, GlDraw, GlEquation, GlFactor, GlFormat, GlState, Vertex, full};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Eighths: sums and products of floats are exact.
const SOURCE: [f64; 4] = [0.25, 0.5, 0.75, 0.375];
const STORED: [f64; 4] = [0.5, 0.125, 0.25, 0.625];
const RGB: [bool; 4] = [true, true, true, false];
const ALPHA: [bool; 4] = [false, false, false, true];
const WITHOUT_RED: [bool; 4] = [false, true, true, true];
/// Channels that are written, and the factors of source and destination. Few: drivers may compile code for each.
const CASES: [([bool; 4], [GlFactor; 2]); 7] = [
    (RGB, [GlFactor::DstAlpha, GlFactor::One]),
    (RGB, [GlFactor::One, GlFactor::OneMinusDstAlpha]),
    (RGB, [GlFactor::SrcAlpha, GlFactor::OneMinusSrcAlpha]),
    (RGB, [GlFactor::DstColor, GlFactor::Zero]),
    (ALPHA, [GlFactor::OneMinusDstAlpha, GlFactor::One]),
    (WITHOUT_RED, [GlFactor::DstColor, GlFactor::SrcColor]),
    (WITHOUT_RED, [GlFactor::OneMinusDstColor, GlFactor::OneMinusSrcColor]),
];

fn factor(factor: GlFactor, channel: usize) -> f64 {
    match factor {
        GlFactor::Zero => 0.0,
        GlFactor::One => 1.0,
        GlFactor::SrcColor => SOURCE[channel],
        GlFactor::OneMinusSrcColor => 1.0 - SOURCE[channel],
        GlFactor::DstColor => STORED[channel],
        GlFactor::OneMinusDstColor => 1.0 - STORED[channel],
        GlFactor::SrcAlpha => SOURCE[3],
        GlFactor::OneMinusSrcAlpha => 1.0 - SOURCE[3],
        GlFactor::DstAlpha => STORED[3],
        GlFactor::OneMinusDstAlpha => 1.0 - STORED[3],
    }
}

/// GL-K5: factors of source and destination under masks, in bytes and in floats.
pub fn masked(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    // A channel of bytes: the stored code, two products and a sum, each half a code off, else one and a half.
    for (format, bounds) in [(GlFormat::Rgba8, [1.5 / 255.0, 2.5 / 255.0]), (GlFormat::Rgba32F, [0.0; 2])] {
        findings.part(|findings| {
            let surface = subject.bench.surface([1, 1], Some(format), None)?;
            let mut tally = GradeTally::default();
            let color = SOURCE.map(|value| value as f32);
            let vertices = full(0.0).map(|vertex| Vertex { value: color, ..vertex });
            for (channels, pair) in CASES {
                surface.clear_color(STORED.map(|value| value as f32));
                let blend = GlBlend::By([pair[0], pair[1], pair[0], pair[1]], GlEquation::Add);
                let state = GlState { depth: None, blend: Some(blend), channels, ..GlState::WRITE };
                subject.bench.draw(&GlDraw::plain(&surface, state, &vertices))?;
                let most = if format == GlFormat::Rgba8 { 1.0 } else { f64::INFINITY };
                let seen = surface.floats()[0];
                for channel in 0..4 {
                    let sum = SOURCE[channel] * factor(pair[0], channel) + STORED[channel] * factor(pair[1], channel);
                    let due = if channels[channel] { sum.min(most) } else { STORED[channel] };
                    let off = f64::from(seen[channel]) - due;
                    tally.add(verify::within(off, bounds[0], bounds[1]), off * 255.0);
                }
            }
            findings.tally(format!("{}, factors under masks", format.name()), tally, "codes");
            Ok(())
        });
    }
    Ok(())
}
