//! Faults of a seventh measure: framebuffers, clears, rasters, depth, stencil and blending.

use glow::HasContext;

use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, Value, after_main, text};

/// Pixels of a side of a tile of memory on the chip.
const TILE: i32 = 64;
/// Clip distance that is free for the driver.
const OWN_DISTANCE: u32 = 6;

/// Tests whether a framebuffer object without colour is drawn into.
pub(super) fn is_bare(call: &Call) -> bool {
    let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
    call.get(glow::DRAW_FRAMEBUFFER_BINDING) != 0 && call.attached(glow::COLOR_ATTACHMENT0, kind) == 0
}

/// Notes the scissor that a draw is made under.
fn note_scissor(call: &mut Call) {
    let on = call.enabled(glow::SCISSOR_TEST);
    call.keep((60, 0), if on { 2 } else { 1 });
    for (index, side) in (0..).zip(call.get4(glow::SCISSOR_BOX)) {
        call.keep((61, index), side);
    }
}

/// Clears under the scissor of the last draw.
fn clear_by_last_scissor(call: &mut Call) {
    let noted = call.kept((60, 0));
    if noted != 0.0 {
        let now = call.get4(glow::SCISSOR_BOX).map(f64::from);
        let last = [0, 1, 2, 3].map(|index| call.kept((61, index)));
        call.other("glScissor", &last);
        call.with(glow::SCISSOR_TEST, noted == 2.0);
        call.other("glScissor", &now);
    }
}

/// Tests whether a fragment shader writes depth alone, as the rasterizer has it.
fn is_depth_only(source: &str) -> bool {
    let is_output = |line: &str| {
        let line = line.trim_start();
        ["out ", "EXACT out ", "layout"].iter().any(|start| line.starts_with(start))
    };
    source.contains("void main(")
        && !source.lines().any(is_output)
        && !source.contains("gl_Position")
        && !["gl_FragDepth", "gl_FragColor", "gl_FragData"].iter().any(|word| source.contains(word))
}

/// Depths with the driver's own offset.
fn with_own_offset(source: &Source) -> Option<String> {
    match source.stage {
        Stage::Vertex => with_state(source, "", "", ""),
        Stage::Fragment if source.version >= 330 && is_depth_only(&source.text) => {
            let statement = "float across = dFdx(gl_FragCoord.z);
    gl_FragDepth = gl_FragCoord.z + (driver_state.x > 0.5 ? driver_state.y * abs(across) + driver_state.z : 0.0);";
            let text = after_main(source, Stage::Fragment, statement)?;
            Some(Source { text, ..*source }.with("flat in vec4 driver_state;"))
        }
        _ => None,
    }
}

/// Draws with an offset by the slope across alone.
fn offset_across(call: &mut Call) {
    let names = [glow::POLYGON_OFFSET_FACTOR, glow::POLYGON_OFFSET_UNITS];
    let [factor, units] = names.map(|name| call.float(name) as f32);
    let is_own = call.kept((61, call.get(glow::CURRENT_PROGRAM) as u32)) != 0.0;
    if is_own && factor != 0.0 && call.enabled(glow::POLYGON_OFFSET_FILL) {
        let bits = call.depth_format().0.min(24);
        set_state(call, [1.0, factor, units * 0.5_f32.powi(bits), 0.0]);
        call.with(glow::POLYGON_OFFSET_FILL, false);
    }
    set_state(call, [0.0; 4]);
}

