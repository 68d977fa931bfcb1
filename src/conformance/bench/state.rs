//! The complete draw state of one bench draw, and the GL calls that set it. Nothing relies on earlier state.

use std::cmp::Ordering;

use glow::HasContext;

use super::blend::{GlBlend, GlEquation};

/// Comparison functions of the depth test, the stencil test and depth textures [GL 4.6, 17.3.4].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GlCompare {
    Never,
    Less,
    Equal,
    LessEqual,
    Greater,
    NotEqual,
    GreaterEqual,
    Always,
}

impl GlCompare {
    /// All eight, in GL's order.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// Tests whether `left OP right` holds when `left` is so ordered against `right`.
    pub fn holds(self, left_to_right: Ordering) -> bool {
        match self {
            Self::Never => false,
            Self::Less => left_to_right.is_lt(),
            Self::Equal => left_to_right.is_eq(),
            Self::LessEqual => left_to_right.is_le(),
            Self::Greater => left_to_right.is_gt(),
            Self::NotEqual => left_to_right.is_ne(),
            Self::GreaterEqual => left_to_right.is_ge(),
            Self::Always => true,
        }
    }

    /// GL numbers them in this order from GL_NEVER.
    pub(crate) fn code(self) -> u32 {
        glow::NEVER + self as u32
    }
}

/// glPolygonOffset and, where it is not 0, glPolygonOffsetClamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlOffset {
    pub factor: f32,
    pub units: f32,
    pub clamp: f32,
}

/// Operation on a stencil value [GL 4.6, 17.3.3].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlStencilOp {
    Keep,
    Zero,
    Replace,
    Increment,
    IncrementWrap,
    Decrement,
    DecrementWrap,
    Invert,
}

impl GlStencilOp {
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::Increment,
        Self::IncrementWrap,
        Self::Decrement,
        Self::DecrementWrap,
        Self::Invert,
    ];

    pub(super) fn code(self) -> u32 {
        match self {
            Self::Keep => glow::KEEP,
            Self::Zero => glow::ZERO,
            Self::Replace => glow::REPLACE,
            Self::Increment => glow::INCR,
            Self::IncrementWrap => glow::INCR_WRAP,
            Self::Decrement => glow::DECR,
            Self::DecrementWrap => glow::DECR_WRAP,
            Self::Invert => glow::INVERT,
        }
    }
}

/// The stencil test and operations of one side of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlStencil {
    pub compare: GlCompare,
    pub reference: i32,
    pub read_mask: u32,
    pub write_mask: u32,
    /// Stencil test fails, depth test fails, both pass.
    pub ops: [GlStencilOp; 3],
}

