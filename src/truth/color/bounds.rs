//! A number of at least 0 with a least and a greatest value.

/// A value that is certain to lie in `[least, most]`; never below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least value that it may have.
    pub least: f64,
    /// In the sample's middle; within the bounds.
    pub value: f64,
    /// The greatest.
    pub most: f64,
    /// True if the exact value may lie anywhere within the bounds, not near `value` alone: at edges, or under mipmaps.
    pub jumps: bool,
}

impl Bounds {
    /// Nothing, exactly.
    pub(super) const NONE: Self = Self { least: 0.0, value: 0.0, most: 0.0, jumps: false };
    /// One, exactly.
    pub(super) const ALL: Self = Self { least: 1.0, value: 1.0, most: 1.0, jumps: false };

    pub(super) fn exactly(value: f64) -> Self {
        Self { least: value, value, most: value, jumps: false }
    }

    /// A value in [0, 1] that may be any other.
    pub(super) fn anything(value: f64) -> Self {
        Self { least: 0.0, value, most: 1.0, jumps: true }
    }

    /// The same, of which the value may jump.
    pub(super) fn jumping(self) -> Self {
        Self { jumps: true, ..self }
    }

    /// The value, and bounds that hold it and all of `others`.
    pub(super) fn around(value: f64, others: impl IntoIterator<Item = f64>) -> Self {
        others.into_iter().fold(Self::exactly(value), |bounds, other| Self {
            least: bounds.least.min(other),
            most: bounds.most.max(other),
            ..bounds
        })
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self {
            least: self.least * other.least,
            value: self.value * other.value,
            most: self.most * other.most,
            jumps: self.jumps || other.jumps,
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            least: self.least + other.least,
            value: self.value + other.value,
            most: self.most + other.most,
            jumps: self.jumps || other.jumps,
        }
    }

    /// `one` where this value is 1, `other` where it is 0; both where it may be either.
    pub(super) fn chosen(self, one: Self, other: Self) -> Self {
        if self.least == self.most {
            return if self.value > 0.5 { one } else { other };
        }
        let value = if self.value > 0.5 { one.value } else { other.value };
        Self { least: one.least.min(other.least), value, most: one.most.max(other.most), jumps: true }
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        self.times(Self::exactly(factor))
    }

    /// The rest to 1, of a value in [0, 1].
    pub(super) fn complement(self) -> Self {
        Self { least: 1.0 - self.most, value: 1.0 - self.value, most: 1.0 - self.least, jumps: self.jumps }
    }

    /// As a picture stores it.
    pub(super) fn clamped(self) -> Self {
        let [least, value, most] = [self.least, self.value, self.most].map(|value| value.clamp(0.0, 1.0));
        Self { least, value, most, jumps: self.jumps }
    }
}
