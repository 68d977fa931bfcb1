//! Lookups of the model's textures [GL 4.6, 8.14, 8.23]: wraps, filters, levels, comparisons, faces.

use super::glsl::{Asked, Detail, Textures};
use super::images::{Image, Plane, depth_step};
use crate::conformance::model::number::{Num, ROUNDING, SLACK};
use crate::geometry::normal_cube::FACES;
use crate::pass::{Border, Compare, DepthFormat, Filter, Format, Sampler, Wrap};

/// Half of a step of a filter's weights and of a coordinate, in texels: drivers place lookups on a grid. GL has no number
/// for it [GL 4.6, 8.14.2]; the coarsest that is known has 64 steps a texel.
const GRID: f64 = 1.0 / 128.0;

/// Doubt of a level of detail: the logarithm is taken of few bits.
const LEVEL: f64 = 1.0 / 16.0;

/// An image as a sampler sees it.
pub struct Bound<'a> {
    pub image: &'a Image,
    pub sampler: Sampler,
    /// It is a cube map.
    pub is_cube: bool,
    /// Filters of cube maps look across the faces' edges.
    pub seamless: bool,
}

/// Textures of a draw. `None`: the shader's sampler has none.
pub struct BoundTextures<'a>(pub Vec<Option<Bound<'a>>>);

impl Textures for BoundTextures<'_> {
    fn has_levels(&self, sampler: usize) -> bool {
        self.0[sampler].as_ref().is_some_and(|bound| {
            bound.sampler.filter == Filter::Trilinear && bound.sampler.lod_halves.is_none() && bound.image.levels() > 1
        })
    }

    fn look(&self, sampler: usize, asked: &Asked) -> [Num; 4] {
        self.0[sampler].as_ref().map_or([Num::UNKNOWN; 4], |bound| bound.look(asked))
    }

    fn fetch(&self, sampler: usize, at: &[Num], level: Num) -> [Num; 4] {
        let Some(bound) = &self.0[sampler] else { return [Num::UNKNOWN; 4] };
        let Some(level) = level.whole().filter(|level| (0..bound.image.levels() as i64).contains(level)) else {
            return [Num::UNKNOWN; 4];
        };
        let plane = bound.image.plane(level as usize, 0);
        let mut place = [0; 2];
        for (part, at) in at.iter().enumerate() {
            match at.whole().and_then(|at| usize::try_from(at).ok()).filter(|at| *at < plane.size[part]) {
                Some(at) => place[part] = at,
                None => return [Num::UNKNOWN; 4],
            }
        }
        plane.texel(place)
    }

    fn size(&self, sampler: usize) -> [f64; 2] {
        self.0[sampler].as_ref().map_or([0.0; 2], |bound| bound.image.plane(0, 0).size.map(|side| side as f64))
    }
}

/// Texels around a place, row by row, and the place among them.
struct Around {
    texels: Vec<[Num; 4]>,
    columns: usize,
    rows: usize,
    /// From the centre of the first texel, in texels.
    at: [f64; 2],
    /// Doubt of the place.
    off: [f64; 2],
}

