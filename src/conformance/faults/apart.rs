//! Faults that were written before any rule had met them: draws, tests, blending, clears, copies. How many of them a rule
//! sees measures how well the rules see what their authors did not think of.

use glow::HasContext;

use super::Call;

/// Key of the number of the framebuffer that is drawn into: it may be asked between glBegin and glEnd.
const FRAMEBUFFER: (u32, u32) = (0, 0);
/// Key of the count of uploads and copies.
const UPLOADS: (u32, u32) = (0, 1);

/// Keeps which framebuffer is drawn into.
fn note_framebuffer(call: &mut Call) {
    if call.u(0) != glow::READ_FRAMEBUFFER {
        call.keep(FRAMEBUFFER, call.f(1));
    }
}

/// Forgets with what depth the framebuffer was cleared last.
fn forget_clear(call: &mut Call) {
    call.keep((1, call.kept(FRAMEBUFFER) as u32), 0.0);
}

fn has_offset(call: &Call) -> bool {
    call.enabled(glow::POLYGON_OFFSET_FILL)
}

/// Factor and units of the offset.
fn offset(call: &Call) -> [f64; 2] {
    [glow::POLYGON_OFFSET_FACTOR, glow::POLYGON_OFFSET_UNITS].map(|name| call.float(name))
}

/// Draws with another offset.
fn with_offset(call: &mut Call, [factor, units]: [f64; 2]) {
    let [old_factor, old_units] = offset(call);
    call.other("glPolygonOffset", &[factor, units]);
    call.now();
    call.other("glPolygonOffset", &[old_factor, old_units]);
}

/// Bits of the depth image that is drawn into, as an offset counts them; 0 without one.
fn offset_bits(call: &Call) -> f64 {
    match call.depth_format() {
        (_, glow::FLOAT) => 24.0,
        (bits, _) => f64::from(bits),
    }
}

/// Near and far of the depth range.
fn depth_range(call: &Call) -> [f64; 2] {
    let mut range = [0.0; 2];
    // SAFETY: the context is current; the range has two numbers.
    unsafe { call.gl().get_parameter_f32_slice(glow::DEPTH_RANGE, &mut range) };
    range.map(f64::from)
}

/// The depth that a clear writes as if it were drawn under the depth range.
fn ranged(call: &Call, depth: f64) -> f64 {
    let [near, far] = depth_range(call);
    near + depth * (far - near)
}

/// Tests whether the framebuffer that is read has a renderbuffer.
fn reads_renderbuffer(call: &Call) -> bool {
    let (gl, kind) = (call.gl(), glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    [glow::DEPTH_ATTACHMENT, glow::COLOR_ATTACHMENT0].into_iter().any(|point| {
        // SAFETY: the context is current; of a point without image only its type may be asked.
        unsafe {
            gl.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING).is_some()
                && gl.get_framebuffer_attachment_parameter_i32(glow::READ_FRAMEBUFFER, point, kind) as u32
                    == glow::RENDERBUFFER
        }
    })
}

/// Draws in parts of `most` indices, each part but the last without its last triangle.
fn in_parts(call: &mut Call, most: i32) {
    let size = match call.u(2) {
        glow::UNSIGNED_INT => 4,
        glow::UNSIGNED_SHORT => 2,
        _ => 1,
    };
    while call.u(0) == glow::TRIANGLES && call.i(1) > most {
        let rest = call.i(1) - most;
        call.set(1, most - 3);
        call.again();
        call.set(1, rest);
        call.set_pointer(3, call.pointer(3).wrapping_byte_add((most * size) as usize));
    }
}

