//! Formats of textures, layouts of the client's texels, and what a texel of one becomes in the other [GL 4.6, 8.4.4, 8.5].

use crate::conformance::random::Random;

/// Numbers that a format stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    Unorm,
    Srgb,
    Snorm,
    Half,
    Float,
    /// R11F_G11F_B10F.
    SmallFloat,
    Uint,
    Int,
    Depth,
    DepthFloat,
}

/// Channels that a look-up gives [GL 4.6, table 15.1 and table 8.11 compat.].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// So many of red, green, blue and alpha; depth is red.
    Colors(usize),
    Alpha,
    Luminance,
    LuminanceAlpha,
    Intensity,
}

/// An internal format.
#[derive(Debug)]
pub struct Format {
    pub name: &'static str,
    pub internal: u32,
    pub numbers: Numbers,
    pub base: Base,
    /// Bits of red, green, blue and alpha.
    pub bits: [u32; 4],
    /// Tests whether it may be drawn into [GL 4.6, 9.4].
    pub drawn: bool,
}

const fn color(name: &'static str, internal: u32, numbers: Numbers, channels: usize, bits: u32, drawn: bool) -> Format {
    Format { name, internal, numbers, base: Base::Colors(channels), bits: [bits; 4], drawn }
}

const fn old(name: &'static str, internal: u32, base: Base) -> Format {
    Format { name, internal, numbers: Numbers::Unorm, base, bits: [8; 4], drawn: false }
}

/// Formats of every context.
pub const FORMATS: &[Format] = &[
    color("R8", glow::R8, Numbers::Unorm, 1, 8, true),
    color("RG8", glow::RG8, Numbers::Unorm, 2, 8, true),
    color("RGB8", glow::RGB8, Numbers::Unorm, 3, 8, false),
    color("RGBA8", glow::RGBA8, Numbers::Unorm, 4, 8, true),
    color("SRGB8_ALPHA8", glow::SRGB8_ALPHA8, Numbers::Srgb, 4, 8, false),
    color("SRGB8", glow::SRGB8, Numbers::Srgb, 3, 8, false),
    color("R8_SNORM", glow::R8_SNORM, Numbers::Snorm, 1, 8, false),
    color("RG8_SNORM", glow::RG8_SNORM, Numbers::Snorm, 2, 8, false),
    color("RGBA8_SNORM", glow::RGBA8_SNORM, Numbers::Snorm, 4, 8, false),
    color("R16", glow::R16, Numbers::Unorm, 1, 16, true),
    color("RG16", glow::RG16, Numbers::Unorm, 2, 16, true),
    color("RGBA16", glow::RGBA16, Numbers::Unorm, 4, 16, true),
    color("R16F", glow::R16F, Numbers::Half, 1, 16, true),
    color("RG16F", glow::RG16F, Numbers::Half, 2, 16, true),
    color("RGB16F", glow::RGB16F, Numbers::Half, 3, 16, false),
    color("RGBA16F", glow::RGBA16F, Numbers::Half, 4, 16, true),
    color("R32F", glow::R32F, Numbers::Float, 1, 32, true),
    color("RG32F", glow::RG32F, Numbers::Float, 2, 32, true),
    color("RGB32F", glow::RGB32F, Numbers::Float, 3, 32, false),
    color("RGBA32F", glow::RGBA32F, Numbers::Float, 4, 32, true),
    color("R11F_G11F_B10F", glow::R11F_G11F_B10F, Numbers::SmallFloat, 3, 0, true),
    Format {
        name: "RGB10_A2",
        internal: glow::RGB10_A2,
        numbers: Numbers::Unorm,
        base: Base::Colors(4),
        bits: [10, 10, 10, 2],
        drawn: true,
    },
    color("R8UI", glow::R8UI, Numbers::Uint, 1, 8, false),
    color("RGBA8UI", glow::RGBA8UI, Numbers::Uint, 4, 8, false),
    color("RGBA16UI", glow::RGBA16UI, Numbers::Uint, 4, 16, false),
    color("R32UI", glow::R32UI, Numbers::Uint, 1, 24, false),
    color("RGBA8I", glow::RGBA8I, Numbers::Int, 4, 8, false),
    color("RG16I", glow::RG16I, Numbers::Int, 2, 16, false),
    color("RGBA32I", glow::RGBA32I, Numbers::Int, 4, 24, false),
    color("DEPTH_COMPONENT16", glow::DEPTH_COMPONENT16, Numbers::Depth, 1, 16, true),
    color("DEPTH_COMPONENT24", glow::DEPTH_COMPONENT24, Numbers::Depth, 1, 24, true),
    color("DEPTH_COMPONENT32F", glow::DEPTH_COMPONENT32F, Numbers::DepthFloat, 1, 32, true),
    color("DEPTH24_STENCIL8", glow::DEPTH24_STENCIL8, Numbers::Depth, 1, 24, true),
    color("DEPTH32F_STENCIL8", glow::DEPTH32F_STENCIL8, Numbers::DepthFloat, 1, 32, true),
];

