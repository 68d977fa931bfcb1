//! Formats of textures and renderbuffers, and how a depth format is encoded on this driver.

use crate::context::DEPTH_COMPONENT32;

/// Internal formats: sized ones, and the unsized one of depth textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GlFormat {
    /// Unsized: the driver chooses the bits [GL 4.6, 8.5.1].
    Depth,
    Depth16,
    Depth24,
    Depth32,
    Depth32F,
    Depth24Stencil8,
    Depth32FStencil8,
    R8,
    Rgba8,
    Rgba8Signed,
    Srgb8Alpha8,
    Rgba16F,
    Rgba32F,
    R32F,
}

impl GlFormat {
    /// The sized depth formats.
    pub const DEPTHS: [Self; 6] =
        [Self::Depth16, Self::Depth24, Self::Depth32, Self::Depth32F, Self::Depth24Stencil8, Self::Depth32FStencil8];

    /// GL's name, without GL_.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "DEPTH_COMPONENT",
            Self::Depth16 => "DEPTH_COMPONENT16",
            Self::Depth24 => "DEPTH_COMPONENT24",
            Self::Depth32 => "DEPTH_COMPONENT32",
            Self::Depth32F => "DEPTH_COMPONENT32F",
            Self::Depth24Stencil8 => "DEPTH24_STENCIL8",
            Self::Depth32FStencil8 => "DEPTH32F_STENCIL8",
            Self::R8 => "R8",
            Self::Rgba8 => "RGBA8",
            Self::Rgba8Signed => "RGBA8_SNORM",
            Self::Srgb8Alpha8 => "SRGB8_ALPHA8",
            Self::Rgba16F => "RGBA16F",
            Self::Rgba32F => "RGBA32F",
            Self::R32F => "R32F",
        }
    }

    /// The depth formats without stencil.
    pub const PURE_DEPTHS: [Self; 4] = [Self::Depth16, Self::Depth24, Self::Depth32, Self::Depth32F];

    /// Tests whether each driver must have the format of this name as a texture and as a renderbuffer, alone and beside
    /// others [GL 4.6, 8.5.1, 9.2.5, 9.4.3]. RGBA8_SNORM need not be drawn into.
    pub fn is_required(name: &str) -> bool {
        ![Self::Depth, Self::Depth32, Self::Rgba8Signed].iter().any(|format| format.name() == name)
    }

    pub fn is_depth(self) -> bool {
        self == Self::Depth || Self::DEPTHS.contains(&self)
    }

    pub fn has_stencil(self) -> bool {
        matches!(self, Self::Depth24Stencil8 | Self::Depth32FStencil8)
    }

    /// The internal format, and format and type of an upload.
    pub(super) fn codes(self) -> (u32, u32, u32) {
        match self {
            Self::Depth => (glow::DEPTH_COMPONENT, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth16 => (glow::DEPTH_COMPONENT16, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth24 => (glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth32 => (DEPTH_COMPONENT32, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth32F => (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth24Stencil8 => (glow::DEPTH24_STENCIL8, glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8),
            Self::Depth32FStencil8 => {
                (glow::DEPTH32F_STENCIL8, glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV)
            }
            Self::R8 => (glow::R8, glow::RED, glow::UNSIGNED_BYTE),
            Self::Rgba8 => (glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Self::Rgba8Signed => (glow::RGBA8_SNORM, glow::RGBA, glow::BYTE),
            Self::Srgb8Alpha8 => (glow::SRGB8_ALPHA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Self::Rgba16F => (glow::RGBA16F, glow::RGBA, glow::FLOAT),
            Self::Rgba32F => (glow::RGBA32F, glow::RGBA, glow::FLOAT),
            Self::R32F => (glow::R32F, glow::RED, glow::FLOAT),
        }
    }
}

/// The driver's choice for a depth format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// True bits of depth, which may differ from those requested.
    pub bits: u32,
    pub stencil_bits: u32,
    pub float: bool,
}

impl Encoding {
    /// The largest code of a fixed-point format; for a float, of as many codes as it has significant bits.
    pub fn most(self) -> f64 {
        if self.float { f64::from(1u32 << 24) } else { f64::from(self.bits).exp2() - 1.0 }
    }

    /// The least difference of stored depths: of a fixed-point format, or of a float's at `depth` in (0, 1).
    pub fn step(self, depth: f64) -> f64 {
        if self.float { (depth.log2().floor() - 23.0).exp2() } else { 1.0 / self.most() }
    }
}

#[cfg(test)]
mod tests {
    use super::Encoding;

    #[test]
    fn steps_of_formats() {
        let float = Encoding { bits: 32, stencil_bits: 0, float: true };
        assert_eq!(float.step(0.75), 2f64.powi(-24));
        assert_eq!(float.step(0.1875), 2f64.powi(-26));
        assert_eq!(Encoding { bits: 16, stencil_bits: 0, float: false }.step(0.75), 1.0 / 65535.0);
    }
}
