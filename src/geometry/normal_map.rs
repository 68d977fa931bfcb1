//! Normal maps from height fields, and their smaller levels, on the CPU.
//!
//! Normals are in tangent space: x along s, y along t, z outwards. A level below the first averages vectors, not colours:
//! where normals differ, their mean is shorter than one, and that length dims the diffuse light [GDC, "Bump Map Mipmapping"].

use std::path::Path;

use glam::{DVec2, DVec3};

use super::{Error, text, texture};

/// Heights in [0, 1], rows from the bottom up.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    /// The file's path, or a built-in's name.
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// `width * height` heights.
    pub heights: Vec<f32>,
}

/// Neighbours that a slope is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Difference {
    /// The next texel and this one: first order, half a texel off.
    Forward,
    /// The texels on both sides: second order.
    #[default]
    Central,
}

/// Heights beyond the border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HeightWrap {
    #[default]
    Repeat,
    /// The border's own.
    Clamp,
}

/// Vectors of one level of a normal map, rows from the bottom up.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalLevel {
    pub width: u32,
    pub height: u32,
    /// Means of the unit normals that each texel covers: `width * height` vectors of length 1 or less.
    pub means: Vec<DVec3>,
}

/// Colours of a normal map's levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MipColors {
    /// RGB: the mean's direction; alpha: its length, which the diffuse light is multiplied by.
    #[default]
    UnitAndLength,
    /// RGB: the mean itself; alpha: 1. Its length dims N' · L already.
    Mean,
}

impl HeightField {
    /// The height at a texel that may lie beyond the border.
    fn at(&self, x: i64, y: i64, border: HeightWrap) -> f64 {
        let inside = |at: i64, count: u32| match border {
            HeightWrap::Repeat => at.rem_euclid(i64::from(count)),
            HeightWrap::Clamp => at.clamp(0, i64::from(count) - 1),
        };
        let (x, y) = (inside(x, self.width), inside(y, self.height));
        f64::from(self.heights[(y * i64::from(self.width) + x) as usize])
    }

    /// Normals of the surface (s, t, `scale` · height), s and t in texels: normalize(-scale ∂h/∂s, -scale ∂h/∂t, 1).
    pub fn normals(&self, scale: f64, difference: Difference, border: HeightWrap) -> NormalLevel {
        let slope = |x: i64, y: i64, step: [i64; 2]| {
            let beside = |sign: i64| self.at(x + sign * step[0], y + sign * step[1], border);
            match difference {
                Difference::Forward => beside(1) - beside(0),
                Difference::Central => 0.5 * (beside(1) - beside(-1)),
            }
        };
        let texels = (0..i64::from(self.height)).flat_map(|y| (0..i64::from(self.width)).map(move |x| [x, y]));
        let means = texels
            .map(|[x, y]| DVec3::new(-scale * slope(x, y, [1, 0]), -scale * slope(x, y, [0, 1]), 1.0).normalize())
            .collect();
        NormalLevel { width: self.width, height: self.height, means }
    }
}

/// Reads a picture's heights: the luminance of its colours, with 16 bits where the file has them.
///
/// # Errors
///
/// Those of [`super::load_texture`].
pub fn load_heights(path: &Path) -> Result<HeightField, Error> {
    decode_heights(path, &text::read(path)?)
}

/// [`load_heights`] of a file that is in memory; `path` is its name.
pub fn decode_heights(path: &Path, bytes: &[u8]) -> Result<HeightField, Error> {
    let picture = texture::decode(path, bytes)?.flipv();
    let (width, height) = (picture.width(), picture.height());
    let heights = picture.into_luma16().into_raw().into_iter().map(|height| f32::from(height) / 65535.0).collect();
    Ok(HeightField { name: path.display().to_string(), width, height, heights })
}

