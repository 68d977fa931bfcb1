//! Faults of what the renderer does not use: conditions, instances, provoking vertices, centroids, blending in sRGB, positions
//! that are no numbers.

use super::{Call, Stage, anywhere, define};

/// Tests whether a buffer is filled with anything that is no number.
fn has_nan(call: &Call) -> bool {
    let is_nan = |four: &[u8; 4]| f32::from_ne_bytes(*four).is_nan();
    call.bytes(2, call.u(1) as usize).as_chunks::<4>().0.iter().any(is_nan)
}

faults! {
    "condition-ignored" [glBeginConditionalRender glEndConditionalRender]
    "All is drawn whatever the condition." { glBeginConditionalRender glEndConditionalRender => |call| call.skip() }
    "condition-of-draws-alone" [glBeginConditionalRender]
    "Clears are done whatever the condition." {
        glBeginConditionalRender => |call| {
            let (query, mode) = (call.f(0), call.f(1));
            call.keep((0, 0), query);
            call.keep((0, 1), mode);
        };
        glEndConditionalRender => |call| call.keep((0, 0), 0.0);
        clear => |call| {
            let (query, mode) = (call.kept((0, 0)), call.kept((0, 1)));
            if query != 0.0 {
                call.other("glEndConditionalRender", &[]);
                call.now();
                call.other("glBeginConditionalRender", &[query, mode]);
            }
        }
    }
    "condition-turned" [glBeginConditionalRender]
    "QUERY_WAIT is QUERY_WAIT_INVERTED and the other way round." {
        glBeginConditionalRender => |call| call.exchange(1, glow::QUERY_WAIT, glow::QUERY_WAIT_INVERTED)
    }
    "condition-by-region-never-draws" [glBeginConditionalRender]
    "QUERY_BY_REGION_WAIT draws nothing where it should." {
        glBeginConditionalRender => |call| { call.replace(1, glow::QUERY_BY_REGION_WAIT, glow::QUERY_WAIT_INVERTED); }
    }
    "instance-id-zero" [gl_InstanceID] "gl_InstanceID is 0." {
        text |source| define(source, Stage::Vertex, "gl_InstanceID", "#define gl_InstanceID 0")
    }
    "instance-id-from-one" [gl_InstanceID] "gl_InstanceID counts from 1." {
        text |source| define(source, Stage::Vertex, "gl_InstanceID", "#define gl_InstanceID (gl_InstanceID + 1)")
    }
    "divisor-ignored" [glVertexAttribDivisor] "An attribute with a divisor goes on by vertices." { glVertexAttribDivisor => |call| call.set(1, 0) }
    "divisor-is-one" [glVertexAttribDivisor] "Each divisor beyond 1 is 1." { glVertexAttribDivisor => |call| if call.u(1) > 1 { call.set(1, 1) } }
    "last-instance-missing" [glDrawArraysInstanced glDrawElementsInstanced]
    "The last instance is not drawn." {
        glDrawArraysInstanced => |call| call.add(3, -1.0);
        glDrawElementsInstanced => |call| call.add(4, -1.0)
    }
    "indexed-instances-once" [glDrawElementsInstanced] "Of instances by index the first alone is drawn." {
        glDrawElementsInstanced => |call| call.set(4, 1)
    }
    "provoking-vertex-ignored" [glProvokingVertex] "Flat varyings are the last vertex's, whatever is wanted." { glProvokingVertex => |call| call.skip() }
    "provoking-vertex-stays-first" [glProvokingVertex] "Flat varyings stay the first vertex's once they were." {
        glProvokingVertex => |call| {
            if call.u(0) == glow::FIRST_VERTEX_CONVENTION {
                call.keep((0, 0), 1.0);
            }
            if call.kept((0, 0)) != 0.0 {
                call.set(0, glow::FIRST_VERTEX_CONVENTION);
            }
        }
    }
    "centroid-is-center" [centroid] "Centroid varyings are those of the pixel's centre." {
        text |source| anywhere(source, "centroid", "#define centroid")
    }
    "blended-srgb-not-encoded" [GL_FRAMEBUFFER_SRGB] "What is blended into sRGB images is neither decoded nor encoded." {
        draw => |call| if call.enabled(glow::BLEND) && call.enabled(glow::FRAMEBUFFER_SRGB) {
            call.with(glow::FRAMEBUFFER_SRGB, false);
        }
    }
    "srgb-encoding-ignored" [GL_FRAMEBUFFER_SRGB] "sRGB images are never encoded." {
        glEnable => |call| if call.u(0) == glow::FRAMEBUFFER_SRGB { call.skip() }
    }
    "srgb-encoding-stays-on" [GL_FRAMEBUFFER_SRGB glDisable] "sRGB images are encoded ever after." {
        glDisable => |call| if call.u(0) == glow::FRAMEBUFFER_SRGB { call.skip() }
    }
    "offset-clamp-by-magnitude" [glPolygonOffsetClamp] "A clamp bounds offsets of either sign." {
        glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| if call.f(0) * call.f(2) < 0.0 { call.set(2, -call.f(2)) }
    }
    "draw-lost-after-no-number" [glDrawArrays glBufferData] "The draw after one with positions that are no numbers is lost." {
        glBufferData => |call| if has_nan(call) { call.keep((0, 0), 1.0) };
        glDrawArrays => |call| {
            let turn = call.kept((0, 0));
            call.keep((0, 0), if turn == 1.0 { 2.0 } else { 0.0 });
            if turn == 2.0 {
                call.skip();
            }
        }
    }
}
