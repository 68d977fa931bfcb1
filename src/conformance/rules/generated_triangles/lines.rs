//! Lines of width 1: a fragment for each column or row, near the line, with the values there [GL 4.6, 14.5.1, 14.5.2].

use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlChange, GlFormat, GlPrimitive, GlState};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};

const SIZE: [u32; 2] = [52, 41];
const ROUNDS: usize = 60;

const VERTEX: &str = "#version 330
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 value;
out float passed;
flat out float last;
void main() { gl_Position = position; passed = value.x; last = value.y; }
";
const FRAGMENT: &str = "#version 330
in float passed;
flat in float last;
out vec4 result;
void main() { result = vec4(float(gl_PrimitiveID), passed, gl_FragCoord.z, last); }
";

/// An end in window space.
#[derive(Clone, Copy)]
struct End {
    at: [f64; 2],
    depth: f64,
    w: f64,
    value: f64,
}

/// A line between two ends, and its axis along which it is longer.
struct Line {
    ends: [End; 2],
    major: usize,
}

impl Line {
    fn new(ends: [End; 2]) -> Self {
        let way = [0, 1].map(|part: usize| (ends[1].at[part] - ends[0].at[part]).abs());
        Self { ends, major: usize::from(way[1] > way[0]) }
    }

    /// Share of the way at a place, and how far the place is off across the longer axis.
    fn share(&self, at: [f64; 2]) -> (f64, f64) {
        let [from, to] = self.ends.map(|end| end.at);
        let share = (at[self.major] - from[self.major]) / (to[self.major] - from[self.major]);
        let minor = 1 - self.major;
        (share, at[minor] - (from[minor] + share * (to[minor] - from[minor])))
    }

    fn length(&self) -> f64 {
        (self.ends[1].at[self.major] - self.ends[0].at[self.major]).abs()
    }

    /// The value with perspective, and the depth.
    fn at(&self, share: f64) -> [f64; 2] {
        let [a, b] = self.ends;
        let weights = [(1.0 - share) / a.w, share / b.w];
        let value = (weights[0] * a.value + weights[1] * b.value) / (weights[0] + weights[1]);
        [value, a.depth + share * (b.depth - a.depth)]
    }
}

/// Grades of pixels, and of numbers in them.
pub fn lines(subject: &DriverUnderTest) -> Result<[GradeTally; 2], Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(9300);
    let surface = bench.surface(SIZE, Some(GlFormat::Rgba32F), Some(GlFormat::Depth24))?;
    let program = bench.whole_program(VERTEX, FRAGMENT)?;
    let stream = bench.stream(2)?;
    bench.set_state(&surface, GlState { depth: None, ..GlState::WRITE });
    bench.use_whole(&program);
    let [mut places, mut numbers] = [GradeTally::default(); 2];
    for _ in 0..ROUNDS {
        bench.clear_outputs_as_it_is(1, [-7.0; 4], 1.0)?;
        if dice.chance(0.2) {
            // Faces and polygon modes are none of a line's.
            bench.change(GlChange::Switch(glow::CULL_FACE, dice.chance(0.5)));
        }
        let primitive = dice.pick(&[GlPrimitive::Lines, GlPrimitive::LineStrip, GlPrimitive::LineLoop]);
        let count = dice.whole(2, 5) as usize;
        let beyond = dice.pick(&[0.0, 0.0, 0.8, 6.0]);
        let spread = dice.pick(&[0.0, 2.0]);
        let (mut floats, mut ends) = (Vec::new(), Vec::new());
        for number in 0..count {
            let w = dice.power(-spread, spread + 0.01);
            let at = SIZE.map(|side| dice.between(0.03 - beyond, 0.97 + beyond) * side as f32);
            let [x, y] = [0, 1].map(|part| at[part] * 2.0 / SIZE[part] as f32 - 1.0);
            let (z, value) = (dice.between(-0.95, 0.95), dice.exact(8));
            floats.extend([x * w, y * w, z * w, w, value, number as f32, 0.0, 0.0]);
            ends.push(End {
                at: at.map(f64::from),
                depth: (f64::from(z) + 1.0) / 2.0,
                w: f64::from(w),
                value: f64::from(value),
            });
        }
        bench.draw_stream(&stream, primitive, &floats, None)?;
        let pairs: Vec<[usize; 2]> = match primitive {
            GlPrimitive::Lines => (0..count / 2).map(|pair| [2 * pair, 2 * pair + 1]).collect(),
            GlPrimitive::LineStrip => (1..count).map(|end| [end - 1, end]).collect(),
            _ => (0..count).map(|end| [end, (end + 1) % count]).collect(),
        };
        let lines: Vec<Line> = pairs.iter().map(|pair| Line::new(pair.map(|end| ends[end]))).collect();
        let seen = surface.floats();
        judge(&lines, &pairs, &seen, &mut places, &mut numbers);
    }
    bench.change(GlChange::Switch(glow::CULL_FACE, false));
    Ok([places, numbers])
}

