//! GL-D1 to GL-D4: how depths are stored, ranged and clamped [GL 4.6, 13.6.1, 13.8.1, 14.6.5, 15.2.3, 17.3.4].

use super::compare::fetched;
use super::coordinates::flat;
use crate::conformance::bench::{Error, GlCompare, GlDraw, GlFormat, GlOffset, GlState, Surface, full};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings, probe};

const FORMATS: [GlFormat; 3] = [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F];
const FRAGMENT_DEPTH: &str = "gl_FragDepth = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).x; result = vec4(0.0);";

/// A surface of `format` with these depths written by a shader, an input a pixel, and its stored depths.
fn written(subject: &DriverUnderTest, format: GlFormat, depths: &[f32]) -> Result<(Surface, Vec<f64>), Error> {
    let side = (depths.len() as f64).sqrt().ceil() as u32;
    let surface = subject.bench.surface([side; 2], None, Some(format))?;
    let inputs: Vec<_> = depths.iter().map(|&depth| [depth, 0.0, 0.0, 0.0]).collect();
    subject.bench.map_into(&surface, GlState::WRITE, FRAGMENT_DEPTH, &inputs, &[])?;
    let mut stored = surface.depths();
    stored.truncate(depths.len());
    Ok((surface, stored))
}

/// GL-D1: conversion to codes by a shader's depth and by a clear, and back by a fetch.
pub fn conversion(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(11);
    let mut depths: Vec<f32> = (0..4096).map(|_| random.unit()).collect();
    depths[..6].copy_from_slice(&[0.0, 1.0, 0.5, 1.0 / 65535.0, 65534.0 / 65535.0, 0.25]);
    for format in FORMATS.into_iter().chain([GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8]) {
        findings.part(|findings| {
            let (surface, stored) = written(subject, format, &depths)?;
            let Some(image) = surface.depth_image() else { return Ok(()) };
            let mut tally = GradeTally::default();
            for (stored, depth) in stored.iter().zip(&depths) {
                let depth = f64::from(*depth);
                let off = (stored - depth) / image.encoding.step(depth.max(1e-6));
                tally.add(verify::depth_code(*stored, depth, image.encoding), off);
            }
            findings.tally(format!("{}: a shader's depth", format.name()), tally, "codes");
            findings.tally(format!("{}: read by a shader", format.name()), fetched(subject, image)?, "of 2^-24");
            cleared(subject, findings, format)
        });
    }
    Ok(())
}

/// Clears against the same rule, and against a draw at the same depth.
fn cleared(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], None, Some(format))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let mut random = Random::new(12);
    // No sums of powers of two: their arithmetic would be exact in any order.
    let depths: Vec<f32> = [0.0, 1.0].into_iter().chain((0..126).map(|_| random.unit() / 1.1)).collect();
    let (mut tally, mut apart) = (GradeTally::default(), 0);
    for depth in depths.iter().copied().map(f64::from) {
        surface.clear_depth(depth);
        let stored = surface.depths()[5];
        let off = (stored - depth) / encoding.step(depth.max(1e-6));
        tally.add(verify::depth_code(stored, depth, encoding), off);
        apart += usize::from(probe::stored(&subject.bench, &surface, depth, 0.0)? != stored);
    }
    findings.tally(format!("{}: a cleared depth", format.name()), tally, "codes");
    let share = 100.0 * apart as f64 / depths.len() as f64;
    findings.fact(format!("{}: a draw is not where a clear is", format.name()), format!("{share:.0} % of depths"));
    Ok(())
}

/// Ranges of GL-D2: plain, inner, reversed, empty, and beyond [0, 1], which is clamped.
const RANGES: [[f64; 2]; 7] = [[0.0, 1.0], [0.25, 0.75], [0.75, 0.25], [1.0, 0.0], [0.1, 1.0], [0.5, 0.5], [-1.0, 2.0]];

/// GL-D2: what window depth a range makes of near, middle and far; and the ledge.
pub fn range(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in FORMATS {
        findings.part(|findings| {
            let surface = subject.bench.surface([4, 4], None, Some(format))?;
            let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
            let mut tally = GradeTally::default();
            for range in RANGES {
                for z in [-1.0_f32, -0.5, 0.0, 0.75, 1.0] {
                    let [near, far] = range.map(|end| end.clamp(0.0, 1.0));
                    let depth = (far - near) / 2.0 * f64::from(z) + (near + far) / 2.0;
                    let state = GlState { depth_range: range, ..GlState::WRITE };
                    subject.bench.draw(&GlDraw::plain(&surface, state, &full(z)))?;
                    let stored = surface.depths()[5];
                    let step = encoding.step(0.75);
                    // The ends need not be codes themselves, so that 0 and 1 alone must be met.
                    let exact = depth == 0.0 || depth == 1.0;
                    let strict = if exact { 0.0 } else { 1.0 };
                    let off = (stored - depth) / step;
                    tally.add(verify::within(off, strict, strict + 0.5), off);
                }
            }
            findings.tally(format!("{}: 7 ranges, 5 depths", format.name()), tally, "codes");
            ledge(subject, findings, &surface, format)
        });
    }
    Ok(())
}

