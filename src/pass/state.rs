//! The complete draw state of a pass. Nothing relies on state left behind by another.

/// Comparison functions of depth test and depth textures [GL 4.6, tables 8.31 and 17.3.4].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compare {
    /// GL_NEVER.
    Never,
    /// GL_LESS: the new value is less than the stored one.
    Less,
    /// GL_LEQUAL.
    LessEqual,
    /// GL_EQUAL.
    Equal,
    /// GL_NOTEQUAL.
    NotEqual,
    /// GL_GEQUAL.
    GreaterEqual,
    /// GL_GREATER.
    Greater,
    /// GL_ALWAYS.
    Always,
}

/// Facing of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// GL_FRONT.
    Front,
    /// GL_BACK.
    Back,
}

/// glPolygonOffset for filled polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonOffset {
    /// Multiple of the polygon's greatest depth slope.
    pub factor: f32,
    /// Multiple of the smallest depth step that the format resolves.
    pub units: f32,
}

/// Operation on a stencil value [GL 4.6, 17.3.3]. Values are eight bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StencilOp {
    /// GL_KEEP.
    Keep,
    /// GL_ZERO.
    Zero,
    /// GL_REPLACE: the reference value.
    Replace,
    /// Stops at 255.
    Increment,
    /// Modulo 256.
    IncrementWrap,
    /// Stops at 0.
    Decrement,
    /// Modulo 256.
    DecrementWrap,
    /// GL_INVERT: every bit.
    Invert,
}

/// Operations for each outcome of the tests on the stencil value of a fragment of one facing (glStencilOpSeparate). With
/// the depth test off, the depth test passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilOps {
    /// Where the stencil test fails.
    pub stencil_fail: StencilOp,
    /// Where the stencil test passes and the depth test fails.
    pub depth_fail: StencilOp,
    /// Where both pass.
    pub pass: StencilOp,
}

impl StencilOps {
    /// All three leave the value as it is.
    pub const KEEP: Self = Self { stencil_fail: StencilOp::Keep, depth_fail: StencilOp::Keep, pass: StencilOp::Keep };
}

/// The stencil test [GL 4.6, 17.3.3]: `(reference & read_mask) test (stored & read_mask)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// Comparison of the reference with the stored value.
    pub test: Compare,
    /// Reference value.
    pub reference: u8,
    /// Bits that are compared.
    pub read_mask: u8,
    /// Bits that are written; 0: the stored values stay.
    pub write_mask: u8,
    /// Operations for front faces.
    pub front: StencilOps,
    /// Operations for back faces.
    pub back: StencilOps,
}

/// Blending of a fragment's colour with the stored one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// GL_ONE, GL_ONE; alpha stays as it is.
    Add,
    /// Blends by the fragment's alpha over the stored colour; alpha stays as it is.
    Over,
    /// GL_ONE, GL_ONE_MINUS_SRC_ALPHA, of all four components: the fragment's colour has its alpha as a factor already.
    OverPremultiplied,
    /// GL_DST_ALPHA, GL_ONE: the fragment's colour is weighed by the stored alpha and added; alpha stays as it is.
    AddByStoredAlpha,
    /// GL_DST_COLOR, GL_ZERO: the product of both; alpha stays as it is.
    Multiply,
    /// GL_DST_COLOR, GL_ZERO for colours, GL_ONE, GL_ZERO for alpha: the product of both, and the fragment's alpha.
    MultiplyAndStoreAlpha,
}

/// Channels of the colour buffer that fragments are written to (glColorMask). Clears write all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// None of them.
    None,
    /// Red, green and blue.
    Rgb,
    /// Alpha alone.
    Alpha,
    /// All four.
    All,
}

impl Channels {
    /// Tests whether anything is written.
    pub fn any(self) -> bool {
        self != Self::None
    }

    /// Arguments of glColorMask: red, green, blue, alpha.
    pub fn mask(self) -> [bool; 4] {
        let rgb = matches!(self, Self::Rgb | Self::All);
        [rgb, rgb, rgb, matches!(self, Self::Alpha | Self::All)]
    }
}

/// All per-fragment and raster state that a pass can set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawState {
    /// `None`: the depth test, and with it depth writing, is off.
    pub depth_test: Option<Compare>,
    /// True if depth is written where the tests pass.
    pub depth_write: bool,
    /// Channels of the colour that are written.
    pub color_write: Channels,
    /// The faces that are not drawn.
    pub cull: Option<Face>,
    /// Offset of the depth of filled polygons; `None`: off.
    pub polygon_offset: Option<PolygonOffset>,
    /// glDepthRange; reversed where the first exceeds the second.
    pub depth_range: [f32; 2],
    /// GL_DEPTH_CLAMP: no clipping at the near and far planes, depth clamped to the range [GL 4.6, 13.7].
    pub depth_clamp: bool,
    /// GL_TEXTURE_CUBE_MAP_SEAMLESS: texels of neighbouring faces are averaged at a cube map's edges.
    pub seamless: bool,
    /// Number of clip distances, from GL_CLIP_DISTANCE0, that the vertex stage writes; at most
    /// [`DrawState::MOST_CLIP_DISTANCES`].
    pub clip_distances: u8,
    /// `None`: the stencil test is off.
    pub stencil: Option<Stencil>,
    /// `None`: the fragment's colour replaces what is there.
    pub blend: Option<Blend>,
    /// Scissor: left, bottom, width and height in pixels; `None`: everything. Clears ignore it.
    pub scissor: Option<[u32; 4]>,
}

impl DrawState {
    /// GL guarantees eight [GL 3.3, table 6.41]; nothing of ours needs more.
    pub const MOST_CLIP_DISTANCES: u8 = 8;

    /// Depth only: LESS, colour writes off.
    pub const DEPTH_ONLY: Self = Self {
        depth_test: Some(Compare::Less),
        depth_write: true,
        color_write: Channels::None,
        cull: None,
        polygon_offset: None,
        depth_range: [0.0, 1.0],
        depth_clamp: false,
        seamless: true,
        clip_distances: 0,
        stencil: None,
        blend: None,
        scissor: None,
    };

    /// Colour and depth: LESS.
    pub const OPAQUE: Self = Self { color_write: Channels::All, ..Self::DEPTH_ONLY };

    /// Colour only where the stored depth equals the draw's: EQUAL, no depth writes. Exact only with the same position
    /// arithmetic as the pass that wrote it [GL 4.6 compatibility, A.3].
    pub const REPEAT: Self = Self { depth_test: Some(Compare::Equal), depth_write: false, ..Self::OPAQUE };
}
