//! GL-O3: polygon offset under depth ranges, of slanted polygons in floats, of points, and its plain call [GL 4.6, 14.6.5].

use crate::conformance::bench::{
    Error, GlDraw, GlFormat, GlOffset, GlPolygonMode, GlState, Surface, Vertex, full, rectangle, triangle,
};
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 16;

/// Depths with and without the offset; what was drawn in both.
fn moved(
    subject: &DriverUnderTest,
    surface: &Surface,
    state: GlState,
    offset: GlOffset,
    vertices: &[Vertex],
) -> Result<Vec<[f64; 2]>, Error> {
    let depths = |offset| {
        surface.clear_depth(0.0);
        subject.bench.draw(&GlDraw::plain(surface, GlState { offset, ..state }, vertices))?;
        Ok::<_, Error>(surface.depths())
    };
    let (plain, offset) = (depths(None)?, depths(Some(offset))?);
    Ok(plain.into_iter().zip(offset).filter(|(plain, _)| *plain > 0.0).map(|(plain, offset)| [plain, offset]).collect())
}

/// GL-O3: the offset where it is not a flat polygon's in [0, 1].
pub fn planes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth24Stencil8, GlFormat::Depth32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIDE; 2], None, Some(format))?;
            units(subject, findings, &surface, format)?;
            factors(subject, findings, &surface, format)
        });
    }
    findings.part(|findings| slanted_floats(subject, findings));
    findings.part(|findings| points(subject, findings));
    Ok(())
}

const RANGES: [[f64; 2]; 4] = [[0.0, 1.0], [0.5, 0.75], [0.75, 0.5], [0.0, 0.5]];

/// Units are of the stored depth, whatever the range; by both calls.
fn units(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface, format: GlFormat) -> Result<(), Error> {
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    const UNITS: f32 = 512.0;
    let mut tally = GradeTally::default();
    for depth_range in RANGES {
        for (units, short_calls) in [(UNITS, false), (UNITS, true), (-UNITS, true)] {
            // A flat polygon at the middle of [0.5, 0.75], or at the same depth of another range.
            let z = (0.625 - (depth_range[0] + depth_range[1]) / 2.0) * 2.0 / (depth_range[1] - depth_range[0]);
            if z.abs() > 1.0 {
                continue;
            }
            let state = GlState { depth_range, short_calls, ..GlState::WRITE };
            let offset = GlOffset { factor: 0.0, units, clamp: 0.0 };
            for [plain, moved] in moved(subject, surface, state, offset, &full(z as f32))? {
                let steps = (moved - plain) / f64::from(units) / encoding.step(0.625);
                // Both depths round to a code.
                let slack = 1.0 / f64::from(UNITS);
                let grades = [steps - slack, steps, steps + slack].map(verify::offset_unit);
                tally.add(grades.into_iter().min().unwrap_or(Grade::Wrong), steps);
            }
        }
    }
    findings.tally(format!("{}: 512 units under 4 depth ranges", format.name()), tally, "steps a unit, which is");
    Ok(())
}

/// The factor's slope is that of window depth, which a range scales.
fn factors(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    format: GlFormat,
) -> Result<(), Error> {
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let mut tally = GradeTally::default();
    for depth_range in RANGES {
        for factor in [3.0_f32, -3.0] {
            let scale = (depth_range[1] - depth_range[0]) / 2.0;
            let [a, b] = [0.25_f64, 0.125];
            let vertices = full(0.0).map(|mut vertex| {
                vertex.position[2] = (a as f32) * vertex.position[0] + (b as f32) * vertex.position[1];
                vertex
            });
            let slope = [a, b].map(|slope| slope * scale * 2.0 / f64::from(SIDE));
            let state = GlState { depth_range, short_calls: factor < 0.0, ..GlState::WRITE };
            let offset = GlOffset { factor, units: 0.0, clamp: 0.0 };
            for [plain, moved] in moved(subject, surface, state, offset, &vertices)? {
                let m = (moved - plain) / f64::from(factor);
                // Two codes of which each may round.
                let code = encoding.step(0.75) / 3.0;
                let grades = [m - code, m, m + code].map(|m| verify::offset_slope(m, slope));
                tally.add(grades.into_iter().min().unwrap_or(Grade::Wrong), 0.0);
            }
        }
    }
    findings.tally(format!("{}: factor 3 under 4 depth ranges", format.name()), tally, "");
    Ok(())
}

/// The r of floats is 2^(e - 23) by the greatest depth of the primitive, at each of its pixels. The triangle is not clipped:
/// what clipping leaves is a primitive too.
fn slanted_floats(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth32F))?;
    const UNITS: f32 = 4096.0;
    for (name, low, high) in
        [("1/16 to 7/8", 0.0625, 0.875), ("1/16 to 3/16", 0.0625, 0.1875), ("1/4 to 7/16", 0.25, 0.4375)]
    {
        let mut tally = GradeTally::default();
        let ndc = |depth: f64| (2.0 * depth - 1.0) as f32;
        let vertices = triangle([[-1.0, -1.0, ndc(low), 1.0], [1.0, -1.0, ndc(high), 1.0], [-1.0, 1.0, ndc(low), 1.0]]);
        let r = (f64::log2(high).floor() - 23.0).exp2();
        let offset = GlOffset { factor: 0.0, units: UNITS, clamp: 0.0 };
        for [plain, moved] in moved(subject, &surface, GlState::WRITE, offset, &vertices)? {
            let units = (moved - plain) / f64::from(UNITS) / r;
            tally.add(verify::offset_unit(units), units);
        }
        findings.tally(format!("DEPTH_COMPONENT32F: r of a triangle from {name}"), tally, "of 2^(e-23), which is");
    }
    Ok(())
}

/// Polygons drawn as points: moved where POLYGON_OFFSET_POINT is on, and not where the others are alone.
fn points(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth24))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let offset = GlOffset { factor: 0.0, units: 1024.0, clamp: 0.0 };
    // Corners in the middle of pixels.
    let [low, high] = [-0.5 + 1.0 / 16.0, 0.5 + 1.0 / 16.0];
    let quad = rectangle([low; 2], [high; 2], 0.25, [0.0; 4]);
    for (name, mode, modes, on, due) in [
        ("points by POLYGON_OFFSET_POINT", GlPolygonMode::Point, [false; 2], true, true),
        ("points by FILL and LINE", GlPolygonMode::Point, [true; 2], false, false),
        ("a filled polygon by POLYGON_OFFSET_POINT", GlPolygonMode::Fill, [false; 2], true, false),
    ] {
        let state = GlState { mode: [mode; 2], offset_modes: modes, offset_points: on, ..GlState::WRITE };
        let pairs = moved(subject, &surface, state, offset, &quad)?;
        let (least, most) = pairs
            .iter()
            .map(|[plain, moved]| (moved - plain) / encoding.step(0.625) / 1024.0)
            .fold((f64::MAX, f64::MIN), |(low, high), steps| (low.min(steps), high.max(steps)));
        let grade = match due {
            _ if pairs.is_empty() => Grade::Wrong,
            true => verify::offset_unit(least).max(verify::offset_unit(most)),
            false => verify::within(least.abs().max(most.abs()), 0.0, 0.0),
        };
        findings.grade(name, grade, format!("{} pixels, moved by {least:.3} to {most:.3} steps a unit", pairs.len()));
    }
    Ok(())
}
