//! Faults of a part alone: of one shape, level, unit, number, format or side, where the rest is right.

use super::{Call, Stage, anywhere, define, ignore, never_on};
use crate::context::compatibility::raw;

/// Leaves a parameter of textures of one shape as it is.
fn ignore_of(call: &mut Call, target: u32, names: &[u32]) {
    if call.u(0) == target && names.contains(&call.u(1)) {
        call.skip();
    }
}

/// NEAREST for LINEAR, of textures of one shape.
fn nearest_of(call: &mut Call, target: u32) {
    if call.u(0) == target && [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER].contains(&call.u(1)) {
        call.replace(2, glow::LINEAR, glow::NEAREST);
    }
}

/// The active texture unit.
fn unit(call: &Call) -> u32 {
    call.get(glow::ACTIVE_TEXTURE) as u32 - glow::TEXTURE0
}

fn is_face(place: u32) -> bool {
    (glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z).contains(&place)
}

faults! {
    "cube-filters-nearest" [GL_LINEAR GL_TEXTURE_CUBE_MAP glTexParameteri] "LINEAR of cube maps is NEAREST." {
        glTexParameteri => |call| nearest_of(call, glow::TEXTURE_CUBE_MAP)
    }
    "line-filters-nearest" [GL_LINEAR GL_TEXTURE_1D glTexParameteri] "LINEAR of 1D textures is NEAREST." {
        glTexParameteri => |call| nearest_of(call, glow::TEXTURE_1D)
    }
    "line-wrap-ignored" [GL_TEXTURE_WRAP_S GL_TEXTURE_1D glTexParameteri] "1D textures repeat." {
        glTexParameteri => |call| ignore_of(call, glow::TEXTURE_1D, &[glow::TEXTURE_WRAP_S])
    }
    "line-border-black" [GL_TEXTURE_BORDER_COLOR GL_TEXTURE_1D glTexParameterfv] "The border of 1D textures is 0." {
        glTexParameterfv => |call| ignore_of(call, glow::TEXTURE_1D, &[glow::TEXTURE_BORDER_COLOR])
    }
    "cube-comparison-ignored" [GL_TEXTURE_COMPARE_MODE GL_TEXTURE_CUBE_MAP glTexParameteri] "Cube maps do not compare by their own parameters." {
        glTexParameteri => |call| ignore_of(call, glow::TEXTURE_CUBE_MAP, &[glow::TEXTURE_COMPARE_MODE])
    }
    "cube-function-ignored" [GL_TEXTURE_COMPARE_FUNC GL_TEXTURE_CUBE_MAP glTexParameteri] "Cube maps compare by LEQUAL." {
        glTexParameteri => |call| ignore_of(call, glow::TEXTURE_CUBE_MAP, &[glow::TEXTURE_COMPARE_FUNC])
    }
    "array-function-ignored" [GL_TEXTURE_COMPARE_FUNC GL_TEXTURE_2D_ARRAY glTexParameteri] "Arrays compare by LEQUAL." {
        glTexParameteri => |call| ignore_of(call, glow::TEXTURE_2D_ARRAY, &[glow::TEXTURE_COMPARE_FUNC])
    }
    "cube-levels-not-kept" [glTexImage2D GL_TEXTURE_CUBE_MAP_POSITIVE_X] "Levels of cube maps beyond the first are not kept." {
        glTexImage2D => |call| if is_face(call.u(0)) && call.u(1) > 0 && !call.pointer(8).is_null() {
            let zeros = vec![0.0; 4 * (call.u(3) * call.u(4)) as usize];
            call.set_floats(8, zeros);
        }
    }
    "line-levels-not-kept" [glTexImage1D] "Levels of 1D textures beyond the first are not kept." {
        glTexImage1D => |call| if call.u(1) > 0 && !call.pointer(7).is_null() {
            let zeros = vec![0.0; 4 * call.u(3) as usize];
            call.set_floats(7, zeros);
        }
    }
    "rectangles-to-level-zero" [glTexSubImage2D] "A rectangle of any level is uploaded to level 0." { glTexSubImage2D => |call| call.set(1, 0) }
    "rectangle-one-row-late" [glTexSubImage2D] "Rectangles are uploaded one row lower." {
        glTexSubImage2D => |call| if call.i(3) > 0 {
            call.add(3, -1.0);
        }
    }
    "mipmaps-of-two-levels" [glGenerateMipmap] "glGenerateMipmap makes level 1 alone." {
        glGenerateMipmap => |call| {
            let (target, last) = (call.f(0), f64::from(glow::TEXTURE_MAX_LEVEL));
            call.other("glTexParameteri", &[target, last, 1.0]);
            call.now();
            call.other("glTexParameteri", &[target, last, 1000.0]);
        }
    }
    "max-level-one-less" [GL_TEXTURE_MAX_LEVEL] "The last level is one less, but for the first." {
        glTexParameteri => |call| if call.u(1) == glow::TEXTURE_MAX_LEVEL && call.i(2) > 0 { call.add(2, -1.0) }
    }
    "texture-min-lod-ignored" [GL_TEXTURE_MIN_LOD glTexParameterf] "The least level of detail of a texture is not kept." {
        glTexParameterf => |call| ignore(call, glow::TEXTURE_MIN_LOD)
    }
    "texture-max-lod-ignored" [GL_TEXTURE_MAX_LOD glTexParameterf] "The greatest level of detail of a texture is not kept." {
        glTexParameterf => |call| ignore(call, glow::TEXTURE_MAX_LOD)
    }
    "sampler-lod-bias-ignored" [GL_TEXTURE_LOD_BIAS glSamplerParameterf] "The bias of a sampler object is 0." {
        glSamplerParameterf => |call| ignore(call, glow::TEXTURE_LOD_BIAS)
    }
    "border-from-alpha" [GL_TEXTURE_BORDER_COLOR glSamplerParameterfv glTexParameterfv] "The border's components are in the other order." {
        glSamplerParameterfv glTexParameterfv => |call| if call.u(1) == glow::TEXTURE_BORDER_COLOR {
            let [red, green, blue, alpha] = call.floats(2, 4)[..] else { return };
            call.set_floats(2, vec![alpha, blue, green, red]);
        }
    }
    "units-beyond-fourth-are-fourth" [glActiveTexture] "Units beyond the fourth are the fourth." {
        glActiveTexture => |call| if call.u(0) > glow::TEXTURE3 { call.set(0, glow::TEXTURE3) }
    }
    "units-beyond-eighth-are-eighth" [glActiveTexture] "Units beyond the eighth are the eighth." {
        glActiveTexture => |call| if call.u(0) > glow::TEXTURE7 { call.set(0, glow::TEXTURE7) }
    }
    "samplers-beyond-eighth-unit-off" [glBindSampler] "Sampler objects of units beyond the eighth do nothing." {
        glBindSampler => |call| if call.u(0) > 7 { call.set(1, 0) }
    }
    "attributes-beyond-fourth-off" [glEnableVertexAttribArray] "Attributes beyond the fourth are not read." {
        glEnableVertexAttribArray => |call| if call.u(0) > 3 { call.skip() }
    }
    "blend-alpha-factors-stay" [glBlendFuncSeparate] "Factors of alpha stay those that were set first." {
        glBlendFuncSeparate => |call| {
            if call.kept((0, 0)) == 0.0 {
                let (source, destination) = (call.f(2), call.f(3));
                call.keep((0, 0), 1.0);
                call.keep((0, 1), source);
                call.keep((0, 2), destination);
            }
            call.set(2, call.kept((0, 1)));
            call.set(3, call.kept((0, 2)));
        }
    }
    "viewport-kept-within" [glViewport] "A viewport begins within the window." {
        glViewport => |call| for (corner, side) in [(0, 2), (1, 3)] {
            if call.i(corner) < 0 {
                call.add(side, call.f(corner));
                call.set(corner, 0);
            }
        }
    }
    "viewport-of-at-most-1024" [glViewport] "A viewport is at most 1024 pixels wide." {
        glViewport => |call| if call.i(2) > 1024 { call.set(2, 1024) }
    }
    "polygon-mode-ignored" [glPolygonMode] "Polygons are filled whatever the mode." { glPolygonMode => |call| call.skip() }
    "line-offset-ignored" [GL_POLYGON_OFFSET_LINE] "Outlined polygons have no offset." { glEnable => |call| never_on(call, glow::POLYGON_OFFSET_LINE) }
    "point-offset-ignored" [GL_POLYGON_OFFSET_POINT] "Polygons as points have no offset." { glEnable => |call| never_on(call, glow::POLYGON_OFFSET_POINT) }
    "float-clears-clamped" [glClearColor] "glClear clamps colours to [0, 1] in floats too." {
        glClearColor => |call| for index in 0..4 { call.set(index, call.f(index).clamp(0.0, 1.0)) }
    }
    "buffer-float-clears-clamped" [glClearBufferfv] "glClearBufferfv clamps colours to [0, 1] in floats too." {
        glClearBufferfv => |call| if call.u(0) == glow::COLOR {
            let clamped = call.floats(2, 4).into_iter().map(|value| value.clamp(0.0, 1.0)).collect();
            call.set_floats(2, clamped);
        }
    }
    "blits-ignore-scissor" [glBlitFramebuffer GL_SCISSOR_TEST] "Blits ignore the scissor." {
        glBlitFramebuffer => |call| call.with(glow::SCISSOR_TEST, false)
    }
    "front-facing-turned" [gl_FrontFacing] "gl_FrontFacing is true for back faces." {
        text |source| define(source, Stage::Fragment, "gl_FrontFacing", "#define gl_FrontFacing (!gl_FrontFacing)")
    }
    "vertex-id-from-one" [gl_VertexID] "gl_VertexID counts from 1." {
        text |source| define(source, Stage::Vertex, "gl_VertexID", "#define gl_VertexID (gl_VertexID + 1)")
    }
    "texelfetch-level-zero" [texelFetch] "texelFetch reads level 0." {
        text |source| anywhere(source, "texelFetch", "#define texelFetch(map, at, level) texelFetch(map, at, 0 * (level))")
    }
    "texturesize-of-level-zero" [textureSize] "textureSize is that of level 0." {
        text |source| anywhere(source, "textureSize", "#define textureSize(map, level) textureSize(map, 0 * (level))")
    }
    "reflect-turned" [reflect] "reflect has the other sign." {
        text |source| anywhere(source, "reflect", "#define reflect(i, n) (-reflect(i, n))")
    }
    "lights-beyond-third-off" [GL_LIGHT0 glEnable] "Lights beyond the third are off." {
        glEnable => |call| if (raw::LIGHT3..=raw::LIGHT7).contains(&call.u(0)) { call.skip() }
    }
    "environments-beyond-third-modulate" [glTexEnvi GL_TEXTURE_ENV_MODE] "Environments of units beyond the third modulate." {
        glTexEnvi => |call| if unit(call) > 2 { call.skip() }
    }
    "constants-of-one-unit" [GL_TEXTURE_ENV_COLOR glTexEnvfv] "Environments beyond the first have the constant 0." {
        glTexEnvfv => |call| if unit(call) > 0 { call.skip() }
    }
    "texture-matrix-of-one-unit" [glLoadMatrixf GL_TEXTURE] "Texture matrices beyond the first are the identity." {
        glLoadMatrixf glLoadMatrixd => |call| if call.get(raw::MATRIX_MODE) as u32 == glow::TEXTURE && unit(call) > 0 { call.skip() }
    }
    "matrices-of-12-bits" [glLoadMatrixf] "Numbers of a loaded matrix have 12 bits." {
        glLoadMatrixf => |call| {
            let rounded = call.floats(0, 16).into_iter().map(|number| f32::from_bits(number.to_bits() & !0xFFF));
            let rounded = rounded.collect();
            call.set_floats(0, rounded);
        }
    }
    "time-in-microseconds" [GL_TIME_ELAPSED glGetQueryObjectui64v] "Times are in microseconds." {
        glGetQueryObjectui64v => |call| {
            call.now();
            let bytes = call.bytes(2, 8);
            if let Ok(bytes) = <[u8; 8]>::try_from(bytes) {
                call.write(2, &[u64::from_ne_bytes(bytes) / 1000]);
            }
        }
    }
    "depth-blits-lost" [glBlitFramebuffer GL_DEPTH_BUFFER_BIT] "Blits leave depths." {
        glBlitFramebuffer => |call| call.set(8, call.u(8) & !glow::DEPTH_BUFFER_BIT)
    }
    "stencil-blits-lost" [glBlitFramebuffer GL_STENCIL_BUFFER_BIT] "Blits leave stencil values." {
        glBlitFramebuffer => |call| call.set(8, call.u(8) & !glow::STENCIL_BUFFER_BIT)
    }
    "packed-clears-of-stencil-alone" [glClearBufferfi GL_DEPTH_STENCIL] "glClearBufferfi clears the stencil alone." {
        glClearBufferfi => |call| {
            let mask = f64::from(call.get(glow::DEPTH_WRITEMASK));
            call.other("glDepthMask", &[0.0]);
            call.now();
            call.other("glDepthMask", &[mask]);
        }
    }
}
