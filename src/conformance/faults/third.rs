//! Faults of a third measure, written by other hands than the rules, before any rule had met them: framebuffers, clears,
//! copies, objects.

use glow::HasContext;

use super::Call;

/// Key of the framebuffer that is drawn into, plus 1.
const FRAMEBUFFER: (u32, u32) = (0, 0);
/// Key of a count of what may change an image but for clears.
const CHANGES: (u32, u32) = (0, 1);
/// Key of the count of such changes, plus 1, at the last clear of everything.
const CLEARED: (u32, u32) = (0, 2);

/// Parameters of a sampler object that are enums; the function of comparisons is the last.
pub(super) const OF_SAMPLERS: [u32; 7] = [
    glow::TEXTURE_MIN_FILTER,
    glow::TEXTURE_MAG_FILTER,
    glow::TEXTURE_WRAP_S,
    glow::TEXTURE_WRAP_T,
    glow::TEXTURE_WRAP_R,
    glow::TEXTURE_COMPARE_MODE,
    glow::TEXTURE_COMPARE_FUNC,
];

/// A list that was kept, and stays so; empty if none was.
fn kept_list(call: &mut Call, key: (u32, u32)) -> Vec<f32> {
    let list = call.keep_list(key, Vec::new()).unwrap_or_default();
    call.keep_list(key, list.clone());
    list
}

/// Counts what may change an image.
fn count_change(call: &mut Call) {
    call.keep(CHANGES, call.kept(CHANGES) + 1.0);
}

fn is_whole(call: &Call) -> bool {
    !call.enabled(glow::SCISSOR_TEST)
}

