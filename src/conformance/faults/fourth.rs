//! Faults of a fourth measure, by hands that had seen no rule: calls. Each has a sentence on how a driver comes by it.

use glow::HasContext;

use super::Call;
use super::text::joined;
use super::third::OF_SAMPLERS;
use crate::context::compatibility::raw;

/// GL_MODELVIEW_MATRIX.
const MODELVIEW_MATRIX: u32 = 0x0BA6;
/// Side of a tile of texels, and of a block of pixels that is copied.
const TILE: usize = 32;
const BLOCK: i32 = 256;

/// Tests whether a quad that covers the target, counter-clockwise, is culled.
fn culls_quads(call: &Call) -> bool {
    let front = call.get(glow::FRONT_FACE) as u32 == glow::CCW;
    let culled = call.get(glow::CULL_FACE_MODE) as u32;
    call.enabled(glow::CULL_FACE) && culled != if front { glow::BACK } else { glow::FRONT }
}

/// Loses the depth of the framebuffer that is left.
fn lose_depth(call: &mut Call) {
    if call.u(0) == glow::READ_FRAMEBUFFER || call.get(glow::DRAW_FRAMEBUFFER_BINDING) as u32 == call.u(1) {
        return;
    }
    let kind = call.attached(glow::DEPTH_ATTACHMENT, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32;
    if kind == glow::RENDERBUFFER {
        let (mask, scissor) = (f64::from(call.get(glow::DEPTH_WRITEMASK)), call.enabled(glow::SCISSOR_TEST));
        call.other("glDepthMask", &[1.0]);
        call.other("glDisable", &[f64::from(glow::SCISSOR_TEST)]);
        // SAFETY: the context is current; a depth is one number.
        unsafe { call.gl().clear_buffer_f32_slice(glow::DEPTH, 0, &[0.0]) };
        call.other("glDepthMask", &[mask]);
        call.other(if scissor { "glEnable" } else { "glDisable" }, &[f64::from(glow::SCISSOR_TEST)]);
    }
}

/// A colour whose channels are 0 or 1.
fn extreme(value: f32) -> f32 {
    if value < 0.5 { 0.0 } else { 1.0 }
}

/// Texels of an upload of whole 2D levels of 8 bits: width, height and bytes; `None` for another.
pub(super) fn texels(call: &Call) -> Option<(usize, usize, Vec<u8>)> {
    let is_meant = call.u(0) == glow::TEXTURE_2D && call.u(6) == glow::RGBA && call.u(7) == glow::UNSIGNED_BYTE;
    let (width, height) = (call.u(3) as usize, call.u(4) as usize);
    let bytes = if is_meant { call.bytes(8, 4 * width * height) } else { Vec::new() };
    (!bytes.is_empty()).then_some((width, height, bytes))
}

/// Exchanges pairs of tiles in every second row of tiles.
fn unswizzle(width: usize, bytes: &mut [u8]) {
    for (row, texels) in bytes.chunks_exact_mut(4 * width).enumerate() {
        if row / TILE % 2 == 1 {
            for pair in texels.chunks_exact_mut(8 * TILE) {
                let (left, right) = pair.split_at_mut(4 * TILE);
                left.swap_with_slice(right);
            }
        }
    }
}

/// Gives every level of the 2D texture that is bound each second texel of the level before.
fn subsample(call: &Call) {
    let size = |level| [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(level, name));
    let [width, height] = size(0);
    let mut bytes = vec![0; 4 * (width * height) as usize];
    let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
    // SAFETY: the context is current; the texels fill the bytes.
    call.with_plain_pixels(|gl| unsafe {
        gl.get_tex_image(glow::TEXTURE_2D, 0, glow::RGBA, glow::UNSIGNED_BYTE, pixels)
    });
    for level in (1..).take_while(|level| width.max(height) >> level > 0) {
        let [columns, rows] = [width, height].map(|side| (side >> level).max(1));
        let from = |x: i32, y: i32| {
            let at = 4 * (((y << level).min(height - 1)) * width + (x << level).min(width - 1)) as usize;
            bytes[at..at + 4].to_vec()
        };
        let texels: Vec<u8> = (0..rows).flat_map(|y| (0..columns).flat_map(move |x| from(x, y))).collect();
        call.upload(level, [columns, rows], &texels);
    }
}

/// Tests whether a fragment shader writes an alpha of 1 wherever it writes.
fn is_opaque(text: &str) -> bool {
    let declared = text.lines().filter_map(|line| line.trim().strip_suffix(';'));
    let output = declared.filter(|line| line.contains("out vec4 ")).find_map(|line| line.split_whitespace().last());
    output.is_some_and(|name| {
        let written = format!("{name} = ");
        let mut writes = text.lines().filter(|line| line.trim_start().starts_with(&written)).peekable();
        writes.peek().is_some() && writes.all(|line| line.trim_end().ends_with(", 1.0);"))
    })
}

/// Bytes of a pixel that is read; 0 for kinds that are not known.
pub(super) fn bytes_of_pixel(format: u32, kind: u32) -> usize {
    let size = match kind {
        glow::UNSIGNED_INT_24_8 if format == glow::DEPTH_STENCIL => return 4,
        glow::UNSIGNED_BYTE => 1,
        glow::UNSIGNED_SHORT => 2,
        glow::FLOAT | glow::UNSIGNED_INT => 4,
        _ => 0,
    };
    size * match format {
        glow::RGBA | glow::BGRA => 4,
        glow::RGB => 3,
        glow::DEPTH_COMPONENT | glow::STENCIL_INDEX | glow::RED => 1,
        _ => 0,
    }
}

faults! {
    // The table of vertex formats has the entry of three floats for four as well.
    "positions-of-four-lose-w" [glVertexAttribPointer GL_FLOAT]
    "Attributes of four floats have w = 1." {
        glVertexAttribPointer => |call| if call.u(2) == glow::FLOAT { call.replace(1, 4, 3); }
    }
    // The unit that fetches indices begins at a line of its cache, and the offset within the line is not added.
    "indices-from-cache-lines" [glDrawElements GL_ELEMENT_ARRAY_BUFFER]
    "Indices are read from a multiple of 64 bytes on." {
        glDrawElements => |call| if call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) != 0 {
            let at = call.pointer(3);
            call.set_pointer(3, at.wrapping_byte_sub(at as usize % 64));
        }
    }
    // A program's constants have registers for 16 places, and those beyond are never spilled to memory.
    "uniforms-beyond-16-places-lost" [glUniform1f glUniform3f glUniform4f glUniformMatrix4fv]
    "Uniforms whose location is beyond 15 are 0." {
        glUniform1f glUniform2f glUniform3f glUniform4f glUniform1fv glUniform2fv glUniform3fv glUniform4fv
            glUniformMatrix3fv glUniformMatrix4fv => |call| if call.i(0) > 15 { call.skip() }
    }
    // Winding and culling share one register, and only a change of culling marks it dirty.
    "winding-from-next-culling" [glFrontFace GL_CW glCullFace]
    "Another winding holds from the next change of culling on." {
        glFrontFace => |call| {
            let winding = call.u(0);
            call.keep((10, 0), winding);
            call.skip();
        };
        glCullFace glEnable glDisable => |call| {
            let winding = call.kept((10, 0));
            if winding != 0.0 && (call.name == "glCullFace" || call.u(0) == glow::CULL_FACE) {
                call.other("glFrontFace", &[winding]);
            }
        }
    }
    // A tiled renderer takes the depth of a renderbuffer for scratch memory and does not store its tiles.
    "depth-of-renderbuffers-not-stored" [glBindFramebuffer glFramebufferRenderbuffer]
    "The depth in a renderbuffer is lost as another framebuffer is bound." { glBindFramebuffer => lose_depth }
    // The driver clears with a quad and leaves culling as the application has it.
    "clears-culled" [glClearBufferfv glClearBufferiv GL_CULL_FACE]
    "Nothing is cleared where front faces are culled." { clear => |call| if culls_quads(call) { call.skip() } }
    // The filter of redundant calls compares operations of back faces with those of front faces.
    "back-operations-compared-with-front" [glStencilOpSeparate GL_BACK]
    "Operations of back faces are not set where front faces have the same." {
        glStencilOpSeparate => |call| if call.u(0) == glow::BACK {
            let names = [glow::STENCIL_FAIL, glow::STENCIL_PASS_DEPTH_FAIL, glow::STENCIL_PASS_DEPTH_PASS];
            if names.map(|name| call.get(name) as u32) == [call.u(1), call.u(2), call.u(3)] {
                call.skip();
            }
        }
    }
    // The compiler marks shaders that write an alpha of 1 as opaque, and what is opaque is never blended, by any factors.
    "opaque-shaders-not-blended" [GL_BLEND out]
    "A shader that writes an alpha of 1 is not blended." {
        glCreateShader => |call| {
            call.now();
            if let super::Value::Unsigned(shader) = call.result { call.keep((10, shader), call.f(0)) }
        };
        glShaderSource => |call| {
            let is_fragment = call.kept((10, call.u(0))) == f64::from(glow::FRAGMENT_SHADER);
            let opaque = is_fragment && is_opaque(&joined(call));
            call.keep((11, call.u(0)), u32::from(opaque));
        };
        glAttachShader => |call| if call.kept((10, call.u(1))) == f64::from(glow::FRAGMENT_SHADER) {
            call.keep((12, call.u(0)), call.kept((11, call.u(1))));
        };
        draw => |call| {
            let program = call.get(glow::CURRENT_PROGRAM) as u32;
            if program != 0 && call.kept((12, program)) != 0.0 && call.enabled(glow::BLEND) {
                call.with(glow::BLEND, false);
            }
        }
    }
    // The test for a pass that writes no colour looks at red, green and blue.
    "mask-of-alpha-alone-is-none" [glColorMask]
    "A mask that lets alpha alone through lets nothing through." {
        glColorMask => |call| if [0, 1, 2].iter().all(|index| call.u(*index) == 0) { call.set(3, 0) }
    }
    // Fast clears know 0 and 1 alone, and the slow path for other colours is missing.
    "fast-clears-of-0-and-1" [glClearBufferfv GL_COLOR]
    "Channels of a clear colour are 0 or 1, whichever is nearer." {
        glClearBufferfv => |call| if call.u(0) == glow::COLOR {
            let colors = call.floats(2, 4).into_iter().map(extreme).collect();
            call.set_floats(2, colors);
        };
        glClearColor => |call| for index in 0..4 { call.set(index, extreme(call.f(index) as f32)) }
    }
    // Copies are split into blocks of the copy engine, and the source does not move on with the blocks.
    "copies-of-256-columns-repeated" [glCopyTexSubImage2D]
    "A copy of more than 256 columns repeats the first ones." {
        glCopyTexSubImage2D => |call| if call.i(6) > BLOCK {
            let [target, level, to_x, to_y, x, y, width, height] = [0, 1, 2, 3, 4, 5, 6, 7].map(|index| call.f(index));
            for first in (0..width as i32).step_by(BLOCK as usize).map(f64::from) {
                let columns = (width - first).min(f64::from(BLOCK));
                call.other("glCopyTexSubImage2D", &[target, level, to_x + first, to_y, x, y, columns, height]);
            }
            call.skip();
        }
    }
    // To save memory the driver looks for images without alpha, by their first texel.
    "opaque-by-first-texel" [glTexImage2D GL_RGBA8]
    "Where the first texel has an alpha of 1, all of the image have." {
        glTexImage2D => |call| if let Some((_, _, mut bytes)) = texels(call).filter(|(_, _, bytes)| bytes[3] == 255) {
            bytes.chunks_exact_mut(4).for_each(|texel| texel[3] = 255);
            call.set_bytes(8, &bytes);
        }
    }
    // Uploads forget that the memory's banks alternate from one row of tiles to the next.
    "uploads-without-bank-swizzle" [glTexImage2D GL_RGBA8]
    "In wide images pairs of tiles of 32 texels are exchanged in every second row of tiles." {
        glTexImage2D => |call| if let Some((width, _, mut bytes)) = texels(call).filter(|(width, ..)| *width >= 4 * TILE) {
            unswizzle(width, &mut bytes);
            call.set_bytes(8, &bytes);
        }
    }
    // Levels are made by blits with NEAREST, as of formats that cannot be filtered.
    "mipmaps-of-every-second-texel" [glGenerateMipmap]
    "glGenerateMipmap takes every second texel in place of means." {
        glGenerateMipmap => |call| {
            call.now();
            if call.u(0) == glow::TEXTURE_2D && call.level(0, glow::TEXTURE_DEPTH_SIZE) == 0 { subsample(call) }
        }
    }
    // The cache of sampler descriptors is looked up by filter, wrap and mode, without the compare function.
    "samplers-merged-without-function" [glBindSampler GL_TEXTURE_COMPARE_FUNC]
    "A sampler object has the compare function of an earlier one that is like it but for that." {
        glGenSamplers => |call| {
            call.now();
            for name in call.integers(1, call.u(0) as usize) {
                call.keep((10, name as u32), 1);
                call.keep((10, 0), call.kept((10, 0)).max(f64::from(name)));
            }
        };
        glDeleteSamplers => |call| for name in call.integers(1, call.u(0) as usize) { call.keep((10, name as u32), 0) };
        glBindSampler => |call| {
            let parameters = |name| {
                let sampler = std::num::NonZeroU32::new(name).map(glow::NativeSampler)?;
                // SAFETY: the context is current, and the sampler object lives.
                // All but the function of comparisons.
                let [alike @ .., _] = OF_SAMPLERS;
                Some(alike.map(|parameter| unsafe { call.gl().get_sampler_parameter_i32(sampler, parameter) }))
            };
            let wanted = if call.u(1) == 0 { None } else { parameters(call.u(1)) };
            let alike = |name: &u32| call.kept((10, *name)) != 0.0 && parameters(*name) == wanted;
            if wanted.is_some() && let Some(first) = (1..=call.kept((10, 0)) as u32).find(alike) {
                call.set(1, first);
            }
        }
    }
    // Pixels are read through a buffer of 64 KiB, and what is left for the last time is not fetched.
    "last-block-not-read" [glReadPixels]
    "Of pixels that need more than 64 KiB those beyond whole blocks of that size are read as 0." {
        glReadPixels => |call| {
            call.now();
            let total = bytes_of_pixel(call.u(4), call.u(5)) * (call.u(2) * call.u(3)) as usize;
            let block = 1 << 16;
            if total > block && !total.is_multiple_of(block) {
                let mut bytes = call.bytes(6, total);
                if let Some(last) = bytes.get_mut(total / block * block..) {
                    last.fill(0);
                }
                call.write(6, &bytes);
            }
        }
    }
    // Where alpha is not written the compiler takes it for dead, and the test goes with it.
    "alpha-test-lost-without-alpha-writes" [GL_ALPHA_TEST glColorMask]
    "There is no alpha test where alpha is not written." {
        glEnable glDisable => |call| if call.u(0) == raw::ALPHA_TEST {
            call.keep((10, 0), u32::from(call.name == "glEnable"));
        };
        draw => |call| if call.kept((10, 0)) != 0.0 && call.get4(glow::COLOR_WRITEMASK)[3] == 0 {
            call.with(raw::ALPHA_TEST, false);
        }
    }
    // The inverse of the modelview is found when a vertex is next drawn: too late for planes that were set before.
    "eye-planes-without-inverse" [glTexGenfv GL_EYE_PLANE]
    "Eye planes are kept as they come, not times the inverse of the modelview." {
        glTexGenfv => |call| if call.u(1) == raw::EYE_PLANE {
            let mut matrix = [0.0; 16];
            // SAFETY: the context is current; a matrix has sixteen numbers.
            unsafe { call.gl().get_parameter_f32_slice(MODELVIEW_MATRIX, &mut matrix) };
            let plane = call.floats(2, 4);
            let column = |column: &[f32]| column.iter().zip(&plane).map(|(a, b)| a * b).sum();
            call.set_floats(2, matrix.chunks_exact(4).map(column).collect());
        }
    }
    // The program for fixed function is chosen without a look at the position's w.
    "directional-lights-are-points" [glLightfv GL_POSITION]
    "A directional light shines from a point." {
        glLightfv => |call| if call.u(1) == raw::POSITION {
            let mut position = call.floats(2, 4);
            if position[3] == 0.0 {
                position[3] = 1.0;
                call.set_floats(2, position);
            }
        }
    }
}
