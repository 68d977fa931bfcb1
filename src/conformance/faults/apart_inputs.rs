//! Faults that were written before any rule had met them: textures, samplers, uniforms, vertex arrays, the fixed-function
//! pipeline.

use std::num::NonZeroU32;

use glow::HasContext;

use super::Call;
use crate::context::compatibility::raw;

/// Texture units that are looked at.
const UNITS: u32 = 8;

/// A unit's 1D or 2D texture, and its sampler object.
struct Unit {
    /// 0 without one.
    texture: u32,
    sampler: Option<glow::NativeSampler>,
    /// Internal format of the texture; 0 without one.
    format: u32,
}

/// Textures that are bound for `target`, and samplers, unit by unit.
fn units(call: &Call, target: u32) -> Vec<Unit> {
    let active = call.get(glow::ACTIVE_TEXTURE);
    let name = if target == glow::TEXTURE_1D { glow::TEXTURE_BINDING_1D } else { glow::TEXTURE_BINDING_2D };
    let found = (0..UNITS)
        .map(|unit| {
            call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
            let texture = call.get(name) as u32;
            // SAFETY: the context is current; a texture is bound.
            let format = unsafe {
                match texture {
                    0 => 0,
                    _ => call.gl().get_tex_level_parameter_i32(target, 0, glow::TEXTURE_INTERNAL_FORMAT) as u32,
                }
            };
            let sampler = NonZeroU32::new(call.get(glow::SAMPLER_BINDING) as u32).map(glow::NativeSampler);
            Unit { texture, sampler, format }
        })
        .collect();
    call.other("glActiveTexture", &[f64::from(active)]);
    found
}

fn parameter(call: &Call, sampler: glow::NativeSampler, name: u32) -> u32 {
    // SAFETY: the context is current, and the sampler is bound.
    unsafe { call.gl().get_sampler_parameter_i32(sampler, name) as u32 }
}

fn set_parameter(call: &Call, sampler: glow::NativeSampler, name: u32, value: u32) {
    // SAFETY: as above.
    unsafe { call.gl().sampler_parameter_i32(sampler, name, value as i32) };
}

fn set_border(call: &Call, sampler: glow::NativeSampler, border: &[f32]) {
    // SAFETY: as above; a border has four numbers.
    unsafe { call.gl().sampler_parameter_f32_slice(sampler, glow::TEXTURE_BORDER_COLOR, border) };
}

/// A filter without LINEAR.
fn unfiltered(filter: u32) -> u32 {
    match filter {
        glow::LINEAR => glow::NEAREST,
        glow::LINEAR_MIPMAP_LINEAR => glow::NEAREST_MIPMAP_LINEAR,
        glow::LINEAR_MIPMAP_NEAREST => glow::NEAREST_MIPMAP_NEAREST,
        other => other,
    }
}

/// Draws with the filters of sampler objects as `NEAREST` where they look at floats.
fn without_filter(call: &mut Call) {
    let mut old = Vec::new();
    for unit in [glow::TEXTURE_1D, glow::TEXTURE_2D].into_iter().flat_map(|target| units(call, target)) {
        let (Some(sampler), glow::R32F | glow::RGBA32F) = (unit.sampler, unit.format) else { continue };
        for name in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            let filter = parameter(call, sampler, name);
            old.push((sampler, name, filter));
            set_parameter(call, sampler, name, unfiltered(filter));
        }
    }
    call.now();
    for (sampler, name, filter) in old.into_iter().rev() {
        set_parameter(call, sampler, name, filter);
    }
}

/// Draws with borders of depths of floats that fail each comparison.
fn with_failing_borders(call: &mut Call) {
    let compared = |unit: &Unit| unit.format == glow::DEPTH_COMPONENT32F;
    let samplers: Vec<_> =
        units(call, glow::TEXTURE_2D).into_iter().filter(compared).filter_map(|unit| unit.sampler).collect();
    for sampler in &samplers {
        if parameter(call, *sampler, glow::TEXTURE_COMPARE_MODE) == glow::COMPARE_REF_TO_TEXTURE {
            let above = matches!(parameter(call, *sampler, glow::TEXTURE_COMPARE_FUNC), glow::GEQUAL | glow::GREATER);
            set_border(call, *sampler, &[if above { 1e9 } else { -1e9 }; 4]);
        }
    }
    call.now();
    for sampler in samplers {
        let key = (0, sampler.0.get());
        let border = call.keep_list(key, Vec::new()).filter(|border| border.len() == 4).unwrap_or(vec![0.0; 4]);
        set_border(call, sampler, &border);
        call.keep_list(key, border);
    }
}

/// Draws with the sampler of the last unit that has a texture on every unit that has it.
fn with_one_sampler_each(call: &mut Call) {
    let units = units(call, glow::TEXTURE_2D);
    let mut old = Vec::new();
    for (index, unit) in (0..).zip(&units) {
        let last = units.iter().rfind(|other| other.texture == unit.texture);
        if let Some(last) = last.filter(|last| unit.texture != 0 && last.sampler != unit.sampler) {
            let number =
                |sampler: Option<glow::NativeSampler>| sampler.map_or(0.0, |sampler| f64::from(sampler.0.get()));
            old.push([f64::from(index), number(unit.sampler)]);
            call.other("glBindSampler", &[f64::from(index), number(last.sampler)]);
        }
    }
    call.now();
    old.iter().for_each(|numbers| call.other("glBindSampler", numbers));
}

