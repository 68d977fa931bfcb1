//! Settings, applied to the model's state.

use crate::conformance::bench::commands::Setting;

use super::state::State;

impl State {
    pub fn set(&mut self, setting: Setting) {
        match setting {
            Setting::DepthTest(on) => self.depth_test = on,
            Setting::DepthFunc(compare) => self.depth_func = compare,
            Setting::DepthMask(on) => self.depth_mask = on,
            // Both numbers are clamped [GL 4.6, 13.8.1].
            Setting::DepthRange(range, short) => {
                let given = if short { range.map(|end| f64::from(end as f32)) } else { range };
                self.depth_range = given.map(|end| end.clamp(0.0, 1.0));
            }
            Setting::DepthClamp(on) => self.depth_clamp = on,
            Setting::CullFace(on) => self.cull = on,
            Setting::Culled(face) => self.culled = face,
            Setting::Clockwise(on) => self.clockwise = on,
            Setting::StencilTest(on) => self.stencil_test = on,
            Setting::StencilFunc(faces, compare, reference, mask) => {
                for (side, _) in self.stencil.iter_mut().zip(faces.sides()).filter(|(_, meant)| *meant) {
                    (side.compare, side.reference, side.read_mask) = (compare, reference, mask);
                }
            }
            Setting::StencilOp(faces, ops) => {
                let sides = self.stencil.iter_mut().zip(faces.sides());
                sides.filter(|(_, meant)| *meant).for_each(|(side, _)| side.ops = ops);
            }
            Setting::StencilMask(faces, mask) => {
                let sides = self.stencil.iter_mut().zip(faces.sides());
                sides.filter(|(_, meant)| *meant).for_each(|(side, _)| side.write_mask = mask);
            }
            Setting::Blend(on) => self.blend.fill(on),
            Setting::BlendOf(output, on) => self.blend[output as usize] = on,
            Setting::BlendFunc(factors) => self.factors = factors,
            Setting::BlendEquation(equations) => self.equations = equations,
            Setting::ColorMask(mask) => self.masks.fill(mask),
            Setting::ColorMaskOf(output, mask) => self.masks[output as usize] = mask,
            Setting::ScissorTest(on) => self.scissor_test = on,
            Setting::Scissor(area) => self.scissor = area,
            Setting::Viewport(area) => self.viewport = area,
            Setting::ClipDistance(on) => self.clip_distance = on,
            Setting::OffsetFill(on) => self.offset_fill = on,
            Setting::Offset(offset) => self.offset = offset,
            Setting::ClearColor(color) => self.clear_color = color,
            Setting::ClearDepth(depth) => self.clear_depth = depth.clamp(0.0, 1.0),
            Setting::ClearStencil(value) => self.clear_stencil = value,
            Setting::Program(program) => self.program = program,
            Setting::Color(program, _)
            | Setting::Period(program, _)
            | Setting::Origin(program, _)
            | Setting::Level(program, _)
            | Setting::Layer(program, _)
            | Setting::Reference(program, _)
            | Setting::Unit(program, _)
            | Setting::Axes(program, _)
            | Setting::Cut(program, _) => {
                self.program = program;
                // A name that the program does not have is ignored [GL 4.6, 7.6.1].
                if program.has(&setting) {
                    self.set_uniform(setting);
                }
            }
            Setting::Texture(unit, slot) => {
                self.active = unit as usize;
                self.bind_texture(slot);
            }
            Setting::Sampler(unit, slot) => self.units[unit as usize].sampler = slot,
            Setting::Filters(object, min, mag, mipmap) => {
                if let Some(sampler) = self.sampler_mut(object) {
                    (sampler.linear, sampler.mipmap) = ([min, mag], mipmap);
                }
            }
            Setting::Wrap(object, wrap) => {
                if let Some(sampler) = self.sampler_mut(object) {
                    sampler.wrap = wrap;
                }
            }
            Setting::Border(object, color) => {
                if let Some(sampler) = self.sampler_mut(object) {
                    sampler.border = color;
                }
            }
            Setting::Compare(object, compare) => {
                if let Some(sampler) = self.sampler_mut(object) {
                    sampler.compare = compare;
                }
            }
            Setting::LodRange(object, range) => {
                if let Some(sampler) = self.sampler_mut(object) {
                    sampler.lod = range;
                }
            }
            Setting::Levels(slot, range) => {
                self.bind_texture(slot);
                if let Some(image) = &mut self.textures[slot] {
                    image.range = range;
                }
            }
            Setting::Swizzle(slot, swizzle) => {
                self.bind_texture(slot);
                if let Some(image) = &mut self.textures[slot] {
                    image.swizzle = swizzle;
                }
            }
        }
    }

    fn set_uniform(&mut self, setting: Setting) {
        match setting {
            Setting::Color(program, value) => self.uniforms[program as usize].color = value,
            Setting::Period(program, value) => self.uniforms[program as usize].period = value,
            Setting::Origin(program, value) => self.uniforms[program as usize].origin = value,
            Setting::Level(program, value) => self.uniforms[program as usize].level = value,
            Setting::Layer(program, value) => self.uniforms[program as usize].layer = value,
            Setting::Reference(program, value) => self.uniforms[program as usize].reference = value,
            Setting::Unit(program, value) => self.uniforms[program as usize].unit = value,
            Setting::Axes(program, value) => self.uniforms[program as usize].axes = value,
            Setting::Cut(program, value) => self.uniforms[program as usize].cut = value,
            _ => {}
        }
    }
}
