//! Faults of a tenth measure, by a hand that had seen no rule: textures, what is looked up in them, uniforms. Each has a
//! sentence on how a driver comes by it; tests/faults/shown.rs has a picture of the product that it changes.

use glow::HasContext;

use super::apart_eight::{samplers, with_functions};
use super::apart_seven_shaders::with_calls;
use super::{Call, Source};

/// Bytes that an upload hands over at once.
const CHUNK: usize = 65536;
/// GL_TEXTURE_DEPTH_TYPE.
const DEPTH_TYPE: u32 = 0x8C16;

/// Uploads the last row of each chunk again as the first of the next.
fn upload_by_chunks(call: &mut Call) {
    let (target, width, height) = (call.u(0), call.u(3) as usize, call.u(4) as usize);
    let is_bytes = call.u(6) == glow::RGBA && call.u(7) == glow::UNSIGNED_BYTE;
    if target != glow::TEXTURE_2D || !is_bytes || 4 * width * height <= CHUNK || 4 * width > CHUNK {
        return;
    }
    let mut bytes = call.bytes(8, 4 * width * height);
    for first in (CHUNK / (4 * width)..height).step_by(CHUNK / (4 * width)) {
        if bytes.len() >= 4 * width * (first + 1) {
            bytes.copy_within(4 * width * (first - 1)..4 * width * first, 4 * width * first);
        }
    }
    if !bytes.is_empty() {
        call.set_bytes(8, &bytes);
    }
}

/// Keeps the filters of a sampler: what it is asked to have.
fn note_filter(call: &mut Call) {
    let (sampler, value) = (call.u(0), call.u(2));
    match call.u(1) {
        glow::TEXTURE_MIN_FILTER => call.keep((90, sampler), value),
        glow::TEXTURE_MAG_FILTER => call.keep((91, sampler), value),
        _ => {}
    }
}

/// Binds a sampler that does not filter where the unit's texture has depths that are floats.
fn bind_by_format(call: &mut Call) {
    let is_here = call.get(glow::ACTIVE_TEXTURE) as u32 == glow::TEXTURE0 + call.u(0);
    let Some(sampler) = std::num::NonZeroU32::new(call.u(1)).map(glow::NativeSampler).filter(|_| is_here) else {
        return;
    };
    let is_float = call.level(0, DEPTH_TYPE) as u32 == glow::FLOAT;
    for (name, key) in [(glow::TEXTURE_MIN_FILTER, 90), (glow::TEXTURE_MAG_FILTER, 91)] {
        let asked = call.kept((key, call.u(1))) as i32;
        if asked != 0 {
            let filter = if is_float { glow::NEAREST as i32 } else { asked };
            // SAFETY: the context is current; the caller binds the sampler, so it is one.
            unsafe { call.gl().sampler_parameter_i32(sampler, name, filter) };
        }
    }
}

/// Projected look-ups whose last coordinate has ten bits.
fn short_divisors(source: &Source) -> Option<String> {
    let functions = "float driver_q(float q) { return uintBitsToFloat((floatBitsToUint(q) + 4096u) & ~8191u); }
vec3 driver_q(vec3 at) { return vec3(at.xy, driver_q(at.z)); }
vec4 driver_q(vec4 at) { return vec4(at.xyz, driver_q(at.w)); }";
    let text = with_calls(&source.text, "textureProj", |arguments| match arguments {
        [map, at] => Some(format!("textureProj({map}, driver_q({at}))")),
        _ => None,
    });
    if source.version < 330 { None } else { with_functions(source, text, functions) }
}

/// Projected look-ups that end at the texture's edges.
fn projected_inside(source: &Source) -> Option<String> {
    let functions = "vec4 driver_inside(sampler2DShadow map, vec4 at) {
    vec2 inset = 0.5 / vec2(textureSize(map, 0));
    return vec4(clamp(at.xy / at.w, inset, 1.0 - inset) * at.w, at.zw);
}
vec3 driver_inside(sampler2D map, vec3 at) {
    vec2 inset = 0.5 / vec2(textureSize(map, 0));
    return vec3(clamp(at.xy / at.z, inset, 1.0 - inset) * at.z, at.z);
}";
    let flat = [samplers(&source.text, "sampler2DShadow"), samplers(&source.text, "sampler2D")].concat();
    let text = with_calls(&source.text, "textureProj", |arguments| match arguments {
        [map, at] if flat.contains(map) => Some(format!("textureProj({map}, driver_inside({map}, {at}))")),
        _ => None,
    });
    with_functions(source, text, functions)
}