faults! {
    "floats-not-filtered" [GL_LINEAR GL_R32F GL_RGBA32F]
    "LINEAR of sampler objects is NEAREST for textures of floats." { draw => without_filter }
    "border-fails-for-floats" [GL_CLAMP_TO_BORDER GL_DEPTH_COMPONENT32F]
    "A comparison with the border of a depth texture of floats always fails." {
        glSamplerParameterfv => |call| if call.u(1) == glow::TEXTURE_BORDER_COLOR {
            let border = call.floats(2, 4);
            call.keep_list((0, call.u(0)), border);
        };
        draw => with_failing_borders
    }
    "one-texture-one-sampler" [glBindSampler glActiveTexture]
    "A texture that is bound on two units is sampled on both by the later one's sampler object." { draw => with_one_sampler_each }
    "levels-by-the-shorter-side" [glGenerateMipmap]
    "glGenerateMipmap leaves the levels black that lie beyond a single row." {
        glGenerateMipmap => |call| {
            call.now();
            let [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(0, name));
            if call.u(0) != glow::TEXTURE_2D || call.level(0, glow::TEXTURE_DEPTH_SIZE) > 0 {
                return;
            }
            for level in (1..).take_while(|level| width.max(height) >> level > 0) {
                if width.min(height) >> level == 0 {
                    let [width, height] = [width, height].map(|side| (side >> level).max(1));
                    call.upload(level, [width, height], &vec![0; 4 * (width * height) as usize]);
                }
            }
        }
    }
    "signed-bytes-by-the-old-rule" [GL_RGBA8_SNORM GL_BYTE]
    "A signed byte c is (2 c + 1) / 255, so that none is 0." {
        glTexImage2D => |call| if call.u(2) == glow::RGBA8_SNORM && call.u(6) == glow::RGBA && call.u(7) == glow::BYTE {
            let bytes = call.bytes(8, 4 * (call.u(3) * call.u(4)) as usize);
            if !bytes.is_empty() {
                call.set_floats(8, bytes.iter().map(|byte| (2.0 * f32::from(*byte as i8) + 1.0) / 255.0).collect());
                call.set(2, glow::RGBA32F);
                call.set(7, glow::FLOAT);
            }
        }
    }
    "uniform-arrays-of-four" [glUniform4fv]
    "Of an array of vec4 the first four are set." { glUniform4fv => |call| if call.i(1) > 4 { call.set(1, 4) } }
    "matrix-compared-by-first-column" [glUniformMatrix4fv]
    "A matrix is not sent where its first column is that of the matrix before." {
        glLinkProgram => |call| call.keep((0, call.u(0)), call.kept((0, call.u(0))) + 1.0);
        glUniformMatrix4fv => |call| {
            let program = call.get(glow::CURRENT_PROGRAM) as u32;
            let key = (program | (call.kept((0, program)) as u32) << 16, call.u(0));
            let values = call.floats(3, 16);
            if let Some(before) = call.keep_list(key, values.clone())
                && before[..4] == values[..4]
            {
                call.keep_list(key, before);
                call.skip();
            }
        }
    }
    "buffers-merged-by-stride" [glVertexAttribPointer glBindBuffer]
    "An attribute with the stride of attribute 0 is read from its buffer, though it has another." {
        glVertexAttribPointer => |call| {
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            let (buffer, first) = (f64::from(call.get(glow::ARRAY_BUFFER_BINDING)), call.kept((0, array)));
            if call.u(0) == 0 {
                call.keep((0, array), buffer);
                call.keep((1, array), call.f(4));
            } else if call.kept((1, array)) == call.f(4) && call.i(4) > 0 && first != 0.0 && first != buffer {
                call.other("glBindBuffer", &[f64::from(glow::ARRAY_BUFFER), first]);
                call.now();
                call.other("glBindBuffer", &[f64::from(glow::ARRAY_BUFFER), buffer]);
            }
        }
    }
    "alpha-test-leaves-depth" [GL_ALPHA_TEST glAlphaFunc]
    "What fails the alpha test writes its depth all the same." {
        glEnable => |call| if call.u(0) == raw::ALPHA_TEST { call.keep((0, 0), 1.0) };
        glDisable => |call| if call.u(0) == raw::ALPHA_TEST { call.keep((0, 0), 0.0) };
        draw => |call| if call.kept((0, 0)) != 0.0 && call.get(glow::DEPTH_WRITEMASK) != 0 {
            call.now();
            let mask = call.get4(glow::COLOR_WRITEMASK).map(f64::from);
            let stencil = call.enabled(glow::STENCIL_TEST);
            call.other("glColorMask", &[0.0; 4]);
            call.other("glDisable", &[f64::from(raw::ALPHA_TEST)]);
            call.other("glDisable", &[f64::from(glow::STENCIL_TEST)]);
            call.again();
            call.other(if stencil { "glEnable" } else { "glDisable" }, &[f64::from(glow::STENCIL_TEST)]);
            call.other("glEnable", &[f64::from(raw::ALPHA_TEST)]);
            call.other("glColorMask", &mask);
        }
    }
    "scale-of-first-unit" [GL_RGB_SCALE glTexEnvf]
    "RGB_SCALE of later units is that of unit 0." {
        glTexEnvf => |call| if call.u(1) == raw::RGB_SCALE {
            if call.get(glow::ACTIVE_TEXTURE) as u32 == glow::TEXTURE0 {
                call.keep((0, 0), call.f(2));
            } else {
                call.set(2, call.kept((0, 0)).max(1.0));
            }
        }
    }
    "interpolates-by-alpha" [GL_INTERPOLATE GL_SRC2_RGB]
    "INTERPOLATE takes the alpha of its third source." {
        glTexEnvi => |call| if call.u(1) == raw::OPERAND0_RGB + 2 { call.skip() }
    }
    "normalize-is-rescale" [GL_NORMALIZE]
    "NORMALIZE divides normals by the scale of the modelview, whatever their length." {
        glEnable glDisable => |call| if call.u(0) == raw::NORMALIZE { call.set(0, raw::RESCALE_NORMAL) }
    }
}
