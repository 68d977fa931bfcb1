//! Texture look-ups in f64: texels by wrap mode, filters within a level and between two, comparisons [GL 4.6, 8.14, 8.23]. A
//! result is a list of spans: the values that may come out.

use super::model::{Comparison, Level, Shape, Span, Texture};
use crate::conformance::bench::{GlMipmap, GlWrap, Sampling};
use crate::conformance::verify::cube;

/// Where and how a texture is read.
#[derive(Clone, Copy)]
pub struct Query<'a> {
    pub texture: &'a Texture,
    /// Parameters in force, with the texture's own levels and swizzle.
    pub sampling: &'a Sampling,
    pub seamless: bool,
    pub compare: Option<Comparison>,
    /// s, t, r: a direction for a cube map, a layer as r of an array.
    pub at: [f64; 3],
    /// Relative error of the coordinates.
    pub error: f64,
    /// The offset of textureOffset.
    pub offset: [i64; 3],
    /// lambda before the bounds: least, most.
    pub lod: [f64; 2],
}

/// Slack of positions in texels for a filter, for the nearest texel, and of a level's number.
const POSITION: [f64; 2] = [1.0 / 128.0, 1.0 / 16.0];
const NEAREST: [f64; 2] = [1.0 / 128.0, 1.0 / 64.0];
const LOD: [f64; 2] = [1.0 / 16.0, 1.0 / 16.0];

/// A place on a layer or face, in parts of its size.
#[derive(Clone, Copy)]
struct Place {
    face: Option<usize>,
    at: [f64; 3],
}