/// Loses what lies beyond whole tiles of the colour that is drawn into again.
fn lose_beyond_tiles(call: &Call) {
    let [_, _, width, height] = call.get4(glow::VIEWPORT);
    let [across, up] = [width, height].map(|side| side / TILE * TILE);
    let gl = call.gl();
    let (scissor, on) = (call.get4(glow::SCISSOR_BOX), call.enabled(glow::SCISSOR_TEST));
    let mask = call.get4(glow::COLOR_WRITEMASK).map(|on| on != 0);
    // SAFETY: the context is current; the framebuffer has colour.
    unsafe {
        gl.enable(glow::SCISSOR_TEST);
        gl.color_mask(true, true, true, true);
        for [left, bottom, wide, high] in [[across, 0, width - across, height], [0, up, across, height - up]] {
            if wide > 0 && high > 0 {
                gl.scissor(left, bottom, wide, high);
                gl.clear_buffer_f32_slice(glow::COLOR, 0, &[0.0; 4]);
            }
        }
        gl.scissor(scissor[0], scissor[1], scissor[2], scissor[3]);
        gl.color_mask(mask[0], mask[1], mask[2], mask[3]);
        if !on {
            gl.disable(glow::SCISSOR_TEST);
        }
    }
}

/// Draws into a framebuffer, whose colour is restored first where it was drawn into before another one.
fn restore_then_draw(call: &mut Call) {
    let framebuffer = call.get(glow::DRAW_FRAMEBUFFER_BINDING) as u32;
    let is_back = call.kept((60, 0)) != 0.0 && call.kept((61, framebuffer)) != 0.0;
    if is_back && framebuffer != 0 && !is_bare(call) {
        lose_beyond_tiles(call);
    }
    call.keep((60, 0), 0);
    call.keep((61, framebuffer), 1);
}

/// A clip distance to the far plane, where the driver says so.
fn clipped_at_far(source: &Source) -> Option<String> {
    let redeclares = source.text.contains("out float gl_ClipDistance[") && !source.has("CLIP_PLANES");
    if source.stage != Stage::Vertex || redeclares {
        return None;
    }
    let statement = format!(
        "\n#ifndef CLIP_PLANES
    gl_ClipDistance[{OWN_DISTANCE}] = driver_state.x > 0.5 ? gl_Position.w - gl_Position.z : 1.0;
#endif\n"
    );
    with_state(source, &statement, "", "")
}

/// The image whose stencil values are drawn into.
fn stencil_image(call: &Call) -> u32 {
    call.attached(glow::STENCIL_ATTACHMENT, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) as u32
}

/// Passes where the stencil value is what it was cleared to, if no operation for a pass has been done since.
fn draw_by_coarse_stencil(call: &mut Call) {
    if !call.enabled(glow::STENCIL_TEST) {
        return;
    }
    let image = stencil_image(call);
    let names = [glow::STENCIL_FUNC, glow::STENCIL_REF, glow::STENCIL_VALUE_MASK];
    let [function, reference, mask] = names.map(|name| f64::from(call.get(name)));
    let is_clear = call.kept((61, image)) == 1.0 && call.kept((60, image)) == reference;
    if function as u32 == glow::EQUAL && is_clear {
        call.other("glStencilFunc", &[f64::from(glow::ALWAYS), reference, mask]);
        call.now();
        call.other("glStencilFunc", &[function, reference, mask]);
    }
    let passes = [glow::STENCIL_PASS_DEPTH_PASS, glow::STENCIL_BACK_PASS_DEPTH_PASS];
    if passes.iter().any(|name| call.get(*name) as u32 != glow::KEEP) {
        call.keep((61, image), 0);
    }
}

/// Draws without colour right after a framebuffer of the same size that has none.
fn draw_without_color(call: &mut Call) {
    let (bare, [_, _, width, height]) = (is_bare(call), call.get4(glow::VIEWPORT));
    if !bare && call.kept((60, 0)) != 0.0 && [61, 62].map(|key| call.kept((key, 0))) == [width, height].map(f64::from) {
        let mask = call.get4(glow::COLOR_WRITEMASK).map(f64::from);
        call.other("glColorMask", &[0.0; 4]);
        call.now();
        call.other("glColorMask", &mask);
    }
    call.keep((60, 0), u32::from(bare));
    call.keep((61, 0), width);
    call.keep((62, 0), height);
}

