//! Faults of a second measure, written as those of `apart` were: before any rule had met them.

use super::apart_shaders::{HALVES, lookups, varyings};
use super::lookups::LOOKUPS;
use super::{Call, Stage, after_main, define};
use crate::context::compatibility::raw;

/// Outputs of a fragment shader that are vec4.
fn outputs(source: &super::Source) -> Vec<String> {
    let name = |line: &str| match line.trim().trim_end_matches(';').split_whitespace().collect::<Vec<_>>()[..] {
        ["out", "vec4", name] | ["precise", "out", "vec4", name] => Some(name.to_owned()),
        _ => None,
    };
    source.text.lines().filter_map(name).collect()
}

fn is_float_target(call: &Call) -> bool {
    call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) as u32 == glow::FLOAT
}

/// Level of the image that is drawn into.
fn attached_level(call: &Call) -> i32 {
    [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT]
        .into_iter()
        .filter(|point| call.attached(*point, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32 == glow::TEXTURE)
        .map(|point| call.attached(point, glow::FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL))
        .next()
        .unwrap_or(0)
}

/// Clears within a rectangle.
fn clear_within(call: &mut Call, rectangle: [f64; 4]) {
    let scissor = call.get4(glow::SCISSOR_BOX).map(f64::from);
    call.other("glScissor", &rectangle);
    call.with(glow::SCISSOR_TEST, true);
    call.other("glScissor", &scissor);
}

/// Copies a rectangle with its last row first.
fn copy_flipped(call: &mut Call) {
    let [target, level, to_x, to_y, x, y, width, height] = [0, 1, 2, 3, 4, 5, 6, 7].map(|index| call.f(index));
    for row in 0..height as u32 {
        let row = f64::from(row);
        let to_y = to_y + height - 1.0 - row;
        call.other("glCopyTexSubImage2D", &[target, level, to_x, to_y, x, y + row, width, 1.0]);
    }
    call.skip();
}

/// Tests whether another framebuffer is bound for drawing, and keeps it.
fn switches_framebuffer(call: &mut Call) -> bool {
    if call.u(0) == glow::READ_FRAMEBUFFER {
        return false;
    }
    let switches = call.kept((0, 0)) != call.f(1) + 1.0;
    call.keep((0, 0), call.f(1) + 1.0);
    switches
}

faults! {
    "offset-units-of-24-bits-for-16" [glPolygonOffset GL_DEPTH_COMPONENT16]
    "The unit of the offset of a depth image of 16 bits is that of 24." {
        draw => |call| if call.enabled(glow::POLYGON_OFFSET_FILL) && call.depth_format().0 == 16 {
            let [factor, units] = [glow::POLYGON_OFFSET_FACTOR, glow::POLYGON_OFFSET_UNITS].map(|name| call.float(name));
            call.other("glPolygonOffset", &[factor, units / 256.0]);
            call.now();
            call.other("glPolygonOffset", &[factor, units]);
        }
    }
    "offset-lost-with-next-program" [glUseProgram GL_POLYGON_OFFSET_FILL]
    "Another program has no offset until the offset is set again." {
        glUseProgram => |call| {
            let before = f64::from(call.get(glow::CURRENT_PROGRAM));
            if call.u(0) != 0 && before != 0.0 && before != call.f(0) {
                call.other("glPolygonOffset", &[0.0, 0.0]);
            }
        }
    }
    "culling-lost-in-stencil-clear" [glClearBufferiv GL_CULL_FACE]
    "After a clear of stencil no face is culled until culling is switched on again." {
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL {
            call.now();
            call.other("glDisable", &[f64::from(glow::CULL_FACE)]);
        }
    }
    "depth-range-lost-with-framebuffer" [glBindFramebuffer glDepthRangef]
    "Another framebuffer has the depth range [0, 1] until it is set again." {
        glBindFramebuffer => |call| if switches_framebuffer(call) { call.other("glDepthRangef", &[0.0, 1.0]) }
    }
    "winding-lost-with-framebuffer" [glBindFramebuffer glFrontFace GL_CW]
    "Another framebuffer has counter-clockwise front faces until a winding is set again." {
        glBindFramebuffer => |call| if switches_framebuffer(call) { call.other("glFrontFace", &[f64::from(glow::CCW)]) }
    }
    "clear-scissor-from-above" [glScissor glClearBufferfv]
    "The scissor of a clear is counted from the upper edge of the viewport." {
        clear => |call| if call.enabled(glow::SCISSOR_TEST) {
            let [x, y, width, height] = call.get4(glow::SCISSOR_BOX).map(f64::from);
            let rows = f64::from(call.get4(glow::VIEWPORT)[3]);
            clear_within(call, [x, rows - y - height, width, height]);
        }
    }
    "levels-cleared-in-part" [glClearBufferfv glFramebufferTexture2D]
    "Of a level beyond the first a clear reaches half its width and height." {
        clear => |call| if attached_level(call) > 0 && !call.enabled(glow::SCISSOR_TEST) {
            let [_, _, width, height] = call.get4(glow::VIEWPORT);
            clear_within(call, [0.0, 0.0, f64::from((width + 1) / 2), f64::from((height + 1) / 2)]);
        }
    }
    "cleared-depth-of-16-bits" [glClearBufferfv GL_DEPTH]
    "Depths that are cleared have 16 bits." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            let depth = call.floats(2, 1).first().copied().unwrap_or(0.0);
            call.set_floats(2, vec![(depth * 65535.0).floor() / 65535.0]);
        };
        glClearDepth glClearDepthf => |call| call.set(0, (call.f(0) * 65535.0).floor() / 65535.0)
    }
    "odd-viewports-narrow" [glViewport]
    "A viewport of odd width or height is one pixel narrower or lower." {
        glViewport => |call| for index in [2, 3] {
            if call.i(index) > 1 { call.set(index, call.i(index) & !1) }
        }
    }
    "lines-of-two-pixels" [GL_LINES glDrawElements]
    "Lines are two pixels wide." {
        glDrawElements => |call| if call.u(0) == glow::LINES {
            call.other("glLineWidth", &[2.0]);
            call.now();
            call.other("glLineWidth", &[1.0]);
        }
    }
    "clip-distances-beyond-fourth-ignored" [GL_CLIP_DISTANCE0 glEnable]
    "Only the first four clip distances clip." {
        glEnable => |call| if (glow::CLIP_DISTANCE4..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.skip() }
    }
    "masks-lost-for-floats" [glColorMask GL_RGBA32F]
    "Draws into floats write every channel where they write one." {
        draw => |call| {
            let mask = call.get4(glow::COLOR_WRITEMASK);
            if is_float_target(call) && mask != [0; 4] {
                call.other("glColorMask", &[1.0; 4]);
                call.now();
                call.other("glColorMask", &mask.map(f64::from));
            }
        }
    }
    "copies-to-cube-y-flipped" [glCopyTexSubImage2D GL_TEXTURE_CUBE_MAP]
    "Copies to the faces +Y and -Y of a cube map have the last row first." {
        glCopyTexSubImage2D => |call| {
            if [glow::TEXTURE_CUBE_MAP_POSITIVE_Y, glow::TEXTURE_CUBE_MAP_NEGATIVE_Y].contains(&call.u(0)) {
                copy_flipped(call);
            }
        }
    }
    "depths-read-of-16-bits" [glReadPixels GL_DEPTH_COMPONENT]
    "Depths that are read as floats have 16 bits." {
        glReadPixels => |call| if call.u(4) == glow::DEPTH_COMPONENT && call.u(5) == glow::FLOAT {
            call.now();
            let depths = call.floats(6, (call.u(2) * call.u(3)) as usize);
            let coarse: Vec<f32> = depths.iter().map(|depth| (depth * 65535.0).round() / 65535.0).collect();
            call.write(6, &coarse);
        }
    }
    "odd-widths-lose-last-column" [glTexImage2D GL_RGBA8]
    "The last column of 8-bit texels of an odd width is the first." {
        glTexImage2D => |call| {
            let (width, height) = (call.u(3) as usize, call.u(4) as usize);
            if call.u(6) == glow::RGBA && call.u(7) == glow::UNSIGNED_BYTE && width % 2 == 1 {
                let mut bytes = call.bytes(8, 4 * width * height);
                bytes.chunks_exact_mut(4 * width).for_each(|row| row.copy_within(0..4, 4 * (width - 1)));
                if !bytes.is_empty() {
                    call.set_bytes(8, &bytes);
                }
            }
        }
    }
    "units-beyond-four-wrap" [glUniform1i GL_TEXTURE0]
    "A sampler of unit 4 reads unit 0, one of unit 5 reads unit 1." {
        glUniform1i => |call| if (4..8).contains(&call.i(1)) { call.set(1, call.i(1) - 4) }
    }
    "attributes-beyond-four-lost" [glEnableVertexAttribArray]
    "Attributes beyond the fourth are not read." { glEnableVertexAttribArray => |call| if call.u(0) > 3 { call.skip() } }
    "small-matrix-last-column-late" [glUniformMatrix3fv]
    "The last column of a matrix of three holds from the second time it is set." {
        glUniformMatrix3fv => |call| {
            let program = call.get(glow::CURRENT_PROGRAM) as u32;
            let mut values = call.floats(3, 9);
            if let Some(before) = call.keep_list((program, call.u(0)), values.clone()) {
                values[6..].copy_from_slice(&before[6..]);
                call.set_floats(3, values);
            }
        }
    }
    "texture-matrix-of-first-unit-only" [glMatrixMode GL_TEXTURE]
    "Units beyond the first have the identity for a texture matrix." {
        glLoadMatrixf glLoadMatrixd glScalef glTranslatef => |call| {
            let later = call.get(glow::ACTIVE_TEXTURE) as u32 != glow::TEXTURE0;
            if later && call.get(raw::MATRIX_MODE) as u32 == glow::TEXTURE { call.skip() }
        }
    }
    "constant-of-last-unit" [GL_TEXTURE_ENV_COLOR glTexEnvfv]
    "The environment's constant of one unit is that of all." {
        glTexEnvfv => |call| if call.u(1) == raw::TEXTURE_ENV_COLOR {
            let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
            for unit in 0..4 {
                call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
                call.again();
            }
            call.other("glActiveTexture", &[active]);
        }
    }
    "attenuation-of-light-0" [GL_QUADRATIC_ATTENUATION GL_LINEAR_ATTENUATION glLightf]
    "Each light has the attenuation of light 0." {
        glLightf => |call| if (raw::CONSTANT_ATTENUATION..=raw::QUADRATIC_ATTENUATION).contains(&call.u(1)) {
            let key = (0, call.u(1));
            if call.u(0) == raw::LIGHT0 {
                call.keep(key, call.f(2));
            } else {
                call.set(2, call.kept(key));
            }
        }
    }
    "shininess-at-most-64" [GL_SHININESS glMaterialf]
    "The exponent of highlights is at most 64." {
        glMaterialf => |call| if call.u(1) == raw::SHININESS { call.set(2, call.f(2).min(64.0)) }
    }
    "implicit-level-of-width" [texture GL_LINEAR_MIPMAP_LINEAR]
    "The level of detail of a 2D look-up takes the texture for a square of its width."
    { text |source| lookups(source, "texture", LOOKUPS, [
        "sampler2D map, vec2 at) { return texture(map, at)",
        "sampler2D map, vec2 at) { vec2 size = vec2(textureSize(map, 0)); vec2 wrong = vec2(1.0, size.x / size.y); \
         return textureGrad(map, at, dFdx(at) * wrong, dFdy(at) * wrong)",
    ]) }
    "cube-direction-of-halves" [texture samplerCubeShadow]
    "The direction of a comparison in a cube map has eleven bits."
    { text |source| lookups(source, "texture", LOOKUPS, [
        "samplerCubeShadow map, vec4 at) { return texture(map, at)",
        "samplerCubeShadow map, vec4 at) { return texture(map, vec4(apart_half(at.xyz), at.w))",
    ]) }
    "colors-of-halves" [out GL_RGBA32F]
    "Colours that a fragment shader writes have eleven bits."
    { text |source| {
        let halved = |name: &String| format!("{name} = apart_half({name}); ");
        let all: String = outputs(source).iter().map(halved).collect();
        let other = (source.version >= 130 && !all.is_empty()).then(|| after_main(source, Stage::Fragment, &all)).flatten()?;
        Some(super::Source { text: other, ..*source }.with(HALVES))
    } }
    "varyings-of-halves" [in out]
    "Varyings have eleven bits at the vertices."
    { text |source| {
        let halved = |name: &String| format!("{name} = apart_half({name}); ");
        let all: String = varyings(source).iter().map(halved).collect();
        let other = (!all.is_empty()).then(|| after_main(source, Stage::Vertex, &all)).flatten()?;
        Some(super::Source { text: other, ..*source }.with(HALVES))
    } }
    "fragcoord-w-of-halves" [gl_FragCoord] "gl_FragCoord.w has eleven bits."
    { text |source| define(source, Stage::Fragment, "gl_FragCoord",
        &format!("{HALVES}\n#define gl_FragCoord vec4(gl_FragCoord.xyz, apart_half(gl_FragCoord.w))")) }
    "fragcoord-of-halves" [gl_FragCoord] "gl_FragCoord.xy has eleven bits: beyond 1024 it is a whole number."
    { text |source| define(source, Stage::Fragment, "gl_FragCoord",
        &format!("{HALVES}\n#define gl_FragCoord vec4(apart_half(gl_FragCoord.xy), gl_FragCoord.zw)")) }
    "texelfetch-beyond-2048-even" [texelFetch] "texelFetch beyond column 2048 reads every second texel."
    { text |source| super::anywhere(source, "texelFetch", "
int apart_even(int at) { return at > 2048 ? at / 2 * 2 : at; }
ivec2 apart_even(ivec2 at) { return ivec2(apart_even(at.x), apart_even(at.y)); }
ivec3 apart_even(ivec3 at) { return ivec3(apart_even(at.xy), at.z); }
#define texelFetch(map, at, level) texelFetch(map, apart_even(at), level)") }
    "dfdy-turned-in-odd-rows" [dFdy] "dFdy goes down the window in every second row."
    { text |source| define(source, Stage::Fragment, "dFdy",
        "#define dFdy(x) ((int(gl_FragCoord.y) & 1) == 1 ? -dFdy(x) : dFdy(x))") }
}