impl Bound<'_> {
    fn look(&self, asked: &Asked) -> [Num; 4] {
        if asked.at.iter().any(|at| !at.is_known()) || asked.reference.is_some_and(|reference| !reference.is_known()) {
            return [Num::UNKNOWN; 4];
        }
        let last = self.image.levels() - 1;
        let Some([low, high]) = self.levels(asked) else { return [Num::UNKNOWN; 4] };
        let [low, high] = [low, high].map(|level| level.clamp(0.0, last as f64));
        let mut result = self.between(asked, low);
        let mut level = low.floor() + 1.0;
        while level <= high.floor() {
            result = joined(result, self.between(asked, level));
            level += 1.0;
        }
        if high > low { joined(result, self.between(asked, high)) } else { result }
    }

    /// Least and most level of detail.
    fn levels(&self, asked: &Asked) -> Option<[f64; 2]> {
        if self.sampler.filter != Filter::Trilinear {
            return Some([0.0; 2]);
        }
        if let Some(halves) = self.sampler.lod_halves {
            return Some([0.5 * f64::from(halves); 2]);
        }
        match asked.detail {
            Detail::Any => Some([0.0; 2]),
            Detail::Unknown => None,
            Detail::Range(low, high) => Some([low, high]),
            Detail::Changes(changes) => {
                let size = self.image.plane(0, 0).size;
                let mut axes = [[0.0_f64; 2]; 2];
                for (part, axis) in axes.iter_mut().enumerate() {
                    for change in changes.iter().map(|along| along[part]) {
                        if !change.is_known() {
                            return None;
                        }
                        let (value, reach) = (change.value.abs(), SLACK * change.error);
                        axis[0] = axis[0].max((value - reach).max(0.0) * size[part] as f64);
                        axis[1] = axis[1].max((value + reach) * size[part] as f64);
                    }
                }
                // Between the greatest change and the sum of both axes [GL 4.6, 8.14.1].
                let least = axes[0][0].max(axes[1][0]).max(1e-6).log2() - LEVEL;
                Some([least, (axes[0][1] + axes[1][1]).max(1e-6).log2() + LEVEL])
            }
        }
    }

    /// At a level between two.
    fn between(&self, asked: &Asked, level: f64) -> [Num; 4] {
        let below = level.floor();
        let first = self.level(asked, below as usize);
        if level == below {
            return first;
        }
        let second = self.level(asked, below as usize + 1);
        let share = Num { value: level - below, error: GRID / SLACK };
        std::array::from_fn(|channel| {
            let [a, b] = [first[channel], second[channel]];
            let mixed = b.minus(a).times(share).plus(a);
            if mixed.is_known() { Num::off(mixed.value, mixed.error + self.rounding()) } else { mixed }
        })
    }

    /// Rounding of a filter's arithmetic.
    fn rounding(&self) -> f64 {
        match self.image.format {
            Format::Rgba8 | Format::Rgba8Signed => 1.5 / 255.0 / SLACK,
            _ => 0.0,
        }
    }

    fn level(&self, asked: &Asked, level: usize) -> [Num; 4] {
        let Some(around) =
            (if self.is_cube { self.around_on_cube(asked.at, level) } else { self.around(asked.at, level) })
        else {
            return [Num::UNKNOWN; 4];
        };
        match (self.sampler.compare, asked.reference) {
            (Some(compare), Some(reference)) => self.compared(around, compare, reference),
            _ => self.filtered(&around),
        }
    }

    fn is_nearest(&self) -> bool {
        self.sampler.filter == Filter::Nearest
    }

    /// Texel numbers along one side, unwrapped, and the place from the first one's centre.
    fn span(&self, at: Num, side: usize) -> Option<(i64, i64, f64, f64)> {
        let doubt = GRID + SLACK * at.error * side as f64;
        let place = at.value * side as f64 - if self.is_nearest() { 0.0 } else { 0.5 };
        if doubt > 1.0 || !place.is_finite() || place.abs() > 1e9 {
            return None;
        }
        let first = (place - doubt).floor() as i64;
        let last = (place + doubt).floor() as i64 + i64::from(!self.is_nearest());
        Some((first, last, place - first as f64, doubt))
    }

    fn around(&self, at: &[Num], level: usize) -> Option<Around> {
        let plane = self.image.plane(level, 0);
        let (first, last, x, off_x) = self.span(at[0], plane.size[0])?;
        let (bottom, top, y, off_y) = match at.get(1) {
            Some(at) => self.span(*at, plane.size[1])?,
            None => (0, 0, 0.0, 0.0),
        };
        let mut texels = Vec::with_capacity(9);
        for row in bottom..=top {
            for column in first..=last {
                texels.push(self.wrapped(plane, [column, row]));
            }
        }
        let (columns, rows) = ((last - first + 1) as usize, (top - bottom + 1) as usize);
        Some(Around { texels, columns, rows, at: [x, y], off: [off_x, off_y] })
    }

    fn wrapped(&self, plane: &Plane, at: [i64; 2]) -> [Num; 4] {
        let mut place = [0; 2];
        for part in 0..2 {
            let side = plane.size[part] as i64;
            place[part] = match self.sampler.wrap {
                Wrap::Repeat => at[part].rem_euclid(side),
                Wrap::ClampToEdge => at[part].clamp(0, side - 1),
                Wrap::ClampToBorder(border) => {
                    if !(0..side).contains(&at[part]) {
                        let value = if border == Border::Zero { 0.0 } else { 1.0 };
                        return [Num::exact(value); 4];
                    }
                    at[part]
                }
            } as usize;
        }
        plane.texel(place)
    }

    /// Texels of the face that the greatest component chooses, and beyond its sides those of its neighbours.
    fn around_on_cube(&self, at: &[Num], level: usize) -> Option<Around> {
        let largest = (0..3).max_by(|a, b| at[*a].value.abs().total_cmp(&at[*b].value.abs()))?;
        for other in (0..3).filter(|other| *other != largest) {
            let apart = at[largest].value.abs() - at[other].value.abs();
            if apart <= SLACK * (at[largest].error + at[other].error) + 1e-6 * at[largest].value.abs() {
                return None;
            }
        }
        let face = 2 * largest + usize::from(at[largest].value < 0.0);
        let over = at[largest].magnitude();
        let coordinate = |axis: usize| {
            let along = FACES[face][axis]
                .to_array()
                .iter()
                .zip(at)
                .map(|(a, b)| b.times(Num::exact(*a)))
                .fold(Num::exact(0.0), Num::plus);
            along.over(over).plus(Num::exact(1.0)).times(Num::exact(0.5))
        };
        let [s, t] = [1, 2].map(coordinate);
        if !s.is_known() || !t.is_known() {
            return None;
        }
        let size = self.image.plane(level, face).size[0];
        let (first, last, x, off_x) = self.span(s, size)?;
        let (bottom, top, y, off_y) = self.span(t, size)?;
        let mut texels = Vec::with_capacity(9);
        for row in bottom..=top {
            for column in first..=last {
                texels.push(self.across(level, face, [column, row])?);
            }
        }
        let (columns, rows) = ((last - first + 1) as usize, (top - bottom + 1) as usize);
        Some(Around { texels, columns, rows, at: [x, y], off: [off_x, off_y] })
    }

    /// A texel of a face, or of the one beside it; `None`: beyond a corner.
    fn across(&self, level: usize, face: usize, [x, y]: [i64; 2]) -> Option<[Num; 4]> {
        let size = self.image.plane(level, face).size[0] as i64;
        let is_out = [x, y].map(|at| !(0..size).contains(&at));
        if self.is_nearest() || is_out == [false; 2] || !self.seamless {
            let place = [x, y].map(|at| at.clamp(0, size - 1) as usize);
            return Some(self.image.plane(level, face).texel(place));
        }
        if is_out == [true; 2] {
            return None;
        }
        let middle = |at: i64| (2 * at + 1) as f64 / size as f64 - 1.0;
        let way = FACES[face][0] + middle(x) * FACES[face][1] + middle(y) * FACES[face][2];
        let next = (0..6).max_by(|a, b| way.dot(FACES[*a][0]).total_cmp(&way.dot(FACES[*b][0])))?;
        let out = way.dot(FACES[next][0]);
        let place = [1, 2].map(|axis: usize| {
            let at = (0.5 + 0.5 * way.dot(FACES[next][axis]) / out) * size as f64;
            (at.floor() as i64).clamp(0, size - 1) as usize
        });
        Some(self.image.plane(level, next).texel(place))
    }

    fn filtered(&self, around: &Around) -> [Num; 4] {
        if self.is_nearest() {
            return around.texels[1..].iter().fold(around.texels[0], |all, texel| joined(all, *texel));
        }
        std::array::from_fn(|channel| {
            let values: Vec<Num> = around.texels.iter().map(|texel| texel[channel]).collect();
            around.mean(&values, self.rounding())
        })
    }

    fn compared(&self, around: Around, compare: Compare, reference: Num) -> [Num; 4] {
        let format = self.image.format;
        let mut reference = reference;
        if !matches!(format, Format::Depth(DepthFormat::Depth32F)) {
            reference = reference.most(Num::exact(0.0)).least(Num::exact(1.0));
        }
        if reference.error != 0.0 || (reference.value != 0.0 && reference.value != 1.0) {
            // A reference may be rounded to what the texture holds.
            reference.error += depth_step(format) / SLACK;
        }
        let values: Vec<Num> =
            around.texels.iter().map(|texel| Num::boolean(holds(compare, reference, texel[0]))).collect();
        let result = if self.is_nearest() {
            values[1..].iter().fold(values[0], |all, value| either(all, *value))
        } else {
            around.comparisons(&values)
        };
        [result, result, result, Num::exact(1.0)]
    }
}