/// Formats that the core profile removed: GL_ALPHA8, GL_LUMINANCE8, GL_LUMINANCE8_ALPHA8, GL_INTENSITY8.
pub const OLD_FORMATS: &[Format] = &[
    old("ALPHA8", 0x803C, Base::Alpha),
    old("LUMINANCE8", 0x8040, Base::Luminance),
    old("LUMINANCE8_ALPHA8", 0x8045, Base::LuminanceAlpha),
    old("INTENSITY8", 0x804B, Base::Intensity),
];

impl Format {
    pub fn is_depth(&self) -> bool {
        matches!(self.numbers, Numbers::Depth | Numbers::DepthFloat)
    }

    pub fn has_stencil(&self) -> bool {
        matches!(self.internal, glow::DEPTH24_STENCIL8 | glow::DEPTH32F_STENCIL8)
    }

    pub fn is_integer(&self) -> bool {
        matches!(self.numbers, Numbers::Uint | Numbers::Int)
    }

    /// Tests whether values lie in [0, 1] or [-1, 1]: the border is clamped to that.
    pub fn range(&self) -> Option<[f64; 2]> {
        match self.numbers {
            Numbers::Unorm | Numbers::Srgb | Numbers::Depth => Some([0.0, 1.0]),
            Numbers::Snorm => Some([-1.0, 1.0]),
            _ => None,
        }
    }

    /// Error of a value that no filter touched, and of one that is filtered: strictly, and at most. The share is of the
    /// greatest texel of the filter.
    pub fn error(&self, most: f64, filtered: bool) -> [f64; 2] {
        let float = most.abs() * f64::from(-20).exp2();
        // Codes of 8 bits may be filtered as such; an sRGB code is decoded to half a code.
        let [strict, least] = match (self.numbers, filtered) {
            (Numbers::Srgb, true) => [1.0 / 255.0 + 1e-3, 2.0 / 255.0 + 2e-3],
            (Numbers::Srgb, false) => [f64::from(-10).exp2(), 0.5 / 255.0],
            (Numbers::Unorm | Numbers::Snorm, true) if self.bits[3] <= 8 => [1.0 / 255.0, 2.0 / 255.0],
            (Numbers::Half | Numbers::SmallFloat, true) => [0.0, most.abs() / 512.0],
            _ => [0.0; 2],
        };
        [strict + float + 1e-12, least + float + f64::from(-20).exp2()]
    }

    /// Tests whether a channel of the client's is kept.
    fn uses(&self, channel: usize) -> bool {
        match self.base {
            Base::Colors(channels) => channel < channels,
            Base::Alpha => channel == 3,
            Base::Luminance | Base::Intensity => channel == 0,
            Base::LuminanceAlpha => channel == 0 || channel == 3,
        }
    }

