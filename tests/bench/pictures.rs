//! Comparison of two pictures: a time counts only if its picture is right.

use std::fmt;
use std::path::Path;

use super::Result;

/// A channel that differs by more tells another shade class: lit, shadowed, background.
const ANOTHER_CLASS: u8 = 24;

/// The share of pixels that may be of another class: edges fall otherwise by rounding, and glumbra turns two-sided
/// normals where the floor does not.
const MOST_OTHERS: f64 = 0.002;

/// The most that the mean of all channels' differences may be, in 1/255.
const MOST_MEAN: f64 = 0.5;

/// Difference of two pictures.
pub struct Difference {
    others: usize,
    pixels: usize,
    mean: f64,
}

/// Compares two files.
pub fn compare(a: &Path, b: &Path) -> Result<Difference> {
    let (a, b) = (image::open(a)?.to_rgb8(), image::open(b)?.to_rgb8());
    if a.dimensions() != b.dimensions() {
        return Err("the pictures differ in size".into());
    }
    let other = |(p, q): &(&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|k| p.0[k].abs_diff(q.0[k]) > ANOTHER_CLASS);
    let others = a.pixels().zip(b.pixels()).filter(other).count();
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(p, q)| u64::from(p.abs_diff(*q))).sum();
    let pixels = (a.width() * a.height()) as usize;
    Ok(Difference { others, pixels, mean: sum as f64 / (3 * pixels) as f64 })
}

impl Difference {
    fn share(&self) -> f64 {
        self.others as f64 / self.pixels as f64
    }

    /// Fails where the pictures are not the same one.
    pub fn check(&self) -> Result<()> {
        if self.share() <= MOST_OTHERS && self.mean <= MOST_MEAN {
            return Ok(());
        }
        Err("glumbra's picture and the floor's differ by more than they may: nothing is timed".into())
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "pictures: {:.3} % of pixels of another shade class (at most {:.1} %), mean difference {:.3}/255",
            100.0 * self.share(),
            100.0 * MOST_OTHERS,
            self.mean
        )
    }
}
