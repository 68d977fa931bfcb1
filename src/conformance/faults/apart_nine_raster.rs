//! Faults of a ninth measure: rasters, depth, stencil, blending and clears.

use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, after_main, text, words};

/// Statements after main() of fragment shaders without a depth of their own, which see the driver's state.
fn after_fragments(source: &Source, statement: &str) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    if source.has("gl_FragDepth") {
        return None;
    }
    let text = after_main(source, Stage::Fragment, statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

/// Depths without the part of the offset that belongs to slopes beyond a 256th.
fn bounded_slopes(source: &Source) -> Option<String> {
    let statement = "float slope = max(abs(dFdx(gl_FragCoord.z)), abs(dFdy(gl_FragCoord.z)));
    gl_FragDepth = gl_FragCoord.z - driver_state.x * max(slope - 1.0 / 256.0, 0.0);";
    after_fragments(source, statement)
}

/// Depths of four pixels that are the first one's, in shaders that discard.
fn depths_of_four(source: &Source) -> Option<String> {
    if !source.has("discard") || source.has("gl_FragDepth") || source.version < 130 {
        return None;
    }
    let statement = "vec2 beside = mod(floor(gl_FragCoord.xy), 2.0);
    gl_FragDepth = gl_FragCoord.z - beside.x * dFdx(gl_FragCoord.z) - beside.y * dFdy(gl_FragCoord.z);";
    after_main(source, Stage::Fragment, statement)
}

/// Black fragments that are gone where colours are blended.
fn without_black(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let name = output(source)?;
    let statement = format!("if (driver_state.x > 0.5 && {name}.rgb == vec3(0.0)) discard;");
    let text = after_main(source, Stage::Fragment, &statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

/// Name of a fragment shader's colour.
pub(super) fn output(source: &Source) -> Option<&str> {
    let is_output = |line: &str| line.trim_start().trim_start_matches("EXACT ").starts_with("out vec4 ");
    words(source.text.lines().find(|line| is_output(line))?.split_once("vec4 ")?.1).next()
}

/// Colours that have six bits where they are blended.
fn short_sources(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let name = output(source)?;
    let statement =
        format!("if (driver_state.x > 0.5) {name}.rgb = floor(clamp({name}.rgb, 0.0, 1.0) * 63.0 + 0.5) / 63.0;");
    let text = after_main(source, Stage::Fragment, &statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

/// Fragments of bins that have no number.
fn without_late_bins(source: &Source) -> Option<String> {
    let statement = "vec2 bin = floor(gl_FragCoord.xy / 32.0);
    if (bin.y * ceil(driver_state.x / 32.0) + bin.x > 127.5) discard;";
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let text = after_main(source, Stage::Fragment, statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

/// Clears to a colour; alpha is the last clear's if the other components are.
fn clear_by_three(call: &mut Call) {
    if call.u(0) != glow::COLOR {
        return;
    }
    let mut color = call.floats(2, 4);
    if color.len() == 4 {
        let last = call.keep_list((90, 0), color.clone());
        if let Some(last) = last.filter(|last| last[..3] == color[..3]) {
            color[3] = last[3];
            call.keep_list((90, 0), last);
            call.set_floats(2, color);
        }
    }
}

faults! {
    // The slope that the offset is made of has eight bits behind the point and none before it.
    "slope-of-offset-saturates" [glPolygonOffset] "The slope that the offset's factor multiplies is at most a 256th." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, bounded_slopes);
        draw => |call| {
            let factor = if call.enabled(glow::POLYGON_OFFSET_FILL) { call.float(glow::POLYGON_OFFSET_FACTOR) } else { 0.0 };
            set_state(call, [factor as f32, 0.0, 0.0, 0.0]);
        }
    }
    // Depths that are written after the shader are sent for four pixels at a time, with one value.
    "late-depths-of-four-pixels" [discard GL_DEPTH_TEST]
    "Where a shader discards, four pixels have the depth of the first of them." { text depths_of_four }
    // Black adds nothing, so it need not be sent; but not every function adds.
    "black-fragments-not-blended" [GL_BLEND GL_DST_COLOR GL_ONE_MINUS_SRC_ALPHA] "Black fragments are dropped while blending." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, without_black);
        draw => |call| {
            let blends = call.enabled(glow::BLEND);
            set_state(call, [if blends { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
        }
    }
    // Test and box are one command, which is sent when the box is set.
    "scissor-on-only-with-new-box" [GL_SCISSOR_TEST glScissor]
    "The scissor test that is turned on begins when a box is set." {
        glEnable => |call| if call.u(0) == glow::SCISSOR_TEST {
            call.keep((90, 0), 1);
            call.skip();
        };
        glDisable => |call| if call.u(0) == glow::SCISSOR_TEST {
            call.keep((90, 0), 0);
        };
        glScissor => |call| {
            call.now();
            if call.kept((90, 0)) != 0.0 {
                call.other("glEnable", &[f64::from(glow::SCISSOR_TEST)]);
            }
        }
    }
    // A clear opens the mask in the register, and the mask is put into it with the function.
    "stencil-mask-after-clear-lost" [glStencilMask glClearBufferiv]
    "The write mask that is set after a clear of stencil values waits for the next stencil function." {
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL {
            call.now();
            call.keep((90, 0), 1);
        };
        glStencilMask => |call| if call.kept((90, 0)) != 0.0 {
            call.keep((91, 0), call.f(0));
            call.keep((90, 0), 2);
            call.skip();
        };
        glStencilFunc glStencilFuncSeparate => |call| {
            if call.kept((90, 0)) == 2.0 {
                let mask = call.kept((91, 0));
                call.other("glStencilMask", &[mask]);
            }
            call.keep((90, 0), 0);
        }
    }
    // Sources go through the stage that dithers, which keeps six bits, and it is passed by only without blending.
    "blended-sources-of-six-bits" [GL_BLEND] "Colours that are blended have six bits." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, short_sources);
        draw => |call| {
            let blends = call.enabled(glow::BLEND);
            set_state(call, [if blends { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
        }
    }
    // Bins of 32 pixels are numbered with seven bits, and what has no number is not drawn.
    "bins-beyond-128-lost" [glViewport] "Fragments beyond the first 128 squares of 32 pixels are lost." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, without_late_bins);
        draw => |call| {
            let viewport = call.get4(glow::VIEWPORT);
            set_state(call, [viewport[2] as f32, 0.0, 0.0, 0.0]);
        }
    }
    // Clear colours are found in a table by their first three components.
    "clear-colors-compared-without-alpha" [glClearBufferfv]
    "A clear to the red, green and blue of the last clear has its alpha too." { glClearBufferfv => clear_by_three }
}
