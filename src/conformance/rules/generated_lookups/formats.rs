//! Formats of textures, and what is stored of a value [GL 4.6, 8.5].

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
pub enum TexelBase {
    /// So many of red, green, blue and alpha; depth is red.
    Colors(usize),
    Alpha,
    Luminance,
    LuminanceAlpha,
    Intensity,
}

/// An internal format.
#[derive(Debug)]
pub struct TexelFormat {
    pub name: &'static str,
    pub internal: u32,
    pub numbers: Numbers,
    pub base: TexelBase,
    /// Bits of red, green, blue and alpha.
    pub bits: [u32; 4],
    /// Tests whether it may be drawn into [GL 4.6, 9.4].
    pub drawn: bool,
}

const fn color(
    name: &'static str,
    internal: u32,
    numbers: Numbers,
    channels: usize,
    bits: u32,
    drawn: bool,
) -> TexelFormat {
    TexelFormat { name, internal, numbers, base: TexelBase::Colors(channels), bits: [bits; 4], drawn }
}

const fn old(name: &'static str, internal: u32, base: TexelBase) -> TexelFormat {
    TexelFormat { name, internal, numbers: Numbers::Unorm, base, bits: [8; 4], drawn: false }
}

/// Formats of every context.
pub const FORMATS: &[TexelFormat] = &[
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
    TexelFormat {
        name: "RGB10_A2",
        internal: glow::RGB10_A2,
        numbers: Numbers::Unorm,
        base: TexelBase::Colors(4),
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
pub const OLD_FORMATS: &[TexelFormat] = &[
    old("ALPHA8", 0x803C, TexelBase::Alpha),
    old("LUMINANCE8", 0x8040, TexelBase::Luminance),
    old("LUMINANCE8_ALPHA8", 0x8045, TexelBase::LuminanceAlpha),
    old("INTENSITY8", 0x804B, TexelBase::Intensity),
];

impl TexelFormat {
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
            TexelBase::Colors(channels) => channel < channels,
            TexelBase::Alpha => channel == 3,
            TexelBase::Luminance | TexelBase::Intensity => channel == 0,
            TexelBase::LuminanceAlpha => channel == 0 || channel == 3,
        }
    }

    /// Texels as a shader sees them, of what is stored.
    fn seen(&self, [r, g, b, a]: [f64; 4]) -> [f64; 4] {
        match self.base {
            TexelBase::Colors(1) => [r, 0.0, 0.0, 1.0],
            TexelBase::Colors(2) => [r, g, 0.0, 1.0],
            TexelBase::Colors(3) => [r, g, b, 1.0],
            TexelBase::Colors(_) => [r, g, b, a],
            TexelBase::Alpha => [0.0, 0.0, 0.0, a],
            TexelBase::Luminance => [r, r, r, 1.0],
            TexelBase::LuminanceAlpha => [r, r, r, a],
            TexelBase::Intensity => [r; 4],
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

    /// A client's value as it is stored and a shader sees it, and by how much that may be off.
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
pub fn round_to(value: f64, bits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let step = (value.abs().log2().floor() as i32 + 1 - bits).max(-24);
    let step = f64::from(step).exp2();
    (value / step).round() * step
}