faults! {
    "clear-believed-done" [glClearBufferfv GL_DEPTH glBindFramebuffer]
    "Depth is not cleared again where this framebuffer drew nothing since, though another drew into the same image." {
        glBindFramebuffer => note_framebuffer;
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            let depth = call.floats(2, 1).first().map_or(0.0, |depth| f64::from(*depth));
            let framebuffer = call.kept(FRAMEBUFFER) as u32;
            let (uploads, cleared) = (call.kept(UPLOADS), depth + 1.0);
            if call.kept((1, framebuffer)) == cleared && call.kept((2, framebuffer)) == uploads {
                call.skip();
            } else if !call.enabled(glow::SCISSOR_TEST) && call.get(glow::DEPTH_WRITEMASK) != 0 {
                call.keep((1, framebuffer), cleared);
                call.keep((2, framebuffer), uploads);
            }
        };
        drawn glClear glClearBufferfi glBlitFramebuffer glFramebufferTexture glFramebufferTexture2D glFramebufferTextureLayer
            glFramebufferRenderbuffer => forget_clear;
        copy glTexImage1D glTexImage2D glTexImage3D glTexSubImage2D glTexStorage2D glRenderbufferStorage => |call| {
            call.keep(UPLOADS, call.kept(UPLOADS) + 1.0);
        }
    }
    "stencil-test-takes-write-mask" [glStencilMask glStencilFunc]
    "The stencil test compares only bits that may be written." {
        draw => |call| if call.enabled(glow::STENCIL_TEST) {
            let faces = [
                (glow::FRONT, [glow::STENCIL_FUNC, glow::STENCIL_REF, glow::STENCIL_VALUE_MASK, glow::STENCIL_WRITEMASK]),
                (glow::BACK, [
                    glow::STENCIL_BACK_FUNC, glow::STENCIL_BACK_REF, glow::STENCIL_BACK_VALUE_MASK, glow::STENCIL_BACK_WRITEMASK,
                ]),
            ];
            let read = faces.map(|(face, names)| (face, names.map(|name| call.get(name))));
            for (face, [function, reference, mask, writes]) in read {
                let numbers = [face as f64, function as f64, reference as f64, f64::from((mask & writes) as u32)];
                call.other("glStencilFuncSeparate", &numbers);
            }
            call.now();
            for (face, [function, reference, mask, _]) in read {
                let numbers = [face as f64, function as f64, reference as f64, f64::from(mask as u32)];
                call.other("glStencilFuncSeparate", &numbers);
            }
        }
    }
    "back-reference-stale" [glStencilFunc]
    "A new reference alone, with function and mask as before, is set for front faces only." {
        glStencilFunc => |call| {
            let others = vec![call.f(0) as f32, call.f(2) as f32];
            if call.keep_list((0, 0), others.clone()) == Some(others) {
                call.other("glStencilFuncSeparate", &[f64::from(glow::FRONT), call.f(0), call.f(1), call.f(2)]);
                call.skip();
            }
        }
    }
    "counts-of-seven-bits" [GL_INCR_WRAP GL_DECR_WRAP]
    "INCR_WRAP and DECR_WRAP count seven bits." {
        draw => |call| {
            let operations = [
                glow::STENCIL_PASS_DEPTH_FAIL, glow::STENCIL_PASS_DEPTH_PASS,
                glow::STENCIL_BACK_PASS_DEPTH_FAIL, glow::STENCIL_BACK_PASS_DEPTH_PASS,
            ];
            let wraps = |name: &u32| [glow::INCR_WRAP, glow::DECR_WRAP].contains(&(call.get(*name) as u32));
            let writes = call.get(glow::STENCIL_WRITEMASK);
            if call.enabled(glow::STENCIL_TEST) && operations.iter().any(wraps) && writes & 0xFF == 0xFF {
                call.other("glStencilMask", &[127.0]);
                call.now();
                call.other("glStencilMask", &[255.0]);
            }
        }
    }
    "offset-of-front-faces-only" [glPolygonOffset glCullFace]
    "Back faces have no offset." {
        draw => |call| if has_offset(call) && (glow::TRIANGLES..=glow::TRIANGLE_FAN).contains(&call.u(0)) {
            let culled = f64::from(call.get(glow::CULL_FACE_MODE));
            if !call.enabled(glow::CULL_FACE) {
                call.other("glEnable", &[f64::from(glow::CULL_FACE)]);
                call.other("glCullFace", &[f64::from(glow::BACK)]);
                call.again();
                call.other("glCullFace", &[f64::from(glow::FRONT)]);
                call.with(glow::POLYGON_OFFSET_FILL, false);
                call.other("glCullFace", &[culled]);
                call.other("glDisable", &[f64::from(glow::CULL_FACE)]);
            } else if culled == f64::from(glow::FRONT) {
                call.with(glow::POLYGON_OFFSET_FILL, false);
            }
        }
    }
    "offset-units-of-format-before" [glPolygonOffset GL_DEPTH_COMPONENT16 glBindFramebuffer]
    "The unit of the offset is that of the depth image that was bound when the offset was set." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.keep((0, 0), offset_bits(call));
        glEnable glDisable => |call| if call.u(0) == glow::POLYGON_OFFSET_FILL { call.keep((0, 0), offset_bits(call)) };
        draw => |call| {
            let (before, now) = (call.kept((0, 0)), offset_bits(call));
            if has_offset(call) && before != 0.0 && now != 0.0 && before != now {
                let [factor, units] = offset(call);
                with_offset(call, [factor, units * (now - before).exp2()]);
            }
        }
    }
    "offset-turned-in-reversed-range" [glPolygonOffset glDepthRangef]
    "An offset has the other sign where the depth range has near beyond far." {
        draw => |call| {
            let [near, far] = depth_range(call);
            if has_offset(call) && near > far {
                let [factor, units] = offset(call);
                with_offset(call, [-factor, -units]);
            }
        }
    }
    "depth-func-lost-in-clear" [glClearBufferfv glDepthFunc]
    "After a clear of depth the depth function is ALWAYS until it is set again." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            call.now();
            call.other("glDepthFunc", &[f64::from(glow::ALWAYS)]);
        }
    }
    "depth-clear-in-depth-range" [glClearBufferfv glDepthRangef]
    "Depths that are cleared go through the depth range." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            let depth = call.floats(2, 1).first().map_or(0.0, |depth| f64::from(*depth));
            call.set_floats(2, vec![ranged(call, depth) as f32]);
        };
        glClear => |call| if call.u(0) & glow::DEPTH_BUFFER_BIT != 0 {
            let depth = call.float(glow::DEPTH_CLEAR_VALUE);
            call.other("glClearDepthf", &[ranged(call, depth)]);
            call.now();
            call.other("glClearDepthf", &[depth]);
        }
    }
    "clear-stops-at-1024" [glClearBufferfv]
    "Clears reach 1024 pixels to the right and up." {
        clear => |call| if !call.enabled(glow::SCISSOR_TEST) {
            let scissor = call.get4(glow::SCISSOR_BOX).map(f64::from);
            call.other("glScissor", &[0.0, 0.0, 1024.0, 1024.0]);
            call.with(glow::SCISSOR_TEST, true);
            call.other("glScissor", &scissor);
        }
    }
    "dst-alpha-is-one-where-masked" [GL_DST_ALPHA glColorMask]
    "The factor DST_ALPHA is 1 where alpha is not written." {
        draw => |call| if call.enabled(glow::BLEND) && call.get4(glow::COLOR_WRITEMASK)[3] == 0 {
            let names = [glow::BLEND_SRC_RGB, glow::BLEND_DST_RGB, glow::BLEND_SRC_ALPHA, glow::BLEND_DST_ALPHA];
            let factors = names.map(|name| call.get(name) as u32);
            let others = factors.map(|factor| match factor {
                glow::DST_ALPHA => glow::ONE,
                glow::ONE_MINUS_DST_ALPHA => glow::ZERO,
                other => other,
            });
            call.other("glBlendFuncSeparate", &others.map(f64::from));
            call.now();
            call.other("glBlendFuncSeparate", &factors.map(f64::from));
        }
    }
    "floats-clamped-while-blended" [GL_BLEND GL_RGBA32F]
    "Colours are clamped to [0, 1] before they are blended into floats." {
        draw => |call| {
            let floats = call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) as u32 == glow::FLOAT;
            let core = call.get(glow::CONTEXT_PROFILE_MASK) as u32 & glow::CONTEXT_CORE_PROFILE_BIT != 0;
            if floats && !core && call.enabled(glow::BLEND) {
                // GL_CLAMP_FRAGMENT_COLOR; TRUE, then FIXED_ONLY.
                call.other("glClampColor", &[f64::from(0x891B_u32), 1.0]);
                call.now();
                call.other("glClampColor", &[f64::from(0x891B_u32), f64::from(glow::FIXED_ONLY)]);
            }
        }
    }
    "copies-by-four-columns" [glCopyTexSubImage2D]
    "Copies leave the columns out that are left over from groups of four." {
        glCopyTexSubImage2D => |call| if call.i(6) > 4 { call.set(6, call.i(6) / 4 * 4) }
    }
    "copies-from-renderbuffers-flipped" [glCopyTexSubImage2D glFramebufferRenderbuffer]
    "Copies from renderbuffers have the last row first." {
        glCopyTexSubImage2D => |call| if reads_renderbuffer(call) {
            let [target, level, to_x, to_y, x, y, width, height] = [0, 1, 2, 3, 4, 5, 6, 7].map(|index| call.f(index));
            for row in 0..height as u32 {
                let row = f64::from(row);
                let to_y = to_y + height - 1.0 - row;
                call.other("glCopyTexSubImage2D", &[target, level, to_x, to_y, x, y + row, width, 1.0]);
            }
            call.skip();
        }
    }
    "index-65535-restarts" [glDrawElements GL_UNSIGNED_INT]
    "The index 65535 ends a primitive, though no restart is on." {
        glDrawElements => |call| if call.u(2) == glow::UNSIGNED_INT && !call.enabled(glow::PRIMITIVE_RESTART) {
            call.other("glPrimitiveRestartIndex", &[65535.0]);
            call.with(glow::PRIMITIVE_RESTART, true);
        }
    }
    "long-draws-lose-a-triangle" [glDrawElements GL_TRIANGLES]
    "Of each 2048 triangles of a draw the last is left out where others follow." {
        glDrawElements => |call| in_parts(call, 3 * 2048)
    }
    "counts-of-last-draw-only" [GL_SAMPLES_PASSED glBeginQuery glEndQuery]
    "A query counts the last of its draws alone." {
        glBeginQuery => |call| if call.u(0) == glow::SAMPLES_PASSED { call.keep((0, 0), call.f(1)) };
        glEndQuery => |call| if call.u(0) == glow::SAMPLES_PASSED { call.keep((0, 0), 0.0) };
        draw => |call| if call.kept((0, 0)) != 0.0 {
            call.other("glEndQuery", &[f64::from(glow::SAMPLES_PASSED)]);
            call.other("glBeginQuery", &[f64::from(glow::SAMPLES_PASSED), call.kept((0, 0))]);
        }
    }
}
