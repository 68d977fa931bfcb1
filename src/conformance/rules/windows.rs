//! GL-R3: viewports and scissors, to the pixel [GL 4.6, 13.8.1, 17.3.1].

use crate::conformance::bench::{
    Error, GlClear, GlCompare, GlDraw, GlFormat, GlState, GlStencilOp, Surface, Vertex, full,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIZE: [i32; 2] = [37, 23];

/// A rectangle that may reach beyond the surface: x, y, width, height.
fn random_rectangle(random: &mut Random) -> [i32; 4] {
    let mut between = |low: i32, high: i32| random.between(low as f32, high as f32).floor() as i32;
    [between(-5, 30), between(-5, 18), between(1, 30), between(1, 20)]
}

fn inside([left, bottom, width, height]: [i32; 4], index: usize) -> bool {
    let [x, y] = [index as i32 % SIZE[0], index as i32 / SIZE[0]];
    (left..left + width).contains(&x) && (bottom..bottom + height).contains(&y)
}

/// GL-R3: which pixels a viewport and a scissor let through, and where a viewport puts a vertex.
pub fn windows(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let size = SIZE.map(|side| side as u32);
    let surface = subject.bench.surface(size, Some(GlFormat::Rgba32F), Some(GlFormat::Depth24Stencil8))?;
    let mut random = Random::new(331);
    let whole = [0, 0, SIZE[0], SIZE[1]];
    let mut fixed =
        vec![whole, [0, 0, 1, 1], [36, 22, 1, 1], [5, 7, 0, 9], [5, 7, 9, 0], [-9, -9, 9, 9], [40, 2, 5, 5]];
    fixed.extend((0..16).map(|_| random_rectangle(&mut random)));
    let count = GlState::counting(GlStencilOp::IncrementWrap, GlStencilOp::IncrementWrap);
    let scissors: Vec<_> = fixed.iter().map(|area| (GlState { scissor: Some(*area), ..count }, *area)).collect();
    judge(subject, findings, "scissors", &surface, &scissors)?;
    let viewports = fixed[..3].iter().chain(&fixed[7..]);
    let viewports: Vec<_> = viewports.map(|area| (GlState { viewport: Some(*area), ..count }, *area)).collect();
    judge(subject, findings, "viewports", &surface, &viewports)?;
    let both: Vec<_> = (0..16)
        .map(|_| {
            let [viewport, scissor] = [(); 2].map(|()| random_rectangle(&mut random));
            let low = [viewport[0].max(scissor[0]), viewport[1].max(scissor[1])];
            let high = [0, 1].map(|axis| (viewport[axis] + viewport[axis + 2]).min(scissor[axis] + scissor[axis + 2]));
            let area = [low[0], low[1], (high[0] - low[0]).max(0), (high[1] - low[1]).max(0)];
            (GlState { viewport: Some(viewport), scissor: Some(scissor), ..count }, area)
        })
        .collect();
    judge(subject, findings, "viewports under scissors", &surface, &both)?;
    places(subject, findings, &surface, &mut random)
}

/// Draws each, with one without in between: pixels that are drawn otherwise than once inside and never outside.
fn judge(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    what: &str,
    surface: &Surface,
    cases: &[(GlState, [i32; 4])],
) -> Result<(), Error> {
    let mut wrong = 0;
    for (state, area) in cases {
        surface.clear_stencil(0);
        subject.bench.draw(&GlDraw::plain(surface, *state, &full(0.0)))?;
        subject.bench.draw(&GlDraw::plain(surface, GlState { scissor: None, viewport: None, ..*state }, &full(0.0)))?;
        let values = surface.stencils();
        wrong +=
            values.iter().enumerate().filter(|(index, value)| **value != 1 + u8::from(inside(*area, *index))).count();
    }
    findings.none_wrong(format!("{} {what}", cases.len()), wrong, cases.len() * (SIZE[0] * SIZE[1]) as usize);
    Ok(())
}

/// Normalised device coordinates and depth that arrive at each pixel of a viewport under a depth range.
fn places(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    random: &mut Random,
) -> Result<(), Error> {
    let (mut at, mut depth) = (GradeTally::default(), GradeTally::default());
    for round in 0..8 {
        let viewport = random_rectangle(random);
        let range = [[0.0, 1.0], [0.25, 0.75], [0.75, 0.125]][round % 3];
        let clear = GlClear { color: Some([9.0; 4]), depth: Some(1.0), ..GlClear::default() };
        subject.bench.clear(surface, GlState::WRITE, clear)?;
        let vertices = full(0.0).map(|vertex| {
            let [x, y, ..] = vertex.position;
            Vertex { position: [x, y, 0.5 * x + 0.25 * y, 1.0], value: [x, y, 0.0, 0.0] }
        });
        let state = GlState {
            viewport: Some(viewport),
            depth_range: range,
            short_calls: round % 2 == 1,
            depth: Some(GlCompare::Always),
            ..GlState::WRITE
        };
        subject.bench.draw(&GlDraw::plain(surface, state, &vertices))?;
        for (index, (color, stored)) in surface.floats().into_iter().zip(surface.depths()).enumerate() {
            if !inside(viewport, index) {
                continue;
            }
            let pixel = [index as i32 % SIZE[0], index as i32 / SIZE[0]];
            let due = [0, 1].map(|axis| {
                (f64::from(pixel[axis] - viewport[axis]) + 0.5) * 2.0 / f64::from(viewport[axis + 2]) - 1.0
            });
            let off = (0..2).map(|axis| (f64::from(color[axis]) - due[axis]).abs()).fold(0.0, f64::max);
            // Strictly roundings of f32, else a sub-pixel of 2^-4.
            let pixel_worth = 2.0 / f64::from(viewport[2].min(viewport[3]));
            at.add(verify::within(off, 1e-5, pixel_worth / 16.0), off);
            let z = 0.5 * due[0] + 0.25 * due[1];
            let due = (range[1] - range[0]) / 2.0 * z + (range[0] + range[1]) / 2.0;
            let off = stored - due;
            depth.add(verify::within(off, 1e-6, 1e-6 + pixel_worth / 32.0), off);
        }
    }
    findings.tally("where 8 viewports put what is drawn", at, "of the viewport");
    findings.tally("depth in 8 viewports under 3 depth ranges", depth, "of the range");
    Ok(())
}
