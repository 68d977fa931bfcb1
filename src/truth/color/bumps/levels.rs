//! Normals of a bump map from the heights in its file, in f64: slopes, smaller levels, their codes, and GL's filter with
//! bounds. No function of the renderer's own maps is used.

use glam::{DVec2, DVec3};

use super::span::Ball;
use crate::geometry::bump::{Bump, BumpSource, NormalFormat};
use crate::geometry::normal_map::{Difference, HeightField, HeightWrap, MipColors};
use crate::truth::color::bounds::Bounds;
use crate::truth::color::projected::Place;

/// Accuracy of a filter's weights, as a share of the difference between two texels: half of a step of 8 bits.
const WEIGHTS: f64 = 0.5 / 256.0;

/// Share by which a driver's size of a pixel in texels may be off [GL 4.6, 8.14.1 asks for the greater of two lengths, and
/// admits what is near it], beside the pixel's perspective.
const LEAST_SLACK: f64 = 0.05;

/// A normal map with its smaller levels, as GL reads them.
pub(in crate::truth::color) struct BumpMap {
    levels: Vec<Level>,
    is_clamped: bool,
    /// Error of a filtered vector that is rounded to the map's format once more.
    rounded: f64,
}

/// Texels of a level, rows from the bottom up: a vector and its dimming.
struct Level {
    width: usize,
    height: usize,
    texels: Vec<(DVec3, f64)>,
}

/// A filtered normal in tangent space, and the factor of diffuse light.
pub(super) struct Filtered {
    pub normal: Ball,
    pub dim: Bounds,
}

impl BumpMap {
    pub fn new(bump: &Bump) -> Self {
        let (mut width, mut height, mut means) = match &bump.source {
            BumpSource::Heights { field, scale, difference } => {
                (field.width as usize, field.height as usize, normals(field, *scale, *difference, bump.border))
            }
            // As the picture has them: 2 c - 1, of unit length.
            BumpSource::Normals { normals, .. } => {
                (normals.width as usize, normals.height as usize, normals.means.clone())
            }
        };
        let mut levels = Vec::new();
        loop {
            let texels = means.iter().map(|mean| packed(*mean, bump.format, bump.colors)).collect();
            levels.push(Level { width, height, texels });
            if width.max(height) == 1 {
                break;
            }
            let [half_width, half_height] = [width, height].map(|side| (side / 2).max(1));
            means = covered(&means, [width, height], [half_width, half_height]);
            (width, height) = (half_width, half_height);
        }
        let rounded = if bump.format == NormalFormat::Unsigned { 3.0_f64.sqrt() / 255.0 } else { 0.0 };
        Self { levels, is_clamped: bump.border == HeightWrap::Clamp, rounded }
    }

    /// The normal at a place: the value of a filter of mipmaps, and a ball that holds what the filter has where the pixel's
    /// size in texels is off. `perspective`: share by which that changes from a pixel to the next, of which a driver takes
    /// differences [GL 4.6, 8.14.1].
    pub(super) fn look(&self, place: &Place, perspective: f64) -> Filtered {
        let size = DVec2::new(self.levels[0].width as f64, self.levels[0].height as f64);
        let widest = place.pixel.map(|step| (step * size).length()).into_iter().fold(0.0, f64::max);
        let slack = 1.0 + LEAST_SLACK + 2.0 * perspective;
        let last = (self.levels.len() - 1) as f64;
        let level = |texels: f64| texels.max(1.0).log2().min(last);
        let [low, middle, high] = [widest / slack, widest, widest * slack].map(level);
        if !(place.st.is_finite() && high.is_finite()) {
            let any = Ball { at: DVec3::Z, error: 2.0 };
            return Filtered { normal: any, dim: Bounds::anything(1.0) };
        }
        let value = self.between(middle, place);
        let mut sampled = vec![self.between(low, place), self.between(high, place)];
        // Between whole levels the filter is linear.
        sampled.extend((low.ceil() as usize..=high.floor() as usize).map(|whole| self.between(whole as f64, place)));
        let error =
            sampled.iter().map(|sample| sample.normal.distance(value.normal) + sample.error).fold(0.0, f64::max);
        let dims = sampled.iter().flat_map(|sample| [sample.dim - sample.dim_error, sample.dim + sample.dim_error]);
        let dim = Bounds::around(value.dim, dims.map(|dim| dim.clamp(0.0, 1.0)));
        Filtered { normal: Ball { at: value.normal, error }, dim }
    }

    /// Two levels, mixed.
    fn between(&self, level: f64, place: &Place) -> Sampled {
        let part = level - level.floor();
        let one = self.sampled(level.floor() as usize, place);
        if part == 0.0 {
            return one;
        }
        let other = self.sampled(level.floor() as usize + 1, place);
        let weights = WEIGHTS * one.normal.distance(other.normal);
        Sampled {
            normal: one.normal.lerp(other.normal, part),
            dim: one.dim + part * (other.dim - one.dim),
            error: one.error.max(other.error) + weights,
            dim_error: one.dim_error.max(other.dim_error) + WEIGHTS * (one.dim - other.dim).abs(),
        }
    }

