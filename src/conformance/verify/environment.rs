//! Texture environments in f64, as ranges: what each unit may write if it rounds by so much [GL 4.6 compatibility, 16.1].

use super::Grade;
use crate::conformance::bench::environment::{GlArgument, GlCombine, GlCombiner, GlEnvironment, GlOperand, GlSource};

/// The least and the greatest value.
pub type Range = [f64; 2];

/// Rounding of a unit before its scale: strictly that of floats [GL 4.6, 2.3.4: 1 part in 10^5], else half a code of
/// 8 bits.
pub const ROUNDING: [f64; 2] = [1e-5, 0.5 / 255.0];

/// RGBA behind all units. `textures` has a colour for each unit; colours are in [0, 1]. `rounding`: of each unit, before its
/// scale.
pub fn color(environments: &[GlEnvironment], textures: &[[f64; 4]], primary: [f64; 4], rounding: f64) -> [Range; 4] {
    let primary = exact(primary);
    environments.iter().enumerate().fold(primary, |previous, (unit, environment)| {
        Stage { environment, unit, textures, primary, previous, rounding }.color()
    })
}

fn exact(color: [f64; 4]) -> [Range; 4] {
    color.map(|value| [value; 2])
}

struct Stage<'a> {
    environment: &'a GlEnvironment,
    unit: usize,
    textures: &'a [[f64; 4]],
    primary: [Range; 4],
    previous: [Range; 4],
    rounding: f64,
}

impl Stage<'_> {
    fn color(&self) -> [Range; 4] {
        let GlEnvironment { rgb, alpha, .. } = self.environment;
        let [red, green, blue] = [0, 1, 2].map(|channel| self.combined(rgb, channel));
        let alpha = if rgb.function == GlCombine::Dot3Rgba { red } else { self.combined(alpha, 3) };
        [red, green, blue, alpha]
    }

    /// A channel, scaled and clamped.
    fn combined(&self, combiner: &GlCombiner, channel: usize) -> Range {
        let arguments = |channel| combiner.arguments.map(|argument| self.argument(argument, channel));
        let (range, rounding) = match combiner.function {
            GlCombine::Dot3Rgb | GlCombine::Dot3Rgba => {
                let parts =
                    [0, 1, 2].map(|channel| over_corners(arguments(channel), |[a, b, _]| (a - 0.5) * (b - 0.5)));
                let sum = [0, 1].map(|end| 4.0 * parts.iter().map(|part| part[end]).sum::<f64>());
                (sum, 4.0 * self.rounding)
            }
            function => (over_corners(arguments(channel), |values| combine(function, values)), self.rounding),
        };
        let scale = f64::from(combiner.scale);
        [range[0] - rounding, range[1] + rounding].map(|value| (value * scale).clamp(0.0, 1.0))
    }

    fn argument(&self, argument: GlArgument, channel: usize) -> Range {
        let texture = |unit: usize| exact(self.textures.get(unit).copied().unwrap_or_default());
        let source = match argument.source {
            GlSource::Texture => texture(self.unit),
            GlSource::Crossbar(unit) => texture(unit as usize),
            GlSource::Constant => exact(self.environment.constant.map(f64::from)),
            GlSource::Primary => self.primary,
            GlSource::Previous => self.previous,
        };
        let [low, high] = match argument.operand {
            GlOperand::Color | GlOperand::OneMinusColor => source[channel],
            GlOperand::Alpha | GlOperand::OneMinusAlpha => source[3],
        };
        match argument.operand {
            GlOperand::Color | GlOperand::Alpha => [low, high],
            GlOperand::OneMinusColor | GlOperand::OneMinusAlpha => [1.0 - high, 1.0 - low],
        }
    }
}

/// The functions of one channel.
pub fn combine(function: GlCombine, [a, b, c]: [f64; 3]) -> f64 {
    match function {
        GlCombine::Replace => a,
        GlCombine::Modulate => a * b,
        GlCombine::Add => a + b,
        GlCombine::AddSigned => a + b - 0.5,
        GlCombine::Interpolate => a * c + b * (1.0 - c),
        GlCombine::Subtract => a - b,
        GlCombine::Dot3Rgb | GlCombine::Dot3Rgba => f64::NAN,
    }
}

/// Range of a function that is linear in each argument: its extremes lie at corners.
pub fn over_corners(ranges: [Range; 3], function: impl Fn([f64; 3]) -> f64) -> Range {
    (0..8).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], corner| {
        let value = function([0, 1, 2].map(|index| ranges[index][corner >> index & 1]));
        [low.min(value), high.max(value)]
    })
}

