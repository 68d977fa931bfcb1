//! Numbers of the model: a value in f64, and a bound of the error that GLSL leaves a driver [GLSL 4.60, 4.7.1].

/// A number of any of GLSL's scalar types: integers and booleans (0 and 1) are exact, or not known at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Num {
    pub value: f64,
    /// Bound of the error by GLSL 4.60, 4.7.1; infinite: GLSL leaves the value open.
    pub error: f64,
}

/// Half of a unit in the last place of 1.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// Errors may be so many times as large before a value is wrong: OpenGL 3.3 itself states no bound. A comparison of
/// values nearer than that is not decided.
pub const SLACK: f64 = 16.0;

/// Beyond: the value, or a step on the way to it, may overflow.
const MOST: f64 = 1e37;

impl Num {
    pub const UNKNOWN: Self = Self { value: 0.0, error: f64::INFINITY };

    pub const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    pub fn boolean(value: Option<bool>) -> Self {
        value.map_or(Self::UNKNOWN, |value| Self::exact(f64::from(u8::from(value))))
    }

    pub fn integer(value: Option<i64>) -> Self {
        value.map_or(Self::UNKNOWN, |value| Self::exact(value as f64))
    }

    pub fn is_known(self) -> bool {
        self.error.is_finite() && self.value.is_finite()
    }

    /// The boolean or integer, if it is known.
    pub fn whole(self) -> Option<i64> {
        self.is_known().then_some(self.value as i64)
    }

    pub fn truth(self) -> Option<bool> {
        self.whole().map(|value| value != 0)
    }

    /// A result that is off by `error`, and rounded: exact if nothing was off, an f32 has it, and `alone`.
    fn rounded(value: f64, error: f64, alone: bool) -> Self {
        let is_normal = value == 0.0 || value.abs() >= f64::from(f32::MIN_POSITIVE);
        if error == 0.0 && alone && is_normal && f64::from(value as f32) == value {
            return Self::exact(value);
        }
        Self::off(value, error + ROUNDING * value.abs())
    }

    /// A result that is off by `error`. Numbers below 2^-126 may be flushed to 0.
    pub fn off(value: f64, error: f64) -> Self {
        let flushed = if value.abs() < 1e-30 { f64::from(f32::MIN_POSITIVE) } else { 0.0 };
        let error = error + flushed;
        let is_open = value.is_nan() || error.is_nan() || value.abs() + SLACK * error > MOST;
        if is_open { Self::UNKNOWN } else { Self { value, error } }
    }

    pub fn plus(self, other: Self) -> Self {
        let value = self.value + other.value;
        let alone = self.value == 0.0 || other.value == 0.0 || [self.value, other.value, value].iter().all(is_short);
        Self::rounded(value, self.error + other.error, alone)
    }

    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negative())
    }

    pub fn negative(self) -> Self {
        Self { value: -self.value, ..self }
    }

    pub fn times(self, other: Self) -> Self {
        let (a, b) = (self, other);
        if !a.is_known() || !b.is_known() {
            return Self::UNKNOWN;
        }
        let error = a.value.abs() * b.error + b.value.abs() * a.error + SLACK * a.error * b.error;
        let value = a.value * b.value;
        let by_power = value == 0.0 || [a, b].iter().any(|x| x.error == 0.0 && is_power_of_two(x.value));
        Self::rounded(value, error, by_power || [a.value, b.value, value].iter().all(is_short))
    }

    /// Within 2.5 units in the last place; by a power of two exactly.
    pub fn over(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let least = b.value.abs() - SLACK * b.error;
        if !a.is_known() || !b.is_known() || least < b.value.abs() / 2.0 || least < 1e-36 {
            return Self::UNKNOWN;
        }
        let value = a.value / b.value;
        let error = (a.error + value.abs() * b.error) / least;
        if b.error == 0.0 && is_power_of_two(b.value) {
            return Self::rounded(value, error, true);
        }
        Self::off(value, error + 5.0 * ROUNDING * value.abs())
    }

    /// A function that rises or falls all along the number's range; `own`: its error as a share of the result.
    pub fn through(self, function: impl Fn(f64) -> f64, own: f64) -> Self {
        if !self.is_known() {
            return Self::UNKNOWN;
        }
        let value = function(self.value);
        let reach = SLACK * self.error;
        let away = |at: f64| (function(at) - value).abs() / SLACK;
        let error = if reach > 0.0 { away(self.value + reach).max(away(self.value - reach)) } else { 0.0 };
        Self::off(value, error + own * value.abs())
    }

    /// A function whose results are whole numbers.
    pub fn step(self, function: impl Fn(f64) -> f64) -> Self {
        if !self.is_known() {
            return Self::UNKNOWN;
        }
        let reach = SLACK * self.error;
        let (low, high) = (function(self.value - reach), function(self.value + reach));
        if low == high { Self::exact(function(self.value)) } else { Self::UNKNOWN }
    }

    pub fn magnitude(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }

    pub fn least(self, other: Self) -> Self {
        self.chosen(other, f64::min)
    }

    pub fn most(self, other: Self) -> Self {
        self.chosen(other, f64::max)
    }

    fn chosen(self, other: Self, by: fn(f64, f64) -> f64) -> Self {
        if !self.is_known() || !other.is_known() {
            return Self::UNKNOWN;
        }
        let apart = (self.value - other.value).abs() > SLACK * (self.error + other.error);
        let value = by(self.value, other.value);
        let error = match apart {
            true if value == self.value => self.error,
            true => other.error,
            false => self.error.max(other.error),
        };
        Self { value, error }
    }

    /// Tests for less, if the errors leave no doubt.
    pub fn below(self, other: Self) -> Option<bool> {
        let (apart, doubt) = (self.value - other.value, SLACK * (self.error + other.error));
        (doubt == 0.0 || apart.abs() > doubt).then_some(apart < 0.0)
    }

    pub fn equals(self, other: Self) -> Option<bool> {
        let (apart, doubt) = (self.value - other.value, SLACK * (self.error + other.error));
        (doubt == 0.0 || apart.abs() > doubt).then_some(apart == 0.0)
    }
}

/// Tests for so few bits that sums and products of a few such numbers are exact, in any order that a compiler takes.
fn is_short(value: &f64) -> bool {
    (value * 1024.0).fract() == 0.0 && value.abs() < 2048.0
}

pub fn is_power_of_two(value: f64) -> bool {
    value != 0.0 && value.is_finite() && value.to_bits() & ((1 << 52) - 1) == 0
}

/// The sum of numbers in any order, with fused products or without.
pub fn sum(terms: &[Num]) -> Num {
    let value: f64 = terms.iter().map(|term| term.value).sum();
    let all: f64 = terms.iter().map(|term| term.value.abs()).sum();
    let error: f64 = terms.iter().map(|term| term.error).sum();
    let is_whole = error == 0.0 && all < 1e7 && terms.iter().all(|term| term.value.fract() == 0.0);
    if is_whole {
        return Num::exact(value);
    }
    Num::off(value, error + terms.len() as f64 * ROUNDING * all)
}

pub fn dot(a: &[Num], b: &[Num]) -> Num {
    let terms: Vec<Num> = a.iter().zip(b).map(|(a, b)| a.times(*b)).collect();
    sum(&terms)
}
