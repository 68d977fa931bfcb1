//! The complete draw state of a pass. Nothing relies on state left behind by another.

/// Comparison functions of depth test and depth textures [GL 4.6, tables 8.31 and 17.3.4].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compare {
    Less,
    LessEqual,
    Equal,
    GreaterEqual,
    Greater,
    Always,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    Front,
    Back,
}

/// glPolygonOffset for filled polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonOffset {
    pub factor: f32,
    pub units: f32,
}

/// All of GL's per-fragment and raster state that a pass of ours can set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawState {
    /// `None`: the depth test, and with it depth writing, is off.
    pub depth_test: Option<Compare>,
    pub depth_write: bool,
    pub color_write: bool,
    /// The faces that are not drawn.
    pub cull: Option<Face>,
    pub polygon_offset: Option<PolygonOffset>,
    /// glDepthRange; reversed where the first exceeds the second.
    pub depth_range: [f32; 2],
}

impl DrawState {
    /// Depth only: LESS, colour writes off.
    pub const DEPTH_ONLY: Self = Self {
        depth_test: Some(Compare::Less),
        depth_write: true,
        color_write: false,
        cull: None,
        polygon_offset: None,
        depth_range: [0.0, 1.0],
    };

    /// Colour and depth: LESS.
    pub const OPAQUE: Self = Self { color_write: true, ..Self::DEPTH_ONLY };
}