faults! {
    // State is sent to the hardware before draws, and a clear goes with what is there.
    "clears-under-scissor-of-last-draw" [glClearBufferfv glClearBufferiv GL_SCISSOR_TEST]
    "A clear is bounded by the scissor of the last draw, whatever was set since." {
        draw => note_scissor;
        clear => clear_by_last_scissor
    }
    // What adds nothing of the stored colour does not need it: the test looks at one of the two factors.
    "blending-off-without-stored-factor" [glBlendFuncSeparate GL_DST_COLOR GL_ZERO]
    "Nothing is blended where the factor of the stored colour is ZERO, though the other factor is DST_COLOR." {
        draw => |call| if call.enabled(glow::BLEND) && call.get(glow::BLEND_DST_RGB) as u32 == glow::ZERO {
            call.with(glow::BLEND, false);
        }
    }
    // The set-up unit has the slope across at hand, and the larger of both was left for later.
    "offset-by-slope-across-alone" [glPolygonOffset]
    "The factor of an offset multiplies the slope along x alone." {
        glCreateProgram => |call| {
            call.now();
            if let Value::Unsigned(program) = call.result { call.keep((61, program), 0) }
        };
        glCreateShader => text::note;
        glShaderSource => |call| {
            let is_own = call.kept((1, call.u(0))) as u32 == glow::FRAGMENT_SHADER && is_depth_only(&text::joined(call));
            call.keep((60, call.u(0)), u32::from(is_own));
            text::rewrite(call, with_own_offset);
        };
        glAttachShader => |call| {
            let either = call.kept((61, call.u(0))).max(call.kept((60, call.u(1))));
            call.keep((61, call.u(0)), either);
        };
        draw => offset_across
    }
    // Tiles are loaded again where a framebuffer is drawn into once more, and their number is rounded down.
    "colors-restored-in-whole-tiles" [glBindFramebuffer]
    "A framebuffer that is drawn into again after another one has lost what lies beyond whole tiles of 64 pixels." {
        glGenFramebuffers => |call| {
            call.now();
            for framebuffer in call.integers(1, call.u(0) as usize) { call.keep((61, framebuffer as u32), 0) }
        };
        glBindFramebuffer => |call| if call.get(glow::DRAW_FRAMEBUFFER_BINDING) != call.i(1) { call.keep((60, 0), 1) };
        glClearBufferfv => |call| if call.u(0) == glow::COLOR { call.keep((60, 0), 0) };
        draw => restore_then_draw
    }
    // The clipper has one switch for each plane, and depth clamp was wired to the near one.
    "far-plane-clips-under-depth-clamp" [GL_DEPTH_CLAMP]
    "Under depth clamp what lies beyond the far plane is clipped." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, clipped_at_far);
        draw => |call| {
            let clamps = call.enabled(glow::DEPTH_CLAMP) && call.get(glow::CURRENT_PROGRAM) != 0;
            set_state(call, [if clamps { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
            if clamps { call.with(glow::CLIP_DISTANCE0 + OWN_DISTANCE, true) }
        }
    }
    // A coarse stencil says which tiles are as they were cleared, and only operations for a pass tell it.
    "coarse-stencil-told-by-passes-alone" [GL_STENCIL_TEST glStencilOpSeparate GL_EQUAL]
    "EQUAL to the cleared stencil value passes everywhere after draws that changed values only where depth failed." {
        glClearBufferiv => |call| if call.u(0) == glow::STENCIL {
            let (image, value) = (stencil_image(call), call.integers(2, 1)[0]);
            call.keep((60, image), value);
            call.keep((61, image), 1);
        };
        draw => draw_by_coarse_stencil
    }
    // The fragment stage is chosen for the images that it writes, and is chosen again at once where the viewport is another.
    "no-color-right-after-bare-framebuffers" [glBindFramebuffer glDrawBuffers]
    "The first draw after draws into a framebuffer without colour, under the same viewport, writes none." {
        draw => draw_without_color
    }
}
