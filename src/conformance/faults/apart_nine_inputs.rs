//! Faults of a ninth measure: attributes, uniforms, draws, names that are used again and the fixed-function pipeline.

use super::{Call, Source, Stage};

/// Draws of a program whose matrices fit into the ring of constants.
const RING: f64 = 3.0;
/// GL_POSITION.
const POSITION: u32 = 0x1203;
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
    // Positions of lights are fixed point with four bits behind the point.
    "light-positions-in-sixteenths" [glLightfv GL_POSITION] "Positions of lights are rounded to sixteenths." {
        glLightfv => |call| if call.u(1) == POSITION {
            let position = call.floats(2, 4).into_iter().map(|number| (number * 16.0).round() / 16.0).collect();
            call.set_floats(2, position);
        }
    }
    // A uniform of three components is taken for a colour, and colours are not below 0.
    "uniform-vec3-not-below-zero" [glUniform3f glUniform3fv] "Components of a uniform vec3 that are below 0 are 0." {
        glUniform3f => |call| for index in 1..4 {
            let number = call.f(index).max(0.0);
            call.set(index, number);
        };
        glUniform3fv => |call| {
            let numbers = call.floats(2, 3 * call.u(1) as usize).into_iter().map(|number| number.max(0.0)).collect();
            call.set_floats(2, numbers);
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
