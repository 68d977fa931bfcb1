//! Sampling state of the player's textures and sampler objects, one parameter or two at a time.

use glow::HasContext;

use super::super::{GlCompare, GlMipmap, GlSwizzle, GlWrap};
use super::{Player, Sampled, Setting};

impl Player<'_> {
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn set_sampling(&mut self, setting: Setting) {
        let gl = self.gl;
        // SAFETY: as the caller promises; only state is set.
        unsafe {
            match setting {
                Setting::Texture(unit, slot) => {
                    gl.active_texture(glow::TEXTURE0 + unit);
                    self.bind_texture(slot);
                }
                Setting::Sampler(unit, slot) => gl.bind_sampler(unit, slot.map(|slot| self.samplers[slot])),
                Setting::Filters(object, min, mag, mipmap) => {
                    let filter = |linear| if linear { glow::LINEAR } else { glow::NEAREST };
                    let least = match (mipmap, min) {
                        (GlMipmap::Off, linear) => filter(linear),
                        (GlMipmap::Nearest, false) => glow::NEAREST_MIPMAP_NEAREST,
                        (GlMipmap::Nearest, true) => glow::LINEAR_MIPMAP_NEAREST,
                        (GlMipmap::Linear, false) => glow::NEAREST_MIPMAP_LINEAR,
                        (GlMipmap::Linear, true) => glow::LINEAR_MIPMAP_LINEAR,
                    };
                    self.parameter(object, glow::TEXTURE_MIN_FILTER, least);
                    self.parameter(object, glow::TEXTURE_MAG_FILTER, filter(mag));
                }
                Setting::Wrap(object, [s, t]) => {
                    self.parameter(object, glow::TEXTURE_WRAP_S, GlWrap::code(s));
                    self.parameter(object, glow::TEXTURE_WRAP_T, GlWrap::code(t));
                }
                Setting::Border(object, color) => match object {
                    Sampled::Texture(slot) => {
                        let target = self.bind_texture(slot);
                        gl.tex_parameter_f32_slice(target, glow::TEXTURE_BORDER_COLOR, &color);
                    }
                    Sampled::Sampler(slot) => {
                        gl.sampler_parameter_f32_slice(self.samplers[slot], glow::TEXTURE_BORDER_COLOR, &color);
                    }
                },
                Setting::Compare(object, compare) => {
                    if let Some(compare) = compare {
                        self.parameter(object, glow::TEXTURE_COMPARE_FUNC, GlCompare::code(compare));
                    }
                    let mode = if compare.is_some() { glow::COMPARE_REF_TO_TEXTURE } else { glow::NONE };
                    self.parameter(object, glow::TEXTURE_COMPARE_MODE, mode);
                }
                Setting::LodRange(object, range) => {
                    for (name, value) in [glow::TEXTURE_MIN_LOD, glow::TEXTURE_MAX_LOD].into_iter().zip(range) {
                        match object {
                            Sampled::Texture(slot) => {
                                let target = self.bind_texture(slot);
                                gl.tex_parameter_f32(target, name, value);
                            }
                            Sampled::Sampler(slot) => gl.sampler_parameter_f32(self.samplers[slot], name, value),
                        }
                    }
                }
                Setting::Levels(slot, [base, most]) => {
                    let target = self.bind_texture(slot);
                    gl.tex_parameter_i32(target, glow::TEXTURE_BASE_LEVEL, base as i32);
                    gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, most as i32);
                }
                Setting::Swizzle(slot, swizzles) => {
                    let target = self.bind_texture(slot);
                    for (name, swizzle) in (glow::TEXTURE_SWIZZLE_R..).zip(swizzles) {
                        gl.tex_parameter_i32(target, name, GlSwizzle::code(swizzle) as i32);
                    }
                }
                _ => {}
            }
        }
    }

    /// # Safety
    ///
    /// The context is current.
    unsafe fn parameter(&mut self, object: Sampled, name: u32, value: u32) {
        // SAFETY: as the caller promises.
        unsafe {
            match object {
                Sampled::Texture(slot) => {
                    let target = self.bind_texture(slot);
                    self.gl.tex_parameter_i32(target, name, value as i32);
                }
                Sampled::Sampler(slot) => self.gl.sampler_parameter_i32(self.samplers[slot], name, value as i32),
            }
        }
    }

    /// Binds the texture of a slot to the unit that is active, and gives its target.
    ///
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn bind_texture(&self, slot: usize) -> u32 {
        let Some((name, desc)) = self.textures[slot] else { return glow::TEXTURE_2D };
        let target = desc.shape.target();
        // SAFETY: as the caller promises; the texture is not deleted.
        unsafe { self.gl.bind_texture(target, Some(name)) };
        target
    }
}
