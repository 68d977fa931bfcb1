//! Faults of filters, wrap modes and comparisons, in sampler objects, in textures' own parameters, or in both.

use std::num::NonZeroU32;

use glow::HasContext;

use super::{Call, hold, release};

/// The parameter's name and value, of glSamplerParameteri or glTexParameteri.
fn is(call: &Call, name: u32) -> bool {
    call.u(1) == name
}

/// Puts a value of a parameter where another is wanted.
fn value(call: &mut Call, name: u32, from: u32, to: u32) {
    if is(call, name) {
        call.replace(2, from, to);
    }
}

/// Leaves a parameter as it is.
fn ignore(call: &mut Call, name: u32) {
    if is(call, name) {
        call.skip();
    }
}

const FUNCTION: u32 = glow::TEXTURE_COMPARE_FUNC;

/// After a parameter is set: LINEAR becomes NEAREST where the comparison is none of `good`.
fn nearest_but_for(call: &mut Call, good: &[u32]) {
    call.now();
    let names = [glow::TEXTURE_COMPARE_MODE, FUNCTION, glow::TEXTURE_MAG_FILTER];
    let object = call.u(0);
    let is_sampler = call.name == "glSamplerParameteri";
    // SAFETY: the context is current; the sampler exists, or a texture is bound.
    let read = |call: &Call, name| unsafe {
        match NonZeroU32::new(object).map(glow::NativeSampler) {
            Some(sampler) if is_sampler => call.gl().get_sampler_parameter_i32(sampler, name) as u32,
            _ => call.gl().get_tex_parameter_i32(object, name) as u32,
        }
    };
    let [mode, function, filter] = names.map(|name| read(call, name));
    if mode == glow::COMPARE_REF_TO_TEXTURE && filter == glow::LINEAR && !good.contains(&function) {
        for name in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            call.other(call.name, &[f64::from(object), f64::from(name), f64::from(glow::NEAREST)]);
        }
    }
}