impl GlStencil {
    /// Always passes, and does `op` where the depth test passes too.
    pub const fn on_pass(op: GlStencilOp) -> Self {
        Self {
            compare: GlCompare::Always,
            reference: 0,
            read_mask: 0xFF,
            write_mask: 0xFF,
            ops: [GlStencilOp::Keep, GlStencilOp::Keep, op],
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlFace {
    Front,
    Back,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlPolygonMode {
    Fill,
    Line,
    Point,
}

impl GlPolygonMode {
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Fill => glow::FILL,
            Self::Line => glow::LINE,
            Self::Point => glow::POINT,
        }
    }
}

/// All of GL's state that a bench draw can have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlState {
    /// `None`: depth test and depth writing are off.
    pub depth: Option<GlCompare>,
    pub depth_write: bool,
    pub depth_range: [f64; 2],
    pub depth_clamp: bool,
    pub offset: Option<GlOffset>,
    /// The polygon modes that the offset is for: POLYGON_OFFSET_FILL and POLYGON_OFFSET_LINE.
    pub offset_modes: [bool; 2],
    /// POLYGON_OFFSET_POINT.
    pub offset_points: bool,
    /// Stencil states of front and back faces.
    pub stencil: Option<[GlStencil; 2]>,
    /// Faces that are not drawn.
    pub cull: Option<GlFace>,
    /// True if front faces wind clockwise in window space.
    pub clockwise: bool,
    /// Polygon modes of front and back faces; a core context knows only equal ones.
    pub mode: [GlPolygonMode; 2],
    pub blend: Option<GlBlend>,
    pub color_write: bool,
    /// Channels that are written where colour is: red, green, blue, alpha.
    pub channels: [bool; 4],
    /// x, y, width, height in pixels from the lower left.
    pub scissor: Option<[i32; 4]>,
    /// Rectangle like the scissor; `None`: all of the surface.
    pub viewport: Option<[i32; 4]>,
    /// Number of gl_ClipDistance values that clip.
    pub clip_distances: u32,
    pub encode_srgb: bool,
    /// Uses the calls without a face (glStencilFunc, glStencilMask, glStencilOp) where both faces have the same,
    /// glDepthRangef and glPolygonOffset; else the calls for a face, glDepthRange and glPolygonOffsetClamp.
    pub short_calls: bool,
    /// Leaves the values of what is off as they are: functions, factors, the scissor's rectangle, the offset. Else each has
    /// one that changes nothing.
    pub stale_values: bool,
}

impl GlState {
    /// Every fragment is written, colour and depth.
    pub const WRITE: Self = Self {
        depth: Some(GlCompare::Always),
        depth_write: true,
        depth_range: [0.0, 1.0],
        depth_clamp: false,
        offset: None,
        offset_modes: [true; 2],
        offset_points: false,
        stencil: None,
        cull: None,
        clockwise: false,
        mode: [GlPolygonMode::Fill; 2],
        blend: None,
        color_write: true,
        channels: [true; 4],
        scissor: None,
        viewport: None,
        clip_distances: 0,
        encode_srgb: false,
        short_calls: false,
        stale_values: false,
    };

    /// Tests whether the values of something are set that is on or off.
    fn sets(&self, on: bool) -> bool {
        on || !self.stale_values
    }

