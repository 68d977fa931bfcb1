//! Faults of what the renderer does not use of textures and framebuffers, and the rules of `glumbra check` ask all the same:
//! arrays, gathers, rows of the client's memory, biases, layers, samples.

use super::{Value, anywhere};

faults! {
    "base-level-ignored" [GL_TEXTURE_BASE_LEVEL] "BASE_LEVEL is 0." {
        glTexParameteri => |call| if call.u(1) == glow::TEXTURE_BASE_LEVEL {
            call.set(2, 0);
        }
    }
    "lod-bias-ignored" [GL_TEXTURE_LOD_BIAS] "TEXTURE_LOD_BIAS is 0." {
        glTexParameterf glSamplerParameterf => |call| if call.u(1) == glow::TEXTURE_LOD_BIAS {
            call.set(2, 0);
        }
    }
    "mirrored-repeat-is-repeat" [GL_MIRRORED_REPEAT] "MIRRORED_REPEAT is REPEAT." {
        glTexParameteri glSamplerParameteri => |call| {
            call.replace(2, glow::MIRRORED_REPEAT, glow::REPEAT);
        }
    }
    "rectangle-one-texel-late" [glTexSubImage2D] "Rectangles are uploaded one texel to the left." {
        glTexSubImage2D => |call| if call.i(2) > 0 {
            call.set(2, call.i(2) - 1);
        }
    }
    "upload-alignment-ignored" [GL_UNPACK_ALIGNMENT] "UNPACK_ALIGNMENT is 1." {
        glPixelStorei => |call| if call.u(0) == glow::UNPACK_ALIGNMENT {
            call.set(1, 1);
        }
    }
    "row-length-ignored" [GL_UNPACK_ROW_LENGTH] "UNPACK_ROW_LENGTH is 0." {
        glPixelStorei => |call| if call.u(0) == glow::UNPACK_ROW_LENGTH {
            call.set(1, 0);
        }
    }
    "new-copies-one-column-late" [glCopyTexImage2D] "glCopyTexImage2D starts one pixel to the right." {
        glCopyTexImage2D => |call| call.set(3, call.i(3) + 1)
    }
    "copies-to-level-zero" [glCopyTexSubImage2D] "A copy to any level goes to level 0." {
        glCopyTexSubImage2D => |call| call.set(1, 0)
    }
    "layers-attached-by-first" [glFramebufferTextureLayer] "Layer 0 is attached for any layer." {
        glFramebufferTextureLayer => |call| call.set(4, 0)
    }
    "layer-of-geometry-ignored" [gl_Layer] "Geometry shaders draw into layer 0." {
        text |source| source.has("gl_Layer").then(|| source.text.replace("gl_Layer = layer", "gl_Layer = 0"))
    }
    "incomplete-is-complete" [glCheckFramebufferStatus] "Each framebuffer is complete." {
        glCheckFramebufferStatus => |call| {
            call.now();
            call.result = Value::Unsigned(glow::FRAMEBUFFER_COMPLETE);
        }
    }
    "one-sample-for-several" [glRenderbufferStorageMultisample] "Renderbuffers have one sample." {
        glRenderbufferStorageMultisample => |call| call.set(1, 0)
    }
    "depth-bias-ignored" [GL_DEPTH_BIAS glPixelTransferf] "DEPTH_BIAS is 0." {
        glPixelTransferf => |call| if call.u(0) == crate::context::compatibility::raw::DEPTH_BIAS {
            call.set(1, 0);
        }
    }
    "depth-scale-ignored" [GL_DEPTH_SCALE glPixelTransferf] "DEPTH_SCALE is 1." {
        glPixelTransferf => |call| if call.u(0) == crate::context::compatibility::raw::DEPTH_SCALE {
            call.set(1, 1);
        }
    }
    "half-floats-of-8-bits" [GL_RGBA16F] "RGBA16F is RGBA8." {
        glTexImage2D => |call| {
            call.replace(2, glow::RGBA16F, glow::RGBA8);
        }
    }
    "srgb-not-decoded" [GL_SRGB8_ALPHA8] "SRGB8_ALPHA8 is RGBA8." {
        glTexImage2D => |call| {
            call.replace(2, glow::SRGB8_ALPHA8, glow::RGBA8);
        }
    }
    "packed-stencil-not-sampled" [GL_DEPTH_STENCIL_TEXTURE_MODE] "Of packed textures a shader reads depth alone." {
        glTexParameteri => |call| if call.u(1) == glow::DEPTH_STENCIL_TEXTURE_MODE {
            call.skip();
        }
    }
    "swizzle-of-red-ignored" [GL_TEXTURE_SWIZZLE_R] "Red of a texture is not taken from another channel." {
        glTexParameteri => |call| if call.u(1) == glow::TEXTURE_SWIZZLE_R {
            call.skip();
        }
    }
    "arrays-not-bound" [GL_TEXTURE_2D_ARRAY] "Textures of layers are not bound beyond unit 0, nor arrays of cube maps." {
        glBindTexture => |call| if call.u(0) == glow::TEXTURE_2D_ARRAY && call.get(glow::ACTIVE_TEXTURE) as u32 != glow::TEXTURE0
            || call.u(0) == glow::TEXTURE_CUBE_MAP_ARRAY && call.u(1) == 0 {
            call.set(1, 0);
        }
    }
    "array-layer-zero" [GL_SAMPLER_2D_ARRAY_SHADOW] "Comparisons in arrays read layer 0." {
        text |source| if source.has("sampler2DArrayShadow") {
            let lines = "float broken_layers(sampler2DArrayShadow map, vec4 at) { return texture(map, vec4(at.xy, 0.0, at.w)); }
#define texture broken_layers";
            anywhere(source, "sampler2DArrayShadow", lines)
        } else {
            None
        }
    }
    "cube-of-array-zero" [GL_SAMPLER_CUBE_MAP_ARRAY_SHADOW] "Comparisons in arrays of cube maps read the first." {
        text |source| anywhere(source, "samplerCubeArrayShadow",
            "float broken_cubes(samplerCubeArrayShadow map, vec4 at, float z) { return texture(map, vec4(at.xyz, 0.0), z); }
#define texture broken_cubes")
    }
    "gathered-in-another-order" [textureGather] "textureGather starts at the lower left texel." {
        text |source| anywhere(source, "textureGather",
            "vec4 broken_gather(sampler2DShadow map, vec2 at, float z) { return textureGather(map, at, z).wxyz; }
#define textureGather broken_gather")
    }
    "bias-of-shaders-ignored" [texture] "The bias of a look-up is 0." {
        text |source| if source.text.contains("texture(map, passed.xy, 1.5)") {
            Some(source.text.replace("texture(map, passed.xy, 1.5)", "texture(map, passed.xy)"))
        } else {
            None
        }
    }
    "blits-one-row-late" [glBlitFramebuffer GL_DEPTH_BUFFER_BIT] "Blits of depth start one row too high." {
        glBlitFramebuffer => |call| if call.u(8) & glow::DEPTH_BUFFER_BIT != 0 {
            call.set(1, call.i(1) + 1);
            call.set(3, call.i(3) + 1);
        }
    }
}
