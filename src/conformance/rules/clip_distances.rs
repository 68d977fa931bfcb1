//! GL-R4: each of eight clip distances alone and several at once, and what is interpolated where they cut [GL 4.6, 13.7].

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, GlUniform, Shader, Surface, Vertex, full};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 32;
/// Pixels along the sides of a large viewport, rows of it that are drawn, and cuts.
const WIDE: u32 = 2048;
const ROWS: u32 = 8;
const CUTS: usize = 12;
const SHADER: Shader = Shader {
    declarations: "uniform vec4 planes[8];\n#ifdef VERTEX\nout float gl_ClipDistance[8];\n#endif",
    vertex: "gl_Position = position; passed = value;
        for (int k = 0; k < 8; ++k) {
            gl_ClipDistance[k] = dot(planes[k], position);
        }",
    fragment: "result = vec4(passed.xy / passed.w, 1.0, 1.0);",
    ..Shader::PLAIN
};

/// GL-R4: 8 distances down to 1, the last of which cuts, then all that are on.
pub fn distances(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba32F), None)?;
    let mut random = Random::new(351);
    let mut place = GradeTally::default();
    let (mut alone, mut together) = (GradeTally::default(), GradeTally::default());
    // From more to fewer: none of those before may stay on.
    for on in (1..=8_usize).rev() {
        let keep = [0.0, 0.0, 0.0, 1.0];
        let mut cutting = || {
            let angle = random.between(0.0, std::f32::consts::TAU);
            [angle.cos(), angle.sin(), 0.0, random.between(-0.2, 0.6)]
        };
        // The last that is on cuts; those that are off would leave nothing.
        let mut planes = [[0.0, 0.0, 0.0, -1.0]; 8];
        planes[..on].fill(keep);
        planes[on - 1] = cutting();
        judge(subject, &surface, &planes, on, &mut alone, &mut place)?;
        planes[..on].iter_mut().for_each(|plane| *plane = cutting());
        judge(subject, &surface, &planes, on, &mut together, &mut place)?;
    }
    findings.tally("each of 8 distances alone, others off", alone, "");
    findings.tally("1 to 8 distances at once", together, "");
    findings.tally("varyings of what is cut", place, "of the viewport");
    findings.part(|findings| {
        findings.tally("shallow cuts of a large viewport", wide(subject)?, "");
        Ok(())
    });
    Ok(())
}

/// Cuts that climb by a few pixels over a large viewport, by distances of any size: what is
/// left of a distance's digits moves the cut.
fn wide(subject: &DriverUnderTest) -> Result<GradeTally, Error> {
    let mut tally = GradeTally::default();
    let side = WIDE.min(subject.bench.largest_side());
    let surface = subject.bench.surface([side, ROWS], Some(GlFormat::Rgba8), None)?;
    let mut random = Random::new(352);
    for _ in 0..CUTS {
        let origin = random.whole(0, (side - ROWS) as i32);
        let [left, right] = [(); 2].map(|()| {
            let height = random.between(1.0, ROWS as f32 - 1.0) + origin as f32;
            2.0 * height / side as f32 - 1.0
        });
        let scale = random.between(-6.0, 6.0).exp2() * if random.chance(0.5) { 1.0 } else { -1.0 };
        let mut planes = [[0.0, 0.0, 0.0, -1.0]; 8];
        planes[0] = [0.5 * (left - right), 1.0, 0.0, -0.5 * (left + right)].map(|number| number * scale);
        let viewport = Some([0, -origin, side as i32, side as i32]);
        surface.clear_color([0.0; 4]);
        let state = GlState { depth: None, clip_distances: 1, viewport, ..GlState::WRITE };
        let uniforms = [("planes", GlUniform::Vec4s(planes))];
        let vertices = bent();
        subject.bench.draw(&GlDraw {
            shader: SHADER,
            uniforms: &uniforms,
            ..GlDraw::plain(&surface, state, &vertices)
        })?;
        let [a, b, _, d] = planes[0].map(f64::from);
        for (index, color) in surface.colors().into_iter().enumerate() {
            let at = |pixel: i32| (f64::from(pixel) + 0.5) * 2.0 / f64::from(side) - 1.0;
            let [x, y] = [at((index as u32 % side) as i32), at((index as u32 / side) as i32 + origin)];
            let distance = a * x + b * y + d;
            if distance.abs() >= b.abs() / 8.0 / f64::from(side) {
                let is_right = (color[2] > 0) == (distance > 0.0);
                tally.add(verify::within(if is_right { 0.0 } else { 1.0 }, 0.0, 0.0), 0.0);
            }
        }
    }
    Ok(tally)
}

/// A rectangle over the viewport with several w.
fn bent() -> [Vertex; 6] {
    full(0.0).map(|vertex| {
        let [x, y, ..] = vertex.position;
        let w = 2.0 + 0.5 * x + 0.25 * y;
        let position = [x * w, y * w, 0.0, w];
        Vertex { position, value: position }
    })
}

/// A viewport with several w against the half-planes in f64, but for a sixteenth of a pixel along their edges.
fn judge(
    subject: &DriverUnderTest,
    surface: &Surface,
    planes: &[[f32; 4]; 8],
    on: usize,
    tally: &mut GradeTally,
    place: &mut GradeTally,
) -> Result<(), Error> {
    surface.clear_color([0.0; 4]);
    let vertices = bent();
    let state = GlState { depth: None, clip_distances: on as u32, ..GlState::WRITE };
    let uniforms = [("planes", GlUniform::Vec4s(*planes))];
    subject.bench.draw(&GlDraw { shader: SHADER, uniforms: &uniforms, ..GlDraw::plain(surface, state, &vertices) })?;
    for (index, color) in surface.floats().into_iter().enumerate() {
        let [x, y] =
            [index as u32 % SIDE, index as u32 / SIDE].map(|at| (f64::from(at) + 0.5) * 2.0 / f64::from(SIDE) - 1.0);
        let distances = planes[..on].iter().map(|[a, b, _, d]| f64::from(*a) * x + f64::from(*b) * y + f64::from(*d));
        let least = distances.fold(f64::MAX, f64::min);
        if least.abs() < 1.0 / 8.0 / f64::from(SIDE) {
            continue;
        }
        let drawn = color[2] == 1.0;
        tally.add(verify::within(if drawn == (least > 0.0) { 0.0 } else { 1.0 }, 0.0, 0.0), 0.0);
        if drawn {
            let off = (f64::from(color[0]) - x).abs().max((f64::from(color[1]) - y).abs());
            place.add(verify::within(off, 1e-5, 1.0 / 8.0 / f64::from(SIDE)), off);
        }
    }
    Ok(())
}
