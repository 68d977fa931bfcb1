//! Settings: pieces of GL's state, each set by one call.

use glow::HasContext;

use super::super::{GlCompare, GlEquation, GlFace, GlFactor, GlMipmap, GlOffset, GlStencilOp, GlSwizzle, GlWrap};
use super::{Player, Program, Sampled};

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

    fn code(self) -> u32 {
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

impl Player<'_> {
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn set(&mut self, setting: Setting) {
        let gl = self.gl;
        let enable = |what, on| unsafe { if on { gl.enable(what) } else { gl.disable(what) } };
        let face = |face| if face == GlFace::Front { glow::FRONT } else { glow::BACK };
        // SAFETY: as the caller promises; only state is set.
        unsafe {
            match setting {
                Setting::DepthTest(on) => enable(glow::DEPTH_TEST, on),
                Setting::DepthFunc(compare) => gl.depth_func(compare.code()),
                Setting::DepthMask(on) => gl.depth_mask(on),
                Setting::DepthRange([near, far], false) => gl.depth_range(near, far),
                Setting::DepthRange([near, far], true) => gl.depth_range_f32(near as f32, far as f32),
                Setting::DepthClamp(on) => enable(glow::DEPTH_CLAMP, on),
                Setting::CullFace(on) => enable(glow::CULL_FACE, on),
                Setting::Culled(which) => gl.cull_face(face(which)),
                Setting::Clockwise(on) => gl.front_face(if on { glow::CW } else { glow::CCW }),
                Setting::StencilTest(on) => enable(glow::STENCIL_TEST, on),
                Setting::StencilFunc(Faces::Short, compare, reference, mask) => {
                    gl.stencil_func(compare.code(), reference, mask);
                }
                Setting::StencilFunc(faces, compare, reference, mask) => {
                    gl.stencil_func_separate(faces.code(), compare.code(), reference, mask);
                }
                Setting::StencilOp(faces, ops) => {
                    let [fail, depth_fail, pass] = ops.map(GlStencilOp::code);
                    if faces == Faces::Short {
                        gl.stencil_op(fail, depth_fail, pass);
                    } else {
                        gl.stencil_op_separate(faces.code(), fail, depth_fail, pass);
                    }
                }
                Setting::StencilMask(Faces::Short, mask) => gl.stencil_mask(mask),
                Setting::StencilMask(faces, mask) => gl.stencil_mask_separate(faces.code(), mask),
                Setting::Blend(on) => enable(glow::BLEND, on),
                Setting::BlendOf(output, true) => gl.enable_draw_buffer(glow::BLEND, output),
                Setting::BlendOf(output, false) => gl.disable_draw_buffer(glow::BLEND, output),
                Setting::BlendFunc(factors) => {
                    let [source, destination, source_alpha, destination_alpha] = factors.map(GlFactor::code);
                    if [source, destination] == [source_alpha, destination_alpha] {
                        gl.blend_func(source, destination);
                    } else {
                        gl.blend_func_separate(source, destination, source_alpha, destination_alpha);
                    }
                }
                Setting::BlendEquation([rgb, alpha]) if rgb == alpha => gl.blend_equation(rgb.code()),
                Setting::BlendEquation([rgb, alpha]) => gl.blend_equation_separate(rgb.code(), alpha.code()),
                Setting::ColorMask([r, g, b, a]) => gl.color_mask(r, g, b, a),
                Setting::ColorMaskOf(output, [r, g, b, a]) => gl.color_mask_draw_buffer(output, r, g, b, a),
                Setting::ScissorTest(on) => enable(glow::SCISSOR_TEST, on),
                Setting::Scissor([x, y, width, height]) => gl.scissor(x, y, width, height),
                Setting::Viewport([x, y, width, height]) => gl.viewport(x, y, width, height),
                Setting::ClipDistance(on) => enable(glow::CLIP_DISTANCE0, on),
                Setting::OffsetFill(on) => enable(glow::POLYGON_OFFSET_FILL, on),
                Setting::Offset(GlOffset { factor, units, .. }) => gl.polygon_offset(factor, units),
                Setting::ClearColor([r, g, b, a]) => gl.clear_color(r, g, b, a),
                Setting::ClearDepth(depth) => gl.clear_depth(depth),
                Setting::ClearStencil(value) => gl.clear_stencil(value),
                Setting::Program(_)
                | Setting::Color(..)
                | Setting::Period(..)
                | Setting::Origin(..)
                | Setting::Level(..)
                | Setting::Layer(..)
                | Setting::Reference(..)
                | Setting::Unit(..)
                | Setting::Axes(..)
                | Setting::Cut(..) => self.set_uniform(setting),
                _ => self.set_sampling(setting),
            }
        }
    }
}
