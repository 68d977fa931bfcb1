//! GL-B4: blending into sRGB images: in linear values with FRAMEBUFFER_SRGB, in codes without [GL 4.6, 17.3.6, 17.3.7].

use super::copies::srgb;
use super::uploads::linear;
use crate::conformance::bench::{Error, GlBlend, GlEquation, GlFactor, GlFormat, GlState, Surface};
use crate::conformance::random::Random;
use crate::conformance::verify::{Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 16;
const COUNT: usize = (SIDE * SIDE) as usize;
const FETCH: &str = "result = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);";

/// Blending of a source (first) into a destination, a channel and its alphas.
type Due = fn([f64; 2], [f64; 2]) -> f64;

const CASES: [(&str, GlBlend, Due); 4] = [
    ("ONE, ONE", GlBlend::Add, |[source, stored], _| source + stored),
    ("DST_COLOR, ZERO", GlBlend::Multiply, |[source, stored], _| source * stored),
    ("DST_ALPHA, ONE", GlBlend::AddByStoredAlpha, |[source, stored], [_, alpha]| source * alpha + stored),
    (
        "SRC_ALPHA, ONE_MINUS_SRC_ALPHA",
        GlBlend::By(
            [GlFactor::SrcAlpha, GlFactor::OneMinusSrcAlpha, GlFactor::SrcAlpha, GlFactor::OneMinusSrcAlpha],
            GlEquation::Add,
        ),
        |[source, stored], [alpha, _]| source * alpha + stored * (1.0 - alpha),
    ),
];

/// GL-B4: each pixel has colours of its own, stored and blended.
pub fn blended(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Srgb8Alpha8), None)?;
    let mut random = Random::new(371);
    for encode in [true, false] {
        for (name, blend, due) in CASES {
            let tally = judge(subject, &surface, &mut random, (blend, due), encode)?;
            let how = if encode { "FRAMEBUFFER_SRGB" } else { "without FRAMEBUFFER_SRGB" };
            findings.tally(format!("{name}, {how}"), tally, "codes");
        }
    }
    Ok(())
}

fn judge(
    subject: &DriverUnderTest,
    surface: &Surface,
    random: &mut Random,
    (blend, due): (GlBlend, Due),
    encode: bool,
) -> Result<GradeTally, Error> {
    let mut colors = || (0..COUNT).map(|_| [(); 4].map(|()| random.unit())).collect::<Vec<_>>();
    let (stored, source) = (colors(), colors());
    let state = GlState { depth: None, encode_srgb: encode, ..GlState::WRITE };
    subject.bench.map_into(surface, state, FETCH, &stored, &[])?;
    let before = surface.colors();
    subject.bench.map_into(surface, GlState { blend: Some(blend), ..state }, FETCH, &source, &[])?;
    let mut tally = GradeTally::default();
    for (pixel, seen) in surface.colors().into_iter().enumerate() {
        let old = before[pixel].map(|code| f64::from(code) / 255.0);
        let new = source[pixel].map(f64::from);
        for channel in 0..4 {
            // Alpha is never encoded.
            let encoded = encode && channel < 3;
            let stored = if encoded { linear(old[channel]) } else { old[channel] };
            let result = due([new[channel], stored], [new[3], old[3]]);
            let (grade, off) = graded(f64::from(seen[channel]), result, encoded);
            tally.add(grade, off);
        }
    }
    Ok(tally)
}

/// Codes that two rounded products may be off, as GL-B3 has it.
const TWO_PRODUCTS: f64 = 2.0 + 1e-6;

/// A code for a blended value: strictly as GL-F4 has it; else what is stored may be decoded as coarsely as GL-U3 allows.
fn graded(code: f64, value: f64, encoded: bool) -> (Grade, f64) {
    let codes = |value: f64| {
        let value = value.clamp(0.0, 1.0);
        255.0 * if encoded { srgb(value) } else { value }
    };
    let off = code - codes(value);
    let slack = if encoded { 0.5 / 255.0 } else { 0.0 };
    let [low, high] = [codes(value - slack) - TWO_PRODUCTS, codes(value + slack) + TWO_PRODUCTS];
    let grade = match () {
        () if off.abs() <= 0.6 => Grade::Good,
        () if (low..=high).contains(&code) => Grade::Allowed,
        () => Grade::Wrong,
    };
    (grade, off)
}
