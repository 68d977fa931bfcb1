//! Faults that the generated rules of triangles, vertex data and uniforms were tried on: each is of one range of numbers, or of
//! one format.

faults! {
    "scissor-left-of-zero-moved" [glScissor]
    "A scissor that begins left of the target is moved to its edge, and keeps its width." {
        glScissor => |call| if call.i(0) < 0 { call.set(0, 0.0) }
    }
    "viewport-left-of-zero-moved" [glViewport]
    "A viewport that begins left of the target is moved to its edge." {
        glViewport => |call| if call.i(0) < 0 { call.set(0, 0.0) }
    }
    "depth-range-ends-sorted" [glDepthRange]
    "glDepthRange takes the lesser end for the near one." {
        glDepthRange => |call| if call.f(0) > call.f(1) { call.swap(0, 1) }
    }
    "offset-clamp-only-above" [glPolygonOffsetClamp]
    "A negative clamp of the polygon offset is none." {
        glPolygonOffsetClamp glPolygonOffsetClampEXT => |call| if call.f(2) < 0.0 { call.set(2, 0.0) }
    }
    "both-faces-culled-as-back" [glCullFace GL_FRONT_AND_BACK]
    "FRONT_AND_BACK culls back faces." {
        glCullFace => |call| { call.replace(0, glow::FRONT_AND_BACK, glow::BACK); }
    }
    "bgra-arrays-as-rgba" [glVertexAttribPointer GL_BGRA]
    "Arrays of BGRA are read as RGBA." { glVertexAttribPointer => |call| { call.replace(1, glow::BGRA, 4); } }
    "divisor-lost-by-pointer" [glVertexAttribDivisor glVertexAttribPointer]
    "A new pointer sets its attribute's divisor to 0." {
        glVertexAttribPointer => |call| {
            call.now();
            call.other("glVertexAttribDivisor", &[call.f(0), 0.0]);
        }
    }
    "signed-bytes-of-integers-unsigned" [glVertexAttribIPointer GL_BYTE]
    "Bytes of an integer attribute are not signed." {
        glVertexAttribIPointer => |call| { call.replace(2, glow::BYTE, glow::UNSIGNED_BYTE); }
    }
    "current-value-without-w" [glVertexAttrib3f]
    "The fourth number of a current value that is set by three is 0." {
        glVertexAttrib3f => |call| {
            call.skip();
            call.other("glVertexAttrib4f", &[call.f(0), call.f(1), call.f(2), call.f(3), 0.0]);
        }
    }
    "block-range-from-the-start" [glBindBufferRange GL_UNIFORM_BUFFER]
    "A uniform block is read from its buffer's start." {
        glBindBufferRange => |call| if call.u(0) == glow::UNIFORM_BUFFER { call.set(3, 0) }
    }
}
