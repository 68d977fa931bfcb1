//! Numbers of vertex arrays: their bytes, and what a shader gets of them [GL 4.6, 2.3.5, 10.3.1].

use crate::conformance::random::Random;

/// Kind of an attribute in the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Signed,
    Unsigned,
}

/// Layout of one vertex's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    pub kind: u32,
    /// 1 to 4, or GL_BGRA.
    pub size: u32,
    pub normalized: bool,
}

/// A number that an attribute must have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Due {
    Bits(u32),
    /// Near a number, to a distance.
    Near(f64, f64),
    /// No number that can be compared.
    Any,
}

impl Due {
    pub fn float(value: f32) -> Self {
        Self::Bits(value.to_bits())
    }

    /// Tests whether a word is what is due.
    pub fn holds(self, word: u32) -> bool {
        match self {
            Self::Bits(bits) => bits == word,
            Self::Near(value, slack) => (f64::from(f32::from_bits(word)) - value).abs() <= slack,
            Self::Any => true,
        }
    }
}

const PACKED: [u32; 2] = [glow::INT_2_10_10_10_REV, glow::UNSIGNED_INT_2_10_10_10_REV];

impl Format {
    /// One of all that an attribute of this kind can have: each number has another until all have been.
    pub fn dealt(number: usize, kind: Kind) -> Self {
        let of = |kinds: &[u32], normalized: &[bool]| {
            let sizes = kinds.iter().flat_map(|kind| (1..=4).map(move |size| (*kind, size)));
            let formats = sizes.flat_map(|(kind, size)| normalized.iter().map(move |on| (kind, size, *on)));
            formats.map(|(kind, size, normalized)| Self { kind, size, normalized }).collect::<Vec<_>>()
        };
        let signed = [glow::BYTE, glow::SHORT, glow::INT];
        let unsigned = [glow::UNSIGNED_BYTE, glow::UNSIGNED_SHORT, glow::UNSIGNED_INT];
        let formats = match kind {
            Kind::Signed => of(&signed, &[false]),
            Kind::Unsigned => of(&unsigned, &[false]),
            Kind::Float => {
                let mut formats = of(&[glow::FLOAT, glow::FLOAT, glow::HALF_FLOAT, glow::DOUBLE], &[false]);
                formats.extend(of(&[signed, unsigned].concat(), &[false, true]));
                let packed =
                    PACKED.into_iter().flat_map(|kind| [(kind, 4, false), (kind, 4, true), (kind, glow::BGRA, true)]);
                let bytes = [(glow::UNSIGNED_BYTE, glow::BGRA, true)];
                formats.extend(packed.chain(bytes).map(|(kind, size, normalized)| Self { kind, size, normalized }));
                formats
            }
        };
        // No number of formats is a multiple of 31.
        formats[number * 31 % formats.len()]
    }

    fn is_packed(self) -> bool {
        PACKED.contains(&self.kind)
    }

    fn count(self) -> usize {
        if self.size == glow::BGRA { 4 } else { self.size as usize }
    }

    fn width(self) -> usize {
        match self.kind {
            glow::BYTE | glow::UNSIGNED_BYTE => 1,
            glow::SHORT | glow::UNSIGNED_SHORT | glow::HALF_FLOAT => 2,
            glow::DOUBLE => 8,
            _ => 4,
        }
    }

    /// Bytes of a vertex.
    pub fn bytes(self) -> usize {
        if self.is_packed() { 4 } else { self.width() * self.count() }
    }

    /// Bytes that are numbers of ordinary sizes; any bytes of integers.
    pub fn sample(self, dice: &mut Random) -> Vec<u8> {
        let mut bytes = Vec::new();
        while bytes.len() < self.bytes() {
            let sign = if dice.chance(0.5) { -1.0 } else { 1.0 };
            match self.kind {
                glow::FLOAT => bytes.extend((sign * dice.power(-90.0, 90.0)).to_ne_bytes()),
                glow::DOUBLE => bytes.extend((f64::from(sign * dice.power(-90.0, 90.0)) * 1.000_000_03).to_ne_bytes()),
                glow::HALF_FLOAT => {
                    bytes.extend((dice.below(0x7C00) as u16 | if sign < 0.0 { 0x8000 } else { 0 }).to_ne_bytes())
                }
                // The ends of their ranges often.
                _ if dice.chance(0.2) => {
                    bytes.extend(dice.pick(&[[0_u8; 8], [0xFF; 8], [0x80; 8], [0x7F; 8], [0x80, 0, 0, 0, 0, 0, 0, 0]]))
                }
                _ => bytes.push(dice.below(256) as u8),
            }
        }
        bytes.truncate(self.bytes());
        bytes
    }

