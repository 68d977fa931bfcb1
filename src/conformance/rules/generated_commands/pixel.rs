//! Values of the model: ranges of what a pixel may hold, and how formats store them.

use std::cmp::Ordering;

use crate::conformance::bench::{GlCompare, GlFormat};

/// A number that is known to lie within two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low: f64,
    pub high: f64,
}

impl Bounds {
    pub const UNKNOWN: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    pub const ZERO: Self = Self::of(0.0);
    pub const ONE: Self = Self::of(1.0);

    pub const fn of(value: f64) -> Self {
        Self { low: value, high: value }
    }

    pub fn is_known(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// All that either may be.
    pub fn or(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub fn widened(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    pub fn clamped(self) -> Self {
        if !self.is_known() {
            return Self { low: 0.0, high: 1.0 };
        }
        Self { low: self.low.clamp(0.0, 1.0), high: self.high.clamp(0.0, 1.0) }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    pub fn minus(self, other: Self) -> Self {
        Self { low: self.low - other.high, high: self.high - other.low }
    }

    pub fn times(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        if !self.is_known() || !other.is_known() {
            return Self::UNKNOWN;
        }
        let products = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        products.into_iter().map(Self::of).reduce(Self::or).unwrap_or(Self::UNKNOWN)
    }

    pub fn least(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    pub fn greatest(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }
}

/// How a stored depth came about: only depths of one way that are equal are surely found equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The corners of a rectangle have it, all the same.
    Drawn,
    /// gl_FragDepth.
    Written,
    Other,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    pub value: f64,
    /// How far off it may be.
    pub slack: f64,
    pub way: Way,
}

impl Depth {
    pub const UNKNOWN: Self = Self { value: 0.5, slack: f64::INFINITY, way: Way::Other };

    pub fn is_known(self) -> bool {
        self.slack.is_finite()
    }

    pub fn range(self) -> Bounds {
        if self.is_known() { Bounds::of(self.value).widened(self.slack) } else { Bounds::UNKNOWN }
    }

    /// Tests whether `self OP stored` holds in a format of this step; `None`: it may or may not.
    pub fn passes(self, compare: GlCompare, stored: Self, step: f64) -> Option<bool> {
        if matches!(compare, GlCompare::Always | GlCompare::Never) {
            return Some(compare == GlCompare::Always);
        }
        let near = self.slack + stored.slack + 2.0 * step;
        let same = self.way == stored.way && self.way != Way::Other && self.value == stored.value;
        match self.value.total_cmp(&stored.value) {
            _ if same => Some(compare.holds(Ordering::Equal)),
            order if (self.value - stored.value).abs() > near => Some(compare.holds(order)),
            _ => None,
        }
    }
}

/// All that a pixel of an image may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownPixel {
    pub color: [Bounds; 4],
    pub depth: Depth,
    pub stencil: Option<u8>,
}

impl KnownPixel {
    pub const UNKNOWN: Self = Self { color: [Bounds::UNKNOWN; 4], depth: Depth::UNKNOWN, stencil: None };
}

/// Channels that a colour format has.
pub fn channels(format: GlFormat) -> usize {
    if matches!(format, GlFormat::R8 | GlFormat::R32F) { 1 } else { 4 }
}

/// Tests whether its numbers are of [0, 1].
pub fn is_fixed(format: GlFormat) -> bool {
    matches!(format, GlFormat::R8 | GlFormat::Rgba8)
}

/// Difference of neighbouring depths, at most.
pub fn step(format: GlFormat) -> f64 {
    match format {
        GlFormat::Depth16 => 1.0 / 65535.0,
        GlFormat::Depth32F | GlFormat::Depth32FStencil8 => f64::from(f32::EPSILON),
        _ => 1.0 / 16_777_215.0,
    }
}

/// A value as a format stores it; `error` is how far the computation before may be off, in codes of 8 bits or relative to
/// `size` in floats.
pub fn stored(format: GlFormat, value: Bounds, error: Option<f64>) -> Bounds {
    if is_fixed(format) {
        // Rounding to the nearest code, with a tenth for the arithmetic [GL 4.6, 2.3.5.1]. A blend in 8 bits may be a
        // code off: GL asks only for as many bits as the buffer has [17.3.6].
        let slack = if error.is_some() { 1.6 } else { 0.6 };
        let value = value.clamped();
        let code = |code: f64| code.clamp(0.0, 255.0) / 255.0;
        return Bounds {
            low: code((value.low * 255.0 - slack).ceil()),
            high: code((value.high * 255.0 + slack).floor()),
        };
    }
    if !value.is_known() {
        return Bounds::UNKNOWN;
    }
    let value = value.widened(error.map_or(0.0, |size| 1e-6 * size));
    let half = format == GlFormat::Rgba16F;
    // What is too large may become infinite, or the largest half [GL 4.6, 2.3.4.2].
    if half && value.magnitude() > 65000.0 {
        return Bounds::UNKNOWN;
    }
    let is_exact = |number: f64| {
        let significant = if half { 11 } else { 24 };
        let scaled = number.abs() * (f64::from(significant) - 1.0 - number.abs().log2().floor()).exp2();
        number == 0.0 || scaled.fract() == 0.0
    };
    if value.low == value.high && is_exact(value.low) {
        return value;
    }
    // Halves may be cut off; floats come from floats.
    let relative = if half { 1.0 / 1024.0 } else { 1.0 / 8_388_608.0 };
    value.widened(relative * value.magnitude())
}

/// Channels as a look-up or a read-back has them: what the format lacks is 0, and alpha 1.
pub fn filled(format: GlFormat, color: [Bounds; 4]) -> [Bounds; 4] {
    if channels(format) == 4 { color } else { [color[0], Bounds::ZERO, Bounds::ZERO, Bounds::ONE] }
}
