//! Texture environments in the model, as ranges [GL 4.6 compatibility, 16.1].

use super::state::{CombinerState, FixedState};
use crate::conformance::bench::environment::GlCombine;
use crate::conformance::verify::environment::{Range, combine, over_corners};
use crate::context::compatibility::raw;

/// A colour, as ranges.
pub type Color = [Range; 4];

/// Rounding of a stage before its scale: half a code of 8 bits.
const ROUNDING: f64 = 0.5 / 255.0;

/// A value that is looked up in the texture of a unit.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    /// Base internal format.
    pub base: u32,
    pub color: Color,
}

pub fn exact(value: f64) -> Range {
    [value; 2]
}

/// The range of both.
pub fn hull(one: Range, other: Range) -> Range {
    [one[0].min(other[0]), one[1].max(other[1])]
}

fn rounded(range: Range, scale: f64) -> Range {
    [range[0] - ROUNDING, range[1] + ROUNDING].map(|value| (value * scale).clamp(0.0, 1.0))
}

/// A function of three arguments that is linear in each.
fn of(arguments: [Range; 3], function: impl Fn([f64; 3]) -> f64) -> Range {
    rounded(over_corners(arguments, function), 1.0)
}

fn function_of(code: u32) -> GlCombine {
    match code {
        glow::REPLACE => GlCombine::Replace,
        raw::MODULATE => GlCombine::Modulate,
        raw::ADD => GlCombine::Add,
        raw::ADD_SIGNED => GlCombine::AddSigned,
        raw::INTERPOLATE => GlCombine::Interpolate,
        raw::SUBTRACT => GlCombine::Subtract,
        raw::DOT3_RGB => GlCombine::Dot3Rgb,
        _ => GlCombine::Dot3Rgba,
    }
}

impl FixedState {
    /// The colour behind all units, from that of the vertices.
    pub fn combined(&self, primary: Color, texels: &[Option<Texel>]) -> Color {
        let mut previous = primary;
        for (unit, texel) in texels.iter().enumerate() {
            let Some(texel) = texel else { continue };
            previous = match self.units[unit].mode {
                raw::COMBINE => self.combiners(unit, primary, previous, texels),
                mode => self.simple(mode, unit, previous, texel),
            };
        }
        previous
    }

    /// REPLACE, MODULATE, DECAL, BLEND and ADD [GL 4.6 compatibility, tables 16.15 to 16.17].
    fn simple(&self, mode: u32, unit: usize, previous: Color, texel: &Texel) -> Color {
        let constant = self.units[unit].constant.to_array();
        let has_color = texel.base != glow::ALPHA;
        let has_alpha = !matches!(texel.base, raw::LUMINANCE | glow::RGB);
        let is_intensity = texel.base == raw::INTENSITY;
        let [.., source_alpha] = texel.color;
        std::array::from_fn(|channel| {
            let arguments = [previous[channel], texel.color[channel], exact(constant[channel])];
            let is_alpha = channel == 3;
            if if is_alpha { !has_alpha } else { !has_color } {
                return previous[channel];
            }
            match mode {
                glow::REPLACE => texel.color[channel],
                raw::MODULATE => of(arguments, |[f, s, _]| f * s),
                raw::DECAL if is_alpha => previous[channel],
                raw::DECAL if texel.base == glow::RGB => texel.color[channel],
                raw::DECAL => {
                    of([previous[channel], texel.color[channel], source_alpha], |[f, s, a]| f * (1.0 - a) + s * a)
                }
                glow::BLEND if !is_alpha || is_intensity => of(arguments, |[f, s, c]| f * (1.0 - s) + c * s),
                glow::BLEND => of(arguments, |[f, s, _]| f * s),
                _ if !is_alpha || is_intensity => of(arguments, |[f, s, _]| f + s),
                _ => of(arguments, |[f, s, _]| f * s),
            }
        })
    }

    fn combiners(&self, unit: usize, primary: Color, previous: Color, texels: &[Option<Texel>]) -> Color {
        let state = &self.units[unit];
        let one = [1.0; 2];
        let argument = |combiner: &CombinerState, index: usize, channel: usize| {
            let texel = |unit: usize| texels.get(unit).and_then(|texel| *texel).map_or([one; 4], |texel| texel.color);
            let source = match combiner.sources[index] {
                glow::TEXTURE => texel(unit),
                raw::PRIMARY_COLOR => primary,
                raw::PREVIOUS => previous,
                raw::CONSTANT => state.constant.to_array().map(exact),
                other => texel((other - glow::TEXTURE0) as usize),
            };
            let operand = combiner.operands[index];
            let takes_alpha = matches!(operand, glow::SRC_ALPHA | glow::ONE_MINUS_SRC_ALPHA);
            let [low, high] = source[if takes_alpha { 3 } else { channel }];
            if matches!(operand, glow::SRC_COLOR | glow::SRC_ALPHA) { [low, high] } else { [1.0 - high, 1.0 - low] }
        };
        let result = |combiner: &CombinerState, channel: usize| {
            let arguments = |channel| [0, 1, 2].map(|index| argument(combiner, index, channel));
            let function = function_of(combiner.function);
            match function {
                // A sum of three products, each rounded before it is multiplied by four.
                GlCombine::Dot3Rgb | GlCombine::Dot3Rgba => {
                    let parts =
                        [0, 1, 2].map(|channel| over_corners(arguments(channel), |[a, b, _]| (a - 0.5) * (b - 0.5)));
                    let sum = [0, 1].map(|end| parts.iter().map(|part| part[end]).sum::<f64>());
                    rounded(sum, 4.0 * combiner.scale)
                }
                function => {
                    rounded(over_corners(arguments(channel), |values| combine(function, values)), combiner.scale)
                }
            }
        };
        let [red, green, blue] = [0, 1, 2].map(|channel| result(&state.rgb, channel));
        // The specification does not say whose scale the fourth component of DOT3_RGBA has.
        let alpha = match state.rgb.function {
            raw::DOT3_RGBA => hull(red, result(&CombinerState { scale: state.alpha.scale, ..state.rgb }, 0)),
            _ => result(&state.alpha, 3),
        };
        [red, green, blue, alpha]
    }
}
