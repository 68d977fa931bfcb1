//! Settings given to GL: state, the program that is used, and uniforms.

use glow::HasContext;

use super::super::{GlFace, GlFactor, GlOffset, GlStencilOp};
use super::{Faces, Player, Setting};

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

impl Player<'_> {
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn set_uniform(&mut self, setting: Setting) {
        let (program, name) = match setting {
            Setting::Color(program, _) => (program, "color"),
            Setting::Period(program, _) => (program, "period"),
            Setting::Origin(program, _) => (program, "origin"),
            Setting::Level(program, _) => (program, "level"),
            Setting::Layer(program, _) => (program, "layer"),
            Setting::Reference(program, _) => (program, "reference"),
            Setting::Unit(program, _) => (program, "map"),
            Setting::Axes(program, _) => (program, "axes"),
            Setting::Cut(program, _) => (program, "cut"),
            Setting::Program(program) => (program, ""),
            _ => return,
        };
        let gl = self.gl;
        let name_of = self.programs[program as usize].name;
        // SAFETY: as the caller promises; the location is of the program that is used.
        unsafe {
            gl.use_program(Some(name_of));
            let location = if name.is_empty() { None } else { gl.get_uniform_location(name_of, name) };
            let at = location.as_ref();
            match setting {
                Setting::Color(_, [r, g, b, a]) => gl.uniform_4_f32(at, r, g, b, a),
                Setting::Period(_, [x, y]) | Setting::Origin(_, [x, y]) => gl.uniform_2_i32(at, x, y),
                Setting::Level(_, value) | Setting::Layer(_, value) | Setting::Unit(_, value) => {
                    gl.uniform_1_i32(at, value);
                }
                Setting::Reference(_, value) => gl.uniform_1_f32(at, value),
                Setting::Cut(_, [x, y]) => gl.uniform_2_f32(at, x, y),
                Setting::Axes(_, axes) => gl.uniform_3_f32_slice(at, axes.as_flattened()),
                _ => {}
            }
        }
    }
}
