//! Vectors and numbers of either sign with bounds.

use glam::DVec3;

use crate::truth::color::bounds::Bounds;

/// A vector that is certain to lie within `error` of `at`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub at: DVec3,
    pub error: f64,
}

/// A number of either sign, in `[least, most]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub least: f64,
    pub value: f64,
    pub most: f64,
}

impl Ball {
    /// The product with another.
    pub fn dot(&self, other: &Self) -> Span {
        let error = self.error * other.at.length() + other.error * self.at.length() + self.error * other.error;
        Span::within(self.at.dot(other.at), error)
    }

    /// Its image under a function of vectors, by that one's values beside `at` along the axes.
    pub fn through(&self, function: impl Fn(DVec3) -> DVec3) -> Self {
        let at = function(self.at);
        let moved = |axis: DVec3| {
            let [one, other] = [1.0, -1.0].map(|sign| function(self.at + sign * self.error * axis).distance(at));
            one.max(other)
        };
        let error = if self.error > 0.0 {
            DVec3::AXES.into_iter().map(|axis| moved(axis).powi(2)).sum::<f64>().sqrt()
        } else {
            0.0
        };
        Self { at, error }
    }
}

impl Span {
    pub fn within(value: f64, error: f64) -> Self {
        Self { least: value - error, value, most: value + error }
    }

    pub fn of(bounds: Bounds) -> Self {
        Self { least: bounds.least, value: bounds.value, most: bounds.most }
    }

    /// Rounded to a code of 255, either way.
    pub fn rounded(self) -> Self {
        let half = 0.5 / 255.0;
        Self { least: self.least - half, value: (255.0 * self.value).round() / 255.0, most: self.most + half }
    }

    /// Each end by a function that does not fall.
    fn rising(self, function: impl Fn(f64) -> f64) -> Bounds {
        let [least, value, most] = [self.least, self.value, self.most].map(function);
        Bounds { least, value, most, jumps: false }
    }

    /// max(0, x), at most 1.
    pub fn positive(self) -> Bounds {
        self.rising(|x| x.clamp(0.0, 1.0))
    }

    /// max(0, x).
    pub fn unbounded(self) -> Bounds {
        self.rising(|x| x.max(0.0))
    }

    /// min(1, 8 max(0, x)).
    pub fn ramp(self) -> Bounds {
        self.rising(|x| (8.0 * x).clamp(0.0, 1.0))
    }

    /// max(0, x) to a power of at least 0.
    pub fn power(self, exponent: f64) -> Bounds {
        let power = self.rising(|x| x.max(0.0).powf(exponent));
        // GLSL leaves pow(0, 0) open.
        if exponent == 0.0 && self.least <= 0.0 {
            Bounds { least: 0.0, most: 1.0, jumps: true, ..power }
        } else {
            power
        }
    }

    /// 1 above 0, else 0.
    pub fn is_positive(self) -> Bounds {
        let value = f64::from(u8::from(self.value > 0.0));
        let is_certain = self.least > 0.0 || self.most <= 0.0;
        if is_certain { Bounds::exactly(value) } else { Bounds::anything(value) }
    }
}
