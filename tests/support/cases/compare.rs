//! The comparator: two pictures against a maximum, a mean and a share of pixels.

use super::picture::Picture;

/// What may differ. Every limit counts; [`Tolerance::EXACT`] lets no bit differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// The largest difference of any channel.
    pub max: f64,
    /// The mean difference over all channels of all pixels.
    pub mean: f64,
    /// The share of pixels that may differ at all.
    pub share: f64,
}

impl Tolerance {
    pub const EXACT: Self = Self { max: 0.0, mean: 0.0, share: 0.0 };
}

/// How two pictures of one shape differ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    pub max: f64,
    pub mean: f64,
    /// Pixels that differ in any bit of any channel.
    pub count: usize,
    pub of: usize,
    /// The pixel of the largest difference.
    pub at: [u32; 2],
}

impl std::fmt::Display for Difference {
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
/// Pictures of different sizes or kinds, and pictures without pixels.
pub fn measure(actual: &Picture, expected: &Picture) -> Result<Difference, String> {
    if actual.size != expected.size || actual.channels != expected.channels {
        return Err(format!(
            "wrong size: {}x{} with {} channels, expected {}x{} with {}",
            actual.size[0], actual.size[1], actual.channels, expected.size[0], expected.size[1], expected.channels
        ));
    }
    if actual.data.is_empty() {
        return Err(String::from("nothing to compare: the pictures are empty"));
    }
    let mut found = Difference { of: actual.pixels().count(), ..Difference::default() };
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
/// What [`measure`] refuses, and a difference beyond the tolerance, in words.
pub fn compare(actual: &Picture, expected: &Picture, tolerance: &Tolerance) -> Result<Difference, String> {
    let found = measure(actual, expected)?;
    let share = found.count as f64 / found.of as f64;
    let within = found.max <= tolerance.max && found.mean <= tolerance.mean && share <= tolerance.share;
    if within {
        return Ok(found);
    }
    let Tolerance { max, mean, share } = *tolerance;
    let allowed = if *tolerance == Tolerance::EXACT {
        String::from("none may")
    } else {
        format!("at most {:.3} % may, by {max:.3e} at most, {mean:.3e} in the mean", 100.0 * share)
    };
    Err(format!("{found}; {allowed}"))
}
