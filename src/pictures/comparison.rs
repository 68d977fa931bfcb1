//! All that two pictures' difference says: where, how much, and which tolerance would pass.

use super::compare::{self, PixelDifference};
use super::raster::Raster;

/// Differences of two pictures, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Maximum, mean, count and the worst pixel.
    pub difference: PixelDifference,
    /// Root of the mean square over all channels of all pixels; infinite where a value is no number in only one of them.
    pub rms: f64,
    /// The first pixel that differs, in rows from the top.
    pub first: Option<[u32; 2]>,
    /// Least and greatest column and row of the pixels that differ.
    pub bounds: Option<[[u32; 2]; 2]>,
    /// The channel of the largest difference.
    pub channel: usize,
    /// The greatest difference over the channels of each pixel that differs, from the least on.
    sorted: Vec<f64>,
}

impl Comparison {
    /// Measures `actual` against `expected`.
    ///
    /// # Errors
    ///
    /// Pictures of different sizes or channels, and pictures without pixels.
    pub fn of(actual: &Raster, expected: &Raster) -> Result<Self, String> {
        let difference = compare::measure(actual, expected)?;
        let (mut squares, mut sorted) = (0.0, Vec::with_capacity(difference.count));
        let (mut first, mut bounds, mut worst) = (None, None, (0.0, 0));
        let width = actual.size[0] as usize;
        for (index, (a, b)) in actual.pixels().zip(expected.pixels()).enumerate() {
            if a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()) {
                continue;
            }
            let mut most = 0.0_f64;
            for (channel, (a, b)) in a.iter().zip(b).enumerate() {
                let off = off(*a, *b);
                squares += off * off;
                most = most.max(off);
                worst = if off > worst.0 { (off, channel) } else { worst };
            }
            sorted.push(most);
            let at = [(index % width) as u32, (index / width) as u32];
            first = first.or(Some(at));
            let [low, high] = bounds.unwrap_or([at; 2]);
            bounds = Some([[low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])]]);
        }
        sorted.sort_by(f64::total_cmp);
        let rms = (squares / actual.data.len() as f64).sqrt();
        Ok(Self { difference, rms, first, bounds, channel: worst.1, sorted })
    }

    /// Pixels with a channel that differs by more than `limit`.
    pub fn count_beyond(&self, limit: f64) -> usize {
        self.sorted.len() - self.sorted.partition_point(|off| *off <= limit)
    }

    /// [`count_beyond`](Self::count_beyond) over all pixels, in [0, 1].
    pub fn share_beyond(&self, limit: f64) -> f64 {
        self.count_beyond(limit) as f64 / self.difference.of.max(1) as f64
    }
}

/// Difference of two values; infinite if either is no number.
fn off(a: f32, b: f32) -> f64 {
    let off = f64::from((a - b).abs());
    match a.to_bits() == b.to_bits() {
        true => 0.0,
        false if off.is_nan() => f64::INFINITY,
        false => off,
    }
}

/// Two pictures with the same channels: a grey one beside colours has three equal ones, and one without alpha beside one with
/// it is opaque.
///
/// # Errors
///
/// Pictures of other sizes; channels that have no such meaning.
pub fn alike(one: Raster, other: Raster) -> Result<[Raster; 2], String> {
    let [a, b] = [one.size, other.size];
    if a != b {
        return Err(format!("the sizes differ: {}x{} and {}x{}", a[0], a[1], b[0], b[1]));
    }
    if one.channels == other.channels {
        return Ok([one, other]);
    }
    if one.channels > 4 || other.channels > 4 {
        return Err(format!("the numbers of channels differ: {} and {}", one.channels, other.channels));
    }
    let has_alpha = [&one, &other].iter().any(|raster| raster.channels % 2 == 0);
    let has_color = [&one, &other].iter().any(|raster| raster.channels > 2);
    Ok([one, other].map(|raster| widened(&raster, has_color, has_alpha)))
}

fn widened(raster: &Raster, has_color: bool, has_alpha: bool) -> Raster {
    let colors = if has_color { 3 } else { 1 };
    let wide = |p: &[f32]| {
        let alpha = if raster.channels.is_multiple_of(2) { p.last().copied() } else { None };
        let color = (0..colors).map(|k| if raster.channels > 2 { p[k] } else { p[0] });
        color.chain(has_alpha.then(|| alpha.unwrap_or(1.0))).collect::<Vec<_>>()
    };
    let data = raster.pixels().flat_map(wide).collect();
    Raster { size: raster.size, channels: colors + usize::from(has_alpha), data }
}