    /// Numbers that a shader gets, completed by 0, 0, 1; `symmetric`: the equation of OpenGL 4.2 for signed normalised numbers.
    pub fn read(self, bytes: &[u8], kind: Kind, symmetric: bool) -> [Due; 4] {
        let one = if kind == Kind::Float { Due::float(1.0) } else { Due::Bits(1) };
        let zero = Due::Bits(0);
        let mut due = [zero, zero, zero, one];
        if self.is_packed() {
            let word = u32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            for (index, (shift, bits)) in [(0, 10), (10, 10), (20, 10), (30, 2)].into_iter().enumerate() {
                let part = word >> shift & ((1 << bits) - 1);
                let signed = i64::from((part << (32 - bits)) as i32 >> (32 - bits));
                let value = if self.kind == glow::INT_2_10_10_10_REV { signed } else { i64::from(part) };
                let place = if self.size == glow::BGRA { [2, 1, 0, 3][index] } else { index };
                due[place] = self.number(value, bits, symmetric);
            }
            return due;
        }
        let width = self.width();
        for (index, part) in bytes.chunks_exact(width).enumerate() {
            let place = if self.size == glow::BGRA { [2, 1, 0, 3][index] } else { index };
            let mut whole = [0; 8];
            whole[..width].copy_from_slice(part);
            let word = u64::from_ne_bytes(whole);
            let shift = 64 - 8 * width as u32;
            let signed = ((word << shift) as i64) >> shift;
            let is_signed = [glow::BYTE, glow::SHORT, glow::INT].contains(&self.kind);
            let value = if is_signed { signed } else { word as i64 };
            due[place] = match self.kind {
                glow::FLOAT => exact(word as u32),
                glow::HALF_FLOAT => half(word as u16),
                glow::DOUBLE => {
                    let value = f64::from_bits(word);
                    let ordinary = (1e-30..1e30).contains(&value.abs());
                    if ordinary { Due::Near(value, value.abs() * f64::from(-23).exp2()) } else { Due::Any }
                }
                _ if kind != Kind::Float => Due::Bits(value as u32),
                _ => self.number(value, 8 * width as u32, symmetric),
            };
        }
        due
    }

    /// An integer of so many bits as a float.
    fn number(self, value: i64, bits: u32, symmetric: bool) -> Due {
        let value = value as f64;
        if !self.normalized {
            // Mesa's llvmpipe takes these for negative.
            if value >= f64::from(1_u32 << 31) {
                return Due::Any;
            }
            let slack = if value.abs() < f64::from(1 << 24) { 0.0 } else { value.abs() * f64::from(-23).exp2() };
            return Due::Near(value, slack);
        }
        let is_signed = [glow::BYTE, glow::SHORT, glow::INT, glow::INT_2_10_10_10_REV].contains(&self.kind);
        // Mesa's llvmpipe gives the least of these as less than -1.
        if is_signed && value == -f64::from(bits - 1).exp2() {
            return Due::Any;
        }
        let most = f64::from(bits).exp2() - 1.0;
        let due = match (is_signed, symmetric) {
            (false, _) => value / most,
            (true, true) => (value / (f64::from(bits - 1).exp2() - 1.0)).max(-1.0),
            (true, false) => (2.0 * value + 1.0) / most,
        };
        Due::Near(due, f64::from(-22).exp2())
    }
}

/// A float as it is; what is no ordinary number may be any.
fn exact(bits: u32) -> Due {
    let exponent = bits >> 23 & 0xFF;
    if exponent == 255 || (exponent == 0 && bits << 1 != 0) { Due::Any } else { Due::Bits(bits) }
}

fn half(bits: u16) -> Due {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 0x3FF));
    let size = match exponent {
        31 => return Due::Any,
        0 => fraction * f64::from(-24).exp2(),
        _ => (1.0 + fraction / 1024.0) * f64::from(exponent - 15).exp2(),
    };
    Due::float(if bits >> 15 == 1 { -size } else { size } as f32)
}
