//! GL-B3: every blend factor and equation, on 8 bits and on floats, RGB and alpha by factors of their own [GL 4.6, 17.3.6].

use crate::conformance::bench::{
    Error, GlBlend, GlDraw, GlEquation, GlFactor, GlFormat, GlState, Surface, Vertex, rectangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side; each has a source and a destination of its own.
const SIDE: usize = 12;

type Color = [f64; 4];

/// Value of a factor for a channel.
fn factor(factor: GlFactor, source: Color, destination: Color, channel: usize) -> f64 {
    match factor {
        GlFactor::Zero => 0.0,
        GlFactor::One => 1.0,
        GlFactor::SrcColor => source[channel],
        GlFactor::OneMinusSrcColor => 1.0 - source[channel],
        GlFactor::DstColor => destination[channel],
        GlFactor::OneMinusDstColor => 1.0 - destination[channel],
        GlFactor::SrcAlpha => source[3],
        GlFactor::OneMinusSrcAlpha => 1.0 - source[3],
        GlFactor::DstAlpha => destination[3],
        GlFactor::OneMinusDstAlpha => 1.0 - destination[3],
    }
}

/// The result, and the sum of its terms' magnitudes, of which roundings are a share.
fn due(factors: [GlFactor; 4], equation: GlEquation, source: Color, destination: Color, channel: usize) -> [f64; 2] {
    let [first, second] = if channel == 3 { [factors[2], factors[3]] } else { [factors[0], factors[1]] };
    let (s, d) = (source[channel], destination[channel]);
    let terms = [first, second].map(|name| factor(name, source, destination, channel));
    let (a, b) = (s * terms[0], d * terms[1]);
    let value = match equation {
        GlEquation::Add => a + b,
        GlEquation::Subtract => a - b,
        GlEquation::ReverseSubtract => b - a,
        GlEquation::Min => s.min(d),
        GlEquation::Max => s.max(d),
    };
    [value, a.abs() + b.abs() + s.abs() + d.abs()]
}

fn cells(colors: &[[f32; 4]]) -> Vec<Vertex> {
    let edge = |index: usize| index as f32 * 2.0 / SIDE as f32 - 1.0;
    let cell = |(index, color): (usize, &[f32; 4])| {
        let [x, y] = [index % SIDE, index / SIDE];
        rectangle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)], 0.0, *color)
    };
    colors.iter().enumerate().flat_map(cell).collect()
}

/// Sources and destinations: codes of 8 bits, or floats that a clamp would change.
struct Colors {
    source: Vec<[f32; 4]>,
    destination: Vec<[f32; 4]>,
}

impl Colors {
    fn random(floats: bool) -> Self {
        let mut random = Random::new(361);
        let mut colors = || {
            let mut channel = || match floats {
                true => random.between(-2.0, 4.0),
                false => (random.unit() * 256.0).floor() / 255.0,
            };
            (0..SIDE * SIDE).map(|_| [(); 4].map(|()| channel())).collect()
        };
        Self { source: colors(), destination: colors() }
    }
}

/// GL-B3: each factor in each place, each pair that renderers use, each equation.
pub fn factors(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Rgba8, GlFormat::Rgba32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIDE as u32; 2], Some(format), None)?;
            let colors = Colors::random(format == GlFormat::Rgba32F);
            let run = |cases: &[([GlFactor; 4], GlEquation)]| {
                let mut tally = GradeTally::default();
                for (factors, equation) in cases {
                    blended(subject, &surface, &colors, *factors, *equation, &mut tally)?;
                }
                Ok::<_, Error>(tally)
            };
            let unit = if format == GlFormat::Rgba8 { "codes" } else { "of the terms" };
            for (name, cases) in cases() {
                findings.tally(format!("{}: {name}", format.name()), run(&cases)?, unit);
            }
            Ok(())
        });
    }
    Ok(())
}

type Cases = Vec<([GlFactor; 4], GlEquation)>;

fn cases() -> [(&'static str, Cases); 3] {
    use GlFactor::{DstAlpha, DstColor, One, OneMinusSrcAlpha, SrcAlpha, Zero};
    let all = GlFactor::ALL;
    let next = |index: usize, by: usize| all[(index + by) % all.len()];
    let add = |factors| (factors, GlEquation::Add);
    let used = [
        [One, One, Zero, One],
        [SrcAlpha, OneMinusSrcAlpha, Zero, One],
        [One, OneMinusSrcAlpha, One, OneMinusSrcAlpha],
        [DstAlpha, One, Zero, One],
        [DstColor, Zero, Zero, One],
        [DstColor, Zero, One, Zero],
        [One, One, One, One],
        [One, Zero, One, Zero],
        [Zero, One, Zero, One],
        [SrcAlpha, One, One, Zero],
    ];
    [
        ("pairs that renderers use", used.map(add).to_vec()),
        (
            "each factor in each place",
            (0..10).map(|index| add([all[index], next(index, 3), next(index, 1), next(index, 4)])).collect(),
        ),
        ("each equation", GlEquation::ALL.map(|equation| ([SrcAlpha, DstColor, One, DstAlpha], equation)).to_vec()),
    ]
}

fn blended(
    subject: &DriverUnderTest,
    surface: &Surface,
    colors: &Colors,
    factors: [GlFactor; 4],
    equation: GlEquation,
    tally: &mut GradeTally,
) -> Result<(), Error> {
    let plain = GlState { depth: None, ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(surface, plain, &cells(&colors.destination)))?;
    let blend = Some(GlBlend::By(factors, equation));
    subject.bench.draw(&GlDraw::plain(surface, GlState { blend, ..plain }, &cells(&colors.source)))?;
    let is_float = surface.color_image().is_some_and(|image| image.format == GlFormat::Rgba32F);
    let seen: Vec<Color> = match is_float {
        true => surface.floats().into_iter().map(|color| color.map(f64::from)).collect(),
        false => surface.colors().into_iter().map(|color| color.map(|code| f64::from(code) / 255.0)).collect(),
    };
    for (pixel, seen) in seen.into_iter().enumerate() {
        let [source, destination] = [&colors.source, &colors.destination].map(|colors| colors[pixel].map(f64::from));
        for (channel, seen) in seen.into_iter().enumerate() {
            let [value, terms] = due(factors, equation, source, destination, channel);
            if is_float {
                // Products and sums in f32: some roundings of the terms; half floats' worth is allowed.
                let off = (seen - value) / terms.max(1.0);
                tally.add(verify::within(off, 4e-7, 1.0 / 1024.0), off);
            } else {
                let off = (seen - value.clamp(0.0, 1.0)) * 255.0;
                // Each of two products may round by itself.
                tally.add(verify::within(off, 1.0, 2.0), off);
            }
        }
    }
    Ok(())
}
