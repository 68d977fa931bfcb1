//! The model's framebuffer: numbers that each pixel of a target must hold.

use std::cmp::Ordering;

use super::model::{Corner, Interpolation, Known, Triangle};
use super::pipeline::Pipeline;
use super::programs::{Component, SHOWN, Text};
use super::shapes::Shapes;
use crate::conformance::bench::{Encoding, GlCompare, GlPolygonMode};
use crate::conformance::model::window::Covered;
use crate::conformance::random::Random;

/// Colour that no draw puts out.
pub const CLEARED: f32 = 7777.0;

/// A pixel: four outputs of four numbers, and depth.
#[derive(Clone, Copy)]
pub struct Pixel {
    pub outputs: [[Known; 4]; 4],
    /// Nothing has been drawn here; `None`: the model does not know.
    pub cleared: Option<bool>,
    /// Least and most.
    pub depth: [f64; 2],
}

impl Pixel {
    pub const UNKNOWN: Self = Self { outputs: [[Known::ANY; 4]; 4], cleared: None, depth: [0.0, 1.0] };
}

pub struct Picture {
    pub size: [u32; 2],
    pub pixels: Vec<Pixel>,
    pub encoding: Encoding,
}

/// Numbers that a draw shows.
pub struct Shown<'a> {
    pub text: &'a Text,
    /// Group of numbers; the one after the last: derivatives.
    pub which: usize,
}

impl Picture {
    pub fn new(size: [u32; 2], encoding: Encoding) -> Self {
        Self { size, pixels: vec![Pixel::UNKNOWN; (size[0] * size[1]) as usize], encoding }
    }

    fn place(&self, index: usize) -> [i32; 2] {
        let width = self.size[0] as usize;
        [index % width, index / width].map(|part| part as i32)
    }

    /// Clears what the scissor leaves, and depth where it is written.
    pub fn clear(&mut self, pipeline: &Pipeline, depth: f32) {
        for index in 0..self.pixels.len() {
            if !pipeline.keeps(self.place(index)) {
                continue;
            }
            let pixel = &mut self.pixels[index];
            pixel.outputs = [[Known::exact(f64::from(CLEARED)); 4]; 4];
            pixel.cleared = Some(true);
            if pipeline.depth_write {
                let code = self.encoding.step(0.75);
                let depth = f64::from(depth);
                let slack = if depth == 0.0 || depth == 1.0 { 0.0 } else { code };
                pixel.depth = [depth - slack, depth + slack];
            }
        }
    }

    /// Draws filled triangles, one after another; lines and points of polygons leave what is near their edges unknown.
    pub fn draw(&mut self, pipeline: &Pipeline, shapes: &Shapes, shown: &Shown) {
        let writes = shown.text.traits.distances;
        for (number, (corners, provoking)) in shapes.triangles(pipeline.first).into_iter().enumerate() {
            let triangle = Triangle::new(corners.map(|index| shapes.corners[index]), provoking, pipeline, writes);
            let offset = Offset::of(&triangle, pipeline, self.encoding);
            for index in 0..self.pixels.len() {
                let place = self.place(index);
                let at = place.map(|part| f64::from(part) + 0.5);
                if !pipeline.keeps(place) {
                    continue;
                }
                if pipeline.mode != GlPolygonMode::Fill {
                    if triangle.may_line(at) {
                        self.pixels[index] = unknown(self.pixels[index], [0.0, 1.0], pipeline);
                    }
                    continue;
                }
                let covered = triangle.covers(at, pipeline.viewport);
                if covered == Covered::No || (pipeline.leaves_out(triangle.front) && covered == Covered::Yes) {
                    continue;
                }
                self.fragment(index, &triangle, number, covered, &offset, pipeline, shown);
            }
        }
    }

