//! GLSL's functions and operators on scalars, with the errors that they may have [GLSL 4.60, 4.7.1, 5.9, 8.1 to 8.3].

use std::f64::consts::PI;

use super::number::{Num, ROUNDING, SLACK};
use super::value::NumberBase;

/// Angles: SPIR-V's environment for Vulkan allows 2^-11 within a turn, and 4096 units in the last place of an arc. GLSL
/// says nothing. With the slack, 2^-8 and 2^-8.
const ANGLE: f64 = 1.0 / 4096.0;

pub fn sqrt(x: Num) -> Num {
    if x == Num::exact(0.0) {
        return x;
    }
    positive(x, |x| x.through(f64::sqrt, 10.0 * ROUNDING))
}

pub fn inversesqrt(x: Num) -> Num {
    positive(x, |x| x.through(|x| 1.0 / x.sqrt(), 4.0 * ROUNDING))
}

/// A function that is defined above 0 alone, and where no number is flushed to 0.
fn positive(x: Num, function: impl Fn(Num) -> Num) -> Num {
    let is_meant = x.is_known() && x.value > 1e-36 && x.value - 2.0 * SLACK * x.error > 0.0;
    if is_meant { function(x) } else { Num::UNKNOWN }
}

pub fn exp2(x: Num) -> Num {
    exponential(x, f64::exp2)
}

pub fn exp(x: Num) -> Num {
    exponential(x, f64::exp)
}

/// Within 3 + 2 |x| units in the last place.
fn exponential(x: Num, function: fn(f64) -> f64) -> Num {
    x.through(function, 2.0 * ROUNDING * (3.0 + 2.0 * x.value.abs()))
}

pub fn log2(x: Num) -> Num {
    logarithm(x, f64::log2)
}

pub fn log(x: Num) -> Num {
    logarithm(x, f64::ln)
}

/// Within 3 units in the last place outside of [0.5, 2], 2^-21 inside.
fn logarithm(x: Num, function: fn(f64) -> f64) -> Num {
    positive(x, |x| {
        let own = if (0.5..=2.0).contains(&x.value) { 8.0 * ROUNDING } else { 0.0 };
        let result = x.through(function, 6.0 * ROUNDING);
        Num::off(result.value, result.error + own)
    })
}

/// As exp2(y log2(x)).
pub fn pow(x: Num, y: Num) -> Num {
    if x == Num::exact(0.0) && y.is_known() && y.value - 2.0 * SLACK * y.error > 0.0 {
        return Num::off(0.0, 0.0);
    }
    let power = exp2(log2(x).times(y));
    if power.is_known() { Num { value: x.value.powf(y.value), ..power } } else { power }
}

pub fn sin(x: Num) -> Num {
    wave(x, f64::sin)
}

pub fn cos(x: Num) -> Num {
    wave(x, f64::cos)
}

fn wave(x: Num, function: fn(f64) -> f64) -> Num {
    if !x.is_known() || x.value.abs() > 256.0 {
        return Num::UNKNOWN;
    }
    let own = if x.value.abs() <= PI { ANGLE } else { ANGLE * (2.0 + x.value.abs() / 32.0) };
    Num::off(function(x.value), own + x.error)
}

/// As sin(x) / cos(x), away from the poles.
pub fn tan(x: Num) -> Num {
    let quotient = sin(x).over(cos(x));
    if quotient.is_known() && x.value.abs() < 40.0 { quotient } else { Num::UNKNOWN }
}

pub fn asin(x: Num) -> Num {
    arc(x, f64::asin)
}

pub fn acos(x: Num) -> Num {
    arc(x, f64::acos)
}

fn arc(x: Num, function: fn(f64) -> f64) -> Num {
    if !x.is_known() || x.value.abs() + 2.0 * SLACK * x.error > 1.0 {
        return Num::UNKNOWN;
    }
    let result = x.through(function, 0.0);
    Num::off(result.value, result.error + ANGLE)
}

pub fn atan(x: Num) -> Num {
    let result = x.through(f64::atan, 0.0);
    Num::off(result.value, result.error + ANGLE * result.value.abs().min(1.0))
}

/// Not at 0, 0, and not where y may have either sign and x is negative.
pub fn atan2(y: Num, x: Num) -> Num {
    let far = x.value.hypot(y.value);
    let doubt = 2.0 * SLACK * (x.error + y.error);
    let is_cut = x.value <= doubt && y.value.abs() <= 2.0 * SLACK * y.error;
    if !x.is_known() || !y.is_known() || doubt >= far || is_cut || !(1e-18..1e18).contains(&far) {
        return Num::UNKNOWN;
    }
    Num::off(y.value.atan2(x.value), (x.error + y.error) / (far - doubt) + 4.0 * ANGLE)
}

