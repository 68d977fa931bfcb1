//! GL-G1: dFdx, dFdy and fwidth [GLSL 4.60, 8.14.1].

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, Shader, Surface, Vertex, full};
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 16;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// GL-G1: derivatives of what is linear, of a curve, and of vectors.
pub fn derivatives(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    linear(subject, findings, &surface)?;
    curve(subject, findings, &surface)?;
    vectors(subject, findings, &surface)?;
    depths(subject, findings, &surface)
}

/// A whole viewport whose value is `of` the window's coordinates in pixels.
fn valued(of: impl Fn([f32; 2]) -> [f32; 4]) -> [Vertex; 6] {
    full(0.0).map(|vertex| {
        let at = [vertex.position[0], vertex.position[1]].map(|ndc| (ndc + 1.0) * SIDE as f32 / 2.0);
        Vertex { value: of(at), ..vertex }
    })
}

/// Slopes that are exact in f32; the derivative is a difference of two values, each good to some roundings.
fn linear(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let mut tallies = [GradeTally::default(); 3];
    for [a, b] in [[1.0_f32, 0.0], [0.0, 1.0], [-0.5, 2.0], [3.0, -0.25], [0.125, 0.0625], [-2.0, -3.0]] {
        let shader = Shader::of("result = vec4(dFdx(passed.x), dFdy(passed.x), fwidth(passed.x), 0.0);");
        let vertices = valued(|[x, y]| [a * x + b * y + 1.0, 0.0, 0.0, 0.0]);
        subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &vertices) })?;
        let scale = f64::from((a.abs() + b.abs()) * SIDE as f32 + 1.0);
        for color in surface.floats() {
            for (index, due) in [a, b, a.abs() + b.abs()].into_iter().enumerate() {
                let off = (f64::from(color[index]) - f64::from(due)) / scale;
                tallies[index].add(verify::within(off, 1e-6, 1e-4), off);
            }
        }
    }
    for (name, tally) in ["dFdx", "dFdy", "fwidth"].into_iter().zip(tallies) {
        findings.tally(format!("{name} of 6 linear functions"), tally, "of the values");
    }
    Ok(())
}

/// x squared and x y: a difference to a neighbour on either side, in the fragment's row or column or the next
/// ("forward differencing", "backward differencing", once for a square of 2 x 2 pixels).
fn curve(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let shader = Shader::of(
        "float f = passed.x * passed.x + passed.x * passed.y; result = vec4(dFdx(f), dFdy(f), fwidth(f), f);",
    );
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &valued(|[x, y]| [x, y, 0.0, 0.0])) })?;
    let f = |x: f64, y: f64| (x + 0.5) * (x + 0.5) + (x + 0.5) * (y + 0.5);
    let mut tallies = [GradeTally::default(); 3];
    for (index, color) in surface.floats().into_iter().enumerate() {
        let [x, y] = [index % SIDE, index / SIDE].map(|at| at as f64);
        let near = [-1.0, 0.0, 1.0];
        // Both ends of a difference lie in the fragment's square.
        let dx: Vec<f64> =
            near.iter().flat_map(|dy| [-1.0, 0.0].map(|dx| f(x + dx + 1.0, y + dy) - f(x + dx, y + dy))).collect();
        let dy: Vec<f64> =
            near.iter().flat_map(|dx| [-1.0, 0.0].map(|dy| f(x + dx, y + dy + 1.0) - f(x + dx, y + dy))).collect();
        let sums: Vec<f64> = dx.iter().flat_map(|dx| dy.iter().map(move |dy| dx.abs() + dy.abs())).collect();
        for (component, candidates) in [dx, dy, sums].into_iter().enumerate() {
            let off = candidates.iter().map(|due| (f64::from(color[component]) - due).abs()).fold(f64::MAX, f64::min);
            tallies[component].add(verify::within(off, 1e-3, 0.05), off);
        }
    }
    for (name, tally) in ["dFdx", "dFdy", "fwidth"].into_iter().zip(tallies) {
        findings.tally(format!("{name} of a curve"), tally, "");
    }
    Ok(())
}

/// Vectors, an expression of gl_FragCoord, and a normal by cross(dFdx, dFdy), which looks to the viewer.
fn vectors(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let vertices = valued(|[x, y]| [x, 2.0 * y, x - y, 4.0 + x + 3.0 * y]);
    for (name, fragment, due) in [
        ("dFdx of vec4", "result = dFdx(passed);", [1.0, 0.0, 1.0, 1.0]),
        ("dFdy of vec4", "result = dFdy(passed);", [0.0, 2.0, -1.0, 3.0]),
        ("fwidth of vec4", "result = fwidth(passed);", [1.0, 2.0, 2.0, 4.0]),
        ("of gl_FragCoord", "result = vec4(dFdx(gl_FragCoord.xy), dFdy(gl_FragCoord.xy));", [1.0, 0.0, 0.0, 1.0]),
        (
            "of a sum",
            "result = vec4(dFdx(passed.x + 3.0 * passed.y), dFdy(passed.x * 2.0), dFdx(-passed.z), dFdy(-passed.z));",
            [1.0, 0.0, -1.0, 1.0],
        ),
        (
            "cross(dFdx, dFdy) of a position",
            "vec3 n = cross(dFdx(passed.xyz), dFdy(passed.xyz)); result = vec4(n, 0.0);",
            [-2.0, 1.0, 2.0, 0.0],
        ),
    ] {
        subject.bench.draw(&GlDraw { shader: Shader::of(fragment), ..GlDraw::plain(surface, FLAT, &vertices) })?;
        let mut tally = GradeTally::default();
        for color in surface.floats() {
            let off =
                (0..4).map(|index| (f64::from(color[index]) - f64::from(due[index] as f32)).abs()).fold(0.0, f64::max);
            tally.add(if off.is_nan() { Grade::Wrong } else { verify::within(off, 1e-4, 1e-2) }, off);
        }
        findings.tally(name, tally, "");
    }
    Ok(())
}

/// Slopes of the fragment's own depth, times the side in pixels, on a surface that leans along both axes.
fn depths(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    // 16: SIDE.
    let shader = Shader::of(
        "float own = gl_FragCoord.z;
         result = 16.0 * vec4(dFdx(gl_FragCoord.z), dFdy(own), fwidth(own), 0.0);",
    );
    let vertices = full(0.0).map(|vertex| {
        let [x, y, _, w] = vertex.position;
        Vertex { position: [x, y, 0.25 * x - 0.5 * y, w], ..vertex }
    });
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &vertices) })?;
    // Window depths are half of z / w, and the window is two units of x / w wide.
    let due = [0.25, -0.5, 0.75];
    let mut tally = GradeTally::default();
    for color in surface.floats() {
        let off = (0..3).map(|index| (f64::from(color[index]) - due[index]).abs()).fold(0.0, f64::max);
        // 16 times the difference of two depths of 24 bits.
        tally.add(if off.is_nan() { Grade::Wrong } else { verify::within(off, 4e-6, 1e-3) }, off);
    }
    findings.tally("of the fragment's depth", tally, "");
    Ok(())
}
