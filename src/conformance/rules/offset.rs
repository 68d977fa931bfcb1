//! GL-O1 and GL-O2: polygon offset [GL 4.6, 14.6.5].

use crate::conformance::bench::{
    Encoding, Error, GlCompare, GlDraw, GlFormat, GlOffset, GlPolygonMode, GlState, Surface, Vertex, rectangle,
};
use crate::conformance::probe::{self, MeasuredDepth};
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// GL-O1: r, m, their sum and its clamp.
pub fn offset(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::DEPTHS {
        findings.part(|findings| unit(subject, findings, format));
    }
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            linear(subject, findings, format)?;
            slope(subject, findings, format)?;
            flat_factor(subject, findings, format)
        });
    }
    findings.part(|findings| clamp(subject, findings));
    Ok(())
}

/// One unit of each format.
fn unit(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let facts = probe::facts(&subject.bench, format)?;
    let Some(measured) = facts.measured else {
        findings.untestable(format.name(), format!("refused: {}", facts.refusal.unwrap_or_default()));
        return Ok(());
    };
    let MeasuredDepth { units: [far, near], one_unit_shows, float, .. } = measured;
    let power = |depth: f64| format!("2^{:.2}", depth.log2());
    let text = format!(
        "{} ({:.2} steps) at {}, {} ({:.2} steps) at {}",
        power(far.depth),
        far.codes,
        far.at_depth,
        power(near.depth),
        near.codes,
        near.at_depth
    );
    findings.fact(format!("{}: r, one unit of polygon offset", format.name()), text.clone());
    let grade = verify::offset_unit(far.codes).max(verify::offset_unit(near.codes));
    let kind = if float { "2^(e-23)" } else { "the least step" };
    findings.grade(format!("{}: r against {kind}", format.name()), grade, text);
    let measured = if one_unit_shows { "moves every depth that was tried" } else { "leaves the stored depth as it is" };
    findings.must_hold(format!("{}: one unit", format.name()), one_unit_shows, measured);
    Ok(())
}

/// A flat surface's offset is so many units, to a code.
fn linear(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], None, Some(format))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    const AT: f64 = 0.625;
    let stored = |units: f32| probe::stored(&subject.bench, &surface, AT, units);
    let zero = stored(0.0)?;
    let r = (stored(4096.0)? - zero) / 4096.0;
    let mut tally = GradeTally::default();
    for units in [1.0_f32, 2.0, 3.0, 16.0, 100.0, -1.0, -16.0] {
        let off = (stored(units)? - zero - f64::from(units) * r) / encoding.step(AT);
        tally.add(verify::within(off, 0.5, 1.0 + 1e-6), off);
    }
    findings.tally(format!("{}: units add up", format.name()), tally, "steps");
    Ok(())
}

/// The window depth of slanted quads, with slopes a pixel along x and y, at the middle of the surface.
const SIDE: u32 = 32;
const FACTOR: f32 = 4.0;

/// A quad over the whole surface with these slopes of window depth, 0.4 in the middle.
fn slanted(slope: [f64; 2]) -> [Vertex; 6] {
    rectangle([-1.0; 2], [1.0; 2], 0.0, [0.0; 4]).map(|mut vertex| {
        let [x, y] = [vertex.position[0], vertex.position[1]].map(|ndc| f64::from(ndc) * f64::from(SIDE) / 2.0);
        vertex.position[2] = ((0.4 + slope[0] * x + slope[1] * y) * 2.0 - 1.0) as f32;
        vertex
    })
}

/// The depth that is stored of a slanted quad at the middle.
fn slanted_depth(
    subject: &DriverUnderTest,
    surface: &Surface,
    slope: [f64; 2],
    offset: Option<GlOffset>,
) -> Result<f64, Error> {
    let state = GlState { offset, ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(surface, state, &slanted(slope)))?;
    let middle = SIDE as i32 / 2;
    Ok(surface.depths_in([middle, middle, 1, 1])[0])
}