/// Images that are drawn into with all their layers: point, texture, level.
fn layered(call: &Call) -> Vec<[f64; 3]> {
    [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT, glow::STENCIL_ATTACHMENT]
        .into_iter()
        .filter(|point| call.attached(*point, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32 == glow::TEXTURE)
        .filter(|point| call.attached(*point, glow::FRAMEBUFFER_ATTACHMENT_LAYERED) != 0)
        .map(|point| {
            let read = |name| f64::from(call.attached(point, name));
            let [texture, level] =
                [glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, glow::FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL].map(read);
            [f64::from(point), texture, level]
        })
        .collect()
}

/// Clears the stencil under the back faces' mask.
fn clear_by_back_mask(call: &mut Call) {
    let [front, back] =
        [glow::STENCIL_WRITEMASK, glow::STENCIL_BACK_WRITEMASK].map(|name| f64::from(call.get(name) as u32));
    if front != back {
        call.other("glStencilMaskSeparate", &[f64::from(glow::FRONT), back]);
        call.now();
        call.other("glStencilMaskSeparate", &[f64::from(glow::FRONT), front]);
    }
}

/// Keeps a copy within the scissor's box.
fn copy_scissored(call: &mut Call) {
    let [left, low, width, height] = call.get4(glow::SCISSOR_BOX);
    for (to, from, size, [first, extent]) in [(2, 4, 6, [left, width]), (3, 5, 7, [low, height])] {
        let begin = call.i(from).max(first);
        let end = (call.i(from) + call.i(size)).min(first + extent);
        if end <= begin {
            call.skip();
            return;
        }
        call.set(to, call.i(to) + begin - call.i(from));
        call.set(from, begin);
        call.set(size, end - begin);
    }
}

/// Tests whether a query that conditions what is drawn found no sample.
fn is_conditioned_away(call: &Call) -> bool {
    let Some(query) = std::num::NonZeroU32::new(call.kept((0, 0)) as u32).map(glow::NativeQuery) else { return false };
    // SAFETY: the context is current; the query was ended before it became a condition.
    unsafe { call.gl().get_query_parameter_u32(query, glow::QUERY_RESULT) == 0 }
}

faults! {
    "scissor-box-per-framebuffer" [glScissor glBindFramebuffer]
    "A framebuffer that is bound again has the scissor's box that was set last while it was bound." {
        glGenFramebuffers => |call| {
            call.now();
            for name in call.integers(1, call.u(0) as usize) {
                call.keep_list((1, name as u32), Vec::new());
            }
        };
        glScissor => |call| {
            let numbers = (0..4).map(|index| call.f(index) as f32).collect();
            call.keep_list((1, call.kept(FRAMEBUFFER).max(1.0) as u32 - 1), numbers);
        };
        glBindFramebuffer => |call| if call.u(0) != glow::READ_FRAMEBUFFER
            && call.kept(FRAMEBUFFER).max(1.0) != call.f(1) + 1.0
        {
            call.now();
            call.keep(FRAMEBUFFER, call.f(1) + 1.0);
            let numbers: Vec<_> = kept_list(call, (1, call.u(1))).into_iter().map(f64::from).collect();
            if numbers.len() == 4 {
                call.other("glScissor", &numbers);
            }
        }
    }
    "copies-after-clears-stale" [glCopyTexSubImage2D glClearBufferfv glClear]
    "A copy from a framebuffer that was cleared whole, and not drawn into since, leaves the texture as it was." {
        clear => |call| if is_whole(call) { call.keep(CLEARED, call.kept(CHANGES) + 1.0) } else { count_change(call) };
        drawn glBindFramebuffer glBlitFramebuffer glReadBuffer => count_change;
        glCopyTexSubImage2D => |call| if call.kept(CLEARED) == call.kept(CHANGES) + 1.0 { call.skip() }
    }
    "scissored-clear-after-clear-is-whole" [glClearBufferfv GL_SCISSOR_TEST]
    "A clear within the scissor right after a clear of the whole image takes the new value for all of it." {
        drawn glBindFramebuffer glBlitFramebuffer => count_change;
        glClearBufferfv => |call| {
            let (key, now) = ((call.u(0), call.u(1)), call.kept(CHANGES) + 1.0);
            if is_whole(call) {
                call.keep(key, now);
            } else if call.kept(key) == now {
                call.with(glow::SCISSOR_TEST, false);
            }
        }
    }
    "layered-clears-of-first-layer" [glFramebufferTexture glClearBufferfv]
    "Of an image that is attached with all its layers a clear reaches the first." {
        clear => |call| {
            let images = layered(call);
            let target = f64::from(glow::DRAW_FRAMEBUFFER);
            for [point, texture, level] in &images {
                call.other("glFramebufferTextureLayer", &[target, *point, *texture, *level, 0.0]);
            }
            call.now();
            for [point, texture, level] in images {
                call.other("glFramebufferTexture", &[target, point, texture, level]);
            }
        }
    }
    "stencil-clear-takes-back-mask" [glStencilMaskSeparate glClearBufferiv]
    "A clear of stencil is under the write mask of back faces." {
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL { clear_by_back_mask(call) };
        glClearBufferfi => clear_by_back_mask;
        glClear => |call| if call.u(0) & glow::STENCIL_BUFFER_BIT != 0 { clear_by_back_mask(call) }
    }
    "depth-lost-with-always" [glDepthFunc GL_ALWAYS glDepthMask]
    "Under the function ALWAYS no depth is written." {
        draw => |call| if call.enabled(glow::DEPTH_TEST) && call.get(glow::DEPTH_FUNC) as u32 == glow::ALWAYS {
            call.with(glow::DEPTH_TEST, false);
        }
    }
    "copies-scissored" [glCopyTexSubImage2D GL_SCISSOR_TEST]
    "The scissor test bounds what is copied to a texture." {
        glCopyTexSubImage2D => |call| if call.enabled(glow::SCISSOR_TEST) { copy_scissored(call) }
    }
    "new-sampler-has-old-parameters" [glGenSamplers glDeleteSamplers glSamplerParameteri]
    "A new sampler object has the parameters of the one that was deleted last." {
        glSamplerParameteri => |call| call.keep((call.u(0), call.u(1)), call.f(2) + 1.0);
        glDeleteSamplers => |call| for name in call.integers(1, call.u(0) as usize) {
            for parameter in OF_SAMPLERS {
                call.keep((0, parameter), call.kept((name as u32, parameter)));
            }
        };
        glGenSamplers => |call| {
            call.now();
            for name in call.integers(1, 1.min(call.u(0) as usize)) {
                for parameter in OF_SAMPLERS {
                    let value = call.kept((0, parameter));
                    if value > 0.0 {
                        call.other("glSamplerParameteri", &[f64::from(name), f64::from(parameter), value - 1.0]);
                        call.keep((name as u32, parameter), value);
                        call.keep((0, parameter), 0.0);
                    }
                }
            }
        }
    }
    "uniforms-compared-across-programs" [glUniform1i glUniform1f glUseProgram]
    "A number is not sent where the location of that number had the same in whichever program set it last." {
        glUniform1i glUniform1f => |call| {
            let (key, value) = ((u32::from(call.name == "glUniform1f"), call.u(0)), vec![call.f(1) as f32]);
            if call.keep_list(key, value.clone()) == Some(value) {
                call.skip();
            }
        }
    }
    "attribute-offsets-of-16-bits" [glVertexAttribPointer]
    "The offset of an attribute has 16 bits." {
        glVertexAttribPointer => |call| if call.get(glow::ARRAY_BUFFER_BINDING) != 0 {
            let at = call.pointer(5);
            call.set_pointer(5, at.wrapping_byte_sub(at as usize & !0xFFFF));
        }
    }
    "query-counts-add-up" [GL_SAMPLES_PASSED glBeginQuery glGetQueryObjectuiv]
    "A query that is begun again goes on from its last count." {
        glBeginQuery => |call| if call.u(0) == glow::SAMPLES_PASSED {
            let query = call.u(1);
            if call.kept((1, query)) != 0.0
                && let Some(object) = std::num::NonZeroU32::new(query).map(glow::NativeQuery)
            {
                // SAFETY: the context is current; the query was begun and ended before.
                let last = unsafe { call.gl().get_query_parameter_u32(object, glow::QUERY_RESULT) };
                call.keep((2, query), call.kept((2, query)) + f64::from(last));
            }
            call.keep((1, query), 1.0);
        };
        glGetQueryObjectuiv => |call| if call.u(1) == glow::QUERY_RESULT && call.kept((1, call.u(0))) != 0.0 {
            call.now();
            let count = call.integers(2, 1).first().map_or(0, |count| *count as u32);
            call.write(2, &[count + call.kept((2, call.u(0))) as u32]);
        }
    }
    "mipmaps-made-on-unit-0" [glGenerateMipmap glActiveTexture]
    "glGenerateMipmap makes the levels of the texture on unit 0, whichever unit is active." {
        glGenerateMipmap => |call| {
            let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
            call.other("glActiveTexture", &[f64::from(glow::TEXTURE0)]);
            if call.u(0) == glow::TEXTURE_2D && call.get(glow::TEXTURE_BINDING_2D) == 0 {
                call.skip();
            }
            call.now();
            call.other("glActiveTexture", &[active]);
        }
    }
    "blits-switch-stencil-test-off" [glBlitFramebuffer GL_STENCIL_TEST]
    "After a blit the stencil test is off until it is switched on again." {
        glBlitFramebuffer => |call| {
            call.now();
            call.other("glDisable", &[f64::from(glow::STENCIL_TEST)]);
        }
    }
    "copies-set-viewport" [glCopyTexSubImage2D glViewport]
    "After a copy to a texture the viewport is the size of what was copied until it is set again." {
        glCopyTexSubImage2D => |call| {
            call.now();
            call.other("glViewport", &[0.0, 0.0, call.f(6), call.f(7)]);
        }
    }
    "borders-looked-up-by-red" [GL_TEXTURE_BORDER_COLOR glSamplerParameterfv glTexParameterfv]
    "A border with the red of an earlier one is that one." {
        glSamplerParameterfv glTexParameterfv => |call| if call.u(1) == glow::TEXTURE_BORDER_COLOR {
            let border = call.floats(2, 4);
            let key = (9, border[0].to_bits());
            let earlier = kept_list(call, key);
            if earlier.is_empty() {
                call.keep_list(key, border);
            } else {
                call.set_floats(2, earlier);
            }
        }
    }
    "buffers-of-same-size-kept" [glBufferData]
    "A buffer that is given as many bytes again keeps those that it has." {
        glBufferData => |call| {
            let name = match call.u(0) {
                glow::ARRAY_BUFFER => glow::ARRAY_BUFFER_BINDING,
                glow::ELEMENT_ARRAY_BUFFER => glow::ELEMENT_ARRAY_BUFFER_BINDING,
                _ => return,
            };
            let (key, size) = ((1, call.get(name) as u32), call.f(1) + 1.0);
            if call.kept(key) == size {
                call.skip();
            }
            call.keep(key, size);
        }
    }
    "srgb-clears-not-encoded" [GL_FRAMEBUFFER_SRGB glClearBufferfv]
    "Clears of sRGB images are not encoded." { clear => |call| call.with(glow::FRAMEBUFFER_SRGB, false) }
    // What follows takes the place of one that proves to do nothing.
    "copies-under-condition" [glBeginConditionalRender glCopyTexSubImage2D]
    "Copies to textures are conditioned as draws are." {
        glBeginConditionalRender => |call| call.keep((0, 0), call.f(0));
        glEndConditionalRender => |call| call.keep((0, 0), 0.0);
        glCopyTexSubImage2D => |call| if is_conditioned_away(call) { call.skip() }
    }
    "stencil-reference-wraps" [glStencilFunc glStencilFuncSeparate]
    "A reference beyond what the stencil holds is taken by its low bits, not clamped." {
        glStencilFunc => |call| call.set(1, call.i(1) & 0xFF);
        glStencilFuncSeparate => |call| call.set(2, call.i(2) & 0xFF)
    }
}