    /// One level's own.
    fn sampled(&self, index: usize, place: &Place) -> Sampled {
        let level = &self.levels[index];
        let size = DVec2::new(level.width as f64, level.height as f64);
        let cell = |st: DVec2| level.bilinear(st * size - 0.5, self.is_clamped);
        let (normal, dim, contrast, dim_contrast) = cell(place.st);
        let mut found = Sampled { normal, dim, error: 0.0, dim_error: 0.0 };
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let (beside, dim_beside, ..) = cell(place.st + DVec2::new(x, y) * place.error);
            found.error = found.error.max(beside.distance(normal));
            found.dim_error = found.dim_error.max((dim_beside - dim).abs());
        }
        found.error += contrast * WEIGHTS + if contrast > 0.0 { self.rounded } else { 0.0 };
        found.dim_error += dim_contrast * WEIGHTS;
        found
    }
}

struct Sampled {
    normal: DVec3,
    dim: f64,
    error: f64,
    dim_error: f64,
}

impl Level {
    /// GL's linear filter [GL 4.6, 8.14.2]; `at` in texels, texel 0 at 0. Vector and dimming, and how far the four texels
    /// of each are apart.
    fn bilinear(&self, at: DVec2, is_clamped: bool) -> (DVec3, f64, f64, f64) {
        let (first, part) = (at.floor(), at - at.floor());
        let index = |at: f64, count: usize| match is_clamped {
            true => at.clamp(0.0, (count - 1) as f64) as usize,
            false => (at.rem_euclid(count as f64) as usize).min(count - 1),
        };
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
            let texel = index(first.y + y, self.height) * self.width + index(first.x + x, self.width);
            let weight = (1.0 - (part.x - x).abs()) * (1.0 - (part.y - y).abs());
            (weight, self.texels[texel])
        });
        let normal = corners.iter().map(|(weight, (normal, _))| *weight * *normal).sum();
        let dim = corners.iter().map(|(weight, (_, dim))| weight * dim).sum();
        // Across and upwards, each has a weight of its own.
        let contrast =
            |apart: &dyn Fn(usize, usize) -> f64| apart(0, 1).max(apart(2, 3)) + apart(0, 2).max(apart(1, 3));
        let texel = |corner: usize| corners[corner].1;
        let vectors = contrast(&|one, other| texel(one).0.distance(texel(other).0));
        (normal, dim, vectors, contrast(&|one, other| (texel(one).1 - texel(other).1).abs()))
    }
}

/// Normals of heights: normalize(-k dh/ds, -k dh/dt, 1), differences from texel to texel.
fn normals(field: &HeightField, scale: f64, difference: Difference, border: HeightWrap) -> Vec<DVec3> {
    let (width, height) = (i64::from(field.width), i64::from(field.height));
    let wrap = |at: i64, count: i64| match border {
        HeightWrap::Repeat => (at + count) % count,
        HeightWrap::Clamp => at.max(0).min(count - 1),
    };
    let height_at = |x: i64, y: i64| {
        let texel = wrap(y, height) * width + wrap(x, width);
        f64::from(field.heights[texel as usize])
    };
    let mut normals = Vec::with_capacity((width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let rise = match difference {
                Difference::Forward => {
                    let here = height_at(x, y);
                    [height_at(x + 1, y) - here, height_at(x, y + 1) - here]
                }
                Difference::Central => [
                    (height_at(x + 1, y) - height_at(x - 1, y)) / 2.0,
                    (height_at(x, y + 1) - height_at(x, y - 1)) / 2.0,
                ],
            };
            let slope = rise.map(|rise| scale * rise);
            let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
            normals.push(DVec3::new(-slope[0] / length, -slope[1] / length, 1.0 / length));
        }
    }
    normals
}

/// The next level: each texel the mean over the area that it covers.
fn covered(means: &[DVec3], [width, height]: [usize; 2], [to_width, to_height]: [usize; 2]) -> Vec<DVec3> {
    let overlap = |from: usize, to: usize, count: usize, to_count: usize| {
        // In units of a texel of the smaller level times one of the larger.
        let [start, end] = [from * to_count, (from + 1) * to_count];
        let [to_start, to_end] = [to * count, (to + 1) * count];
        end.min(to_end).saturating_sub(start.max(to_start)) as f64 / count as f64
    };
    let mut smaller = Vec::with_capacity(to_width * to_height);
    for to_y in 0..to_height {
        for to_x in 0..to_width {
            let mut sum = DVec3::ZERO;
            for y in to_y * height / to_height..((to_y + 1) * height).div_ceil(to_height) {
                for x in to_x * width / to_width..((to_x + 1) * width).div_ceil(to_width) {
                    let share = overlap(x, to_x, width, to_width) * overlap(y, to_y, height, to_height);
                    sum += share * means[y * width + x];
                }
            }
            smaller.push(sum);
        }
    }
    smaller
}

/// A mean of normals as its texel holds it, in codes of the format: round(127 x), or round(255 (x / 2 + 1 / 2)).
fn packed(mean: DVec3, format: NormalFormat, colors: MipColors) -> (DVec3, f64) {
    let length = mean.length();
    let (vector, dim) = match colors {
        MipColors::Mean => (mean, 1.0),
        MipColors::UnitAndLength if length > 0.0 => (mean / length, length.min(1.0)),
        MipColors::UnitAndLength => (DVec3::Z, 0.0),
    };
    match format {
        NormalFormat::Signed => (vector.to_array().map(|part| (127.0 * part).round() / 127.0).into(), signed(dim)),
        NormalFormat::Unsigned => {
            let code = |part: f64| 2.0 * (255.0 * (0.5 * part + 0.5)).round() / 255.0 - 1.0;
            (vector.to_array().map(code).into(), (255.0 * dim).round() / 255.0)
        }
    }
}

fn signed(value: f64) -> f64 {
    (127.0 * value).round() / 127.0
}