    #[allow(clippy::too_many_arguments, reason = "what a fragment depends on")]
    fn fragment(
        &mut self,
        index: usize,
        triangle: &Triangle,
        number: usize,
        covered: Covered,
        offset: &Offset,
        pipeline: &Pipeline,
        shown: &Shown,
    ) {
        let place = self.place(index);
        let at = place.map(|part| f64::from(part) + 0.5);
        let traits = shown.text.traits;
        let row = if traits.upper_left { self.size[1] as i32 - 1 - place[1] } else { place[1] };
        if traits.discards && (place[0] + 2 * row) & 3 == 0 {
            return;
        }
        let (plain, _) = triangle.depth(at, pipeline.depth_range);
        let moved = offset.moved(plain);
        let [near, far] = pipeline.depth_range.map(|end| end.clamp(0.0, 1.0));
        let [low, high] = [near.min(far), near.max(far)];
        let mut ends = [moved.value - moved.slack, moved.value + moved.slack];
        let inside = ends[0] >= 0.0 && ends[1] <= 1.0 && (!pipeline.depth_clamp || (ends[0] >= low && ends[1] <= high));
        if traits.depth {
            ends = if inside { [1.0 - ends[1], 1.0 - ends[0]] } else { [0.0, 1.0] };
        }
        if pipeline.depth_clamp {
            ends = ends.map(|end| end.clamp(low, high));
        }
        let code = self.encoding.step(0.75);
        let ends = ends.map(|end| end.clamp(0.0, 1.0));
        let ends = if ends[0] == ends[1] && (ends[0] == 0.0 || ends[0] == 1.0) {
            ends
        } else {
            [(ends[0] - code).max(0.0), (ends[1] + code).min(1.0)]
        };
        let pixel = self.pixels[index];
        let passes = if pipeline.depth_test { passes(pipeline.compare, ends, pixel.depth) } else { Some(true) };
        if passes == Some(false) {
            return;
        }
        if covered == Covered::Unsure || passes.is_none() {
            self.pixels[index] = unknown(pixel, ends, pipeline);
            return;
        }
        let mut outputs = [[Known::exact(0.0); 4]; 4];
        let shift = if traits.whole_centers { -0.5 } else { 0.0 };
        let coordinates = [f64::from(place[0]) + 0.5 + shift, f64::from(row) + 0.5 + shift];
        let z = if inside { moved } else { Known::ANY };
        outputs[0] = [Known::exact(coordinates[0]), Known::exact(coordinates[1]), z, triangle.over_w(at)];
        show(&mut outputs, triangle, shown, at);
        outputs[3][2] = Known::exact(f64::from(u8::from(triangle.front)));
        outputs[3][3] = Known::exact(number as f64);
        let writes = pipeline.depth_test && pipeline.depth_write;
        self.pixels[index] = Pixel { outputs, cleared: Some(false), depth: if writes { ends } else { pixel.depth } };
    }
}

/// A pixel that may have been drawn.
fn unknown(pixel: Pixel, ends: [f64; 2], pipeline: &Pipeline) -> Pixel {
    let mut depth = pixel.depth;
    if pipeline.depth_test && pipeline.depth_write {
        depth = [depth[0].min(ends[0]), depth[1].max(ends[1])];
    }
    Pixel { outputs: [[Known::ANY; 4]; 4], cleared: None, depth }
}

/// The depth test of numbers that are known to lie in ranges.
fn passes(compare: GlCompare, new: [f64; 2], old: [f64; 2]) -> Option<bool> {
    let possible = [
        (Ordering::Less, new[0] < old[1]),
        (Ordering::Equal, new[0] <= old[1] && new[1] >= old[0]),
        (Ordering::Greater, new[1] > old[0]),
    ];
    let mut answers = possible.into_iter().filter(|(_, may)| *may).map(|(order, _)| compare.holds(order));
    let first = answers.next()?;
    answers.all(|answer| answer == first).then_some(first)
}

/// Polygon offset of a triangle: the range of what is added.
struct Offset {
    least: f64,
    most: f64,
}