fn judge(lines: &[Line], pairs: &[[usize; 2]], seen: &[[f32; 4]], places: &mut GradeTally, numbers: &mut GradeTally) {
    let width = SIZE[0] as usize;
    for (index, seen) in seen.iter().enumerate().filter(|(_, seen)| seen[0] >= 0.0) {
        let at = [index % width, index / width].map(|place| place as f64 + 0.5);
        let number = seen[0] as usize;
        let Some(line) = lines.get(number) else {
            places.add(verify::Grade::Wrong, 1.0);
            continue;
        };
        let (share, off) = line.share(at);
        // A fragment may be one pixel off across the line, and begins or ends within one of the ends.
        let past = (share.max(1.0 - share) - 1.0) * line.length();
        places.add(verify::within(off.abs().max(past), 1.0 + 1.0 / 32.0, 1.5), off);
        // Values of anywhere within a pixel.
        let step = 1.0 / line.length().max(1.0);
        let around = [-step, 0.0, step].map(|step| line.at((share + step).clamp(-step.abs(), 1.0 + step.abs())));
        for (part, seen) in [seen[1], seen[2]].into_iter().enumerate() {
            let [low, high] = around
                .iter()
                .fold([f64::MAX, f64::MIN], |[low, high], values| [low.min(values[part]), high.max(values[part])]);
            let off = (f64::from(seen) - (low + high) / 2.0).abs() - (high - low) / 2.0;
            let off = if off.is_nan() { f64::INFINITY } else { off.max(0.0) };
            numbers.add(verify::within(off, 1e-4, 1e-2), off);
        }
        // Flat: of the last end.
        let off = f64::from(seen[3]) - pairs[number][1] as f64;
        numbers.add(verify::within(off, 0.0, 0.0), off);
    }
    for line in lines {
        let sides = [SIZE[line.major], SIZE[1 - line.major]];
        for step in 0..sides[0] {
            let along = f64::from(step) + 0.5;
            let mut at = [along; 2];
            at[1 - line.major] = 0.0;
            let (share, off) = line.share(at);
            let across = -off;
            // Well between the ends, and within the viewport.
            let inner = (0.5 - (share - 0.5).abs()) * line.length();
            if inner < 1.5 || across < 1.5 || across > f64::from(sides[1]) - 1.5 {
                continue;
            }
            let drawn = (0..sides[1]).any(|place| {
                let place_at = if line.major == 0 { [step, place] } else { [place, step] };
                let is_near = (f64::from(place) + 0.5 - across).abs() <= 1.0 + 1.0 / 32.0;
                is_near && seen[(place_at[1] * SIZE[0] + place_at[0]) as usize][0] >= 0.0
            });
            places.add(verify::within(f64::from(u8::from(!drawn)), 0.0, 0.0), 1.0);
        }
    }
}