    /// Texels as a shader sees them, of what is stored.
    fn seen(&self, [r, g, b, a]: [f64; 4]) -> [f64; 4] {
        match self.base {
            Base::Colors(1) => [r, 0.0, 0.0, 1.0],
            Base::Colors(2) => [r, g, 0.0, 1.0],
            Base::Colors(3) => [r, g, b, 1.0],
            Base::Colors(_) => [r, g, b, a],
            Base::Alpha => [0.0, 0.0, 0.0, a],
            Base::Luminance => [r, r, r, 1.0],
            Base::LuminanceAlpha => [r, r, r, a],
            Base::Intensity => [r; 4],
        }
    }

    /// The least difference of values up to `most`.
    pub fn step(&self, most: f64) -> f64 {
        let least = self.bits.into_iter().min().unwrap_or(8);
        match self.numbers {
            Numbers::Unorm | Numbers::Srgb | Numbers::Depth => 1.0 / (f64::from(least).exp2() - 1.0),
            Numbers::Snorm => 1.0 / (f64::from(least - 1).exp2() - 1.0),
            Numbers::Half => most * f64::from(-10).exp2(),
            Numbers::SmallFloat => most * f64::from(-5).exp2(),
            _ => most * f64::from(-20).exp2(),
        }
    }

    /// The border as a shader sees it.
    pub fn border(&self, border: [f64; 4]) -> [f64; 4] {
        self.seen(border.map(|value| self.range().map_or(value, |[low, high]| value.clamp(low, high))))
    }

    /// What is stored of a client's value, as a shader sees it, and by how much that may be off.
    pub fn store(&self, value: [f64; 4]) -> ([f64; 4], f64) {
        let mut slack = 0.0_f64;
        let mut stored = [0.0; 4];
        for channel in 0..4 {
            let value = value[channel];
            let mut code = |most: f64, low: f64| {
                let exact = value.clamp(low, 1.0) * most;
                if (exact - exact.round()).abs() > 2e-5 && self.uses(channel) {
                    slack = slack.max(1.0 / most);
                }
                exact.round() / most
            };
            stored[channel] = match self.numbers {
                Numbers::Unorm | Numbers::Depth => code(f64::from(self.bits[channel]).exp2() - 1.0, 0.0),
                Numbers::Snorm => code(f64::from(self.bits[channel] - 1).exp2() - 1.0, -1.0),
                Numbers::Srgb => {
                    let code = code(255.0, 0.0);
                    if channel == 3 { code } else { linear(code) }
                }
                Numbers::DepthFloat | Numbers::Float => f64::from(value as f32),
                Numbers::Uint | Numbers::Int => value,
                Numbers::Half | Numbers::SmallFloat => {
                    let bits = match (self.numbers, channel) {
                        (Numbers::Half, _) => 11,
                        (_, 2) => 6,
                        _ => 7,
                    };
                    let kept = if bits < 11 { value.max(0.0) } else { value };
                    let rounded = round_to(kept, bits);
                    if rounded != kept && self.uses(channel) {
                        slack = slack.max(rounded.abs() * f64::from(1 - bits).exp2());
                    }
                    rounded
                }
            };
        }
        if self.numbers == Numbers::Srgb && slack > 0.0 {
            slack *= 2.4;
        }
        (self.seen(stored), slack)
    }
}