/// m of slopes along x, y and both; which norm it is.
fn slope(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(format))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let mut tally = GradeTally::default();
    let mut diagonal = 0.0;
    const S: f64 = 0.01;
    for slope in [[S, 0.0], [0.0, S], [S, S], [-S, 0.0], [S, -S], [S, S / 2.0]] {
        for sign in [1.0, -1.0] {
            let offset = GlOffset { factor: sign * FACTOR, units: 0.0, clamp: 0.0 };
            let moved = slanted_depth(subject, &surface, slope, Some(offset))?;
            let m = (moved - slanted_depth(subject, &surface, slope, None)?) / f64::from(offset.factor);
            let ideal = slope[0].abs().max(slope[1].abs());
            // The stored value is a code: m is known to half a code each, over the factor.
            let code = encoding.step(0.75) / f64::from(FACTOR);
            let grades = [m - code, m, m + code].map(|m| verify::offset_slope(m, slope));
            let best = grades.into_iter().min().unwrap_or(Grade::Wrong);
            tally.add(best, m / ideal - 1.0);
            if slope == [S, S] {
                diagonal = m / S;
            }
        }
    }
    findings.tally(format!("{}: m of 6 slopes, both signs", format.name()), tally, "of the larger slope");
    let norm = match () {
        () if (diagonal - 1.0_f64).abs() < 0.02 => "the larger slope".to_owned(),
        () if (diagonal - 2f64.sqrt()).abs() < 0.02 => "the length of both slopes".to_owned(),
        () => format!("{diagonal:.3} of the larger slope on a diagonal"),
    };
    findings.fact(format!("{}: m is", format.name()), norm);
    Ok(())
}

/// A factor alone leaves what faces the viewer where it is.
fn flat_factor(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(format))?;
    surface.clear_color([0.0; 4]);
    let quad = rectangle([-1.0; 2], [1.0; 2], 0.3, [1.0; 4]);
    subject.bench.draw(&GlDraw::plain(&surface, GlState { color_write: false, ..GlState::WRITE }, &quad))?;
    let offset = GlOffset { factor: FACTOR, units: 0.0, clamp: 0.0 };
    let state = GlState { depth: Some(GlCompare::Equal), offset: Some(offset), ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(&surface, state, &quad))?;
    let colors = surface.colors();
    let missed = colors.iter().filter(|color| color[0] != 255).count();
    findings.none_wrong(format!("{}: a factor on a flat surface, EQUAL", format.name()), missed, colors.len());
    Ok(())
}

/// glPolygonOffsetClamp, of both signs; and what the range does to the sum.
fn clamp(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth24))?;
    let slope = [0.02, 0.0];
    let plain = slanted_depth(subject, &surface, slope, None)?;
    let moved = |factor: f32, clamp: f32| {
        Ok::<f64, Error>(slanted_depth(subject, &surface, slope, Some(GlOffset { factor, units: 0.0, clamp }))? - plain)
    };
    if subject.bench.has_offset_clamp() {
        let cases = [
            (5.0, 0.05, 0.05),
            (-5.0, -0.05, -0.05),
            (5.0, 0.5, 0.1),
            (5.0, 0.0, 0.1),
            // A positive clamp is an upper bound alone, a negative one a lower bound.
            (-5.0, 0.05, -0.1),
            (5.0, -0.05, 0.1),
            (-5.0, 0.0, -0.1),
        ];
        for (factor, clamp, due) in cases {
            let moved = moved(factor, clamp)?;
            let grade = verify::within(moved - due, 1e-4, 1e-3);
            findings.grade(format!("offset of {due:.2} at most, by a clamp of {clamp}"), grade, format!("{moved:.4}"));
        }
    } else {
        findings.untestable("the offset's clamp", "neither OpenGL 4.6 nor ARB_polygon_offset_clamp");
    }
    for (factor, due) in [(500.0, 1.0), (-500.0, 0.0)] {
        let stored = plain + moved(factor, 0.0)?;
        findings.must_hold(format!("an offset beyond {due}"), stored == due, format!("{stored} is stored"));
    }
    Ok(())
}

