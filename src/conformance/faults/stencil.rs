//! Faults of the stencil test.

use super::{Call, hold, release};

/// Makes the call while an operation of both faces is KEEP where `place` says: 0 stencil fail, 1 depth fail, 2 pass.
fn keeping(call: &mut Call, place: usize) {
    let read = |names: [u32; 3]| names.map(|name| f64::from(call.get(name)));
    let front = read([glow::STENCIL_FAIL, glow::STENCIL_PASS_DEPTH_FAIL, glow::STENCIL_PASS_DEPTH_PASS]);
    let back = read([glow::STENCIL_BACK_FAIL, glow::STENCIL_BACK_PASS_DEPTH_FAIL, glow::STENCIL_BACK_PASS_DEPTH_PASS]);
    let set = |call: &Call, face: u32, [fail, depth_fail, pass]: [f64; 3]| {
        call.other("glStencilOpSeparate", &[f64::from(face), fail, depth_fail, pass]);
    };
    for (face, mut operations) in [(glow::FRONT, front), (glow::BACK, back)] {
        operations[place] = f64::from(glow::KEEP);
        set(call, face, operations);
    }
    call.now();
    set(call, glow::FRONT, front);
    set(call, glow::BACK, back);
}

/// Puts an operation where another is wanted.
fn operation(call: &mut Call, from: u32, to: u32) {
    let first = if call.name == "glStencilOpSeparate" { 1 } else { 0 };
    for index in first..first + 3 {
        call.replace(index, from, to);
    }
}

/// The argument that is the function: before it stands a face in the separate form.
fn function(call: &Call) -> usize {
    usize::from(call.name == "glStencilFuncSeparate")
}

