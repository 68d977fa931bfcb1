//! Numbers that look random and are the same on every machine.

/// SplitMix64.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// In [0, 1), of 24 bits: exact as f32.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    /// In [low, high).
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// True for this share of the calls.
    pub fn chance(&mut self, share: f32) -> bool {
        self.unit() < share
    }

    /// In [0, count).
    pub fn below(&mut self, count: usize) -> usize {
        ((f64::from(self.unit()) * count as f64) as usize).min(count.saturating_sub(1))
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