impl NormalLevel {
    /// A level of GL's next size, down to 1 × 1; each texel the mean of what it covers, in shares where a side is odd.
    #[must_use]
    pub fn halved(&self) -> Self {
        let [width, height] = [self.width, self.height].map(|side| (side / 2).max(1));
        let across = spans(self.width, width);
        let up = spans(self.height, height);
        let mean = |x: usize, y: usize| {
            let mut sum = DVec3::ZERO;
            for (row, share_up) in &up[y] {
                for (column, share_across) in &across[x] {
                    sum += share_up * share_across * self.means[row * self.width as usize + column];
                }
            }
            sum
        };
        let means = (0..height as usize).flat_map(|y| (0..width as usize).map(move |x| (x, y)));
        Self { width, height, means: means.map(|(x, y)| mean(x, y)).collect() }
    }

    /// This level and all smaller ones.
    pub fn levels(self) -> Vec<Self> {
        let mut levels = vec![self];
        while let Some(last) = levels.last().filter(|last| last.width.max(last.height) > 1) {
            let next = last.halved();
            levels.push(next);
        }
        levels
    }

    /// RGBA as a shader reads it before it is packed: RGB in [-1, 1], alpha in [0, 1]. A mean without a length points
    /// outwards and has an alpha of 0.
    pub fn texels(&self, colors: MipColors) -> impl ExactSizeIterator<Item = [f64; 4]> + '_ {
        self.means.iter().map(move |mean| match colors {
            MipColors::Mean => [mean.x, mean.y, mean.z, 1.0],
            MipColors::UnitAndLength => {
                let (unit, length) = (mean.try_normalize(), mean.length().min(1.0));
                let (unit, length) = unit.map_or((DVec3::Z, 0.0), |unit| (unit, length));
                [unit.x, unit.y, unit.z, length]
            }
        })
    }

    /// The same in unsigned bytes, x as round(255 (x / 2 + 1 / 2)): 0 has no code of its own.
    pub fn unsigned(&self, colors: MipColors) -> Vec<[u8; 4]> {
        let code = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
        let packed = |[x, y, z, alpha]: [f64; 4]| {
            let [x, y, z] = [x, y, z].map(|part| code(0.5 * part + 0.5));
            [x, y, z, code(alpha)]
        };
        self.texels(colors).map(packed).collect()
    }

    /// The same in signed bytes, x as round(127 x): 0 is exact.
    pub fn signed(&self, colors: MipColors) -> Vec<[i8; 4]> {
        let code = |value: f64| (127.0 * value.clamp(-1.0, 1.0)).round() as i8;
        self.texels(colors).map(|texel| texel.map(code)).collect()
    }

    /// Normals that a picture has in its colours, as (2 c - 1). `green_down`: y points down, as in Direct3D's maps.
    pub fn from_colors(width: u32, height: u32, rgba: &[u8], green_down: bool) -> Self {
        let part = |code: u8| 2.0 * f64::from(code) / 255.0 - 1.0;
        let means = rgba.as_chunks::<4>().0.iter().map(|[red, green, blue, _]| {
            let y = if green_down { -part(*green) } else { part(*green) };
            DVec3::new(part(*red), y, part(*blue)).try_normalize().unwrap_or(DVec3::Z)
        });
        Self { width, height, means: means.collect() }
    }

    /// The mean at (s, t) by a bilinear filter that repeats, in f64.
    pub fn bilinear(&self, st: DVec2) -> DVec3 {
        let at = st * DVec2::new(f64::from(self.width), f64::from(self.height)) - 0.5;
        let (first, part) = (at.floor(), at - at.floor());
        let mean = |x: f64, y: f64| {
            let inside = |at: f64, count: u32| at.rem_euclid(f64::from(count)).min(f64::from(count - 1)) as usize;
            self.means[inside(y, self.height) * self.width as usize + inside(x, self.width)]
        };
        let row = |y: f64| mean(first.x, y).lerp(mean(first.x + 1.0, y), part.x);
        row(first.y).lerp(row(first.y + 1.0), part.y)
    }
}