impl Around {
    /// GL_LINEAR's weighted mean.
    fn mean(&self, values: &[Num], rounding: f64) -> Num {
        if values.iter().any(|value| !value.is_known()) {
            return Num::UNKNOWN;
        }
        let (mut value, mut worst, mut size) = (0.0, 0.0_f64, 0.0_f64);
        let (mut along, mut up) = (0.0_f64, 0.0_f64);
        let weight = |at: f64, index: usize| (1.0 - (at - index as f64).abs()).max(0.0);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let index = row * self.columns + column;
                let texel = values[index];
                let weight_y = if self.rows == 1 { 1.0 } else { weight(self.at[1], row) };
                value += weight(self.at[0], column) * weight_y * texel.value;
                (worst, size) = (worst.max(texel.error), size.max(texel.value.abs()));
                if column > 0 {
                    along = along.max((texel.value - values[index - 1].value).abs());
                }
                if row > 0 {
                    up = up.max((texel.value - values[index - self.columns].value).abs());
                }
            }
        }
        let moved = self.off[0] * along + self.off[1] * up;
        let rounding = if moved == 0.0 && worst == 0.0 { 0.0 } else { rounding };
        Num::off(value, worst + moved / SLACK + rounding + 4.0 * ROUNDING * size)
    }

    /// Four comparisons as one number: proportional to those that pass [GL 4.6, 8.23.1], by GL_LINEAR's weights or by their
    /// count.
    fn comparisons(&self, values: &[Num]) -> Num {
        if values.iter().any(|value| !value.is_known()) {
            return Num::UNKNOWN;
        }
        if values.iter().all(|value| *value == values[0]) {
            return values[0];
        }
        let mut result = self.mean(values, 1.0 / 255.0 / SLACK);
        // Where the place may be between one pair of texels or the next, any count of either.
        for row in 0..self.rows - 1 {
            for column in 0..self.columns - 1 {
                let four = [0, 1, self.columns, self.columns + 1];
                let count: f64 = four.iter().map(|step| values[row * self.columns + column + step].value).sum();
                result = either(result, Num::exact(count / 4.0));
            }
        }
        result
    }
}

use super::glsl::either_of as either;

fn joined(a: [Num; 4], b: [Num; 4]) -> [Num; 4] {
    std::array::from_fn(|channel| either(a[channel], b[channel]))
}

/// A comparison of two numbers, if the errors leave no doubt.
pub fn holds(compare: Compare, a: Num, b: Num) -> Option<bool> {
    match compare {
        Compare::Never => return Some(false),
        Compare::Always => return Some(true),
        _ if !a.is_known() || !b.is_known() => return None,
        _ => {}
    }
    match compare {
        Compare::Less => a.below(b),
        Compare::LessEqual => b.below(a).map(|above| !above),
        Compare::Greater => b.below(a),
        Compare::GreaterEqual => a.below(b).map(|below| !below),
        Compare::Equal => a.equals(b),
        Compare::NotEqual => a.equals(b).map(|equal| !equal),
        Compare::Never | Compare::Always => None,
    }
}
