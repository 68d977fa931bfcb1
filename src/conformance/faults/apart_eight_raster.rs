//! Faults of an eighth measure, by a hand that had seen no rule: rasters, depth, stencil, blending and framebuffers. Each has a
//! sentence on how a driver comes by it.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::num::NonZeroU32;

use glow::HasContext;

use super::apart_seven_raster::is_bare;
use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, after_main, text, words};

/// Clip distance that is free for the driver.
const OWN_DISTANCE: u32 = 6;

/// Clears the other faces of a cube map with the one that is drawn into.
fn clear_all_faces(call: &mut Call) {
    call.now();
    let point = glow::DEPTH_ATTACHMENT;
    let is_texture = call.attached(point, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32 == glow::TEXTURE;
    if call.u(0) != glow::DEPTH || !is_texture {
        return;
    }
    let face = call.attached(point, glow::FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE) as u32;
    let name = call.attached(point, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) as u32;
    let Some(texture) = NonZeroU32::new(name).map(glow::NativeTexture).filter(|_| face != 0) else { return };
    let attach = |face: u32| {
        // SAFETY: the context is current; the texture is a cube map whose level 0 is attached.
        unsafe { call.gl().framebuffer_texture_2d(glow::DRAW_FRAMEBUFFER, point, face, Some(texture), 0) };
    };
    for other in 0..6 {
        attach(glow::TEXTURE_CUBE_MAP_POSITIVE_X + other);
        call.again();
    }
    attach(face);
}

/// Loses the stencil values of a framebuffer without colour that is left.
fn lose_stencil(call: &mut Call) {
    let is_left = call.u(0) != glow::READ_FRAMEBUFFER && call.get(glow::DRAW_FRAMEBUFFER_BINDING) != call.i(1);
    let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
    if !is_left || !is_bare(call) || call.attached(glow::STENCIL_ATTACHMENT, kind) == 0 {
        return;
    }
    let (mask, on, gl) = (call.get(glow::STENCIL_WRITEMASK) as u32, call.enabled(glow::SCISSOR_TEST), call.gl());
    // SAFETY: the context is current; the framebuffer has stencil values.
    unsafe {
        gl.disable(glow::SCISSOR_TEST);
        gl.stencil_mask(0xFF);
        gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[0]);
        gl.stencil_mask(mask);
        if on {
            gl.enable(glow::SCISSOR_TEST);
        }
    }
}

/// Draws with the masks of the first stencil state that agrees in all else.
fn draw_by_first_masks(call: &mut Call) {
    if !call.enabled(glow::STENCIL_TEST) {
        return;
    }
    let parts = [
        glow::STENCIL_FUNC,
        glow::STENCIL_FAIL,
        glow::STENCIL_PASS_DEPTH_FAIL,
        glow::STENCIL_PASS_DEPTH_PASS,
        glow::STENCIL_BACK_FAIL,
        glow::STENCIL_BACK_PASS_DEPTH_FAIL,
        glow::STENCIL_BACK_PASS_DEPTH_PASS,
        glow::DEPTH_FUNC,
    ];
    let mut hasher = DefaultHasher::new();
    parts.map(|name| call.get(name)).hash(&mut hasher);
    let key = hasher.finish() as u32;
    let [function, reference] = [glow::STENCIL_FUNC, glow::STENCIL_REF].map(|name| f64::from(call.get(name)));
    let masks = [glow::STENCIL_VALUE_MASK, glow::STENCIL_WRITEMASK].map(|name| f64::from(call.get(name) & 0xFF));
    if call.kept((60, key)) == 0.0 {
        call.keep((60, key), 1);
        call.keep((61, key), masks[0]);
        call.keep((62, key), masks[1]);
    }
    let set = |call: &Call, [read, write]: [f64; 2]| {
        call.other("glStencilFunc", &[function, reference, read]);
        call.other("glStencilMask", &[write]);
    };
    set(call, [61, 62].map(|part| call.kept((part, key))));
    call.now();
    set(call, masks);
}

/// Depths of all vertices, farther by what the driver says.
fn shifted(source: &Source) -> Option<String> {
    match source.stage {
        Stage::Vertex => with_state(source, "gl_Position.z += driver_state.x * gl_Position.w;", "", ""),
        _ => None,
    }
}

/// A clip distance to the plane where depth in clip space is 0.
fn clipped_at_zero(source: &Source) -> Option<String> {
    let redeclares = source.text.contains("out float gl_ClipDistance[") && !source.has("CLIP_PLANES");
    if source.stage != Stage::Vertex || source.version < 330 || redeclares {
        return None;
    }
    let statement = format!("\n#ifndef CLIP_PLANES\n    gl_ClipDistance[{OWN_DISTANCE}] = gl_Position.z;\n#endif\n");
    after_main(source, Stage::Vertex, &statement)
}

