//! Normals of a bump map from the heights in its file, in f64: slopes, smaller levels, their codes, and GL's filter with
//! bounds. No function of the renderer's own maps is used.

use glam::{DVec2, DVec3};

use super::span::Ball;
use crate::geometry::bump::{Bump, BumpSource, NormalFormat};
use crate::geometry::normal_map::{Difference, HeightField, HeightWrap, MipColors};
use crate::truth::color::bounds::Bounds;
use crate::truth::color::projected::Place;

/// Accuracy of a filter's weights, as a share of the difference between texels: 8 bits each way.
const WEIGHTS: f64 = 2.0 / 256.0;

/// Factor by which a driver's own derivatives may differ from those in the pixel's middle: they are those of two by two
/// pixels.
const DERIVATIVES: f64 = 1.15;

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

    /// The normal at a place: the value of a filter of mipmaps, and a ball that holds what every level has that the filter
    /// may meet [GL 4.6, 8.14.1].
    pub(super) fn look(&self, place: &Place) -> Filtered {
        let size = DVec2::new(self.levels[0].width as f64, self.levels[0].height as f64);
        let [right, up] = place.pixel.map(|step| step * size);
        let widest = right.max(up);
        let [low, middle, high] =
            [widest.max_element() / DERIVATIVES, right.length().max(up.length()), (widest.x + widest.y) * DERIVATIVES];
        let last = self.levels.len() - 1;
        if !(place.st.is_finite() && high.is_finite()) {
            let any = Ball { at: DVec3::Z, error: 2.0 };
            return Filtered { normal: any, dim: Bounds::anything(1.0) };
        }
        let level = |texels: f64| texels.max(1.0).log2().min(last as f64);
        let (first, end) = (level(low).floor() as usize, level(high).ceil() as usize);
        let samples: Vec<Sampled> = (first..=end).map(|index| self.sampled(index, place)).collect();
        let middle = level(middle);
        let index = (middle.floor() as usize).clamp(first, end);
        let (one, other) = (&samples[index - first], &samples[(index + 1).min(end) - first]);
        let part = middle - middle.floor();
        let at = one.normal.lerp(other.normal, part);
        let dim = one.dim + part * (other.dim - one.dim);
        let error = samples.iter().map(|sample| sample.normal.distance(at) + sample.error).fold(0.0, f64::max);
        let dims = samples.iter().flat_map(|sample| [sample.dim - sample.dim_error, sample.dim + sample.dim_error]);
        let dim = Bounds::around(dim, dims.map(|dim| dim.clamp(0.0, 1.0)));
        Filtered { normal: Ball { at, error }, dim }
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
        let pairs = || corners.iter().flat_map(|one| corners.iter().map(move |other| (one.1, other.1)));
        let contrast = pairs().map(|(one, other)| one.0.distance(other.0)).fold(0.0, f64::max);
        let dim_contrast = pairs().map(|(one, other)| (one.1 - other.1).abs()).fold(0.0, f64::max);
        (normal, dim, contrast, dim_contrast)
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