/// Units of GL-O2's offset, and of the one that the size of a unit is found by.
const UNITS: f32 = 64.0;
const MANY_UNITS: f32 = 1024.0;

/// GL-O2: the offset of filled and of outlined polygons, by side: a side is moved where the offset is on for its mode. Each
/// pair of modes has the unit that is measured there; whether all have the same is one question of its own.
pub fn modes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use GlPolygonMode::{Fill, Line};
    let surface = subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth24))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let mut units = Vec::new();
    for mode in [[Fill, Fill], [Line, Line], [Fill, Line], [Line, Fill]] {
        let name = format!("front {:?}, back {:?}", mode[0], mode[1]);
        if mode[0] != mode[1] && !subject.bench.is_compatible() {
            findings.untestable(name, "a core context has one mode for both sides");
            continue;
        }
        for side in [0, 1] {
            let moved = |units, offset_modes| {
                let state = GlState { mode, offset_modes, ..GlState::WRITE };
                moved(subject, &surface, GlOffset { factor: 0.0, units, clamp: 0.0 }, state, side == 1, encoding)
            };
            let unit = moved(MANY_UNITS, [true; 2])? / f64::from(MANY_UNITS);
            units.push((name.clone(), unit / encoding.step(0.75)));
            for offset_modes in [[true, true], [true, false], [false, true]] {
                let due = if offset_modes[usize::from(mode[side] == Line)] { UNITS } else { 0.0 };
                let on = match offset_modes {
                    [true, true] => "fill and line",
                    [true, false] => "fill",
                    _ => "line",
                };
                let what = format!("{name}: the {} with an offset for {on}", ["front", "back"][side]);
                let moved = moved(UNITS, offset_modes)? / unit;
                let grade = verify::offset_moves(moved, f64::from(due), encoding.step(0.75) / unit);
                findings.grade(what, grade, format!("moved by {moved:.1} units; {due} is due"));
            }
        }
    }
    one_unit(findings, &units);
    Ok(())
}

/// r is a constant of the depth buffer, whatever is drawn: `units` in steps, the first of filled polygons.
fn one_unit(findings: &mut Findings, units: &[(String, f64)]) {
    let Some((_, filled)) = units.first() else { return };
    let most = units.iter().max_by(|a, b| (a.1 - filled).abs().total_cmp(&(b.1 - filled).abs()));
    let Some((name, most)) = most else { return };
    // Each is a difference of codes over so many units.
    let same = (most - filled).abs() <= 4.0 / f64::from(MANY_UNITS);
    let measured = match same {
        true => format!("{filled:.2} steps everywhere"),
        false => format!("{most:.2} steps with {name}, {filled:.2} where both sides are filled"),
    };
    findings.must_hold("one unit of outlined polygons is one of filled ones", same, measured);
}

/// By how much an offset moves a side's depths; where they disagree, the least.
fn moved(
    subject: &DriverUnderTest,
    surface: &Surface,
    offset: GlOffset,
    state: GlState,
    turned: bool,
    encoding: Encoding,
) -> Result<f64, Error> {
    const Z: f32 = 0.25;
    let mut quad = rectangle([-0.5; 2], [0.5; 2], Z, [0.0; 4]);
    if turned {
        quad.reverse();
    }
    let flat = probe::stored(&subject.bench, surface, f64::from(Z + 1.0) / 2.0, 0.0)?;
    surface.clear_depth(0.0);
    subject.bench.draw(&GlDraw::plain(surface, GlState { offset: Some(offset), ..state }, &quad))?;
    let drawn = surface.depths().into_iter().filter(|depth| *depth > encoding.step(0.75));
    Ok(drawn.fold(f64::INFINITY, f64::min) - flat)
}