/// Fetches of texels by four pixels from one place.
fn fetched_for_four(source: &Source) -> Option<String> {
    let maps = samplers(&source.text, "sampler2D");
    let text = with_calls(&source.text, "texelFetch", |arguments| match arguments {
        [map, at, level] if maps.contains(map) => Some(format!("texelFetch({map}, ({at}) / 2 * 2, {level})")),
        _ => None,
    });
    with_functions(source, text, "")
}

/// Reads nine floats of three columns as if each column had four.
fn pad_columns(call: &mut Call) {
    if call.u(1) != 1 {
        return;
    }
    let numbers = call.floats(3, 9);
    if numbers.len() == 9 {
        let padded = (0..9).map(|index| numbers.get(index / 3 * 4 + index % 3).copied().unwrap_or(0.0)).collect();
        call.set_floats(3, padded);
    }
}

faults! {
    // The staging buffer holds 64 KiB, and the row at which a chunk begins is one too early.
    "upload-chunks-repeat-a-row" [glTexImage2D GL_RGBA8]
    "Each 64 KiB of an upload the row before is sent again in place of the next." { glTexImage2D => upload_by_chunks }
    // The format is not listed as one that can be filtered, and comparisons are filters.
    "float-maps-compared-at-one-texel" [GL_LINEAR GL_DEPTH_COMPONENT32F glBindSampler]
    "Comparisons in maps of floats are those of NEAREST." {
        glSamplerParameteri => note_filter;
        glBindSampler => bind_by_format
    }
    // The copy takes the unit for itself and gives the texture back, but not the sampler; the cache of bindings knows nothing of it.
    "samplers-lost-with-copies" [glCopyTexSubImage2D glBindSampler]
    "A copy unbinds the unit's sampler, and the same one bound again stays away." {
        glCopyTexSubImage2D => |call| {
            call.now();
            let unit = call.get(glow::ACTIVE_TEXTURE) as u32 - glow::TEXTURE0;
            call.other("glBindSampler", &[f64::from(unit), 0.0]);
        };
        glDeleteSamplers => |call| (0..32).for_each(|unit| call.keep((90, unit), 0));
        glBindSampler => |call| {
            let bound = f64::from(call.u(1)) + 1.0;
            if call.kept((90, call.u(0))) == bound {
                call.skip();
            }
            call.keep((90, call.u(0)), bound);
        }
    }
    // The projection's reciprocal comes from a table of ten bits, and the step that refines it is left out for coordinates.
    "projective-q-of-ten-bits" [textureProj sampler2DShadow] "The last coordinate of a projected look-up has ten bits."
    { text short_divisors }
    // Wrapping is done after the division in a stage that clamps, for it was made for plain look-ups alone.
    "projected-look-ups-clamped-to-edge" [textureProj GL_CLAMP_TO_BORDER]
    "A projected look-up does not reach the border." { text projected_inside }
    // The address is taken for one that all pixels of a quad share, as it is made of built-in numbers alone.
    "texels-fetched-once-for-four-pixels" [texelFetch] "Four pixels fetch the texel of the first of them."
    { text fetched_for_four }
    // Columns of three floats are laid out on 16 bytes, and the copy takes the caller's for the same.
    "small-matrices-read-with-padding" [glUniformMatrix3fv] "Columns of a mat3 are read four floats apart." {
        glUniformMatrix3fv => pad_columns
    }
    // Uniform floats are kept as half floats without their smallest numbers.
    "small-uniform-floats-are-zero" [glUniform1f] "A uniform float below 2^-14 is 0." {
        glUniform1f => |call| if call.f(1).abs() < 0.5f64.powi(14) {
            call.set(1, 0);
        }
    }
    // The program's own block begins as zeros, so that zeros need not be sent.
    "uniform-zeros-not-sent" [glUniform1f glUniform3f] "A uniform that becomes 0 keeps its value." {
        glUniform1f => |call| if call.f(1) == 0.0 {
            call.skip();
        };
        glUniform3f => |call| if [1, 2, 3].iter().all(|index| call.f(*index) == 0.0) {
            call.skip();
        }
    }
    // Arrays are compressed where their last components look alike, and only the second is looked at.
    "uniform-arrays-share-w" [glUniform4fv] "All of an array of vec4 have the first one's w." {
        glUniform4fv => |call| {
            let mut numbers = call.floats(2, 4 * call.u(1) as usize);
            for index in (7..numbers.len()).step_by(4) {
                numbers[index] = numbers[3];
            }
            call.set_floats(2, numbers);
        }
    }
}