    /// Fragments only count: no depth test, no writes but the stencil's.
    pub const fn counting(front: GlStencilOp, back: GlStencilOp) -> Self {
        Self {
            depth: None,
            color_write: false,
            stencil: Some([GlStencil::on_pass(front), GlStencil::on_pass(back)]),
            ..Self::WRITE
        }
    }
}

/// Functions that glow lacks, looked up once.
pub(super) type OffsetClamp = unsafe extern "system" fn(f32, f32, f32);

/// Sets all of `state`; `size` is the surface's.
pub(super) fn apply(gl: &glow::Context, offset_clamp: Option<OffsetClamp>, state: &GlState, size: [u32; 2]) {
    let enable = |what, on| unsafe { if on { gl.enable(what) } else { gl.disable(what) } };
    // SAFETY: the context is current; only state is set.
    unsafe {
        enable(glow::DEPTH_TEST, state.depth.is_some());
        if state.sets(state.depth.is_some()) {
            gl.depth_func(state.depth.unwrap_or(GlCompare::Always).code());
        }
        gl.depth_mask(state.depth_write);
        let [near, far] = state.depth_range;
        if state.short_calls {
            gl.depth_range_f32(near as f32, far as f32);
        } else {
            gl.depth_range(near, far);
        }
        enable(glow::DEPTH_CLAMP, state.depth_clamp);
        apply_stencil(gl, state);
        enable(glow::CULL_FACE, state.cull.is_some());
        if state.sets(state.cull.is_some()) {
            gl.cull_face(if state.cull == Some(GlFace::Front) { glow::FRONT } else { glow::BACK });
        }
        gl.front_face(if state.clockwise { glow::CW } else { glow::CCW });
        apply_mode(gl, state.mode);
        enable(glow::BLEND, state.blend.is_some());
        if state.sets(state.blend.is_some()) {
            let [source, destination, source_alpha, destination_alpha] =
                state.blend.unwrap_or(GlBlend::Replace).factors();
            gl.blend_func_separate(source, destination, source_alpha, destination_alpha);
            gl.blend_equation(state.blend.map_or(GlEquation::Add, GlBlend::equation).code());
        }
        let [red, green, blue, alpha] = state.channels.map(|channel| channel && state.color_write);
        gl.color_mask(red, green, blue, alpha);
        enable(glow::SCISSOR_TEST, state.scissor.is_some());
        let whole = [0, 0, size[0] as i32, size[1] as i32];
        let [x, y, width, height] = state.scissor.unwrap_or(whole);
        if state.sets(state.scissor.is_some()) {
            gl.scissor(x, y, width, height);
        }
        let [x, y, width, height] = state.viewport.unwrap_or(whole);
        gl.viewport(x, y, width, height);
        for index in 0..8 {
            enable(glow::CLIP_DISTANCE0 + index, index < state.clip_distances);
        }
        enable(glow::FRAMEBUFFER_SRGB, state.encode_srgb);
        enable(glow::DITHER, false);
    }
    apply_offset(gl, offset_clamp, state);
}

fn apply_stencil(gl: &glow::Context, state: &GlState) {
    // SAFETY: as in `apply`.
    unsafe {
        let Some(sides) = state.stencil else { return gl.disable(glow::STENCIL_TEST) };
        gl.enable(glow::STENCIL_TEST);
        let test = |side: GlStencil| (side.compare, side.reference, side.read_mask);
        let [front, back] = sides;
        let both = |same: bool| state.short_calls && same;
        let short = [test(front) == test(back), front.write_mask == back.write_mask, front.ops == back.ops].map(both);
        if short[0] {
            gl.stencil_func(front.compare.code(), front.reference, front.read_mask);
        }
        if short[1] {
            gl.stencil_mask(front.write_mask);
        }
        if short[2] {
            let [fail, depth_fail, pass] = front.ops.map(GlStencilOp::code);
            gl.stencil_op(fail, depth_fail, pass);
        }
        for (face, side) in [glow::FRONT, glow::BACK].into_iter().zip(sides) {
            if !short[0] {
                gl.stencil_func_separate(face, side.compare.code(), side.reference, side.read_mask);
            }
            if !short[1] {
                gl.stencil_mask_separate(face, side.write_mask);
            }
            if !short[2] {
                let [fail, depth_fail, pass] = side.ops.map(GlStencilOp::code);
                gl.stencil_op_separate(face, fail, depth_fail, pass);
            }
        }
    }
}

fn apply_mode(gl: &glow::Context, mode: [GlPolygonMode; 2]) {
    let code = GlPolygonMode::code;
    // SAFETY: as in `apply`.
    unsafe {
        if mode[0] == mode[1] {
            gl.polygon_mode(glow::FRONT_AND_BACK, code(mode[0]));
        } else {
            gl.polygon_mode(glow::FRONT, code(mode[0]));
            gl.polygon_mode(glow::BACK, code(mode[1]));
        }
    }
}

fn apply_offset(gl: &glow::Context, offset_clamp: Option<OffsetClamp>, state: &GlState) {
    // SAFETY: as in `apply`; glPolygonOffsetClamp has the signature that it was loaded with.
    unsafe {
        for (mode, on) in [glow::POLYGON_OFFSET_FILL, glow::POLYGON_OFFSET_LINE].into_iter().zip(state.offset_modes) {
            if on && state.offset.is_some() { gl.enable(mode) } else { gl.disable(mode) }
        }
        let points = state.offset_points && state.offset.is_some();
        if points {
            gl.enable(glow::POLYGON_OFFSET_POINT)
        } else {
            gl.disable(glow::POLYGON_OFFSET_POINT)
        }
        if !state.sets(state.offset.is_some()) {
            return;
        }
        let GlOffset { factor, units, clamp } =
            state.offset.unwrap_or(GlOffset { factor: 0.0, units: 0.0, clamp: 0.0 });
        match offset_clamp {
            Some(function) if !state.short_calls => function(factor, units, clamp),
            _ => gl.polygon_offset(factor, units),
        }
    }
}
