//! Choices of a generator.

use crate::conformance::random::Random;

/// Random choices of several kinds.
pub struct Dice(Random);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    /// In [low, high).
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0.between(low, high)
    }

    pub fn chance(&mut self, share: f32) -> bool {
        self.0.unit() < share
    }

    /// In [0, count).
    pub fn below(&mut self, count: usize) -> usize {
        ((f64::from(self.0.unit()) * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// One of a list that is not empty.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// In [low, high].
    pub fn whole(&mut self, low: i32, high: i32) -> i32 {
        low + self.below((high - low + 1).max(1) as usize) as i32
    }

    /// A power of two whose exponent is in [low, high).
    pub fn power(&mut self, low: f32, high: f32) -> f32 {
        self.between(low, high).exp2()
    }

    /// A multiple of 1/64 in [-range, range): sums and small multiples of it are exact as f32.
    pub fn exact(&mut self, range: i32) -> f32 {
        self.whole(-64 * range, 64 * range - 1) as f32 / 64.0
    }
}
