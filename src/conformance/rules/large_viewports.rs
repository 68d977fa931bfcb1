//! GL-R7: edges in large viewports, measured along a shallow slope [GL 4.6, 14.6.1, 23.62 (SUBPIXEL_BITS)].

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, Shader, Vertex, triangle};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along the sides of viewports.
const SIDES: [u32; 8] = [64, 255, 256, 300, 640, 1024, 2048, 4096];
/// Pixels across the target.
const ACROSS: u32 = 4;
const EDGES: usize = 4;

/// GL-R7: an edge climbs by a few pixels over all of the viewport; where it passes the pixels' centres tells its height to
/// the pixels' share that it climbs from one column to the next.
pub fn edges(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(40);
    let step = f64::from(-(subject.bench.subpixel_bits().max(4) as i32)).exp2();
    for side in SIDES.into_iter().filter(|side| *side <= subject.bench.largest_side()) {
        let mut tally = GradeTally::default();
        for high in [false, true] {
            let size = if high { [ACROSS, side] } else { [side, ACROSS] };
            let surface = subject.bench.surface(size, Some(GlFormat::Rgba8), None)?;
            for edge in 0..EDGES {
                // Half of the viewports are as high as they are wide, and the target is a strip of them.
                let across = if edge % 2 == 0 { ACROSS } else { side };
                let origin = if across == side { random.whole(0, (side - ACROSS) as i32) } else { 0 };
                let viewport = if high {
                    [-origin, 0, across as i32, side as i32]
                } else {
                    [0, -origin, side as i32, across as i32]
                };
                let ends = [random.between(0.1, 1.3), random.between(2.2, 3.9)];
                let ends = if random.chance(0.5) { ends } else { [ends[1], ends[0]] };
                // Clip space along and across the strip; the third corner lies far below it.
                let clip = |pixels: f64, from: u32| (2.0 * pixels / f64::from(from) - 1.0) as f32;
                let place = |along: f64, height: f64| {
                    let [x, y] = [clip(along, side), clip(height + f64::from(origin), across)];
                    if high { [y, x, 0.0, 1.0] } else { [x, y, 0.0, 1.0] }
                };
                let [low, high_end] = [place(0.0, f64::from(ends[0])), place(f64::from(side), f64::from(ends[1]))];
                let below = place(0.5 * f64::from(side), -64.0 * f64::from(side));
                surface.clear_color([0.0; 4]);
                let state = GlState { viewport: Some(viewport), depth: None, ..GlState::WRITE };
                let white = triangle([low, high_end, below]).map(|vertex| Vertex { value: [1.0; 4], ..vertex });
                let shader = Shader { version: "#version 330", ..Shader::PLAIN };
                subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, state, &white) })?;
                // Heights as the numbers in clip space say.
                let height = |corner: [f32; 4]| {
                    let at = f64::from(corner[usize::from(!high)]);
                    (at + 1.0) / 2.0 * f64::from(across) - f64::from(origin)
                };
                measure(&surface.colors(), side, high, [height(low), height(high_end)], step, &mut tally);
            }
        }
        findings.tally(format!("viewports of {side} pixels"), tally, "steps of a subpixel");
    }
    Ok(())
}

/// Adds the height of the edge at each row of pixels' centres that it passes.
fn measure(colors: &[[u8; 4]], side: u32, high: bool, [low, high_end]: [f64; 2], step: f64, tally: &mut GradeTally) {
    let slope = (high_end - low) / f64::from(side);
    for row in 0..ACROSS {
        let centre = f64::from(row) + 0.5;
        // Too near the ends, other edges pass.
        let crossing = (centre - low) / slope;
        if !(0.05..0.95).contains(&(crossing / f64::from(side))) {
            continue;
        }
        let index = |at: u32| if high { at * ACROSS + row } else { row * side + at } as usize;
        let margin = 1 + side / 64;
        let drawn = (margin..side - margin).filter(|at| colors[index(*at)][3] != 0).count() as f64;
        // Pixels are drawn where the edge is above their centre: on the right of the crossing, or on the left.
        let found = if slope > 0.0 { f64::from(side - margin) - drawn } else { f64::from(margin) + drawn };
        let off = (found - crossing) * slope.abs();
        // Each end is put on the nearest step; or on the next below it. A column, and the roundings of clip space.
        let error = slope.abs() + f64::from(side) * 2.0_f64.powi(-22);
        tally.add(verify::within(off, 0.5 * step + error, step + error), off / step);
    }
}
