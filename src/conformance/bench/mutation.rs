//! Mistakes that a test makes the bench commit, to see that a rule notices. Pure; no command line knows of it.

use super::blend::GlBlend;
use super::sampling::Sampling;
use super::state::{GlCompare, GlOffset, GlState, GlStencilOp};

/// One mistake, made at every draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutation {
    /// LEQUAL for LESS, GEQUAL for GREATER and the other way round, in depth textures.
    CompareSwapped,
    /// Stencil values saturate in place of wrapping.
    IncrementForIncrementWrap,
    OneOffsetUnitLess,
    OffsetClampIgnored,
    /// Texgen planes given column by column.
    PlanesTransposed,
    /// Eye planes given while the modelview is another.
    PlanesUnderWrongModelview,
    /// Depths are filtered, then compared.
    FilterThenCompare,
    FrontAndBackSwapped,
    DepthRangeReversed,
    DepthClampIgnored,
    StencilMaskIgnored,
    /// Depth copies start one texel off.
    CopyShifted,
    ClipPlanesIgnored,
    BlendIgnored,
    /// DST_ALPHA is 1.
    StoredAlphaAsOne,
    /// Alpha is blended as RGB is.
    AlphaBlendedAsRgb,
    /// Faces +x and -x of cube maps exchanged.
    CubeFacesSwapped,
    /// s and t exchanged on the face +z.
    CubeFaceTransposed,
    SeamlessIgnored,
    /// DOT3 without the factor 4.
    Dot3WithoutFour,
    Dot3AsModulate,
    AddSignedAsAdd,
    /// Another unit's texture is the unit's own.
    CrossbarIgnored,
    /// RGB_SCALE and ALPHA_SCALE are 1.
    CombineScaleIgnored,
    /// ONE_MINUS_SRC_ALPHA is SRC_ALPHA.
    ComplementIgnored,
}

impl Mutation {
    /// Each of them.
    pub const ALL: [Self; 25] = [
        Self::CompareSwapped,
        Self::IncrementForIncrementWrap,
        Self::OneOffsetUnitLess,
        Self::OffsetClampIgnored,
        Self::PlanesTransposed,
        Self::PlanesUnderWrongModelview,
        Self::FilterThenCompare,
        Self::FrontAndBackSwapped,
        Self::DepthRangeReversed,
        Self::DepthClampIgnored,
        Self::StencilMaskIgnored,
        Self::CopyShifted,
        Self::ClipPlanesIgnored,
        Self::BlendIgnored,
        Self::StoredAlphaAsOne,
        Self::AlphaBlendedAsRgb,
        Self::CubeFacesSwapped,
        Self::CubeFaceTransposed,
        Self::SeamlessIgnored,
        Self::Dot3WithoutFour,
        Self::Dot3AsModulate,
        Self::AddSignedAsAdd,
        Self::CrossbarIgnored,
        Self::CombineScaleIgnored,
        Self::ComplementIgnored,
    ];

    pub(super) fn state(self, mut state: GlState) -> GlState {
        match self {
            Self::IncrementForIncrementWrap => {
                for op in state.stencil.iter_mut().flatten().flat_map(|side| &mut side.ops) {
                    *op = if *op == GlStencilOp::IncrementWrap { GlStencilOp::Increment } else { *op };
                }
            }
            Self::OneOffsetUnitLess => {
                state.offset = state.offset.map(|offset| GlOffset { units: offset.units - 1.0, ..offset });
            }
            Self::OffsetClampIgnored => state.offset = state.offset.map(|offset| GlOffset { clamp: 0.0, ..offset }),
            Self::FrontAndBackSwapped => state.clockwise = !state.clockwise,
            Self::DepthRangeReversed => state.depth_range.reverse(),
            Self::DepthClampIgnored => state.depth_clamp = false,
            Self::StencilMaskIgnored => {
                for side in state.stencil.iter_mut().flatten() {
                    side.write_mask = 0xFF;
                }
            }
            Self::ClipPlanesIgnored => state.clip_distances = 0,
            Self::BlendIgnored => state.blend = None,
            Self::StoredAlphaAsOne if state.blend == Some(GlBlend::AddByStoredAlpha) => {
                state.blend = Some(GlBlend::Add);
            }
            Self::AlphaBlendedAsRgb if state.blend == Some(GlBlend::MultiplyRgb) => {
                state.blend = Some(GlBlend::Multiply);
            }
            _ => {}
        }
        state
    }

    pub(super) fn sampling(self, sampling: Sampling) -> Sampling {
        let swapped = |compare| match compare {
            GlCompare::Less => GlCompare::LessEqual,
            GlCompare::LessEqual => GlCompare::Less,
            GlCompare::Greater => GlCompare::GreaterEqual,
            GlCompare::GreaterEqual => GlCompare::Greater,
            other => other,
        };
        match self {
            Self::CompareSwapped => Sampling { compare: sampling.compare.map(swapped), ..sampling },
            Self::FilterThenCompare => Sampling { compare: None, ..sampling },
            Self::SeamlessIgnored => Sampling { seamless: false, ..sampling },
            _ => sampling,
        }
    }

    /// Faces of a cube map of `side` texels.
    pub(super) fn faces(self, side: u32, mut faces: [Vec<[u8; 4]>; 6]) -> [Vec<[u8; 4]>; 6] {
        match self {
            Self::CubeFacesSwapped => faces.swap(0, 1),
            Self::CubeFaceTransposed => {
                let side = side as usize;
                faces[4] = (0..side * side).map(|texel| faces[4][texel % side * side + texel / side]).collect();
            }
            _ => {}
        }
        faces
    }
}