/// The value of an sRGB code [GL 4.6, 8.24].
fn linear(code: f64) -> f64 {
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// The nearest number of so many significant bits.
fn round_to(value: f64, bits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let step = (value.abs().log2().floor() as i32 + 1 - bits).max(-24);
    let step = f64::from(step).exp2();
    (value / step).round() * step
}

/// Layout of the client's texels: format, type.
pub type Layout = [u32; 2];

const COLORS: [Layout; 24] = [
    [glow::RGBA, glow::UNSIGNED_BYTE],
    [glow::RGBA, glow::FLOAT],
    [glow::RGBA, glow::UNSIGNED_BYTE],
    [glow::BGRA, glow::UNSIGNED_BYTE],
    [glow::RGBA, glow::UNSIGNED_SHORT],
    [glow::RGBA, glow::HALF_FLOAT],
    [glow::RGB, glow::UNSIGNED_BYTE],
    [glow::RGB, glow::FLOAT],
    [glow::RGBA, glow::UNSIGNED_INT_8_8_8_8_REV],
    [glow::BGRA, glow::UNSIGNED_INT_8_8_8_8_REV],
    [glow::RGBA, glow::UNSIGNED_INT_8_8_8_8],
    [glow::RGB, glow::UNSIGNED_SHORT_5_6_5],
    [glow::RGBA, glow::UNSIGNED_SHORT_4_4_4_4],
    [glow::RGBA, glow::UNSIGNED_SHORT_5_5_5_1],
    [glow::BGRA, glow::UNSIGNED_SHORT_1_5_5_5_REV],
    [glow::RGBA, glow::UNSIGNED_INT_2_10_10_10_REV],
    [glow::RED, glow::UNSIGNED_BYTE],
    [glow::RG, glow::UNSIGNED_BYTE],
    [glow::RED, glow::FLOAT],
    [glow::RG, glow::FLOAT],
    [glow::RED, glow::UNSIGNED_SHORT],
    [glow::BGR, glow::UNSIGNED_BYTE],
    [glow::RGBA, glow::BYTE],
    [glow::RGBA, glow::SHORT],
];

/// A layout for texels of a format.
pub fn layout(random: &mut Random, format: &Format) -> Layout {
    let pick = |random: &mut Random, of: &[Layout]| of[(random.unit() * of.len() as f32) as usize];
    match format.numbers {
        Numbers::Depth if format.has_stencil() => [glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8],
        Numbers::DepthFloat if format.has_stencil() => [glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV],
        Numbers::Depth => {
            let types = [glow::FLOAT, glow::UNSIGNED_SHORT, glow::UNSIGNED_INT];
            [glow::DEPTH_COMPONENT, types[(random.unit() * 3.0) as usize]]
        }
        Numbers::DepthFloat => [glow::DEPTH_COMPONENT, glow::FLOAT],
        Numbers::Uint | Numbers::Int => {
            let signed = format.numbers == Numbers::Int;
            let kind = match (format.bits[0], signed) {
                (8, false) => glow::UNSIGNED_BYTE,
                (8, true) => glow::BYTE,
                (16, false) => glow::UNSIGNED_SHORT,
                (16, true) => glow::SHORT,
                (_, false) => glow::UNSIGNED_INT,
                (_, true) => glow::INT,
            };
            let all = [glow::RED_INTEGER, glow::RG_INTEGER, glow::RGB_INTEGER, glow::RGBA_INTEGER];
            let channels = if let Base::Colors(channels) = format.base { channels } else { 4 };
            [all[channels - 1], kind]
        }
        Numbers::Half | Numbers::Float => {
            // Halves are exact in both.
            pick(random, &[COLORS[1], COLORS[5], COLORS[1], COLORS[7], COLORS[18], COLORS[19], COLORS[0], COLORS[4]])
        }
        Numbers::SmallFloat => {
            pick(random, &[COLORS[1], COLORS[7], COLORS[5], [glow::RGB, glow::UNSIGNED_INT_10F_11F_11F_REV]])
        }
        Numbers::Snorm => pick(random, &[COLORS[22], COLORS[1], COLORS[22], COLORS[23], COLORS[5], COLORS[0]]),
        _ if random.unit() < 0.3 => COLORS[0],
        _ => pick(random, &COLORS[..22]),
    }
}

/// A random value that the format could hold.
pub fn value(random: &mut Random, format: &Format, scale: i32) -> [f64; 4] {
    let mut unit = || f64::from(random.unit());
    [0, 1, 2, 3].map(|channel| match format.numbers {
        Numbers::Unorm | Numbers::Srgb | Numbers::Depth => {
            let most = f64::from(format.bits[channel]).exp2() - 1.0;
            let value = unit();
            // Both ends are often met.
            if value < 0.04 { 0.0 } else { ((value * 1.08).min(1.0) * most).round() / most }
        }
        Numbers::Snorm => ((unit() * 2.1 - 1.05) * 127.0).round().clamp(-127.0, 127.0) / 127.0,
        Numbers::DepthFloat => {
            let value = unit();
            f64::from(if value < 0.04 { 0.0 } else { (value * 1.08).min(1.0) } as f32)
        }
        Numbers::Float => f64::from(((unit() * 2.0 - 1.0) * f64::from(scale).exp2()) as f32),
        Numbers::Half => round_to((unit() * 2.0 - 1.0) * f64::from(scale).exp2(), 11),
        Numbers::SmallFloat => {
            let value = unit();
            // What is denormal in eleven bits is none.
            if value < 0.01 { 0.0 } else { round_to(value * f64::from(scale).exp2(), 6) }
        }
        Numbers::Uint => (unit() * f64::from(format.bits[channel]).exp2()).floor(),
        Numbers::Int => ((unit() - 0.5) * f64::from(format.bits[channel]).exp2()).floor(),
    })
}

/// Positions of red, green, blue and alpha in the order of a client's format.
fn order(format: u32) -> &'static [usize] {
    match format {
        glow::RED | glow::RED_INTEGER | glow::DEPTH_COMPONENT | glow::DEPTH_STENCIL => &[0],
        glow::RG | glow::RG_INTEGER => &[0, 1],
        glow::RGB | glow::RGB_INTEGER => &[0, 1, 2],
        glow::BGR => &[2, 1, 0],
        glow::BGRA => &[2, 1, 0, 3],
        _ => &[0, 1, 2, 3],
    }
}

