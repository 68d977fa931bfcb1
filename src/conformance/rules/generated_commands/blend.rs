//! Blending in ranges [GL 4.6, 17.3.6].

use crate::conformance::bench::{GlEquation, GlFactor, GlFormat};

use super::pixel::{Bounds, filled, is_fixed, stored};

fn factor(factor: GlFactor, channel: usize, source: [Bounds; 4], destination: [Bounds; 4]) -> Bounds {
    let minus = |range: Bounds| Bounds::ONE.minus(range);
    match factor {
        GlFactor::Zero => Bounds::ZERO,
        GlFactor::One => Bounds::ONE,
        GlFactor::SrcColor => source[channel],
        GlFactor::OneMinusSrcColor => minus(source[channel]),
        GlFactor::DstColor => destination[channel],
        GlFactor::OneMinusDstColor => minus(destination[channel]),
        GlFactor::SrcAlpha => source[3],
        GlFactor::OneMinusSrcAlpha => minus(source[3]),
        GlFactor::DstAlpha => destination[3],
        GlFactor::OneMinusDstAlpha => minus(destination[3]),
    }
}

/// Blends `source` over `before`, as a format stores the result.
pub fn blended(
    format: GlFormat,
    source: [Bounds; 4],
    before: [Bounds; 4],
    factors: [GlFactor; 4],
    equations: [GlEquation; 2],
) -> [Bounds; 4] {
    let source = if is_fixed(format) { source.map(Bounds::clamped) } else { source };
    let destination = filled(format, before);
    std::array::from_fn(|channel| {
        let alpha = usize::from(channel == 3);
        let of = [source[channel], destination[channel]];
        let by = [factors[2 * alpha], factors[2 * alpha + 1]];
        let terms: [Bounds; 2] =
            std::array::from_fn(|side| of[side].times(factor(by[side], channel, source, destination)));
        let result = match equations[alpha] {
            GlEquation::Add => terms[0].plus(terms[1]),
            GlEquation::Subtract => terms[0].minus(terms[1]),
            GlEquation::ReverseSubtract => terms[1].minus(terms[0]),
            GlEquation::Min => of[0].least(of[1]),
            GlEquation::Max => of[0].greatest(of[1]),
        };
        if result.low.is_nan() || result.high.is_nan() {
            return if is_fixed(format) { Bounds { low: 0.0, high: 1.0 } } else { Bounds::UNKNOWN };
        }
        let plain = matches!(equations[alpha], GlEquation::Min | GlEquation::Max)
            || by.iter().all(|by| matches!(by, GlFactor::Zero | GlFactor::One));
        let size = terms.iter().map(|term| term.low.abs().max(term.high.abs())).fold(0.0, f64::max);
        // Sums of numbers as they are have no rounding of their own in 8 bits.
        stored(format, result, (!plain || !is_fixed(format)).then_some(size))
    })
}