/// A ledge drawn in (0, n) lies before a scene drawn in (n, 1), but for its very top.
fn ledge(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface, format: GlFormat) -> Result<(), Error> {
    let mut random = Random::new(21);
    let (mut wrong, mut overlaps, mut misses) = (0, 0, 0);
    const ROUNDS: usize = 64;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    for _ in 0..ROUNDS {
        let n = f64::from(random.between(0.05, 0.95));
        let draw = |range: [f64; 2], z: f32| {
            subject.bench.draw(&GlDraw::plain(surface, GlState { depth_range: range, ..GlState::WRITE }, &full(z)))?;
            Ok::<f64, Error>(surface.depths()[5])
        };
        let scene = draw([n, 1.0], -1.0)?;
        wrong += usize::from(draw([0.0, n], 0.99)? >= scene);
        let top = draw([0.0, n], 1.0)?;
        overlaps += usize::from(top > scene);
        misses += usize::from(((scene - n) / encoding.step(n)).abs() > 0.5 + 1e-6);
    }
    findings.none_wrong(format!("{}: a ledge before its scene", format.name()), wrong, ROUNDS);
    let percent = |count: usize| 100 * count / ROUNDS;
    let text = format!(
        "{} % behind the scene's near plane; that plane is off the nearest code in {} %",
        percent(overlaps),
        percent(misses)
    );
    findings.fact(format!("{}: a ledge's very top", format.name()), text);
    Ok(())
}

/// GL-D3: clamping to the range in place of clipping, after the offset and before the test.
pub fn clamp(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([4, 4], None, Some(format))?;
            let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
            let r = (probe::stored(&subject.bench, &surface, 0.35, 1024.0)?
                - probe::stored(&subject.bench, &surface, 0.35, 0.0)?)
                / 1024.0;
            let offset = GlOffset { factor: 0.0, units: (0.2 / r) as f32, clamp: 0.0 };
            // z = 0.35 in (0.2, 0.4).
            let inner = GlState { depth_range: [0.2, 0.4], offset: Some(offset), ..GlState::WRITE };
            let plain = GlState::WRITE;
            let cases = [
                ("offset beyond the range", inner, 0.5, Some(0.55)),
                ("offset beyond the range, clamped", GlState { depth_clamp: true, ..inner }, 0.5, Some(0.4)),
                ("beyond far", plain, 1.5, None),
                ("before near", plain, -1.5, None),
                ("beyond far, clamped", GlState { depth_clamp: true, ..plain }, 1.5, Some(1.0)),
                ("before near, clamped", GlState { depth_clamp: true, ..plain }, -1.5, Some(0.0)),
                (
                    "beyond far, clamped to a reversed range",
                    GlState { depth_clamp: true, depth_range: [0.75, 0.25], ..plain },
                    1.5,
                    Some(0.25),
                ),
            ];
            for (name, state, z, expected) in cases {
                surface.clear_depth(0.125);
                subject.bench.draw(&GlDraw::plain(&surface, state, &full(z)))?;
                let stored = surface.depths()[5];
                let due = expected.unwrap_or(0.125);
                // An offset of 0.2 is so many r, measured to a thousandth of one.
                let slack = if expected == Some(0.55) { 2e-4 } else { 1.5 * encoding.step(0.75) };
                let grade = verify::within(stored - due, slack, slack);
                findings.grade(format!("{}: {name}", format.name()), grade, format!("{stored:.6}; {due} is due"));
            }
            Ok(())
        });
    }
    Ok(())
}

/// GL-D4: a shader's depth is clamped to [0, 1], in float formats too.
pub fn fragment_clamp(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in FORMATS {
        findings.part(|findings| {
            let (_, stored) = written(subject, format, &[1.5, -1.0, 0.0, 1.0])?;
            let grade = if stored == [1.0, 0.0, 0.0, 1.0] { Grade::Good } else { Grade::Wrong };
            findings.grade(format.name(), grade, format!("1.5 is stored as {}, -1 as {}", stored[0], stored[1]));
            Ok(())
        });
    }
    Ok(())
}

/// GL-D5: the eight functions of the depth test, the fragment on the left.
pub fn test(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let (mut wrong, mut count) = (0, 0);
    let surface = subject.bench.surface([4, 4], None, Some(GlFormat::Depth24))?;
    for compare in GlCompare::ALL {
        for fragment in [0.25, 0.5, 0.75] {
            // Stored by a draw: a clear need not meet the same code.
            subject.bench.draw(&GlDraw::plain(&surface, GlState::WRITE, &flat(0.5)))?;
            let before = surface.depths()[5];
            let state = GlState { depth: Some(compare), ..GlState::WRITE };
            subject.bench.draw(&GlDraw::plain(&surface, state, &flat(fragment)))?;
            let written = surface.depths()[5];
            let passes = compare.holds(fragment.total_cmp(&0.5));
            let due = if passes { fragment } else { before };
            wrong += usize::from((written - due).abs() > 1e-5);
            count += 1;
        }
    }
    findings.none_wrong("8 functions, fragment nearer, equal, farther", wrong, count);
    Ok(())
}
