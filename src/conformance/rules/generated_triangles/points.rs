//! Points of any size: their pixels, gl_PointCoord and depth [GL 4.6, 14.4].

use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlChange, GlFormat, GlPrimitive, GlState};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};

const SIZE: [u32; 2] = [43, 38];
const ROUNDS: usize = 50;
/// GL_POINT_SPRITE, which a core context always has on.
const POINT_SPRITE: u32 = 0x8861;

const VERTEX: &str = "#version 330
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 value;
out vec4 passed;
void main() { gl_Position = position; gl_PointSize = value.x; passed = value; }
";
const FRAGMENT: &str = "#version 330
in vec4 passed;
out vec4 result;
void main() { result = vec4(gl_PointCoord, passed.y, gl_FragCoord.z); }
";

/// Grades of pixels, and of numbers in them.
pub fn points(subject: &DriverUnderTest) -> Result<[GradeTally; 2], Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(9200);
    let surface = bench.surface(SIZE, Some(GlFormat::Rgba32F), Some(GlFormat::Depth24))?;
    let program = bench.whole_program(VERTEX, FRAGMENT)?;
    let stream = bench.stream(2)?;
    bench.set_state(&surface, GlState { depth: None, ..GlState::WRITE });
    bench.change(GlChange::Switch(glow::PROGRAM_POINT_SIZE, true));
    if bench.is_compatible() {
        bench.change(GlChange::Switch(POINT_SPRITE, true));
    }
    bench.use_whole(&program);
    let [mut places, mut numbers] = [GradeTally::default(); 2];
    for _ in 0..ROUNDS {
        bench.clear_outputs_as_it_is(1, [7.0; 4], 1.0)?;
        let count = dice.whole(1, 4) as usize;
        let mut drawn = Vec::new();
        let mut floats = Vec::new();
        for number in 0..count {
            let w = dice.power(-9.0, 9.0);
            let at = SIZE.map(|side| dice.between(0.02, 0.98) * side as f32);
            let size = dice.pick(&[1.0, 2.0, 3.0, 5.5, 8.0, 20.0, 63.0]) + dice.pick(&[0.0, 0.0, 0.25]);
            let z = dice.between(-0.9, 0.9);
            let [x, y] = [0, 1].map(|part| at[part] * 2.0 / SIZE[part] as f32 - 1.0);
            floats.extend([x * w, y * w, z * w, w, size, number as f32, 0.0, 0.0]);
            drawn.push((at.map(f64::from), f64::from(size), (f64::from(z) + 1.0) / 2.0));
        }
        bench.draw_stream(&stream, GlPrimitive::Points, &floats, None)?;
        for (index, seen) in surface.floats().into_iter().enumerate() {
            let center = [index as u32 % SIZE[0], index as u32 / SIZE[0]].map(|place| f64::from(place) + 0.5);
            // The last point over a pixel; `None`: none, or one that may or may not be there.
            let (mut due, mut is_sure) = (None, true);
            for (number, (at, size, z)) in drawn.iter().enumerate() {
                let off = [0, 1].map(|part| (center[part] - at[part]).abs() - size / 2.0);
                let beyond = off[0].max(off[1]);
                match () {
                    () if beyond < -1.0 / 64.0 => (due, is_sure) = (Some((number, at, size, z)), true),
                    () if beyond <= 1.0 / 64.0 => is_sure = false,
                    () => {}
                }
            }
            if !is_sure {
                continue;
            }
            let is = seen[2] != 7.0;
            places.add(verify::within(f64::from(u8::from(is != due.is_some())), 0.0, 0.0), 0.0);
            let Some((number, at, size, z)) = due.filter(|_| is) else { continue };
            // The origin is at the upper left.
            let s = 0.5 + (center[0] - at[0]) / size;
            let t = 0.5 - (center[1] - at[1]) / size;
            let slack = 1.0 / 128.0 / size + 1e-5;
            for (seen, due, slack) in
                [(seen[0], s, slack), (seen[1], t, slack), (seen[2], number as f64, 1e-5), (seen[3], *z, 1e-5)]
            {
                let off = f64::from(seen) - due;
                let off = if off.is_nan() { f64::INFINITY } else { off };
                numbers.add(verify::within(off, slack, 4.0 * slack), off);
            }
        }
    }
    bench.change(GlChange::Switch(glow::PROGRAM_POINT_SIZE, false));
    if bench.is_compatible() {
        bench.change(GlChange::Switch(POINT_SPRITE, false));
    }
    Ok([places, numbers])
}