/// Alpha of eight bits, where the driver says so.
fn alpha_of_bytes(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let is_output = |line: &str| line.trim_start().trim_start_matches("EXACT ").starts_with("out vec4 ");
    let name = words(source.text.lines().find(|line| is_output(line))?.split_once("vec4 ")?.1).next()?;
    let statement =
        format!("if (driver_state.x > 0.5) {name}.a = floor(clamp({name}.a, 0.0, 1.0) * 255.0 + 0.5) / 255.0;");
    let text = after_main(source, Stage::Fragment, &statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

faults! {
    // The clear is a quad of the driver's own, and of what the quad sets the colour mask is not put back.
    "stencil-clears-leave-colors-masked" [glClearBufferiv glColorMask]
    "After a clear of stencil values no colour is written until the colour mask is set again." {
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL {
            call.now();
            call.other("glColorMask", &[0.0; 4]);
        }
    }
    // One word for an image says that it is cleared and not yet drawn into, and the faces are one image.
    "cube-faces-cleared-together" [glClearBufferfv GL_TEXTURE_CUBE_MAP]
    "A clear of the depths of one face of a cube map clears all six." { glClearBufferfv => clear_all_faces }
    // A tile's depths are written back to memory, and its stencil values with its colours.
    "stencil-not-stored-without-color" [glBindFramebuffer GL_STENCIL_ATTACHMENT]
    "The stencil values of a framebuffer without colour are 0 once another framebuffer is bound." {
        glBindFramebuffer => lose_stencil
    }
    // States are found again by a key, and the two masks were taken for a part of the reference, which is no part of it.
    "stencil-states-found-without-masks" [glStencilMask glStencilFunc]
    "A stencil state has the masks of the first one with the same operations and functions." { draw => draw_by_first_masks }
    // Depths are stepped from the corner of what is drawn, and that is another one under a scissor.
    "depths-stepped-from-scissor" [GL_SCISSOR_TEST GL_EQUAL]
    "Depths that are drawn under a scissor are one step off." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, shifted);
        draw => |call| {
            let step = if call.enabled(glow::SCISSOR_TEST) { f32::EPSILON } else { 0.0 };
            set_state(call, [step, 0.0, 0.0, 0.0]);
        }
    }
    // The clip volume is that of an interface whose depth begins at 0, and the depths alone were converted.
    "near-plane-at-zero" [gl_Position] "The near plane clips where z is less than 0, not where it is less than -w." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, clipped_at_zero);
        draw => |call| {
            let is_free = !call.enabled(glow::CLIP_DISTANCE0) && !call.enabled(glow::DEPTH_CLAMP);
            if is_free && call.get(glow::CURRENT_PROGRAM) != 0 {
                call.with(glow::CLIP_DISTANCE0 + OWN_DISTANCE, true);
            }
        }
    }
    // Rows are counted from above inside, and the rule for lines that meet pixels' corners is turned with them.
    "lines-one-row-lower" [GL_LINES] "Lines lie one row lower." {
        glDrawElements glDrawArrays => |call| if call.u(0) == glow::LINES {
            let now = call.get4(glow::VIEWPORT).map(f64::from);
            call.other("glViewport", &[now[0], now[1] - 1.0, now[2], now[3]]);
            call.now();
            call.other("glViewport", &now);
        }
    }
    // Factors go through the part of the blender that was there before floats were.
    "blended-by-alpha-of-bytes" [glBlendFuncSeparate GL_ONE_MINUS_SRC_ALPHA GL_RGBA32F]
    "Alpha that stored floats are multiplied by has 8 bits." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, alpha_of_bytes);
        draw => |call| {
            let bits = call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE);
            let weighs = call.get(glow::BLEND_DST_RGB) as u32 == glow::ONE_MINUS_SRC_ALPHA;
            let rounds = bits == 32 && weighs && call.enabled(glow::BLEND);
            set_state(call, [if rounds { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
        }
    }
    // Depths are copied by a quad that writes them whatever is there, and the function stays as the quad had it.
    "copies-leave-depth-func-always" [glCopyTexSubImage2D glDepthFunc]
    "After a copy of depths the depth test passes always, until its function is set again." {
        glCopyTexSubImage2D => |call| {
            call.now();
            call.other("glDepthFunc", &[f64::from(glow::ALWAYS)]);
        }
    }
}
