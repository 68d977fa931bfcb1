//! Faults of a tenth measure: stencil values, blending and write masks.

use super::apart_nine_raster::output;
use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, after_main, text};

/// GL_STENCIL_FAIL and GL_STENCIL_PASS_DEPTH_PASS, GL_STENCIL_PASS_DEPTH_FAIL; those of back faces.
const FRONT: [u32; 3] = [0x0B94, 0x0B95, 0x0B96];
const BACK: [u32; 3] = [0x8801, 0x8802, 0x8803];

/// Draws; where depth is not written, no operation of a failed depth test is done.
fn draw_without_depth_fail(call: &mut Call) {
    if !call.enabled(glow::STENCIL_TEST) || call.get(glow::DEPTH_WRITEMASK) != 0 {
        return;
    }
    let faces = [(glow::FRONT, FRONT), (glow::BACK, BACK)];
    let held = faces.map(|(face, names)| (face, names.map(|name| f64::from(call.get(name)))));
    for (face, [fail, _, pass]) in held {
        call.other("glStencilOpSeparate", &[f64::from(face), fail, f64::from(glow::KEEP), pass]);
    }
    call.now();
    for (face, [fail, depth_fail, pass]) in held {
        call.other("glStencilOpSeparate", &[f64::from(face), fail, depth_fail, pass]);
    }
}

/// Alpha that is written alone and is 0 or 1.
fn lone_alpha(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let name = output(source)?;
    let statement = format!("if (driver_state.x > 0.5) {name}.a = step(0.5, {name}.a);");
    let text = after_main(source, Stage::Fragment, &statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

faults! {
    // A depth unit that writes nothing is turned off, and with it the signal that the test failed.
    "depth-fail-lost-without-depth-writes" [glStencilOpSeparate glDepthMask]
    "Where depth is not written a failed depth test changes no stencil value." { draw => draw_without_depth_fail }
    // The test's function is compared, and what belongs to it is not.
    "stencil-func-compared-by-function" [glStencilFunc]
    "A stencil function that is set again keeps reference and mask." {
        glStencilFunc => |call| {
            let function = call.f(0);
            if call.kept((90, 0)) == function {
                call.skip();
            }
            call.keep((90, 0), function);
        }
    }
    // The clear is a rectangle that replaces by its own reference, which stays in the register.
    "stencil-clears-set-reference" [glClearBufferiv glStencilFunc GL_STENCIL]
    "After a clear of stencil values the reference is the clear's." {
        glStencilFunc => |call| {
            call.keep((90, 0), call.f(0));
            call.keep((90, 1), call.f(2));
        };
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL && call.kept((90, 0)) != 0.0 {
            call.now();
            let value = call.integers(2, 1).first().copied().unwrap_or(0);
            let [function, mask] = [0, 1].map(|index| call.kept((90, index)));
            call.other("glStencilFunc", &[function, f64::from(value), mask]);
        }
    }
    // Blend states are found in a table by the first factor.
    "blend-func-compared-by-source" [glBlendFuncSeparate] "Blend factors with the source factor before are those before." {
        glBlendFuncSeparate => |call| {
            let source = call.f(0) + 1.0;
            if call.kept((90, 0)) == source {
                call.skip();
            }
            call.keep((90, 0), source);
        }
    }
    // What writes alpha alone goes to a plane of one bit.
    "lone-alpha-of-one-bit" [glColorMask] "Alpha that is written without colour is 0 or 1." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, lone_alpha);
        draw => |call| {
            let is_alone = call.get4(glow::COLOR_WRITEMASK) == [0, 0, 0, 1];
            set_state(call, [f32::from(is_alone), 0.0, 0.0, 0.0]);
        }
    }
}
