//! The comparator: two pictures against a maximum, a mean, a share of pixels and a largest spot.

use super::raster::Raster;

/// Limits of a difference. Every limit counts; [`Tolerance::EXACT`] lets no bit differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// The largest difference of any channel; colours and shades are in [0, 1].
    pub max: f64,
    /// The mean difference over all channels of all pixels.
    pub mean: f64,
    /// The share of pixels, in [0, 1], that may differ by more than `slight`.
    pub share: f64,
    /// A difference that is not counted.
    pub slight: f64,
    /// The side of a square, in pixels, that may not differ by more than `slight` in each of its pixels.
    pub spot: Option<u32>,
}

impl Tolerance {
    /// No bit may differ.
    pub const EXACT: Self = Self { max: 0.0, mean: 0.0, share: 0.0, slight: 0.0, spot: None };
}

/// Difference of two pictures of one shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelDifference {
    /// The largest of any channel.
    pub max: f64,
    /// The mean over all channels of all pixels.
    pub mean: f64,
    /// Pixels that differ in any bit of any channel.
    pub count: usize,
    /// Pixels that were compared.
    pub of: usize,
    /// The pixel of the largest difference.
    pub at: [u32; 2],
}

impl std::fmt::Display for PixelDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share = 100.0 * self.count as f64 / self.of.max(1) as f64;
        write!(
            f,
            "{} of {} pixels ({share:.3} %) differ, by {:.3e} at most (at {}, {}), {:.3e} in the mean",
            self.count, self.of, self.max, self.at[0], self.at[1], self.mean
        )
    }
}

/// Measures `actual` against `expected`.
///
/// # Errors
///
/// Rasters of different sizes or kinds, and pictures without pixels.
pub fn measure(actual: &Raster, expected: &Raster) -> Result<PixelDifference, String> {
    if actual.size != expected.size || actual.channels != expected.channels {
        return Err(format!(
            "wrong size: {}x{} with {} channels, expected {}x{} with {}",
            actual.size[0], actual.size[1], actual.channels, expected.size[0], expected.size[1], expected.channels
        ));
    }
    if actual.data.is_empty() {
        return Err(String::from("nothing to compare: the pictures are empty"));
    }
    let mut found = PixelDifference { of: actual.pixels().count(), ..PixelDifference::default() };
    let mut sum = 0.0;
    for (index, (a, b)) in actual.pixels().zip(expected.pixels()).enumerate() {
        if a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()) {
            continue;
        }
        found.count += 1;
        for (a, b) in a.iter().zip(b) {
            let off = f64::from((a - b).abs());
            let off = if off.is_nan() { f64::INFINITY } else { off };
            sum += off;
            if off > found.max {
                found.max = off;
                found.at = [index as u32 % actual.size[0], index as u32 / actual.size[0]];
            }
        }
    }
    found.mean = sum / actual.data.len() as f64;
    Ok(found)
}

/// Holds `actual` against `expected`.
///
/// # Errors
///
/// Rasters that [`measure`] refuses, and a difference beyond the tolerance, in words.
pub fn compare(actual: &Raster, expected: &Raster, tolerance: &Tolerance) -> Result<PixelDifference, String> {
    let found = measure(actual, expected)?;
    let differing = differing(actual, expected, tolerance.slight);
    let share = differing.iter().filter(|differs| **differs).count() as f64 / found.of as f64;
    let spot = tolerance.spot.and_then(|side| spot(&differing, actual.size, side));
    let within = found.max <= tolerance.max && found.mean <= tolerance.mean && share <= tolerance.share;
    if within && spot.is_none() {
        return Ok(found);
    }
    let Tolerance { max, mean, share, slight, .. } = *tolerance;
    let mut allowed = if *tolerance == Tolerance::EXACT {
        String::from("none may")
    } else {
        format!("at most {:.3} % may, by {max:.3e} at most, {mean:.3e} in the mean", 100.0 * share)
    };
    if slight > 0.0 {
        allowed = format!("{allowed}; those that differ by {slight:.3e} or less are not counted");
    }
    if let Some([x, y]) = spot {
        allowed = format!("{allowed}; and a spot at ({x}, {y}) differs as a whole");
    }
    Err(format!("{found}; {allowed}"))
}

/// The pixels that differ by more than `slight`, or in any bit where that is 0.
fn differing(actual: &Raster, expected: &Raster, slight: f64) -> Vec<bool> {
    let differs = |(a, b): (&f32, &f32)| {
        let is_slight = f64::from((a - b).abs()) <= slight;
        a.to_bits() != b.to_bits() && (slight == 0.0 || !is_slight)
    };
    actual.pixels().zip(expected.pixels()).map(|(a, b)| a.iter().zip(b).any(differs)).collect()
}

/// Tests whether a square of `side` pixels differs by more than `slight` in each of them.
pub fn has_spot(actual: &Raster, expected: &Raster, slight: f64, side: u32) -> bool {
    let is_alike = actual.size == expected.size && actual.channels == expected.channels;
    is_alike && spot(&differing(actual, expected, slight), actual.size, side).is_some()
}

/// The corner of the first square of `side` pixels that differs as a whole.
fn spot(differing: &[bool], [width, height]: [u32; 2], side: u32) -> Option<[u32; 2]> {
    let at = |x: u32, y: u32| differing.get(y as usize * width as usize + x as usize) == Some(&true);
    let corners =
        (0..(height + 1).saturating_sub(side)).flat_map(|y| (0..(width + 1).saturating_sub(side)).map(move |x| [x, y]));
    let whole = |[left, top]: &[u32; 2]| (0..side).all(|y| (0..side).all(|x| at(left + x, top + y)));
    corners.into_iter().find(whole)
}
