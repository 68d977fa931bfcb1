//! Blending of the bench: named pairs of factors, and every factor and equation.

/// result = source * first + destination * second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlBlend {
    /// ONE, ONE.
    Add,
    /// DST_COLOR, ZERO.
    Multiply,
    /// ONE, ZERO: the source alone, by way of the blender.
    Replace,
    /// DST_COLOR, ZERO for RGB; ONE, ZERO for alpha.
    MultiplyRgb,
    /// DST_ALPHA, ONE.
    AddByStoredAlpha,
    /// Factors of source and destination for RGB, then for alpha, and the equation of all four.
    By([GlFactor; 4], GlEquation),
}

/// Factors of glBlendFuncSeparate [GL 4.6, table 17.2].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlFactor {
    Zero,
    One,
    SrcColor,
    OneMinusSrcColor,
    DstColor,
    OneMinusDstColor,
    SrcAlpha,
    OneMinusSrcAlpha,
    DstAlpha,
    OneMinusDstAlpha,
}

impl GlFactor {
    pub const ALL: [Self; 10] = [
        Self::Zero,
        Self::One,
        Self::SrcColor,
        Self::OneMinusSrcColor,
        Self::DstColor,
        Self::OneMinusDstColor,
        Self::SrcAlpha,
        Self::OneMinusSrcAlpha,
        Self::DstAlpha,
        Self::OneMinusDstAlpha,
    ];

    pub(super) fn code(self) -> u32 {
        match self {
            Self::Zero => glow::ZERO,
            Self::One => glow::ONE,
            Self::SrcColor => glow::SRC_COLOR,
            Self::OneMinusSrcColor => glow::ONE_MINUS_SRC_COLOR,
            Self::DstColor => glow::DST_COLOR,
            Self::OneMinusDstColor => glow::ONE_MINUS_DST_COLOR,
            Self::SrcAlpha => glow::SRC_ALPHA,
            Self::OneMinusSrcAlpha => glow::ONE_MINUS_SRC_ALPHA,
            Self::DstAlpha => glow::DST_ALPHA,
            Self::OneMinusDstAlpha => glow::ONE_MINUS_DST_ALPHA,
        }
    }
}

/// Equations of glBlendEquation [GL 4.6, table 17.1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlEquation {
    Add,
    Subtract,
    ReverseSubtract,
    Min,
    Max,
}

impl GlEquation {
    pub const ALL: [Self; 5] = [Self::Add, Self::Subtract, Self::ReverseSubtract, Self::Min, Self::Max];

    pub(super) fn code(self) -> u32 {
        match self {
            Self::Add => glow::FUNC_ADD,
            Self::Subtract => glow::FUNC_SUBTRACT,
            Self::ReverseSubtract => glow::FUNC_REVERSE_SUBTRACT,
            Self::Min => glow::MIN,
            Self::Max => glow::MAX,
        }
    }
}

impl GlBlend {
    /// Factors of glBlendFuncSeparate.
    pub(super) fn factors(self) -> [u32; 4] {
        let [source, destination] = match self {
            Self::Add => [glow::ONE, glow::ONE],
            Self::Multiply => [glow::DST_COLOR, glow::ZERO],
            Self::Replace => [glow::ONE, glow::ZERO],
            Self::MultiplyRgb => return [glow::DST_COLOR, glow::ZERO, glow::ONE, glow::ZERO],
            Self::AddByStoredAlpha => [glow::DST_ALPHA, glow::ONE],
            Self::By(factors, _) => return factors.map(GlFactor::code),
        };
        [source, destination, source, destination]
    }

    pub(super) fn equation(self) -> GlEquation {
        if let Self::By(_, equation) = self { equation } else { GlEquation::Add }
    }
}
