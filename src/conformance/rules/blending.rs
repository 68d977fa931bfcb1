//! GL-F5: blending by the stored alpha, with factors of alpha's own [GL 4.6, 17.3.6].

use crate::conformance::bench::{Error, GlBlend, GlDraw, GlFormat, GlState, Surface, Vertex, rectangle};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side; each has colours of its own.
const SIDE: usize = 32;

/// A random colour of codes for each pixel.
fn colors(random: &mut Random) -> Vec<[f64; 4]> {
    (0..SIDE * SIDE).map(|_| [(); 4].map(|()| f64::from((random.unit() * 256.0).floor()))).collect()
}

/// A rectangle for each pixel.
fn cells(colors: &[[f64; 4]]) -> Vec<Vertex> {
    let edge = |index: usize| index as f32 * 2.0 / SIDE as f32 - 1.0;
    let cell = |(index, color): (usize, &[f64; 4])| {
        let [x, y] = [index % SIDE, index / SIDE];
        let value = color.map(|code| (code / 255.0) as f32);
        rectangle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)], 0.0, value)
    };
    colors.iter().enumerate().flat_map(cell).collect()
}

fn draw(
    subject: &DriverUnderTest,
    surface: &Surface,
    blend: Option<GlBlend>,
    colors: &[[f64; 4]],
) -> Result<(), Error> {
    let state = GlState { depth: None, blend, ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(surface, state, &cells(colors)))
}

/// GL-F5: the stored alpha as a factor, and a product that leaves it alone.
pub fn stored_alpha(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), None)?;
    let mut random = Random::new(17);
    let [first, second, third] = [(); 3].map(|()| colors(&mut random));
    let tally = |channels: &[usize], seen: &[[u8; 4]], bounds: [f64; 2], due: &dyn Fn(usize, usize) -> f64| {
        let mut tally = GradeTally::default();
        for (pixel, seen) in seen.iter().enumerate() {
            for channel in channels {
                let off = f64::from(seen[*channel]) - due(pixel, *channel).min(255.0);
                tally.add(verify::within(off, bounds[0], bounds[1]), off);
            }
        }
        tally
    };
    // A product rounds to the nearest code, or to a code and a half as GL-F4 allows; what is only copied is exact.
    let product = [0.5 + 1e-4, 1.5];
    draw(subject, &surface, None, &first)?;
    draw(subject, &surface, Some(GlBlend::AddByStoredAlpha), &second)?;
    let due = |pixel: usize, channel: usize| first[pixel][channel] + second[pixel][channel] * first[pixel][3] / 255.0;
    let added = tally(&[0, 1, 2, 3], &surface.colors(), product, &due);
    findings.tally("DST_ALPHA, ONE", added, "codes");

    draw(subject, &surface, None, &first)?;
    draw(subject, &surface, Some(GlBlend::MultiplyRgb), &second)?;
    let multiplied = surface.colors();
    let due = |pixel: usize, channel: usize| first[pixel][channel] * second[pixel][channel] / 255.0;
    findings.tally("DST_COLOR, ZERO for RGB", tally(&[0, 1, 2], &multiplied, product, &due), "codes");
    let kept = tally(&[3], &multiplied, [0.0; 2], &|pixel, _| second[pixel][3]);
    findings.tally("ONE, ZERO for alpha beside it", kept, "codes");

    // Light, then the decal with gloss in alpha, then highlights: both products round.
    draw(subject, &surface, Some(GlBlend::AddByStoredAlpha), &third)?;
    let due = |pixel: usize, channel: usize| {
        let [light, decal, highlight] = [&first, &second, &third].map(|colors| colors[pixel][channel]);
        (light * decal + highlight * second[pixel][3]) / 255.0
    };
    let three = tally(&[0, 1, 2], &surface.colors(), product.map(|bound| 2.0 * bound), &due);
    findings.tally("three passes: light, decal with gloss in alpha, highlights by DST_ALPHA, ONE", three, "codes");
    Ok(())
}
