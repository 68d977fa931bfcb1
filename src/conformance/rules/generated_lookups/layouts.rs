//! Layouts of the client's texels, and random values that a format can hold [GL 4.6, 8.4.4].

use super::formats::{Numbers, TexelBase, TexelFormat, round_to};
use crate::conformance::random::Random;

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
pub fn layout(random: &mut Random, format: &TexelFormat) -> Layout {
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
            let channels = if let TexelBase::Colors(channels) = format.base { channels } else { 4 };
            [all[channels - 1], kind]
        }
        Numbers::Half | Numbers::Float => {
            // Halves are exact in both.
            random.pick(&[COLORS[1], COLORS[5], COLORS[1], COLORS[7], COLORS[18], COLORS[19], COLORS[0], COLORS[4]])
        }
        Numbers::SmallFloat => {
            random.pick(&[COLORS[1], COLORS[7], COLORS[5], [glow::RGB, glow::UNSIGNED_INT_10F_11F_11F_REV]])
        }
        Numbers::Snorm => random.pick(&[COLORS[22], COLORS[1], COLORS[22], COLORS[23], COLORS[5], COLORS[0]]),
        _ if random.unit() < 0.3 => COLORS[0],
        _ => random.pick(&COLORS[..22]),
    }
}

/// A random value that the format could hold.
pub fn value(random: &mut Random, format: &TexelFormat, scale: i32) -> [f64; 4] {
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