pub fn round(x: Num) -> Num {
    // A half may go either way.
    if (x.value.abs().fract() - 0.5).abs() <= SLACK * x.error { Num::UNKNOWN } else { x.step(f64::round) }
}

pub fn fract(x: Num) -> Num {
    x.minus(x.step(f64::floor))
}

/// As x - y floor(x / y).
pub fn modulus(x: Num, y: Num) -> Num {
    x.minus(y.times(x.over(y).step(f64::floor)))
}

pub fn sign(x: Num) -> Num {
    x.step(|x| if x == 0.0 { 0.0 } else { x.signum() })
}

/// Undefined where `low` is not below `high`.
pub fn clamp(x: Num, low: Num, high: Num) -> Num {
    if high.below(low) == Some(false) { x.most(low).least(high) } else { Num::UNKNOWN }
}

/// As x (1 - t) + y t, or x + t (y - x).
pub fn mix(x: Num, y: Num, t: Num) -> Num {
    let sum = x.times(Num::exact(1.0).minus(t)).plus(y.times(t));
    let size = (x.value.abs() + y.value.abs()) * (1.0 + t.value.abs());
    if sum.is_known() { Num::off(sum.value, sum.error + 4.0 * ROUNDING * size) } else { sum }
}

pub fn step(edge: Num, x: Num) -> Num {
    Num::boolean(x.below(edge).map(|below| !below))
}

pub fn smoothstep(low: Num, high: Num, x: Num) -> Num {
    if low.below(high) != Some(true) {
        return Num::UNKNOWN;
    }
    let share = x.minus(low).over(high.minus(low));
    if !share.is_known() {
        return Num::UNKNOWN;
    }
    let t = share.most(Num::exact(0.0)).least(Num::exact(1.0));
    let due = t.value * t.value * (3.0 - 2.0 * t.value);
    Num::off(due, 1.5 * t.error + 8.0 * ROUNDING)
}

/// The low 32 bits.
pub fn wrapped(value: i64, base: NumberBase) -> i64 {
    if base == NumberBase::Uint { i64::from(value as u32) } else { i64::from(value as i32) }
}

/// An operator of integers; `None`: GLSL leaves it open.
pub fn integers(a: Num, b: Num, base: NumberBase, operate: fn(i64, i64) -> Option<i64>) -> Num {
    let result = a.whole().zip(b.whole()).and_then(|(a, b)| operate(a, b));
    Num::integer(result.map(|value| wrapped(value, base)))
}

pub fn quotient(a: i64, b: i64) -> Option<i64> {
    (b != 0 && !(a == i64::from(i32::MIN) && b == -1)).then(|| a / b)
}

/// Open where an operand is negative.
pub fn remainder(a: i64, b: i64) -> Option<i64> {
    (a >= 0 && b > 0).then(|| a % b)
}

pub fn left(a: i64, by: i64) -> Option<i64> {
    (0..32).contains(&by).then(|| a << by)
}

/// Fills with the sign of what is signed.
pub fn right(a: i64, by: i64) -> Option<i64> {
    (0..32).contains(&by).then(|| a >> by)
}

/// A constructor's conversion of one scalar [GLSL 4.60, 5.4.1].
pub fn converted(x: Num, from: NumberBase, to: NumberBase) -> Num {
    match (from, to) {
        _ if from == to => x,
        (NumberBase::Float, NumberBase::Bool) => Num::boolean(x.equals(Num::exact(0.0)).map(|is_zero| !is_zero)),
        (NumberBase::Float, _) => {
            let range = if to == NumberBase::Uint { 0.0..=4_294_967_000.0 } else { -2_147_483_000.0..=2_147_483_000.0 };
            let is_meant = range.contains(&(x.value - SLACK * x.error)) && range.contains(&(x.value + SLACK * x.error));
            if is_meant { x.step(f64::trunc) } else { Num::UNKNOWN }
        }
        (_, NumberBase::Bool) => Num::integer(x.whole().map(|value| i64::from(value != 0))),
        (NumberBase::Int | NumberBase::Uint, NumberBase::Float) if x.is_known() => x.plus(Num::exact(0.0)),
        (_, NumberBase::Float) => x,
        _ => Num::integer(x.whole().map(|value| wrapped(value, to))),
    }
}
