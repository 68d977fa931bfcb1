//! Faults of blending, colour masks and clears of colour.

use super::{Call, hold, release};

/// Puts a factor where another is wanted, in glBlendFuncSeparate.
fn factor(call: &mut Call, from: u32, to: u32) {
    for index in 0..4 {
        call.replace(index, from, to);
    }
}

faults! {
    "blend-ignored" [GL_BLEND glEnable]
    "Nothing is blended." { glEnable => |call| if call.u(0) == glow::BLEND { call.skip() } }
    "blend-stays-on" [GL_BLEND glDisable]
    "Blending stays on once it was." { glDisable => |call| if call.u(0) == glow::BLEND { call.skip() } }
    "blend-a-draw-late" [GL_BLEND glEnable glDisable]
    "Blending is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::BLEND { call.hold() };
        draw => release
    }
    "blend-func-a-draw-late" [glBlendFuncSeparate]
    "Factors hold from the second draw after they are set." {
        glBlendFuncSeparate => hold;
        draw => release
    }
    "alpha-blended-as-rgb" [glBlendFuncSeparate]
    "Alpha is blended by the factors of RGB." {
        glBlendFuncSeparate => |call| {
            call.set(2, call.f(0));
            call.set(3, call.f(1));
        }
    }
    "rgb-blended-as-alpha" [glBlendFuncSeparate]
    "RGB is blended by the factors of alpha." {
        glBlendFuncSeparate => |call| {
            call.set(0, call.f(2));
            call.set(1, call.f(3));
        }
    }
    "blend-factors-swapped" [glBlendFuncSeparate]
    "Factors of source and destination are exchanged." {
        glBlendFuncSeparate => |call| {
            call.swap(0, 1);
            call.swap(2, 3);
        }
    }
    "dst-alpha-is-one" [GL_DST_ALPHA]
    "The factor DST_ALPHA is 1." { glBlendFuncSeparate => |call| factor(call, glow::DST_ALPHA, glow::ONE) }
    "dst-alpha-is-src-alpha" [GL_DST_ALPHA]
    "The factor DST_ALPHA is the source's alpha." { glBlendFuncSeparate => |call| factor(call, glow::DST_ALPHA, glow::SRC_ALPHA) }
    "dst-color-is-one" [GL_DST_COLOR]
    "The factor DST_COLOR is 1." { glBlendFuncSeparate => |call| factor(call, glow::DST_COLOR, glow::ONE) }
    "dst-color-is-dst-alpha" [GL_DST_COLOR]
    "The factor DST_COLOR is the destination's alpha." { glBlendFuncSeparate => |call| factor(call, glow::DST_COLOR, glow::DST_ALPHA) }
    "src-alpha-is-one" [GL_SRC_ALPHA]
    "The factor SRC_ALPHA is 1." { glBlendFuncSeparate => |call| factor(call, glow::SRC_ALPHA, glow::ONE) }
    "src-alpha-is-dst-alpha" [GL_SRC_ALPHA]
    "The factor SRC_ALPHA is the destination's alpha." { glBlendFuncSeparate => |call| factor(call, glow::SRC_ALPHA, glow::DST_ALPHA) }
    "one-minus-src-alpha-is-one" [GL_ONE_MINUS_SRC_ALPHA]
    "The factor ONE_MINUS_SRC_ALPHA is 1." { glBlendFuncSeparate => |call| factor(call, glow::ONE_MINUS_SRC_ALPHA, glow::ONE) }
    "one-minus-src-alpha-is-zero" [GL_ONE_MINUS_SRC_ALPHA]
    "The factor ONE_MINUS_SRC_ALPHA is 0." { glBlendFuncSeparate => |call| factor(call, glow::ONE_MINUS_SRC_ALPHA, glow::ZERO) }
    "blend-one-is-src-alpha" [GL_ONE]
    "The factor ONE of the source is its alpha." { glBlendFuncSeparate => |call| { call.replace(0, glow::ONE, glow::SRC_ALPHA); } }
    "blend-destination-one-is-zero" [GL_ONE]
    "The factor ONE of the destination is 0." {
        glBlendFuncSeparate => |call| {
            call.replace(1, glow::ONE, glow::ZERO);
            call.replace(3, glow::ONE, glow::ZERO);
        }
    }
    "blend-zero-is-one" [GL_ZERO]
    "The factor ZERO is 1." { glBlendFuncSeparate => |call| factor(call, glow::ZERO, glow::ONE) }
    "blend-add-is-max" [GL_FUNC_ADD glBlendEquation]
    "The blend equation is the larger of both." {
        draw => |call| {
            call.other("glBlendEquation", &[f64::from(glow::MAX)]);
            call.now();
            call.other("glBlendEquation", &[f64::from(glow::FUNC_ADD)]);
        }
    }
    "blend-lost-for-floats" [GL_BLEND GL_RGBA32F]
    "Float images are not blended." {
        draw => |call| if call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) as u32 == glow::FLOAT {
            call.with(glow::BLEND, false);
        }
    }
    "color-mask-ignored" [glColorMask]
    "Every channel is written." {
        glColorMask => |call| for index in 0..4 { call.set(index, 1) }
    }
    "color-mask-alpha-ignored" [glColorMask]
    "Alpha is written whatever the mask says." { glColorMask => |call| if call.u(0) != 0 { call.set(3, 1) } }
    "color-mask-alpha-as-red" [glColorMask]
    "Alpha is written where red is." { glColorMask => |call| call.set(3, call.f(0)) }
    "color-mask-red-as-alpha" [glColorMask]
    "RGB is written where alpha is." { glColorMask => |call| for index in 0..3 { call.set(index, call.f(3)) } }
    "color-mask-stays-off" [glColorMask]
    "Alpha is not written again once its mask was off." {
        glColorMask => |call| {
            if call.u(0) != 0 && call.u(3) == 0 {
                call.keep((0, 0), 1.0);
            }
            if call.kept((0, 0)) != 0.0 {
                call.set(3, 0);
            }
        }
    }
    "color-mask-a-draw-late" [glColorMask]
    "A colour mask holds from the second draw after it is set." {
        glColorMask => hold;
        draw => release
    }
    "color-not-cleared-by-buffer" [glClearBufferfv GL_COLOR]
    "glClearBufferfv leaves colours as they are." {
        glClearBufferfv => |call| if call.u(0) == glow::COLOR { call.skip() }
    }
    "alpha-clears-to-one" [glClearBufferfv GL_COLOR]
    "Alpha is cleared to 1 whatever is wanted." {
        glClearColor => |call| call.set(3, 1);
        glClearBufferfv => |call| if call.u(0) == glow::COLOR {
            let [red, green, blue, _] = call.floats(2, 4)[..] else { return };
            call.set_floats(2, vec![red, green, blue, 1.0]);
        }
    }
    "buffer-alpha-clears-to-one" [glClearBufferfv GL_COLOR]
    "glClearBufferfv clears alpha to 1 whatever is wanted." {
        glClearBufferfv => |call| if call.u(0) == glow::COLOR {
            let [red, green, blue, _] = call.floats(2, 4)[..] else { return };
            call.set_floats(2, vec![red, green, blue, 1.0]);
        }
    }
    "red-and-blue-swapped-in-clears" [glClearBufferfv]
    "Clears exchange red and blue." {
        glClearColor => |call| call.swap(0, 2);
        glClearBufferfv => |call| if call.u(0) == glow::COLOR {
            let [red, green, blue, alpha] = call.floats(2, 4)[..] else { return };
            call.set_floats(2, vec![blue, green, red, alpha]);
        }
    }
    "clear-ignores-color-mask" [glColorMask glClearBufferfv]
    "Clears of colour ignore the mask." {
        glClear glClearBufferfv => |call| {
            let [red, green, blue, alpha] = call.get4(glow::COLOR_WRITEMASK).map(f64::from);
            call.other("glColorMask", &[1.0; 4]);
            call.now();
            call.other("glColorMask", &[red, green, blue, alpha]);
        }
    }
}