/// For each of `to` texels: those of `from` that it covers, each with its share of it.
fn spans(from: u32, to: u32) -> Vec<Vec<(usize, f64)>> {
    let size = f64::from(from) / f64::from(to);
    let span = |index: u32| {
        let (start, end) = (f64::from(index) * size, f64::from(index + 1) * size);
        let covered = |texel: u32| {
            let length = end.min(f64::from(texel + 1)) - start.max(f64::from(texel));
            (length > 1e-9).then_some((texel as usize, length / size))
        };
        (start as u32..from.min(end.ceil() as u32)).filter_map(covered).collect()
    };
    (0..to).map(span).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A field of so many texels a side, its heights by a function of (s, t) in the texels' middles.
    fn field(width: u32, height: u32, of: impl Fn(f64, f64) -> f64) -> HeightField {
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let middle = |at: u32, count: u32| (f64::from(at) + 0.5) / f64::from(count);
        let heights = texels.map(|(x, y)| of(middle(x, width), middle(y, height)) as f32).collect();
        HeightField { name: String::from("test"), width, height, heights }
    }

    /// Greatest angle in degrees to the normals of 0.01 sin 6 π s.
    fn worst(size: u32, difference: Difference) -> f64 {
        let wave = field(size, 1, |s, _| 0.5 + 0.01 * (3.0 * TAU * s).sin());
        let normals = wave.normals(f64::from(size), difference, HeightWrap::Repeat);
        let angle = |(x, normal): (usize, &DVec3)| {
            let s = (x as f64 + 0.5) / f64::from(size);
            let slope = 0.01 * 3.0 * TAU * (3.0 * TAU * s).cos();
            normal.angle_between(DVec3::new(-slope, 0.0, 1.0)).to_degrees()
        };
        normals.means.iter().enumerate().map(angle).fold(0.0, f64::max)
    }

    #[test]
    fn forward_differences_are_of_first_order_and_central_ones_of_second() {
        let sizes = [32, 64, 128, 256];
        for (difference, order) in [(Difference::Forward, 1.0), (Difference::Central, 2.0)] {
            let errors = sizes.map(|size| worst(size, difference));
            println!("{difference:?}: {errors:.3?} degrees");
            for pair in errors.windows(2) {
                let fall = (pair[0] / pair[1]).log2();
                assert!((fall - order).abs() < 0.1, "{difference:?}: {errors:?}");
            }
        }
        assert!(
            (worst(32, Difference::Forward) - 3.1).abs() < 0.1
                && (worst(256, Difference::Central) - 0.009).abs() < 0.001
        );
    }

    #[test]
    fn a_flat_field_is_straight_up() {
        for (width, height) in [(1, 1), (1, 7), (8, 8), (5, 3)] {
            for border in [HeightWrap::Repeat, HeightWrap::Clamp] {
                let flat = field(width, height, |_, _| 0.3).normals(5.0, Difference::Central, border);
                for level in flat.levels() {
                    assert!(level.signed(MipColors::UnitAndLength).iter().all(|texel| *texel == [0, 0, 127, 127]));
                    assert!(
                        level.unsigned(MipColors::UnitAndLength).iter().all(|texel| *texel == [128, 128, 255, 255])
                    );
                }
            }
        }
    }

    #[test]
    fn borders_repeat_or_stay() {
        let ramp = field(4, 1, |s, _| s);
        let slopes = |border| -> Vec<f64> {
            let normals = ramp.normals(1.0, Difference::Forward, border);
            normals.means.iter().map(|normal| (-normal.x / normal.z * 100.0).round() / 100.0).collect()
        };
        assert_eq!(slopes(HeightWrap::Repeat), [0.25, 0.25, 0.25, -0.75]);
        assert_eq!(slopes(HeightWrap::Clamp), [0.25, 0.25, 0.25, 0.0]);
        // Upwards in t is upwards in the file: rows begin at the bottom.
        let up = field(1, 4, |_, t| t).normals(1.0, Difference::Forward, HeightWrap::Clamp);
        assert!(up.means[0].y < -0.2 && up.means[0].x == 0.0);
    }

    /// Light that reaches every normal: the mean of N · L is the mean of N, times L, at every level, of every size.
    #[test]
    fn levels_keep_the_diffuse_light() {
        let mut random = fastrand::Rng::with_seed(7);
        for (width, height) in [(16, 16), (13, 5), (1, 9), (31, 2)] {
            let heights: Vec<f64> = (0..width * height).map(|_| random.f64()).collect();
            let place = |at: f64, count: u32| (at * f64::from(count)) as usize;
            let bumps = field(width, height, |s, t| heights[place(t, height) * width as usize + place(s, width)]);
            let first = bumps.normals(1.0, Difference::Central, HeightWrap::Repeat);
            let whole = first.means.iter().sum::<DVec3>() / first.means.len() as f64;
            let levels = first.levels();
            assert_eq!(levels.len() as u32, 32 - width.max(height).leading_zeros());
            for level in &levels {
                let mean = level.means.iter().sum::<DVec3>() / level.means.len() as f64;
                assert!(mean.distance(whole) < 1e-12, "{}x{}: {mean}, not {whole}", level.width, level.height);
                for ([x, y, z, length], own) in level.texels(MipColors::UnitAndLength).zip(&level.means) {
                    assert!((DVec3::new(x, y, z) * length).distance(*own) < 1e-12 && length <= 1.0);
                }
            }
        }
    }

    /// Two normals at 45 degrees to either side: their mean is 0.707 long. Opposite ones have no direction.
    #[test]
    fn means_are_shorter_where_normals_differ() {
        let level = |means: Vec<DVec3>| NormalLevel { width: means.len() as u32, height: 1, means };
        let leaning = |x: f64| DVec3::new(x, 0.0, 1.0).normalize();
        let half = level(vec![leaning(1.0), leaning(-1.0)]).halved();
        assert_eq!(half.signed(MipColors::UnitAndLength), [[0, 0, 127, 90]]);
        assert_eq!(half.unsigned(MipColors::Mean), [[128, 128, 218, 255]]);
        let none = level(vec![DVec3::X, DVec3::NEG_X]).halved();
        assert_eq!(none.signed(MipColors::UnitAndLength), [[0, 0, 127, 0]]);
        assert_eq!(none.unsigned(MipColors::Mean), [[128, 128, 128, 255]]);
    }

    #[test]
    fn a_packed_map_is_read_again() {
        let mut random = fastrand::Rng::with_seed(3);
        let bumps = field(6, 4, |s, t| 0.5 + 0.3 * (TAU * (s + 2.0 * t)).sin());
        let first = bumps.normals(2.0, Difference::Central, HeightWrap::Repeat);
        let bytes: Vec<u8> = first.unsigned(MipColors::UnitAndLength).concat();
        let back = NormalLevel::from_colors(6, 4, &bytes, false);
        for (own, back) in first.means.iter().zip(&back.means) {
            assert!(own.angle_between(*back).to_degrees() < 0.4, "half a code of each: {own} {back}");
        }
        let down: Vec<u8> = bytes.as_chunks::<4>().0.iter().flat_map(|[r, g, b, a]| [*r, 255 - *g, *b, *a]).collect();
        assert_eq!(NormalLevel::from_colors(6, 4, &down, true), back);
        // In a texel's middle the filter is the texel; halfway it is the mean.
        let (x, y) = (random.u32(0..6), random.u32(0..4));
        let middle = DVec2::new((f64::from(x) + 0.5) / 6.0, (f64::from(y) + 0.5) / 4.0);
        assert!(first.bilinear(middle).distance(first.means[(y * 6 + x) as usize]) < 1e-12);
        let seam = first.bilinear(DVec2::new(0.0, 0.5 / 4.0));
        assert!(seam.distance(0.5 * (first.means[0] + first.means[5])) < 1e-12, "across the border");
    }
}