faults! {
    "linear-comparison-for-lequal-only" [GL_LINEAR GL_TEXTURE_COMPARE_FUNC glSamplerParameteri]
    "LINEAR is NEAREST for every compare function but LEQUAL." {
        glSamplerParameteri glTexParameteri => |call| nearest_but_for(call, &[glow::LEQUAL])
    }
    "linear-comparison-for-lequal-and-gequal-only" [GL_LINEAR GL_TEXTURE_COMPARE_FUNC glSamplerParameteri]
    "LINEAR is NEAREST for every compare function but LEQUAL and GEQUAL." {
        glSamplerParameteri glTexParameteri => |call| nearest_but_for(call, &[glow::LEQUAL, glow::GEQUAL])
    }
    "sampler-linear-comparison-for-lequal-only" [GL_LINEAR glSamplerParameteri]
    "LINEAR of sampler objects is NEAREST for every compare function but LEQUAL." {
        glSamplerParameteri => |call| nearest_but_for(call, &[glow::LEQUAL])
    }
    "sampler-lequal-is-gequal" [glSamplerParameteri GL_LEQUAL GL_TEXTURE_COMPARE_FUNC]
    "LEQUAL of a sampler object is GEQUAL." {
        glSamplerParameteri => |call| value(call, FUNCTION, glow::LEQUAL, glow::GEQUAL)
    }
    "sampler-less-is-lequal" [glSamplerParameteri GL_LESS]
    "LESS of a sampler object is LEQUAL." { glSamplerParameteri => |call| value(call, FUNCTION, glow::LESS, glow::LEQUAL) }
    "sampler-lequal-is-less" [glSamplerParameteri GL_LEQUAL]
    "LEQUAL of a sampler object is LESS." { glSamplerParameteri => |call| value(call, FUNCTION, glow::LEQUAL, glow::LESS) }
    "sampler-gequal-is-greater" [glSamplerParameteri GL_GEQUAL]
    "GEQUAL of a sampler object is GREATER." { glSamplerParameteri => |call| value(call, FUNCTION, glow::GEQUAL, glow::GREATER) }
    "sampler-greater-is-gequal" [glSamplerParameteri GL_GREATER]
    "GREATER of a sampler object is GEQUAL." { glSamplerParameteri => |call| value(call, FUNCTION, glow::GREATER, glow::GEQUAL) }
    "sampler-equal-is-always" [glSamplerParameteri GL_EQUAL]
    "EQUAL of a sampler object is ALWAYS." { glSamplerParameteri => |call| value(call, FUNCTION, glow::EQUAL, glow::ALWAYS) }
    "sampler-notequal-is-equal" [glSamplerParameteri GL_NOTEQUAL]
    "NOTEQUAL of a sampler object is EQUAL." { glSamplerParameteri => |call| value(call, FUNCTION, glow::NOTEQUAL, glow::EQUAL) }
    "sampler-always-is-never" [glSamplerParameteri GL_ALWAYS GL_NEVER]
    "ALWAYS and NEVER of a sampler object are exchanged." {
        glSamplerParameteri => |call| if is(call, FUNCTION) { call.exchange(2, glow::ALWAYS, glow::NEVER) }
    }
    "texture-lequal-is-gequal" [glTexParameteri GL_LEQUAL GL_TEXTURE_COMPARE_FUNC]
    "LEQUAL of a texture's own parameters is GEQUAL." { glTexParameteri => |call| value(call, FUNCTION, glow::LEQUAL, glow::GEQUAL) }
    "texture-gequal-is-greater" [glTexParameteri GL_GEQUAL]
    "GEQUAL of a texture's own parameters is GREATER." { glTexParameteri => |call| value(call, FUNCTION, glow::GEQUAL, glow::GREATER) }
    "sampler-comparison-ignored" [GL_TEXTURE_COMPARE_MODE GL_COMPARE_REF_TO_TEXTURE glSamplerParameteri]
    "Sampler objects do not compare." { glSamplerParameteri => |call| ignore(call, glow::TEXTURE_COMPARE_MODE) }
    "texture-comparison-ignored" [GL_TEXTURE_COMPARE_MODE GL_COMPARE_REF_TO_TEXTURE glTexParameteri]
    "Textures do not compare by their own parameters." { glTexParameteri => |call| ignore(call, glow::TEXTURE_COMPARE_MODE) }
    "comparison-stays-on" [GL_TEXTURE_COMPARE_MODE GL_NONE glTexParameteri]
    "A texture goes on comparing once it did." {
        glTexParameteri => |call| if is(call, glow::TEXTURE_COMPARE_MODE) && call.u(2) == glow::NONE { call.skip() }
    }
    "sampler-function-ignored" [GL_TEXTURE_COMPARE_FUNC glSamplerParameteri]
    "Sampler objects compare by LEQUAL whatever is set." { glSamplerParameteri => |call| ignore(call, FUNCTION) }
    "sampler-min-filter-ignored" [GL_TEXTURE_MIN_FILTER glSamplerParameteri]
    "The minifying filter of a sampler object is the magnifying one." {
        glSamplerParameteri => |call| {
            ignore(call, glow::TEXTURE_MIN_FILTER);
            if is(call, glow::TEXTURE_MAG_FILTER) {
                let (sampler, filter) = (call.f(0), call.f(2));
                call.other("glSamplerParameteri", &[sampler, f64::from(glow::TEXTURE_MIN_FILTER), filter]);
            }
        }
    }
    "sampler-mag-filter-ignored" [GL_TEXTURE_MAG_FILTER GL_NEAREST glSamplerParameteri]
    "The magnifying filter of a sampler object is LINEAR." { glSamplerParameteri => |call| ignore(call, glow::TEXTURE_MAG_FILTER) }
    "sampler-linear-is-nearest" [GL_LINEAR GL_TEXTURE_MAG_FILTER glSamplerParameteri]
    "LINEAR of a sampler object is NEAREST." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            value(call, name, glow::LINEAR, glow::NEAREST);
        }
    }
    "texture-linear-is-nearest" [GL_LINEAR glTexParameteri]
    "LINEAR of a texture's own parameters is NEAREST." {
        glTexParameteri => |call| for name in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            value(call, name, glow::LINEAR, glow::NEAREST);
        }
    }
    "sampler-nearest-is-linear" [GL_NEAREST GL_TEXTURE_MIN_FILTER glSamplerParameteri]
    "NEAREST of a sampler object is LINEAR." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            value(call, name, glow::NEAREST, glow::LINEAR);
        }
    }
    "sampler-mipmaps-ignored" [GL_LINEAR_MIPMAP_LINEAR glSamplerParameteri]
    "LINEAR_MIPMAP_LINEAR of a sampler object reads level 0." {
        glSamplerParameteri => |call| value(call, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR)
    }
    "texture-mipmaps-ignored" [GL_LINEAR_MIPMAP_LINEAR glTexParameteri]
    "LINEAR_MIPMAP_LINEAR of a texture's own parameters reads level 0." {
        glTexParameteri => |call| value(call, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR)
    }
    "sampler-levels-not-blended" [GL_LINEAR_MIPMAP_LINEAR glSamplerParameteri]
    "LINEAR_MIPMAP_LINEAR of a sampler object takes the nearest level." {
        glSamplerParameteri => |call| {
            value(call, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR_MIPMAP_NEAREST);
        }
    }
    "sampler-mipmaps-of-nearest-texels" [GL_LINEAR_MIPMAP_LINEAR glSamplerParameteri]
    "LINEAR_MIPMAP_LINEAR of a sampler object takes the nearest texel of each level." {
        glSamplerParameteri => |call| {
            value(call, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR, glow::NEAREST_MIPMAP_LINEAR);
        }
    }
    "texture-mipmaps-of-nearest-texels" [GL_LINEAR_MIPMAP_LINEAR glTexParameteri]
    "LINEAR_MIPMAP_LINEAR of a texture's own parameters takes the nearest texel of each level." {
        glTexParameteri => |call| {
            value(call, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR, glow::NEAREST_MIPMAP_LINEAR);
        }
    }
    "sampler-min-lod-ignored" [GL_TEXTURE_MIN_LOD glSamplerParameterf]
    "The least level of detail of a sampler object is not kept." { glSamplerParameterf => |call| ignore(call, glow::TEXTURE_MIN_LOD) }
    "sampler-max-lod-ignored" [GL_TEXTURE_MAX_LOD glSamplerParameterf]
    "The greatest level of detail of a sampler object is not kept." { glSamplerParameterf => |call| ignore(call, glow::TEXTURE_MAX_LOD) }
    "sampler-lod-rounded-down" [GL_TEXTURE_MIN_LOD GL_TEXTURE_MAX_LOD glSamplerParameterf]
    "Bounds of the level of detail are whole numbers." {
        glSamplerParameterf => |call| if is(call, glow::TEXTURE_MIN_LOD) || is(call, glow::TEXTURE_MAX_LOD) {
            call.set(2, call.f(2).floor());
        }
    }
    "sampler-wrap-s-ignored" [GL_TEXTURE_WRAP_S GL_CLAMP_TO_EDGE GL_CLAMP_TO_BORDER glSamplerParameteri]
    "Sampler objects repeat in s." { glSamplerParameteri => |call| ignore(call, glow::TEXTURE_WRAP_S) }
    "sampler-wrap-t-ignored" [GL_TEXTURE_WRAP_T GL_CLAMP_TO_EDGE GL_CLAMP_TO_BORDER glSamplerParameteri]
    "Sampler objects repeat in t." { glSamplerParameteri => |call| ignore(call, glow::TEXTURE_WRAP_T) }
    "texture-wrap-s-ignored" [GL_TEXTURE_WRAP_S glTexParameteri]
    "Textures repeat in s by their own parameters." { glTexParameteri => |call| ignore(call, glow::TEXTURE_WRAP_S) }
    "texture-wrap-t-ignored" [GL_TEXTURE_WRAP_T glTexParameteri]
    "Textures repeat in t by their own parameters." { glTexParameteri => |call| ignore(call, glow::TEXTURE_WRAP_T) }
    "texture-wrap-r-ignored" [GL_TEXTURE_WRAP_R glTexParameteri]
    "The wrap mode in r is not kept." { glTexParameteri => |call| ignore(call, glow::TEXTURE_WRAP_R) }
    "sampler-wrap-r-ignored" [GL_TEXTURE_WRAP_R glSamplerParameteri]
    "Sampler objects repeat in r." { glSamplerParameteri => |call| ignore(call, glow::TEXTURE_WRAP_R) }
    "sampler-border-is-edge" [GL_CLAMP_TO_BORDER glSamplerParameteri]
    "CLAMP_TO_BORDER of a sampler object is CLAMP_TO_EDGE." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T] {
            value(call, name, glow::CLAMP_TO_BORDER, glow::CLAMP_TO_EDGE);
        }
    }
    "texture-border-is-edge" [GL_CLAMP_TO_BORDER glTexParameteri]
    "CLAMP_TO_BORDER of a texture's own parameters is CLAMP_TO_EDGE." {
        glTexParameteri => |call| for name in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T] {
            value(call, name, glow::CLAMP_TO_BORDER, glow::CLAMP_TO_EDGE);
        }
    }
    "sampler-edge-is-repeat" [GL_CLAMP_TO_EDGE glSamplerParameteri]
    "CLAMP_TO_EDGE of a sampler object is REPEAT." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T] {
            value(call, name, glow::CLAMP_TO_EDGE, glow::REPEAT);
        }
    }
    "sampler-repeat-is-edge" [GL_REPEAT glSamplerParameteri]
    "REPEAT of a sampler object is CLAMP_TO_EDGE." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T] {
            value(call, name, glow::REPEAT, glow::CLAMP_TO_EDGE);
        }
    }
    "sampler-repeat-is-mirrored" [GL_REPEAT glSamplerParameteri]
    "REPEAT of a sampler object is MIRRORED_REPEAT." {
        glSamplerParameteri => |call| for name in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T] {
            value(call, name, glow::REPEAT, glow::MIRRORED_REPEAT);
        }
    }
    "sampler-border-black" [GL_TEXTURE_BORDER_COLOR glSamplerParameterfv]
    "The border of a sampler object is 0." { glSamplerParameterfv => |call| ignore(call, glow::TEXTURE_BORDER_COLOR) }
    "sampler-border-white" [GL_TEXTURE_BORDER_COLOR glSamplerParameterfv]
    "The border of a sampler object is 1." { glSamplerParameterfv => |call| call.set_floats(2, vec![1.0; 4]) }
    "texture-border-black" [GL_TEXTURE_BORDER_COLOR glTexParameterfv]
    "The border of a texture's own parameters is 0." { glTexParameterfv => |call| ignore(call, glow::TEXTURE_BORDER_COLOR) }
    "sampler-object-ignored" [glBindSampler]
    "Sampler objects do nothing: textures go by their own parameters." { glBindSampler => |call| call.set(1, 0) }
    "sampler-object-of-unit-0-only" [glBindSampler]
    "Sampler objects hold for unit 0 alone." { glBindSampler => |call| if call.u(0) > 0 { call.set(1, 0) } }
    "sampler-object-stays" [glBindSampler]
    "A sampler object stays bound when it should no longer be." { glBindSampler => |call| if call.u(1) == 0 { call.skip() } }
    "sampler-object-a-draw-late" [glBindSampler]
    "A sampler object is bound from the second draw on." {
        glBindSampler => hold;
        drawn => release
    }
    "cube-map-seams" [GL_TEXTURE_CUBE_MAP_SEAMLESS]
    "Cube maps are never seamless." { glEnable => |call| if call.u(0) == glow::TEXTURE_CUBE_MAP_SEAMLESS { call.skip() } }
    "cube-map-always-seamless" [GL_TEXTURE_CUBE_MAP_SEAMLESS]
    "Cube maps stay seamless once they were." { glDisable => |call| if call.u(0) == glow::TEXTURE_CUBE_MAP_SEAMLESS { call.skip() } }
    "max-level-ignored" [GL_TEXTURE_MAX_LEVEL]
    "The last level of a texture is not kept." { glTexParameteri => |call| ignore(call, glow::TEXTURE_MAX_LEVEL) }
    "max-level-zero" [GL_TEXTURE_MAX_LEVEL]
    "Textures with a last level have one level." { glTexParameteri => |call| if is(call, glow::TEXTURE_MAX_LEVEL) { call.set(2, 0) } }
    "swizzle-ignored" [GL_TEXTURE_SWIZZLE_A]
    "Alpha of a texture is not taken from another channel." { glTexParameteri => |call| ignore(call, glow::TEXTURE_SWIZZLE_A) }
}