impl Offset {
    fn of(triangle: &Triangle, pipeline: &Pipeline, encoding: Encoding) -> Self {
        if !pipeline.offset_on[0] {
            return Self { least: 0.0, most: 0.0 };
        }
        let (_, [along, up]) = triangle.depth([0.0; 2], pipeline.depth_range);
        let slopes = [along.abs().max(up.abs()) * 0.999, along.hypot(up) * 1.001];
        let units = match encoding.float {
            // By the exponent of the polygon's greatest depth, which clipping may make any.
            true => [0.0, f64::from(-23).exp2()],
            false => [0.99 / encoding.most(), 2.0 * 1.01 / encoding.most()],
        };
        let (factor, count) = (f64::from(pipeline.offset.factor), f64::from(pipeline.offset.units));
        let ends = |pair: [f64; 2], by: f64| {
            let [a, b] = pair.map(|end| end * by);
            [a.min(b), a.max(b)]
        };
        let (slope, unit) = (ends(slopes, factor), ends(units, count));
        let clamp = f64::from(pipeline.offset.clamp);
        let clamped = |value: f64| match clamp {
            clamp if clamp > 0.0 => value.min(clamp),
            clamp if clamp < 0.0 => value.max(clamp),
            _ => value,
        };
        Self { least: clamped(slope[0] + unit[0]), most: clamped(slope[1] + unit[1]) }
    }

    fn moved(&self, depth: Known) -> Known {
        let half = (self.most - self.least) / 2.0;
        Known { value: depth.value + self.least + half, slack: depth.slack + half }
    }
}

/// The numbers of the group that is shown.
fn show(outputs: &mut [[Known; 4]; 4], triangle: &Triangle, shown: &Shown, at: [f64; 2]) {
    let (text, which) = (shown.text, shown.which);
    if let Some(group) = text.components.chunks(SHOWN).nth(which) {
        for (index, component) in group.iter().enumerate() {
            outputs[1 + index / 4][index % 4] = value(triangle, component, at);
        }
        return;
    }
    let [a, b, c, d] = text.derived.map(|index| text.components[index]);
    for (index, component) in [a, b, c, d].iter().enumerate() {
        outputs[1][index] = difference(triangle, &[(1.0, *component)], at, true);
        outputs[2][index] = difference(triangle, &[(1.0, *component)], at, false);
    }
    let [along, up] = [outputs[1][0], outputs[2][0]];
    let least = |known: Known| (known.value.abs() - known.slack).max(0.0);
    let most = |known: Known| known.value.abs() + known.slack;
    outputs[3][0] = Known::spanning(least(along) + least(up), most(along) + most(up));
    outputs[3][1] = difference(triangle, &[(1.0, b), (-2.0, c)], at, true);
}

fn value(triangle: &Triangle, component: &Component, at: [f64; 2]) -> Known {
    let known =
        triangle.interpolate(triangle.corners.map(|corner: Corner| component.of(corner.value)), component.how, at);
    // What it is computed from has other roundings than the sum.
    let slack = if component.how == Interpolation::Flat { 0.0 } else { f64::from(-20).exp2() * component.added.abs() };
    Known { slack: known.slack + slack, ..known }
}

/// A difference of a sum to a neighbour on either side, in the fragment's row or column or the next [GLSL 4.60, 8.14.1].
fn difference(triangle: &Triangle, sum: &[(f64, Component)], at: [f64; 2], along: bool) -> Known {
    let of = |[x, y]: [f64; 2]| {
        let here = [at[0] + x, at[1] + y];
        let depth = triangle.over_w(here);
        let mut whole = Known::exact(0.0);
        for (factor, component) in sum {
            let known = value(triangle, component, here);
            whole.value += factor * known.value;
            whole.slack += factor.abs() * known.slack;
        }
        // Beyond the horizon there is no value.
        if depth.value <= 4.0 * depth.slack { Known::ANY } else { whole }
    };
    let (mut low, mut high, mut slack) = (f64::MAX, f64::MIN, 0.0_f64);
    for side in [-1.0, 0.0, 1.0] {
        let ends = [-1.0, 0.0, 1.0].map(|step| of(if along { [step, side] } else { [side, step] }));
        for pair in ends.windows(2) {
            let change = pair[1].value - pair[0].value;
            (low, high) = (low.min(change), high.max(change));
            slack = slack.max(pair[0].slack + pair[1].slack);
        }
    }
    let known = Known::spanning(low, high);
    Known { slack: known.slack + slack, ..known }
}

/// A depth to clear with: the ends, or between them.
pub fn clear_depth(dice: &mut Random) -> f32 {
    dice.pick(&[1.0, 1.0, 0.0, 0.5, 0.25])
}