impl Query<'_> {
    /// Everything that may come out; `None` if too much may.
    pub fn spans(&self, tier: usize) -> Option<Vec<Span>> {
        let mut spans = Vec::new();
        if self.texture.shape == Shape::Cube {
            for face in cube::faces(self.at) {
                let [s, t] = cube::on_face(face, self.at);
                self.at_place(Place { face: Some(face), at: [s, t, 0.0] }, tier, &mut spans)?;
            }
        } else {
            self.at_place(Place { face: None, at: self.at }, tier, &mut spans)?;
        }
        (spans.len() <= 48).then_some(spans)
    }

    /// TexelBase level and the last that there is.
    fn range(&self) -> [f64; 2] {
        let last = self.texture.levels.len() as u32 - 1;
        let [base, most] = self.sampling.levels.unwrap_or([0, last]);
        [f64::from(base), f64::from(most.min(last).max(base))]
    }

    fn at_place(&self, place: Place, tier: usize, spans: &mut Vec<Span>) -> Option<()> {
        let [base, most] = self.range();
        let minified = self.sampling.linear;
        let magnified = self.sampling.magnified.unwrap_or(minified);
        if self.sampling.mipmap == GlMipmap::Off && magnified == minified {
            return self.level(base as usize, place, minified, tier, spans);
        }
        let [least, greatest] = self.lod;
        let clamp = |lod: f64| lod.clamp(f64::from(self.sampling.lod[0]), f64::from(self.sampling.lod[1]));
        let [low, high] = [least - LOD[tier], greatest + LOD[tier]].map(clamp);
        // Between 0 and 1/2 either filter is right where the magnifying one is LINEAR and the other NEAREST by levels.
        let half = if magnified && !minified && self.sampling.mipmap != GlMipmap::Off { 0.5 } else { 0.0 };
        if low <= half {
            self.level(base as usize, place, magnified, tier, spans)?;
        }
        if high <= 0.0 {
            return Some(());
        }
        let [low, high] = [low.max(0.0), high].map(|lod| (base + lod).min(most));
        match self.sampling.mipmap {
            GlMipmap::Off => self.level(base as usize, place, minified, tier, spans)?,
            GlMipmap::Nearest => {
                let nearest = |lod: f64| ((lod + 0.5).ceil() - 1.0).clamp(base, most) as usize;
                for level in nearest(low)..=nearest(high) {
                    self.level(level, place, minified, tier, spans)?;
                }
            }
            GlMipmap::Linear => {
                for level in low.floor() as usize..=high.floor() as usize {
                    let floor = level as f64;
                    let shares = [low.max(floor) - floor, high.min(floor + 1.0) - floor];
                    let mut near = Vec::new();
                    self.level(level, place, minified, tier, &mut near)?;
                    if floor >= most {
                        spans.extend(near);
                        continue;
                    }
                    let mut far = Vec::new();
                    self.level(level + 1, place, minified, tier, &mut far)?;
                    for a in &near {
                        spans.extend(far.iter().map(|b| a.blend(b, shares)));
                    }
                }
            }
        }
        Some(())
    }

    /// Texels of one level.
    fn level(&self, level: usize, place: Place, linear: bool, tier: usize, spans: &mut Vec<Span>) -> Option<()> {
        let texels = self.texture.levels.get(level)?;
        if !texels.known {
            return None;
        }
        let shape = self.texture.shape;
        let axes = shape.axes();
        let mut place_in = [0.0; 3];
        let mut slack = [0.0; 3];
        for axis in 0..axes {
            let size = if shape == Shape::Rectangle { 1.0 } else { texels.size[axis] as f64 };
            place_in[axis] = place.at[axis] * size + self.offset[axis] as f64;
            let reach = place.at[axis].abs().max(1.0) * size;
            slack[axis] = reach * self.error + if linear { POSITION[tier] } else { NEAREST[tier] };
            if slack[axis] > 0.4 || place_in[axis].abs() > 1e9 {
                return None;
            }
        }
        let layer = match shape {
            Shape::Array => (place.at[2] + 0.5).floor().clamp(0.0, texels.size[2] as f64 - 1.0) as i64,
            Shape::Cube => place.face.unwrap_or(0) as i64,
            _ => 0,
        };
        if linear {
            self.linear(texels, (place_in, slack), layer, tier, spans)
        } else {
            self.nearest(texels, (place_in, slack), layer, spans)
        }
    }

    fn nearest(
        &self,
        texels: &Level,
        (place, slack): ([f64; 3], [f64; 3]),
        layer: i64,
        spans: &mut Vec<Span>,
    ) -> Option<()> {
        let ends = [0, 1, 2].map(|axis| [-slack[axis], slack[axis]].map(|slack| (place[axis] + slack).floor() as i64));
        for z in ends[2][0]..=ends[2][1] {
            for y in ends[1][0]..=ends[1][1] {
                for x in ends[0][0]..=ends[0][1] {
                    // NEAREST at a face's edge stays on the face.
                    let at = if self.texture.shape == Shape::Cube && self.seamless {
                        [x, y].map(|at| at.clamp(0, texels.size[0] as i64 - 1))
                    } else {
                        [x, y]
                    };
                    let texel = self.texel(texels, [at[0], at[1], z], layer)?;
                    self.results(texel, texels.slack, spans);
                }
            }
        }
        Some(())
    }

    /// A texel as the filter sees it: itself, or what a comparison with it gives.
    fn results(&self, texel: [f64; 4], slack: f64, spans: &mut Vec<Span>) {
        match self.compare {
            None => spans.push(Span::of(texel, slack)),
            Some(comparison) => {
                for passes in comparison.passes(texel[0], slack).into_iter().flatten() {
                    spans.push(Span::of([passes, 0.0, 0.0, 1.0], 0.0));
                }
            }
        }
    }

    fn linear(
        &self,
        texels: &Level,
        (place, slack): ([f64; 3], [f64; 3]),
        layer: i64,
        tier: usize,
        spans: &mut Vec<Span>,
    ) -> Option<()> {
        let axes = self.texture.shape.axes();
        let mut from = [0; 3];
        let mut ends = [[0; 2]; 3];
        let mut share = [0.0; 3];
        for axis in 0..axes {
            let middle = place[axis] - 0.5;
            from[axis] = middle.floor() as i64;
            share[axis] = middle - middle.floor();
            ends[axis] = [(middle - slack[axis]).floor() as i64, (middle + slack[axis]).floor() as i64 + 1];
        }
        let (mut low, mut high, mut mean) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4], [0.0; 4]);
        let mut corner = Vec::new();
        let mut weight_left = 0.0;
        let mut there: ([f64; 4], f64) = ([0.0; 4], 0.0);
        for z in ends[2][0]..=ends[2][1] {
            for y in ends[1][0]..=ends[1][1] {
                for x in ends[0][0]..=ends[0][1] {
                    let mut weight = 1.0;
                    for (axis, at) in [x, y, z].into_iter().enumerate().take(axes) {
                        weight *= match at - from[axis] {
                            0 => 1.0 - share[axis],
                            1 => share[axis],
                            _ => 0.0,
                        };
                    }
                    let inside = (0..axes).all(|axis| ([x, y, z][axis] - from[axis]) as u64 <= 1);
                    let Some(texel) = self.texel(texels, [x, y, z], layer) else {
                        weight_left += weight;
                        corner.push([x, y]);
                        continue;
                    };
                    let texel = match self.compare {
                        None => texel,
                        Some(comparison) => {
                            let [Some(passes), None] = comparison.passes(texel[0], texels.slack) else { return None };
                            [passes, 0.0, 0.0, 1.0]
                        }
                    };
                    for channel in 0..4 {
                        low[channel] = low[channel].min(texel[channel]);
                        high[channel] = high[channel].max(texel[channel]);
                        mean[channel] += weight * texel[channel];
                    }
                    if inside {
                        there = ([0, 1, 2, 3].map(|channel| there.0[channel] + texel[channel]), there.1 + 1.0);
                    }
                }
            }
        }
        let most = low.into_iter().chain(high).map(f64::abs).fold(0.0, f64::max);
        let slack_of_texels = if self.compare.is_some() { 0.0 } else { texels.slack };
        let mut span = Span { low, high, most, blended: true, slack: slack_of_texels };
        if corner.is_empty() || tier == 0 && weight_left > 0.0 {
            for channel in 0..4 {
                // The fourth texel at a cube's corner is the mean of the three.
                let middle = mean[channel] + weight_left * there.0[channel] / there.1.max(1.0);
                let slack: f64 = slack[..axes].iter().sum();
                let reach = slack * (high[channel] - low[channel]);
                span.low[channel] = (middle - reach).max(low[channel]);
                span.high[channel] = (middle + reach).min(high[channel]);
            }
        }
        if self.compare.is_some() {
            self.loosen(&mut span, there, tier);
        }
        spans.push(span);
        Some(())
    }

    /// A filtered comparison is "proportional to the number of comparison passes": five bits of it, and at most the mean of all
    /// or what is nearest.
    fn loosen(&self, span: &mut Span, there: ([f64; 4], f64), tier: usize) {
        let all_same = span.low[0] == span.high[0];
        let error = if all_same { 0.0 } else { 1.0 / 32.0 };
        if tier == 1 && !all_same {
            let mean = there.0[0] / there.1.max(1.0);
            span.low[0] = span.low[0].min(mean);
            span.high[0] = span.high[0].max(mean);
        }
        span.low[0] -= error;
        span.high[0] += error;
    }

    /// The texel at a place of any column, row and slice; `None` beyond two edges of a seamless face.
    fn texel(&self, texels: &Level, place: [i64; 3], layer: i64) -> Option<[f64; 4]> {
        let shape = self.texture.shape;
        if shape == Shape::Cube && self.seamless {
            return self.seamless_texel(texels, [place[0], place[1]], layer as usize);
        }
        let mut inside = [0, 0, layer];
        for axis in 0..shape.axes() {
            let size = texels.size[axis] as i64;
            let at = place[axis];
            inside[axis] = match self.sampling.wrap[axis] {
                GlWrap::Repeat => at.rem_euclid(size),
                GlWrap::MirroredRepeat => {
                    let there = at.rem_euclid(2 * size);
                    if there < size { there } else { 2 * size - 1 - there }
                }
                GlWrap::ClampToEdge => at.clamp(0, size - 1),
                GlWrap::ClampToBorder | GlWrap::Clamp if (0..size).contains(&at) => at,
                GlWrap::ClampToBorder | GlWrap::Clamp => {
                    return Some(self.texture.format.border(self.sampling.border.map(f64::from)));
                }
            };
        }
        Some(texels.at(inside))
    }

    fn seamless_texel(&self, texels: &Level, [column, row]: [i64; 2], face: usize) -> Option<[f64; 4]> {
        let side = texels.size[0] as i64;
        let beyond = [column, row].map(|index| !(0..side).contains(&index));
        match beyond {
            [true, true] => None,
            [false, false] => Some(texels.at([column, row, face as i64])),
            _ => {
                // As far from the edge as the middle of the texel that is asked for, folded inwards.
                let middle = [column, row].map(|index| (index as f64 + 0.5) / side as f64);
                let mut folded = cube::direction(face, middle.map(|at| at.clamp(0.0, 1.0)));
                let over = middle.map(|at| (at - 0.5).abs() - 0.5).into_iter().fold(0.0, f64::max);
                folded[face / 2] *= 1.0 - 2.0 * over;
                let other = cube::faces(folded).find(|other| other / 2 != face / 2)?;
                let [x, y] =
                    cube::on_face(other, folded).map(|at| ((at * side as f64).floor() as i64).clamp(0, side - 1));
                Some(texels.at([x, y, other as i64]))
            }
        }
    }

    /// The four texels of textureGather, as GL orders them, unless the position leaves them open.
    pub fn gathered(&self) -> Option<[[f64; 4]; 4]> {
        let [base, _] = self.range();
        let texels = self.texture.levels.get(base as usize)?;
        let mut from = [0; 2];
        let rectangle = self.texture.shape == Shape::Rectangle;
        for (axis, from) in from.iter_mut().enumerate() {
            let size = if rectangle { 1.0 } else { texels.size[axis] as f64 };
            let middle = self.at[axis] * size - 0.5;
            let slack = self.at[axis].abs().max(1.0) * size * self.error + NEAREST[1];
            *from = (middle - slack).floor() as i64;
            if *from != (middle + slack).floor() as i64 || !texels.known {
                return None;
            }
        }
        let layer = if self.texture.shape == Shape::Array {
            (self.at[2] + 0.5).floor().clamp(0.0, texels.size[2] as f64 - 1.0) as i64
        } else {
            0
        };
        let mut four = [[0.0; 4]; 4];
        for (texel, [x, y]) in four.iter_mut().zip([[0, 1], [1, 1], [1, 0], [0, 0]]) {
            *texel = self.texel(texels, [from[0] + x + self.offset[0], from[1] + y + self.offset[1], 0], layer)?;
            if let Some(comparison) = self.compare {
                let [Some(passes), None] = comparison.passes(texel[0], texels.slack) else { return None };
                *texel = [passes; 4];
            }
        }
        Some(four)
    }
}
