//! Faults of faces, polygon offset, viewport, scissor, clip distances and primitives.

use super::{Call, hold, release};

/// Offset calls: factor, units and, in two of them, a clamp.
fn is_clamped(call: &Call) -> bool {
    call.name != "glPolygonOffset"
}

/// Makes the draw without an offset.
fn without_offset(call: &mut Call) {
    let [factor, units] = [glow::POLYGON_OFFSET_FACTOR, glow::POLYGON_OFFSET_UNITS].map(|name| call.float(name));
    call.other("glPolygonOffset", &[0.0, 0.0]);
    call.now();
    call.other("glPolygonOffset", &[factor, units]);
}

faults! {
    "culling-ignored" [GL_CULL_FACE glEnable]
    "No face is culled." { glEnable => |call| if call.u(0) == glow::CULL_FACE { call.skip() } }
    "culling-stays-on" [GL_CULL_FACE glDisable]
    "Faces are culled once they were." { glDisable => |call| if call.u(0) == glow::CULL_FACE { call.skip() } }
    "culling-a-draw-late" [GL_CULL_FACE glCullFace glEnable glDisable]
    "Culling is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::CULL_FACE { call.hold() };
        draw => release
    }
    "cull-face-swapped" [glCullFace GL_FRONT GL_BACK]
    "FRONT culls back faces and BACK front faces." { glCullFace => |call| call.exchange(0, glow::FRONT, glow::BACK) }
    "cull-face-is-back" [glCullFace GL_FRONT]
    "Back faces are culled whatever glCullFace says." { glCullFace => |call| call.set(0, glow::BACK) }
    "cull-face-a-draw-late" [glCullFace]
    "A face to cull is another from the second draw on." {
        glCullFace => hold;
        draw => release
    }
    "winding-ignored" [glFrontFace GL_CW]
    "Counter-clockwise faces are the front whatever glFrontFace says." { glFrontFace => |call| call.set(0, glow::CCW) }
    "winding-swapped" [glFrontFace GL_CW GL_CCW]
    "Clockwise and counter-clockwise are exchanged." { glFrontFace => |call| call.exchange(0, glow::CW, glow::CCW) }
    "winding-a-draw-late" [glFrontFace]
    "A winding holds from the second draw after it is set." {
        glFrontFace => hold;
        draw => release
    }
    "offset-ignored" [GL_POLYGON_OFFSET_FILL glEnable]
    "Filled polygons have no offset." { glEnable => |call| if call.u(0) == glow::POLYGON_OFFSET_FILL { call.skip() } }
    "offset-stays-on" [GL_POLYGON_OFFSET_FILL glDisable]
    "The offset stays on once it was." { glDisable => |call| if call.u(0) == glow::POLYGON_OFFSET_FILL { call.skip() } }
    "offset-a-draw-late" [GL_POLYGON_OFFSET_FILL glPolygonOffset]
    "The offset is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::POLYGON_OFFSET_FILL { call.hold() };
        draw => release
    }
    "offset-values-a-draw-late" [glPolygonOffset]
    "Factor and units of the offset hold from the second draw after they are set." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => hold;
        draw => release
    }
    "offset-factor-ignored" [glPolygonOffset]
    "The factor of the offset is 0." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.set(0, 0)
    }
    "offset-units-ignored" [glPolygonOffset]
    "The units of the offset are 0." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.set(1, 0)
    }
    "offset-units-doubled" [glPolygonOffset]
    "The units of the offset count twice." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.set(1, 2.0 * call.f(1))
    }
    "offset-factor-doubled" [glPolygonOffset]
    "The factor of the offset counts twice." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.set(0, 2.0 * call.f(0))
    }
    "offset-factor-and-units-swapped" [glPolygonOffset]
    "Factor and units of the offset are exchanged." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| call.swap(0, 1)
    }
    "offset-sign-ignored" [glPolygonOffset]
    "A negative offset is none." {
        glPolygonOffset glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| {
            call.set(0, call.f(0).max(0.0));
            call.set(1, call.f(1).max(0.0));
        }
    }
    "plain-offset-ignored" [glPolygonOffset]
    "glPolygonOffset does nothing; glPolygonOffsetClamp does." {
        glPolygonOffset => |call| {
            call.set(0, 0);
            call.set(1, 0);
        }
    }
    "offset-clamp-ignored" [glPolygonOffset]
    "The offset is not clamped." {
        glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| if is_clamped(call) { call.set(2, 0) }
    }
    "offset-lost-under-depth-range" [glPolygonOffset glDepthRangef]
    "There is no offset under a depth range other than [0, 1]." {
        draw => |call| {
            // As integers the range's ends are scaled to the largest.
            let whole = call.get4(glow::DEPTH_RANGE)[..2] == [0, i32::MAX];
            if !whole { without_offset(call) }
        }
    }
    "offset-lost-for-floats" [glPolygonOffset GL_DEPTH_COMPONENT32F]
    "There is no offset for depth images of floats." {
        draw => |call| if call.depth_format().1 == glow::FLOAT { without_offset(call) }
    }
    "offset-lost-for-16-bits" [glPolygonOffset GL_DEPTH_COMPONENT16]
    "There is no offset for depth images of 16 bits." {
        draw => |call| if call.depth_format().0 == 16 { without_offset(call) }
    }
    "offset-lost-with-stencil" [glPolygonOffset GL_DEPTH24_STENCIL8]
    "There is no offset for packed depth and stencil." {
        draw => |call| if call.attached(glow::STENCIL_ATTACHMENT, glow::FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE) > 0 {
            without_offset(call);
        }
    }
    "viewport-one-pixel-off" [glViewport]
    "The viewport lies one pixel to the right." { glViewport => |call| call.add(0, 1.0) }
    "viewport-one-row-off" [glViewport]
    "The viewport lies one pixel higher." { glViewport => |call| call.add(1, 1.0) }
    "viewport-one-pixel-narrow" [glViewport]
    "The viewport is one pixel narrower." { glViewport => |call| call.add(2, -1.0) }
    "viewport-square" [glViewport]
    "The viewport is as high as wide." { glViewport => |call| call.set(3, call.f(2)) }
    "viewport-a-draw-late" [glViewport]
    "A viewport holds from the second draw after it is set." {
        glViewport => hold;
        draw => release
    }
    "scissor-ignored" [GL_SCISSOR_TEST glEnable]
    "There is no scissor." { glEnable => |call| if call.u(0) == glow::SCISSOR_TEST { call.skip() } }
    "scissor-stays-on" [GL_SCISSOR_TEST glDisable]
    "The scissor stays on once it was." { glDisable => |call| if call.u(0) == glow::SCISSOR_TEST { call.skip() } }
    "scissor-a-draw-late" [GL_SCISSOR_TEST glScissor]
    "The scissor is switched from the second draw on." {
        glEnable glDisable => |call| if call.u(0) == glow::SCISSOR_TEST { call.hold() };
        draw => release
    }
    "scissor-box-a-draw-late" [glScissor]
    "The scissor's rectangle is another from the second draw on." {
        glScissor => hold;
        draw => release
    }
    "scissor-one-pixel-left" [glScissor]
    "The scissor lies one pixel to the left." { glScissor => |call| call.add(0, -1.0) }
    "scissor-one-row-down" [glScissor]
    "The scissor lies one pixel lower." { glScissor => |call| call.add(1, -1.0) }
    "scissor-one-pixel-wide" [glScissor]
    "The scissor is one pixel wider." { glScissor => |call| call.add(2, 1.0) }
    "scissor-one-row-high" [glScissor]
    "The scissor is one pixel higher." { glScissor => |call| call.add(3, 1.0) }
    "clear-ignores-scissor" [GL_SCISSOR_TEST glClearBufferfv]
    "Clears go beyond the scissor." { clear => |call| call.with(glow::SCISSOR_TEST, false) }
    "clip-distances-ignored" [GL_CLIP_DISTANCE0 glEnable gl_ClipDistance]
    "No clip distance clips." { glEnable => |call| if (glow::CLIP_DISTANCE0..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.skip() } }
    "second-clip-distance-ignored" [GL_CLIP_DISTANCE0 gl_ClipDistance]
    "Only the first clip distance clips." { glEnable => |call| if (glow::CLIP_DISTANCE1..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.skip() } }
    "later-clip-distances-ignored" [GL_CLIP_DISTANCE0 gl_ClipDistance]
    "Only the first two clip distances clip." { glEnable => |call| if (glow::CLIP_DISTANCE2..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.skip() } }
    "clip-distances-stay-on" [GL_CLIP_DISTANCE0 glDisable]
    "A clip distance stays on once it was." { glDisable => |call| if (glow::CLIP_DISTANCE0..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.skip() } }
    "clip-distances-a-draw-late" [GL_CLIP_DISTANCE0]
    "Clip distances are switched from the second draw on." {
        glEnable glDisable => |call| if (glow::CLIP_DISTANCE0..=glow::CLIP_DISTANCE7).contains(&call.u(0)) { call.hold() };
        draw => release
    }
    "last-triangle-missing" [glDrawElements GL_TRIANGLES]
    "The last three indices are not drawn." {
        glDrawElements => |call| if call.u(0) == glow::TRIANGLES { call.add(1, -3.0) };
        glDrawArrays => |call| if call.u(0) == glow::TRIANGLES { call.add(2, -3.0) }
    }
    "elements-last-triangle-missing" [glDrawElements]
    "glDrawElements leaves the last three indices out." {
        glDrawElements => |call| if call.u(0) == glow::TRIANGLES { call.add(1, -3.0) }
    }
    "elements-from-the-first" [glDrawElements GL_ELEMENT_ARRAY_BUFFER]
    "Indices are read from the buffer's start." { glDrawElements => |call| call.set_pointer(3, std::ptr::null()) }
    "elements-of-16-bits" [glDrawElements GL_UNSIGNED_INT]
    "Indices of 32 bits are read as 16." {
        glDrawElements => |call| { call.replace(2, glow::UNSIGNED_INT, glow::UNSIGNED_SHORT); }
    }
    "lines-are-points" [GL_LINES]
    "Lines are drawn as their ends." { glDrawElements => |call| { call.replace(0, glow::LINES, glow::POINTS); } }
}
