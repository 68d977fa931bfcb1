//! Faults of the depth test, of depth writes, the depth range, depth clamp and clears of depth.

use super::{Call, hold, release};

/// Puts a depth function where another is wanted.
fn function(call: &mut Call, from: u32, to: u32) {
    call.replace(0, from, to);
}

faults! {
    "depth-less-is-lequal" [glDepthFunc GL_LESS]
    "LESS lets equal depths pass." { glDepthFunc => |call| function(call, glow::LESS, glow::LEQUAL) }
    "depth-lequal-is-less" [glDepthFunc GL_LEQUAL]
    "LEQUAL rejects equal depths." { glDepthFunc => |call| function(call, glow::LEQUAL, glow::LESS) }
    "depth-equal-is-lequal" [glDepthFunc GL_EQUAL]
    "EQUAL lets nearer depths pass." { glDepthFunc => |call| function(call, glow::EQUAL, glow::LEQUAL) }
    "depth-equal-is-gequal" [glDepthFunc GL_EQUAL]
    "EQUAL lets farther depths pass." { glDepthFunc => |call| function(call, glow::EQUAL, glow::GEQUAL) }
    "depth-greater-is-gequal" [glDepthFunc GL_GREATER]
    "GREATER lets equal depths pass." { glDepthFunc => |call| function(call, glow::GREATER, glow::GEQUAL) }
    "depth-gequal-is-greater" [glDepthFunc GL_GEQUAL]
    "GEQUAL rejects equal depths." { glDepthFunc => |call| function(call, glow::GEQUAL, glow::GREATER) }
    "depth-less-is-greater" [glDepthFunc GL_LESS GL_GREATER]
    "LESS and GREATER are exchanged." { glDepthFunc => |call| call.exchange(0, glow::LESS, glow::GREATER) }
    "depth-notequal-is-always" [glDepthFunc GL_NOTEQUAL]
    "NOTEQUAL is ALWAYS." { glDepthFunc => |call| function(call, glow::NOTEQUAL, glow::ALWAYS) }
    "depth-always-is-lequal" [glDepthFunc GL_ALWAYS]
    "ALWAYS is LEQUAL." { glDepthFunc => |call| function(call, glow::ALWAYS, glow::LEQUAL) }
    "depth-never-is-always" [glDepthFunc GL_NEVER]
    "NEVER is ALWAYS." { glDepthFunc => |call| function(call, glow::NEVER, glow::ALWAYS) }
    "depth-func-ignored" [glDepthFunc]
    "The depth function stays LESS." { glDepthFunc => |call| call.skip() }
    "depth-func-a-draw-late" [glDepthFunc]
    "A depth function holds from the second draw after it is set." {
        glDepthFunc => hold;
        draw => release
    }
    "depth-test-ignored" [GL_DEPTH_TEST glEnable]
    "The depth test is never on." { glEnable => |call| if call.u(0) == glow::DEPTH_TEST { call.skip() } }
    "depth-test-stays-on" [GL_DEPTH_TEST glDisable]
    "The depth test stays on once it was." { glDisable => |call| if call.u(0) == glow::DEPTH_TEST { call.skip() } }
    "depth-test-a-draw-late" [GL_DEPTH_TEST glEnable glDisable]
    "The depth test is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::DEPTH_TEST { call.hold() };
        draw => release
    }
    "depth-written-without-test" [GL_DEPTH_TEST glDepthMask]
    "Depth is written where the depth test is off." {
        draw => |call| if !call.enabled(glow::DEPTH_TEST) && call.get(glow::DEPTH_WRITEMASK) != 0 {
            let function = f64::from(call.get(glow::DEPTH_FUNC));
            call.other("glDepthFunc", &[f64::from(glow::ALWAYS)]);
            call.with(glow::DEPTH_TEST, true);
            call.other("glDepthFunc", &[function]);
        }
    }
    "depth-mask-ignored" [glDepthMask]
    "Depth is written whatever the mask says." { glDepthMask => |call| call.set(0, 1) }
    "depth-mask-stays-off" [glDepthMask]
    "Depth is not written again once its mask was off." {
        glDepthMask => |call| {
            if call.u(0) == 0 {
                call.keep((0, 0), 1.0);
            }
            if call.kept((0, 0)) != 0.0 {
                call.set(0, 0);
            }
        }
    }
    "depth-mask-a-draw-late" [glDepthMask]
    "A depth mask holds from the second draw after it is set." {
        glDepthMask => hold;
        draw => release
    }
    "depth-lost-without-colour" [glDepthMask glColorMask]
    "With colour writes off depth is not written." {
        draw => |call| if call.get4(glow::COLOR_WRITEMASK) == [0; 4] && call.get(glow::DEPTH_WRITEMASK) != 0 {
            call.other("glDepthMask", &[0.0]);
            call.now();
            call.other("glDepthMask", &[1.0]);
        }
    }
    "depth-written-where-stencil-fails" [GL_STENCIL_TEST glDepthMask]
    "The stencil test does not keep depth from being written." {
        draw => |call| {
            let writes = call.get(glow::DEPTH_WRITEMASK) != 0 && call.enabled(glow::DEPTH_TEST);
            if call.enabled(glow::STENCIL_TEST) && writes && call.name != "glEnd" {
                call.other("glDepthMask", &[0.0]);
                call.again();
                call.other("glDepthMask", &[1.0]);
                let [red, green, blue, alpha] = call.get4(glow::COLOR_WRITEMASK).map(f64::from);
                call.other("glColorMask", &[0.0; 4]);
                call.with(glow::STENCIL_TEST, false);
                call.other("glColorMask", &[red, green, blue, alpha]);
            }
        }
    }
    "depth-range-ignored" [glDepthRangef]
    "The depth range is [0, 1] whatever is set." { glDepthRangef glDepthRange => |call| call.skip() }
    "depth-range-f-ignored" [glDepthRangef]
    "glDepthRangef does nothing; glDepthRange does." { glDepthRangef => |call| call.skip() }
    "depth-range-swapped" [glDepthRangef]
    "Near and far of the depth range are exchanged." { glDepthRangef glDepthRange => |call| call.swap(0, 1) }
    "depth-range-sorted" [glDepthRangef]
    "A depth range whose near is beyond its far is turned." {
        glDepthRangef glDepthRange => |call| if call.f(0) > call.f(1) { call.swap(0, 1) }
    }
    "depth-range-near-ignored" [glDepthRangef]
    "The near end of the depth range is 0." { glDepthRangef glDepthRange => |call| call.set(0, 0) }
    "depth-range-far-ignored" [glDepthRangef]
    "The far end of the depth range is 1." { glDepthRangef glDepthRange => |call| call.set(1, 1) }
    "depth-range-a-draw-late" [glDepthRangef]
    "A depth range holds from the second draw after it is set." {
        glDepthRangef glDepthRange => hold;
        draw => release
    }
    "depth-clamp-ignored" [GL_DEPTH_CLAMP glEnable]
    "Near and far planes clip under depth clamp." { glEnable => |call| if call.u(0) == glow::DEPTH_CLAMP { call.skip() } }
    "depth-clamp-stays-on" [GL_DEPTH_CLAMP glDisable]
    "Depth clamp stays on once it was." { glDisable => |call| if call.u(0) == glow::DEPTH_CLAMP { call.skip() } }
    "depth-clamp-a-draw-late" [GL_DEPTH_CLAMP glEnable glDisable]
    "Depth clamp is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::DEPTH_CLAMP { call.hold() };
        draw => release
    }
    "depth-clamp-lost-without-colour" [GL_DEPTH_CLAMP glColorMask]
    "With colour writes off depth clamp is off." {
        draw => |call| if call.get4(glow::COLOR_WRITEMASK) == [0; 4] && call.enabled(glow::DEPTH_CLAMP) {
            call.with(glow::DEPTH_CLAMP, false);
        }
    }
    "depth-clears-to-one" [glClearBufferfv GL_DEPTH]
    "Depth is cleared to 1 whatever is wanted." {
        glClearDepth glClearDepthf => |call| call.set(0, 1);
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH { call.set_floats(2, vec![1.0]) }
    }
    "buffer-depth-clears-to-one" [glClearBufferfv GL_DEPTH]
    "glClearBufferfv clears depth to 1 whatever is wanted." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH { call.set_floats(2, vec![1.0]) }
    }
    "buffer-depth-not-cleared" [glClearBufferfv GL_DEPTH]
    "glClearBufferfv leaves depth as it is." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH { call.skip() }
    }
    "depth-clear-takes-stencil" [glClearBufferfv GL_DEPTH_STENCIL_ATTACHMENT]
    "Clearing the depth of a packed buffer clears its stencil too." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            call.now();
            call.other("glClear", &[f64::from(glow::STENCIL_BUFFER_BIT)]);
        };
        glClear => |call| if call.u(0) & glow::DEPTH_BUFFER_BIT != 0 { call.set(0, call.u(0) | glow::STENCIL_BUFFER_BIT) }
    }
    "stencil-clear-takes-depth" [glClearBufferiv GL_DEPTH24_STENCIL8]
    "Clearing the stencil of a packed buffer clears its depth too." {
        glClearBufferiv => |call| {
            call.now();
            call.other("glClear", &[f64::from(glow::DEPTH_BUFFER_BIT)]);
        };
        glClear => |call| if call.u(0) & glow::STENCIL_BUFFER_BIT != 0 { call.set(0, call.u(0) | glow::DEPTH_BUFFER_BIT) }
    }
    "depth-clear-ignores-mask" [glDepthMask glClearBufferfv]
    "Clears of depth ignore its write mask." {
        glClear glClearBufferfv => |call| if call.get(glow::DEPTH_WRITEMASK) == 0 {
            call.other("glDepthMask", &[1.0]);
            call.now();
            call.other("glDepthMask", &[0.0]);
        }
    }
}