faults! {
    "back-takes-front-depth-fail" [glStencilOpSeparate GL_BACK]
    "Back faces take the front's operation where the depth test fails." {
        glStencilOpSeparate => |call| match call.u(0) {
            glow::FRONT => call.keep((0, 0), call.f(2)),
            glow::BACK if call.kept((0, 0)) != 0.0 => call.set(2, call.kept((0, 0))),
            _ => {}
        }
    }
    "stencil-ops-swap-faces" [glStencilOpSeparate GL_FRONT GL_BACK]
    "Front and back faces have each other's stencil operations." {
        glStencilOpSeparate => |call| call.exchange(0, glow::FRONT, glow::BACK)
    }
    "stencil-ops-of-back-ignored" [glStencilOpSeparate GL_BACK]
    "Stencil operations of back faces alone do nothing." {
        glStencilOpSeparate => |call| if call.u(0) == glow::BACK { call.skip() }
    }
    "stencil-ops-of-front-ignored" [glStencilOpSeparate GL_FRONT]
    "Stencil operations of front faces alone do nothing." {
        glStencilOpSeparate => |call| if call.u(0) == glow::FRONT { call.skip() }
    }
    "stencil-face-is-both" [glStencilOpSeparate GL_FRONT]
    "Operations that are set for one face hold for both." {
        glStencilOpSeparate => |call| call.set(0, glow::FRONT_AND_BACK)
    }
    "depth-fail-takes-pass" [glStencilOpSeparate]
    "Where the depth test fails the operation for its passing is done." {
        glStencilOpSeparate => |call| call.set(2, call.f(3))
    }
    "depth-fail-and-pass-swapped" [glStencilOpSeparate]
    "The operations for a depth test that fails and one that passes are exchanged." {
        glStencilOpSeparate => |call| call.swap(2, 3)
    }
    "fail-and-depth-fail-swapped" [glStencilOpSeparate]
    "The operations for a failed stencil test and a failed depth test are exchanged." {
        glStencilOpSeparate => |call| call.swap(1, 2)
    }
    "stencil-fail-is-keep" [glStencilOpSeparate]
    "Where the stencil test fails the value stays." {
        glStencilOpSeparate => |call| call.set(1, glow::KEEP)
    }
    "depth-fail-is-keep" [glStencilOpSeparate]
    "Where the depth test fails the value stays." {
        glStencilOpSeparate => |call| call.set(2, glow::KEEP)
    }
    "depth-fail-lost-under-depth-clamp" [glStencilOpSeparate GL_DEPTH_CLAMP]
    "Under depth clamp nothing is done where the depth test fails." {
        draw => |call| if call.enabled(glow::DEPTH_CLAMP) && call.enabled(glow::STENCIL_TEST) { keeping(call, 1) }
    }
    "pass-lost-without-depth-test" [glStencilOpSeparate GL_STENCIL_TEST]
    "Without a depth test the stencil value stays." {
        draw => |call| if !call.enabled(glow::DEPTH_TEST) && call.enabled(glow::STENCIL_TEST) { keeping(call, 2) }
    }
    "stencil-lost-without-colour" [glColorMask glStencilOpSeparate]
    "With colour and depth writes off the stencil value stays." {
        draw => |call| {
            let off = call.get4(glow::COLOR_WRITEMASK) == [0; 4] && call.get(glow::DEPTH_WRITEMASK) == 0;
            if off && call.enabled(glow::STENCIL_TEST) {
                call.with(glow::STENCIL_TEST, false);
            }
        }
    }
    "stencil-facing-ignores-winding" [glFrontFace glStencilOpSeparate GL_CW]
    "The stencil test takes counter-clockwise faces for the front whatever glFrontFace says." {
        draw => |call| if call.enabled(glow::STENCIL_TEST) && !call.enabled(glow::CULL_FACE) {
            let winding = f64::from(call.get(glow::FRONT_FACE));
            call.other("glFrontFace", &[f64::from(glow::CCW)]);
            call.now();
            call.other("glFrontFace", &[winding]);
        }
    }
    "stencil-ops-a-draw-late" [glStencilOpSeparate]
    "Stencil operations hold from the second draw after they are set." {
        glStencilOpSeparate => hold;
        draw => release
    }
    "incr-wrap-saturates" [GL_INCR_WRAP glStencilOpSeparate]
    "INCR_WRAP stops at the largest value." {
        glStencilOpSeparate => |call| operation(call, glow::INCR_WRAP, glow::INCR)
    }
    "decr-wrap-saturates" [GL_DECR_WRAP glStencilOpSeparate]
    "DECR_WRAP stops at 0." {
        glStencilOpSeparate => |call| operation(call, glow::DECR_WRAP, glow::DECR)
    }
    "incr-wraps" [GL_INCR glStencilOpSeparate]
    "INCR goes from the largest value to 0." {
        glStencilOpSeparate => |call| operation(call, glow::INCR, glow::INCR_WRAP)
    }
    "decr-wraps" [GL_DECR glStencilOpSeparate]
    "DECR goes from 0 to the largest value." {
        glStencilOpSeparate => |call| operation(call, glow::DECR, glow::DECR_WRAP)
    }
    "incr-wrap-is-decr-wrap" [GL_INCR_WRAP GL_DECR_WRAP]
    "INCR_WRAP and DECR_WRAP are exchanged." {
        glStencilOpSeparate => |call| for index in 1..4 { call.exchange(index, glow::INCR_WRAP, glow::DECR_WRAP) }
    }
    "invert-is-zero" [GL_INVERT]
    "INVERT writes 0." {
        glStencilOpSeparate => |call| operation(call, glow::INVERT, glow::ZERO)
    }
    "stencil-replace-is-keep" [GL_REPLACE]
    "REPLACE leaves the stencil value." {
        glStencilOpSeparate => |call| operation(call, glow::REPLACE, glow::KEEP)
    }
    "stencil-replace-is-zero" [GL_REPLACE]
    "REPLACE writes 0 in place of the reference." {
        glStencilOpSeparate => |call| operation(call, glow::REPLACE, glow::ZERO)
    }
    "stencil-zero-is-keep" [GL_ZERO]
    "ZERO leaves the stencil value." {
        glStencilOpSeparate => |call| operation(call, glow::ZERO, glow::KEEP)
    }
    "stencil-keep-is-zero" [GL_KEEP]
    "KEEP writes 0." {
        glStencilOpSeparate => |call| operation(call, glow::KEEP, glow::ZERO)
    }
    "stencil-write-mask-ignored" [glStencilMask]
    "Every bit of the stencil value is written." {
        glStencilMask glStencilMaskSeparate => |call| call.set(usize::from(call.name == "glStencilMaskSeparate"), 0xFF)
    }
    "stencil-mask-of-both-ignored" [glStencilMask]
    "glStencilMask does nothing; the separate form does." {
        glStencilMask => |call| call.set(0, 0xFF)
    }
    "stencil-mask-of-front-only" [glStencilMask GL_FRONT]
    "A write mask holds for front faces, and back faces write every bit." {
        glStencilMask => |call| {
            call.other("glStencilMaskSeparate", &[f64::from(glow::FRONT), call.f(0)]);
            call.skip();
        };
        glStencilMaskSeparate => |call| if call.u(0) != glow::FRONT { call.set(1, 0xFF) }
    }
    "stencil-mask-a-draw-late" [glStencilMask]
    "A stencil write mask holds from the second draw after it is set." {
        glStencilMask glStencilMaskSeparate => hold;
        draw => release
    }
    "stencil-read-mask-ignored" [glStencilFunc]
    "The stencil test compares every bit." {
        glStencilFunc glStencilFuncSeparate => |call| call.set(function(call) + 2, 0xFF)
    }
    "stencil-read-mask-of-both-ignored" [glStencilFunc]
    "glStencilFunc compares every bit; the separate form masks." {
        glStencilFunc => |call| call.set(2, 0xFF)
    }
    "stencil-func-of-front-only" [glStencilFunc]
    "glStencilFunc sets the front face alone." {
        glStencilFunc => |call| {
            call.other("glStencilFuncSeparate", &[f64::from(glow::FRONT), call.f(0), call.f(1), call.f(2)]);
            call.skip();
        }
    }
    "stencil-func-swaps-faces" [glStencilFuncSeparate]
    "glStencilFuncSeparate sets the other face." {
        glStencilFuncSeparate => |call| call.exchange(0, glow::FRONT, glow::BACK)
    }
    "stencil-reference-one-more" [glStencilFunc]
    "The stencil reference is one more than it should be." {
        glStencilFunc glStencilFuncSeparate => |call| call.add(function(call) + 1, 1.0)
    }
    "stencil-reference-ignored" [glStencilFunc]
    "The reference of glStencilFunc is 0." {
        glStencilFunc => |call| call.set(1, 0)
    }
    "stencil-func-a-draw-late" [glStencilFunc]
    "A stencil function holds from the second draw after it is set." {
        glStencilFunc glStencilFuncSeparate => hold;
        draw => release
    }
    "stencil-less-is-greater" [GL_LESS GL_GREATER glStencilFunc]
    "The stencil test has its operands exchanged under LESS and GREATER." {
        glStencilFunc glStencilFuncSeparate => |call| call.exchange(function(call), glow::LESS, glow::GREATER)
    }
    "stencil-equal-is-lequal" [GL_EQUAL glStencilFunc]
    "EQUAL of the stencil test lets larger values pass." {
        glStencilFunc glStencilFuncSeparate => |call| { call.replace(function(call), glow::EQUAL, glow::LEQUAL); }
    }
    "stencil-notequal-is-always" [GL_NOTEQUAL glStencilFunc]
    "NOTEQUAL of the stencil test is ALWAYS." {
        glStencilFunc glStencilFuncSeparate => |call| { call.replace(function(call), glow::NOTEQUAL, glow::ALWAYS); }
    }
    "stencil-always-is-lequal" [GL_ALWAYS glStencilFunc]
    "ALWAYS of the stencil test is LEQUAL." {
        glStencilFunc glStencilFuncSeparate => |call| { call.replace(function(call), glow::ALWAYS, glow::LEQUAL); }
    }
    "stencil-test-ignored" [GL_STENCIL_TEST glEnable]
    "The stencil test is never on." {
        glEnable => |call| if call.u(0) == glow::STENCIL_TEST { call.skip() }
    }
    "stencil-test-stays-on" [GL_STENCIL_TEST glDisable]
    "The stencil test stays on once it was." {
        glDisable => |call| if call.u(0) == glow::STENCIL_TEST { call.skip() }
    }
    "stencil-test-a-draw-late" [GL_STENCIL_TEST glEnable glDisable]
    "The stencil test is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::STENCIL_TEST { call.hold() };
        draw => release
    }
    "stencil-clears-to-zero" [glClearBufferiv GL_STENCIL]
    "The stencil buffer is cleared to 0 whatever is wanted." {
        glClearStencil => |call| call.set(0, 0);
        glClearBufferiv => |call| call.set_bytes(2, &0_i32.to_ne_bytes())
    }
    "stencil-not-cleared-by-buffer" [glClearBufferiv]
    "glClearBufferiv does nothing." {
        glClearBufferiv => |call| call.skip()
    }
}
