//! Settings: pieces of GL's state, each set by one call.

use super::super::{GlCompare, GlEquation, GlFace, GlFactor, GlMipmap, GlOffset, GlStencilOp, GlSwizzle, GlWrap};

/// Faces that a stencil call is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// The call without a face.
    Short,
    /// GL_FRONT_AND_BACK.
    Both,
    Front,
    Back,
}

impl Faces {
    /// True for front, and for back, where they are meant.
    pub fn sides(self) -> [bool; 2] {
        [self != Self::Back, self != Self::Front]
    }

    pub(super) fn code(self) -> u32 {
        match self {
            Self::Short | Self::Both => glow::FRONT_AND_BACK,
            Self::Front => glow::FRONT,
            Self::Back => glow::BACK,
        }
    }
}

/// One piece of state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    DepthTest(bool),
    DepthFunc(GlCompare),
    DepthMask(bool),
    /// True: by glDepthRangef.
    DepthRange([f64; 2], bool),
    DepthClamp(bool),
    CullFace(bool),
    Culled(GlFace),
    Clockwise(bool),
    StencilTest(bool),
    StencilFunc(Faces, GlCompare, i32, u32),
    StencilOp(Faces, [GlStencilOp; 3]),
    StencilMask(Faces, u32),
    Blend(bool),
    /// glEnablei.
    BlendOf(u32, bool),
    /// Source and destination of RGB, then of alpha; by glBlendFunc where both are the same.
    BlendFunc([GlFactor; 4]),
    /// Equations of RGB and of alpha.
    BlendEquation([GlEquation; 2]),
    ColorMask([bool; 4]),
    /// glColorMaski.
    ColorMaskOf(u32, [bool; 4]),
    ScissorTest(bool),
    Scissor([i32; 4]),
    Viewport([i32; 4]),
    OffsetFill(bool),
    /// GL_CLIP_DISTANCE0.
    ClipDistance(bool),
    Offset(GlOffset),
    ClearColor([f32; 4]),
    ClearDepth(f64),
    ClearStencil(i32),
    Program(Program),
    /// Uniforms of a program, which is used for that.
    Color(Program, [f32; 4]),
    Period(Program, [i32; 2]),
    Origin(Program, [i32; 2]),
    Level(Program, i32),
    Layer(Program, i32),
    Reference(Program, f32),
    Unit(Program, i32),
    /// Directions of s, t and the axis of a cube's face.
    Axes(Program, [[f32; 3]; 3]),
    Cut(Program, [f32; 2]),
    /// A unit's texture; the slot's own target.
    Texture(u32, usize),
    Sampler(u32, Option<usize>),
    /// State of a texture, or of a sampler object.
    Filters(Sampled, bool, bool, GlMipmap),
    Wrap(Sampled, [GlWrap; 2]),
    Border(Sampled, [f32; 4]),
    Compare(Sampled, Option<GlCompare>),
    LodRange(Sampled, [f32; 2]),
    /// TEXTURE_BASE_LEVEL and TEXTURE_MAX_LEVEL.
    Levels(usize, [u32; 2]),
    Swizzle(usize, [GlSwizzle; 4]),
}

/// The object whose sampling state is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampled {
    /// A texture, bound to the unit that is active.
    Texture(usize),
    Sampler(usize),
}

/// The program that draws; each is one fragment shader. Textures are read at the pixel's own place, moved by `origin`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// The colour of the uniform.
    Plain,
    /// The colour of the vertices.
    Varying,
    /// Squares of pixels, `period` on a side, in turn discarded and drawn.
    Squares,
    /// Two outputs: the uniform, and the uniform with its channels turned round.
    Two,
    /// The uniform's colour, at the depth `reference`.
    Depth,
    /// A texel of a 2D texture's level by texelFetch, times the uniform.
    Fetch,
    /// The red channel of the same, in all channels: of a depth texture.
    FetchDepth,
    /// A texel of an array's layer by texelFetch.
    FetchLayer,
    /// A texel of a 2D texture by textureLod, at its centre and beyond the texture.
    Look,
    /// A texel of a cube map by textureLod, at its centre.
    LookCube,
    /// A comparison with `reference` in a 2D texture by textureLod, at a texel's centre: result, 1/4, result, 1.
    Compare,
    /// By which side is seen: the uniform or the vertices' colour.
    Sides,
    /// The uniform's colour with an alpha of 1.
    Opaque,
    /// The uniform's colour, where `cut.x * x + cut.y * w` of the position is not negative: a clip distance.
    Clip,
}

impl Program {
    pub const ALL: [Self; 14] = [
        Self::Plain,
        Self::Varying,
        Self::Squares,
        Self::Two,
        Self::Depth,
        Self::Fetch,
        Self::FetchDepth,
        Self::FetchLayer,
        Self::Look,
        Self::LookCube,
        Self::Compare,
        Self::Sides,
        Self::Opaque,
        Self::Clip,
    ];

    /// Tests whether it reads a texture.
    pub fn reads(self) -> bool {
        matches!(self, Self::Fetch | Self::FetchDepth | Self::FetchLayer | Self::Look | Self::LookCube | Self::Compare)
    }

    /// Tests whether it has `reference`, `period` and `layer`.
    pub fn has(self, setting: &Setting) -> bool {
        match setting {
            Setting::Color(..) => !matches!(self, Self::Varying) && (!self.reads() || self == Self::Fetch),
            Setting::Period(..) => self == Self::Squares,
            Setting::Reference(..) => matches!(self, Self::Depth | Self::Compare),
            Setting::Layer(..) => self == Self::FetchLayer,
            Setting::Axes(..) => self == Self::LookCube,
            Setting::Cut(..) => self == Self::Clip,
            Setting::Origin(..) | Setting::Level(..) | Setting::Unit(..) => self.reads(),
            _ => false,
        }
    }
}