/// Grade of an 8-bit code, and its distance from the middle of the strict range in codes: strictly the nearest code of a
/// value in the strict range, else one of the two nearest in the allowed one.
pub fn code(code: u8, strict: Range, allowed: Range) -> (Grade, f64) {
    let code = f64::from(code);
    let inside = |[low, high]: Range, slack: f64| (low * 255.0 - slack..=high * 255.0 + slack).contains(&code);
    let grade = match () {
        () if inside(strict, 0.5 + 1e-4) => Grade::Good,
        () if inside(allowed, 1.0 + 1e-4) => Grade::Allowed,
        () => Grade::Wrong,
    };
    (grade, code - 127.5 * (strict[0] + strict[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRIMARY: [f64; 4] = [0.25, 0.5, 1.0, 0.75];
    const TEXTURES: [[f64; 4]; 2] = [[0.5, 1.0, 0.0, 0.25], [1.0, 0.0, 0.5, 0.125]];

    fn environment(function: GlCombine, sources: [GlSource; 3], scale: u32) -> GlEnvironment {
        let combiner = GlCombiner { scale, ..GlCombiner::plain(function, sources) };
        GlEnvironment {
            rgb: combiner,
            alpha: GlCombiner::replace(GlSource::Previous),
            constant: [0.5, 0.25, 0.75, 1.0],
        }
    }

    fn ideal(environments: &[GlEnvironment]) -> [f64; 4] {
        color(environments, &TEXTURES, PRIMARY, 0.0).map(|[low, high]| {
            assert_eq!(low, high);
            low
        })
    }

    #[test]
    fn functions_by_hand() {
        use GlSource::{Constant, Crossbar, Previous, Primary, Texture};
        let cases = [
            (GlCombine::Replace, [Texture; 3], 1, [0.5, 1.0, 0.0]),
            (GlCombine::Replace, [Crossbar(1); 3], 2, [1.0, 0.0, 1.0]),
            (GlCombine::Modulate, [Texture, Primary, Texture], 4, [0.5, 1.0, 0.0]),
            (GlCombine::Add, [Texture, Constant, Texture], 1, [1.0, 1.0, 0.75]),
            (GlCombine::AddSigned, [Primary, Constant, Texture], 1, [0.25, 0.25, 1.0]),
            (GlCombine::Interpolate, [Texture, Previous, Constant], 1, [0.375, 0.625, 0.25]),
            (GlCombine::Subtract, [Primary, Texture, Texture], 2, [0.0, 0.0, 1.0]),
            // 4 (0 + 0.5 · 0 - 0.5 · 0.5), and 4 (0.25² + 0.5² · 0) with the operands' halves taken off.
            (GlCombine::Dot3Rgb, [Texture, Primary, Texture], 1, [0.0; 3]),
            (GlCombine::Dot3Rgb, [Primary, Primary, Texture], 1, [1.0; 3]),
            (GlCombine::Dot3Rgb, [Constant, Constant, Texture], 1, [0.5; 3]),
            (GlCombine::Dot3Rgb, [Constant, Constant, Texture], 2, [1.0; 3]),
        ];
        for (function, sources, scale, due) in cases {
            let [red, green, blue, alpha] = ideal(&[environment(function, sources, scale)]);
            assert_eq!(([red, green, blue], alpha), (due, 0.75), "{function:?} {sources:?}");
        }
        let dot = environment(GlCombine::Dot3Rgba, [Constant, Constant, Texture], 1);
        assert_eq!(ideal(&[dot]), [0.5; 4]);
        let chain = [
            environment(GlCombine::Modulate, [Texture, Previous, Texture], 1),
            environment(GlCombine::Add, [Previous, Texture, Texture], 1),
        ];
        assert_eq!(ideal(&chain), [1.0, 0.5, 0.5, 0.75]);
    }

    #[test]
    fn operands() {
        let with = |operand| {
            let mut environment = environment(GlCombine::Replace, [GlSource::Primary; 3], 1);
            environment.rgb.arguments[0].operand = operand;
            environment.alpha.arguments[0].operand = operand;
            ideal(&[environment])
        };
        assert_eq!(with(GlOperand::Color), PRIMARY);
        assert_eq!(with(GlOperand::OneMinusColor), [0.75, 0.5, 0.0, 0.25]);
        assert_eq!(with(GlOperand::Alpha), [0.75; 4]);
        assert_eq!(with(GlOperand::OneMinusAlpha), [0.25; 4]);
    }

    /// A range has in it what a rounding within the bound makes of the chain.
    #[test]
    fn ranges_hold_what_roundings_make() {
        let mut random = fastrand::Rng::with_seed(4);
        let sources = [GlSource::Texture, GlSource::Constant, GlSource::Primary, GlSource::Previous];
        for _ in 0..500 {
            let [first, mut second] = [(); 2].map(|()| {
                let function = GlCombine::SHARED[random.usize(..6)];
                environment(function, [(); 3].map(|()| sources[random.usize(..4)]), 1 << random.u32(..3))
            });
            let primary = [(); 4].map(|()| random.f64());
            let rounding = 0.01;
            let range = color(&[first, second], &TEXTURES, primary, rounding);
            // The second unit finds what the first one rounded in a texture.
            let off = (random.f64() * 2.0 - 1.0) * rounding * f64::from(first.rgb.scale);
            // A clamped value stays: it may be far outside of [0, 1] before.
            let round = |value: f64| if value % 1.0 == 0.0 { value } else { (value + off).clamp(0.0, 1.0) };
            let rounded = color(&[first], &TEXTURES, primary, 0.0).map(|[value, _]| round(value));
            for argument in &mut second.rgb.arguments {
                if argument.source == GlSource::Previous {
                    argument.source = GlSource::Crossbar(1);
                }
            }
            let seen = color(&[second], &[TEXTURES[1], rounded], primary, 0.0);
            for (range, value) in range.into_iter().zip(seen).take(3) {
                assert!(value[0] >= range[0] - 1e-12 && value[1] <= range[1] + 1e-12, "{value:?} of {range:?}");
            }
        }
    }

    #[test]
    fn codes() {
        let (strict, allowed) = ([0.5, 0.5], [0.49, 0.51]);
        let cases = [
            (128, Grade::Good),
            (127, Grade::Good),
            (129, Grade::Allowed),
            (124, Grade::Allowed),
            (123, Grade::Wrong),
            (132, Grade::Wrong),
        ];
        for (value, grade) in cases {
            assert_eq!(code(value, strict, allowed).0, grade, "{value}");
        }
        assert_eq!(code(130, strict, allowed).1, 2.5);
    }
}
