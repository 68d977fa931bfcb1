//! Faults of a tenth measure: rasters, depth, offsets and culling.

use super::apart_shaders::HALVES;
use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, after_main, text};

/// GL_CULL_FACE_MODE and GL_FRONT_FACE.
const CULL_FACE_MODE: u32 = 0x0B45;
const FRONT_FACE: u32 = 0x0B46;

/// Draws without an offset.
fn draw_plainly(call: &mut Call, plainly: bool) {
    if plainly && call.enabled(glow::POLYGON_OFFSET_FILL) {
        call.with(glow::POLYGON_OFFSET_FILL, false);
    }
}

/// Draws into a framebuffer without colour no farther than the last with colour reached.
fn draw_within_last(call: &mut Call) {
    let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
    if call.get(glow::DRAW_FRAMEBUFFER_BINDING) == 0 || call.attached(glow::COLOR_ATTACHMENT0, kind) != 0 {
        let [_, _, width, height] = call.get4(glow::VIEWPORT);
        call.keep((90, 0), width);
        call.keep((90, 1), height);
        return;
    }
    let [width, height] = [0, 1].map(|index| call.kept((90, index)));
    if width > 0.0 && !call.enabled(glow::SCISSOR_TEST) {
        let held = call.get4(glow::SCISSOR_BOX).map(f64::from);
        call.other("glScissor", &[0.0, 0.0, width, height]);
        call.with(glow::SCISSOR_TEST, true);
        call.other("glScissor", &held);
    }
}

/// Vertices far beside the picture that are no place.
fn without_far_vertices(source: &Source) -> Option<String> {
    if source.version < 330 {
        return None;
    }
    let statement = "if (gl_Position.w > 0.0 && max(abs(gl_Position.x), abs(gl_Position.y)) > 8.0 * gl_Position.w)
        gl_Position = vec4(uintBitsToFloat(0x7FC00000u));";
    after_main(source, Stage::Vertex, statement)
}

/// Clip distances that are half floats.
fn short_distances(source: &Source) -> Option<String> {
    let shortened = |line: &str| match line.split_once(" = ") {
        Some((place, value)) if place.trim_start().starts_with("gl_ClipDistance[") && value.ends_with(';') => {
            format!("{place} = apart_half({});\n", value.trim_end_matches(';'))
        }
        _ => format!("{line}\n"),
    };
    let text: String = source.text.lines().map(shortened).collect();
    (source.stage == Stage::Vertex && source.version >= 130 && source.has("gl_ClipDistance"))
        .then(|| Source { text, ..*source }.with(HALVES))
}

/// `discard` does nothing where the driver says so.
fn discards_unless_told(source: &Source) -> Option<String> {
    with_state(source, "", "discard", "#define discard if (driver_state.x < 0.5) discard")
}

faults! {
    // The register holds factor and units, and the cache compares the units alone.
    "offset-compared-by-units" [glPolygonOffset] "An offset of the units before keeps the factor before." {
        glPolygonOffset => |call| {
            let units = call.f(1);
            if call.kept((91, 0)) != 0.0 && call.kept((90, 0)) == units {
                call.skip();
            }
            call.keep((90, 0), units);
            call.keep((91, 0), 1);
        }
    }
    // Clamp and offset are one field, and the clamp's value wins.
    "offset-lost-under-depth-clamp" [glPolygonOffset GL_DEPTH_CLAMP] "Under depth clamp nothing is offset." {
        draw => |call| {
            let clamps = call.enabled(glow::DEPTH_CLAMP);
            draw_plainly(call, clamps);
        }
    }
    // The factor is a whole number in the register: the old API had no other.
    "offset-factor-whole" [glPolygonOffset] "The factor of an offset is rounded to a whole number." {
        glPolygonOffset => |call| {
            let factor = call.f(0).round();
            call.set(0, factor);
        }
    }
    // Winding and side are turned into one bit, and two turns into none at all.
    "mirrored-fronts-not-culled" [glCullFace GL_FRONT glFrontFace GL_CW]
    "Front faces that wind clockwise are not culled." {
        draw => |call| {
            let is_both = call.get(CULL_FACE_MODE) as u32 == glow::FRONT && call.get(FRONT_FACE) as u32 == glow::CW;
            if call.enabled(glow::CULL_FACE) && is_both {
                call.with(glow::CULL_FACE, false);
            }
        }
    }
    // The area to draw is the smallest of the colour images, and with none it is not set.
    "bare-framebuffers-as-large-as-the-last" [glBindFramebuffer GL_DEPTH_ATTACHMENT glViewport]
    "Without a colour image nothing beyond the size of the last colour image is drawn or cleared." {
        draw clear => draw_within_last
    }
    // What reaches far beyond the window is taken for garbage and dropped, not clipped.
    "triangles-beyond-guard-band-lost" [gl_Position] "Triangles with a vertex eight windows away are lost."
    { text without_far_vertices }
    // Distances travel as half floats.
    "clip-distances-of-halves" [gl_ClipDistance GL_CLIP_DISTANCE0] "Clip distances have eleven bits."
    { text short_distances }
    // Pixels are killed before the blender, which has its own list of those that live.
    "discard-ignored-while-blending" [discard GL_BLEND] "Where colours are blended, fragments that are discarded are drawn." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, discards_unless_told);
        draw => |call| {
            let blends = call.enabled(glow::BLEND);
            set_state(call, [f32::from(blends), 0.0, 0.0, 0.0]);
        }
    }
    // Only the far end of the range is compared before it is sent.
    "depth-ranges-compared-by-far" [glDepthRangef] "A depth range with the far end before keeps the near end before." {
        glDepthRangef => |call| {
            let far = call.f(1);
            if call.kept((91, 0)) != 0.0 && call.kept((90, 0)) == far {
                call.skip();
            }
            call.keep((90, 0), far);
            call.keep((91, 0), 1);
        }
    }
    // The rectangle of a clear winds the usual way, and the register is not set back.
    "clears-reset-winding" [glClearBufferfv glFrontFace GL_CW] "After a clear front faces wind counter-clockwise." {
        clear => |call| {
            call.now();
            call.other("glFrontFace", &[f64::from(glow::CCW)]);
        }
    }
}