/// Appends a value in a layout, and returns what GL reads of it.
pub fn encode(bytes: &mut Vec<u8>, [format, kind]: Layout, value: [f64; 4]) -> [f64; 4] {
    let mut seen = [0.0, 0.0, 0.0, 1.0];
    let unorm = |value: f64, bits: u32| (value.clamp(0.0, 1.0) * (f64::from(bits).exp2() - 1.0)).round();
    let order = order(format);
    let integers = matches!(format, glow::RED_INTEGER | glow::RG_INTEGER | glow::RGB_INTEGER | glow::RGBA_INTEGER);
    // Bits of each component from the lowest, and its place in the order.
    let packed: &[(u32, usize)] = match kind {
        glow::UNSIGNED_SHORT_5_6_5 => &[(5, 2), (6, 1), (5, 0)],
        glow::UNSIGNED_SHORT_4_4_4_4 => &[(4, 3), (4, 2), (4, 1), (4, 0)],
        glow::UNSIGNED_SHORT_5_5_5_1 => &[(1, 3), (5, 2), (5, 1), (5, 0)],
        glow::UNSIGNED_SHORT_1_5_5_5_REV => &[(5, 0), (5, 1), (5, 2), (1, 3)],
        glow::UNSIGNED_INT_8_8_8_8_REV => &[(8, 0), (8, 1), (8, 2), (8, 3)],
        glow::UNSIGNED_INT_8_8_8_8 => &[(8, 3), (8, 2), (8, 1), (8, 0)],
        glow::UNSIGNED_INT_2_10_10_10_REV => &[(10, 0), (10, 1), (10, 2), (2, 3)],
        _ => &[],
    };
    if !packed.is_empty() {
        let (mut word, mut shift) = (0_u32, 0);
        for &(bits, place) in packed {
            let code = unorm(value[order[place]], bits);
            seen[order[place]] = code / (f64::from(bits).exp2() - 1.0);
            word |= (code as u32) << shift;
            shift += bits;
        }
        if shift == 16 {
            bytes.extend((word as u16).to_ne_bytes())
        } else {
            bytes.extend(word.to_ne_bytes())
        }
        return seen;
    }
    match kind {
        glow::UNSIGNED_INT_10F_11F_11F_REV => {
            let small = |value: f64, bits: i32| (half(value) >> (10 - bits)) as u32;
            bytes.extend((small(value[0], 6) | small(value[1], 6) << 11 | small(value[2], 5) << 22).to_ne_bytes());
            return [value[0], value[1], round_to(value[2], 6), 1.0];
        }
        glow::UNSIGNED_INT_24_8 => {
            let code = unorm(value[0], 24);
            // Eight bits of stencil that no look-up of depth sees.
            bytes.extend(((code as u32) << 8 | (code as u32 ^ 0xA7) & 0xFF).to_ne_bytes());
            return [code / (f64::from(24).exp2() - 1.0), 0.0, 0.0, 1.0];
        }
        glow::FLOAT_32_UNSIGNED_INT_24_8_REV => {
            bytes.extend((value[0] as f32).to_ne_bytes());
            bytes.extend(0x1234_5678_u32.to_ne_bytes());
            return [f64::from(value[0] as f32), 0.0, 0.0, 1.0];
        }
        _ => {}
    }
    for &channel in order {
        let value = value[channel];
        let signed = |most: f64| (value.clamp(-1.0, 1.0) * most).round();
        seen[channel] = match (kind, integers) {
            (glow::UNSIGNED_BYTE, false) => {
                bytes.push(unorm(value, 8) as u8);
                unorm(value, 8) / 255.0
            }
            (glow::BYTE, false) => {
                bytes.push(signed(127.0) as i8 as u8);
                signed(127.0) / 127.0
            }
            (glow::UNSIGNED_SHORT, false) => {
                bytes.extend((unorm(value, 16) as u16).to_ne_bytes());
                unorm(value, 16) / 65535.0
            }
            (glow::SHORT, false) => {
                bytes.extend((signed(32767.0) as i16).to_ne_bytes());
                signed(32767.0) / 32767.0
            }
            (glow::UNSIGNED_INT, false) => {
                bytes.extend((unorm(value, 32) as u32).to_ne_bytes());
                unorm(value, 32) / f64::from(u32::MAX)
            }
            (glow::HALF_FLOAT, _) => {
                bytes.extend(half(value).to_ne_bytes());
                round_to(value, 11)
            }
            (glow::UNSIGNED_BYTE, true) => {
                bytes.push(value as u8);
                value
            }
            (glow::BYTE, true) => {
                bytes.push(value as i8 as u8);
                value
            }
            (glow::UNSIGNED_SHORT, true) => {
                bytes.extend((value as u16).to_ne_bytes());
                value
            }
            (glow::SHORT, true) => {
                bytes.extend((value as i16).to_ne_bytes());
                value
            }
            (glow::UNSIGNED_INT, true) => {
                bytes.extend((value as u32).to_ne_bytes());
                value
            }
            (glow::INT, true) => {
                bytes.extend((value as i32).to_ne_bytes());
                value
            }
            _ => {
                bytes.extend((value as f32).to_ne_bytes());
                f64::from(value as f32)
            }
        };
    }
    seen
}

/// Bits of a number that a half holds.
fn half(value: f64) -> u16 {
    let rounded = round_to(value, 11);
    let sign = if rounded.is_sign_negative() { 0x8000 } else { 0 };
    let magnitude = rounded.abs();
    let exponent = if magnitude == 0.0 { -15 } else { (magnitude.log2().floor() as i32).max(-15) };
    if exponent < -14 {
        return sign | (magnitude * f64::from(24).exp2()) as u16;
    }
    let mantissa = (magnitude / f64::from(exponent).exp2() - 1.0) * 1024.0;
    sign | ((exponent + 15) as u16) << 10 | mantissa.round() as u16
}
