//! Texture environments as data, and the GL calls that set them: GL_COMBINE alone [GL 4.6 compatibility, 16.1].

use glam::DMat4;

use super::image::GlImage;
use super::sampling::Sampling;
use super::texgen::GlTexgen;
use crate::context::compatibility::{Binding, raw};

/// GL_COMBINE's functions [GL 4.6 compatibility, tables 16.20 and 16.21].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlCombine {
    Replace,
    Modulate,
    Add,
    AddSigned,
    Interpolate,
    Subtract,
    /// GL_DOT3_RGB: of RGB alone.
    Dot3Rgb,
    /// GL_DOT3_RGBA: of RGB; alpha gets the same.
    Dot3Rgba,
}

impl GlCombine {
    /// The functions that RGB and alpha share.
    pub const SHARED: [Self; 6] =
        [Self::Replace, Self::Modulate, Self::Add, Self::AddSigned, Self::Interpolate, Self::Subtract];

    /// GL's name, without GL_.
    pub fn name(self) -> &'static str {
        match self {
            Self::Replace => "REPLACE",
            Self::Modulate => "MODULATE",
            Self::Add => "ADD",
            Self::AddSigned => "ADD_SIGNED",
            Self::Interpolate => "INTERPOLATE",
            Self::Subtract => "SUBTRACT",
            Self::Dot3Rgb => "DOT3_RGB",
            Self::Dot3Rgba => "DOT3_RGBA",
        }
    }

    fn code(self) -> u32 {
        match self {
            Self::Replace => glow::REPLACE,
            Self::Modulate => raw::MODULATE,
            Self::Add => raw::ADD,
            Self::AddSigned => raw::ADD_SIGNED,
            Self::Interpolate => raw::INTERPOLATE,
            Self::Subtract => raw::SUBTRACT,
            Self::Dot3Rgb => raw::DOT3_RGB,
            Self::Dot3Rgba => raw::DOT3_RGBA,
        }
    }
}

/// Source of a combiner's argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlSource {
    Texture,
    /// The texture of the unit of this number.
    Crossbar(u32),
    Constant,
    Primary,
    /// The unit before; the primary colour for the first.
    Previous,
}

/// Part of a source that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlOperand {
    Color,
    OneMinusColor,
    Alpha,
    OneMinusAlpha,
}

impl GlOperand {
    pub const ALL: [Self; 4] = [Self::Color, Self::OneMinusColor, Self::Alpha, Self::OneMinusAlpha];
}

/// One argument of a combiner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlArgument {
    pub source: GlSource,
    /// A combiner of alpha takes the source's alpha in place of its colour.
    pub operand: GlOperand,
}

impl GlArgument {
    /// The source as it is.
    pub const fn of(source: GlSource) -> Self {
        Self { source, operand: GlOperand::Color }
    }
}

/// The combiner of RGB or of alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlCombiner {
    pub function: GlCombine,
    pub arguments: [GlArgument; 3],
    /// RGB_SCALE or ALPHA_SCALE: 1, 2 or 4.
    pub scale: u32,
}

impl GlCombiner {
    /// The source as it is.
    pub const fn replace(source: GlSource) -> Self {
        Self::plain(GlCombine::Replace, [source; 3])
    }

    /// Sources as they are, scale 1.
    pub const fn plain(function: GlCombine, [a, b, c]: [GlSource; 3]) -> Self {
        Self { function, arguments: [GlArgument::of(a), GlArgument::of(b), GlArgument::of(c)], scale: 1 }
    }
}

/// A unit's environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlEnvironment {
    pub rgb: GlCombiner,
    pub alpha: GlCombiner,
    /// TEXTURE_ENV_COLOR.
    pub constant: [f32; 4],
}

/// Source of a unit's texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a few on the stack")]
pub enum GlCoordinates {
    /// The viewport as [0, 1] x [0, 1].
    Square,
    /// The vertex's value.
    Value,
    /// glTexGen, and the unit's texture matrix.
    Generated(GlTexgen, DMat4),
}

/// A texture unit.
#[derive(Clone, Copy)]
pub struct GlUnit<'a> {
    pub image: &'a GlImage,
    pub sampling: Sampling,
    pub coordinates: GlCoordinates,
    pub environment: GlEnvironment,
}

/// Sets the active unit's environment.
///
/// # Safety
///
/// The context of `binding` is current.
pub(super) unsafe fn set(binding: &Binding, environment: &GlEnvironment) {
    // SAFETY: as the caller promises; four numbers are read.
    unsafe {
        binding.TexEnvi(raw::TEXTURE_ENV, raw::TEXTURE_ENV_MODE, raw::COMBINE as i32);
        binding.TexEnvfv(raw::TEXTURE_ENV, raw::TEXTURE_ENV_COLOR, environment.constant.as_ptr());
        binding.TexEnvf(raw::TEXTURE_ENV, raw::RGB_SCALE, environment.rgb.scale as f32);
        binding.TexEnvf(raw::TEXTURE_ENV, raw::ALPHA_SCALE, environment.alpha.scale as f32);
        set_combiner(binding, &environment.rgb, raw::COMBINE_RGB, raw::SRC0_RGB, raw::OPERAND0_RGB);
        set_combiner(binding, &environment.alpha, raw::COMBINE_ALPHA, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA);
    }
}

/// # Safety
///
/// As [`set`]. The names of sources and operands 1 and 2 follow those of 0.
unsafe fn set_combiner(binding: &Binding, combiner: &GlCombiner, name: u32, source: u32, operand: u32) {
    let is_alpha = name == raw::COMBINE_ALPHA;
    // SAFETY: as the caller promises.
    unsafe {
        binding.TexEnvi(raw::TEXTURE_ENV, name, combiner.function.code() as i32);
        for (index, argument) in (0..).zip(combiner.arguments) {
            let from = match argument.source {
                GlSource::Texture => glow::TEXTURE,
                GlSource::Crossbar(unit) => glow::TEXTURE0 + unit,
                GlSource::Constant => raw::CONSTANT,
                GlSource::Primary => raw::PRIMARY_COLOR,
                GlSource::Previous => raw::PREVIOUS,
            };
            let taken = match argument.operand {
                GlOperand::Color if is_alpha => glow::SRC_ALPHA,
                GlOperand::OneMinusColor if is_alpha => glow::ONE_MINUS_SRC_ALPHA,
                GlOperand::Color => glow::SRC_COLOR,
                GlOperand::OneMinusColor => glow::ONE_MINUS_SRC_COLOR,
                GlOperand::Alpha => glow::SRC_ALPHA,
                GlOperand::OneMinusAlpha => glow::ONE_MINUS_SRC_ALPHA,
            };
            binding.TexEnvi(raw::TEXTURE_ENV, source + index, from as i32);
            binding.TexEnvi(raw::TEXTURE_ENV, operand + index, taken as i32);
        }
    }
}
