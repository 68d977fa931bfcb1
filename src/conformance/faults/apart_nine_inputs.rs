//! Faults of a ninth measure: attributes, uniforms, draws, names that are used again and the fixed-function pipeline.

use glow::HasContext;

use super::{Call, Source, Stage};

/// Draws of a program whose matrices fit into the ring of constants.
const RING: f64 = 3.0;
/// Bits of the draw that was made last: vertex array, count and offset.
const LAST: [(u32, u32); 3] = [(90, 0), (90, 1), (90, 2)];

/// Vectors of three components whose components have ten bits.
fn packed_directions(source: &Source) -> Option<String> {
    const DECLARED: &str = "in vec3 ";
    if source.stage != Stage::Vertex || source.version < 130 {
        return None;
    }
    let is_attribute = |line: &str| line.starts_with("layout(location") || line.starts_with(DECLARED);
    let packed = |line: &str| match line.split_once(DECLARED) {
        Some((before, name)) if is_attribute(line) && name.trim_end().ends_with(';') => {
            let name = name.trim_end().trim_end_matches(';');
            format!("{before}in vec3 driver_{name}; vec3 {name} = floor(driver_{name} * 511.0 + 0.5) / 511.0;\n")
        }
        _ => format!("{line}\n"),
    };
    let text: String = source.text.lines().map(packed).collect();
    (text.contains("in vec3 driver_")).then_some(text)
}

/// Leaves out a draw that differs from the one before in uniforms alone.
fn leave_out_again(call: &mut Call) {
    let offset = call.pointer(3) as usize as f64;
    let now = [f64::from(call.get(glow::VERTEX_ARRAY_BINDING)), f64::from(call.u(1)), offset];
    if now[0] == 0.0 {
        return;
    }
    if call.kept((91, 0)) != 0.0 && LAST.map(|key| call.kept(key)) == now {
        call.skip();
    }
    for (key, value) in LAST.into_iter().zip(now) {
        call.keep(key, value);
    }
    call.keep((91, 0), 1);
}

/// Binds a framebuffer; a new one has the draw buffers that its name had before.
fn bind_with_old_buffers(call: &mut Call) {
    call.now();
    let key = call.u(1);
    let is_drawn_into = call.u(0) != glow::READ_FRAMEBUFFER;
    if is_drawn_into && key != 0 && call.kept((91, key)) != 0.0 {
        call.keep((91, key), 0);
        if call.kept((92, key)) != 0.0 {
            // SAFETY: the context is current, and a framebuffer object is bound.
            unsafe { call.gl().draw_buffers(&[glow::NONE]) };
        }
    }
}

faults! {
    // Arrays of three floats are taken for directions, and repacked as vectors of 10 bits are half the size.
    "directions-fetched-as-10-bits" [glVertexAttribPointer GL_FLOAT]
    "Attributes of three floats have components of 10 bits with a sign." { text packed_directions }
    // Constants are written to a ring for each program, whose end is not looked at.
    "matrices-after-third-draw-lost" [glUniformMatrix4fv]
    "After a program's third draw its matrices stay, until a program is used again." {
        glUseProgram => |call| call.keep((90, 0), 0);
        glUniformMatrix4fv => |call| if call.kept((90, 0)) >= RING {
            call.skip();
        };
        draw => |call| {
            let drawn = call.kept((90, 0));
            call.keep((90, 0), drawn + 1.0);
        }
    }
    // A filter of calls that repeat themselves for games that draw all twice; it looks at state, and not at uniforms.
    "same-draw-twice-dropped" [glDrawElements]
    "A draw with the indices of the one before is left out where only uniforms changed between." {
        glDrawElements => leave_out_again;
        glUseProgram glBindFramebuffer glEnable glDisable glDepthFunc glDepthMask glColorMask glCullFace glFrontFace glScissor
        glBindTexture clear => |call| call.keep((91, 0), 0)
    }
    // Names of deleted framebuffers are given again, and what is kept by name is not all set back.
    "reused-framebuffer-names-keep-draw-buffers" [glGenFramebuffers glDrawBuffers]
    "A framebuffer under the name of a deleted one without draw buffers has none." {
        glGenFramebuffers => |call| {
            call.now();
            for framebuffer in call.integers(1, call.u(0) as usize) {
                let key = framebuffer as u32;
                let was_named = call.kept((90, key));
                call.keep((91, key), was_named);
                call.keep((90, key), 1);
            }
        };
        glBindFramebuffer => bind_with_old_buffers;
        glDrawBuffers => |call| {
            let key = call.get(glow::DRAW_FRAMEBUFFER_BINDING) as u32;
            let is_none = call.integers(1, 1) == [glow::NONE as i32];
            call.keep((92, key), u32::from(is_none));
        }
    }
    // Culling and winding are one register, which is built from the side alone when that is set.
    "cull-face-resets-winding" [glCullFace glFrontFace]
    "Setting the side that is culled makes front faces wind counter-clockwise." {
        glCullFace => |call| {
            call.now();
            call.other("glFrontFace", &[f64::from(glow::CCW)]);
        }
    }
    // The old chip's register for the reference, of which the emulation keeps the width.
    "alpha-reference-of-four-bits" [glAlphaFunc] "The alpha test's reference has 4 bits, rounded down." {
        glAlphaFunc => |call| {
            let reference = (call.f(1) * 15.0).floor() / 15.0;
            call.set(1, reference);
        }
    }
    // The factor of the blender is read as it was when blending was turned on.
    "blend-func-taken-when-turned-on" [glBlendFuncSeparate glEnable]
    "Blend factors that are set while blending is on are used from the next time it is turned on." {
        glBlendFuncSeparate => |call| if call.enabled(glow::BLEND) {
            for index in 0..4 {
                call.keep((90, index), call.f(index as usize));
            }
            call.keep((91, 0), 1);
            call.skip();
        };
        glEnable => |call| if call.u(0) == glow::BLEND && call.kept((91, 0)) != 0.0 {
            call.keep((91, 0), 0);
            call.other("glBlendFuncSeparate", &[0, 1, 2, 3].map(|index| call.kept((90, index))));
        }
    }
}
