//! Faults of programs, uniforms, vertex arrays and queries.

use super::release;

faults! {
    "program-a-draw-late" [glUseProgram]
    "Another program is used from the second draw on." {
        glUseProgram => |call| if call.u(0) != 0 { call.hold() };
        drawn => release
    }
    "uniform-integers-ignored" [glUniform1i]
    "Integers stay 0: every sampler reads unit 0." { glUniform1i => |call| call.set(1, 0) }
    "uniform-floats-ignored" [glUniform1f]
    "A float of a program is 0." { glUniform1f => |call| call.set(1, 0) }
    "uniform-floats-of-8-bits" [glUniform1f]
    "A float of a program has 8 bits." { glUniform1f => |call| call.set(1, (call.f(1) * 256.0).round() / 256.0) }
    "uniform-vec2-swapped" [glUniform2f]
    "The components of a vec2 are exchanged." { glUniform2f => |call| call.swap(1, 2) }
    "uniform-vec3-without-last" [glUniform3f]
    "The last component of a vec3 is 0." { glUniform3f => |call| call.set(3, 0) }
    "uniform-vec4-without-last" [glUniform4f]
    "The last component of a vec4 is 0." { glUniform4f => |call| call.set(4, 0) }
    "uniform-arrays-of-one" [glUniform4fv]
    "Of an array of vec4 only the first is set." { glUniform4fv => |call| if call.i(1) > 1 { call.set(1, 1) } }
    "uniform-vec4-list-without-last" [glUniform4fv]
    "The last component of a vec4 that comes as a list is 0." {
        glUniform4fv => |call| {
            let mut values = call.floats(2, 4 * call.u(1) as usize);
            values.chunks_exact_mut(4).for_each(|value| value[3] = 0.0);
            call.set_floats(2, values);
        }
    }
    "matrices-transposed" [glUniformMatrix4fv]
    "Matrices of four columns are transposed." { glUniformMatrix4fv => |call| call.set(2, 1) }
    "matrices-without-offset" [glUniformMatrix4fv]
    "The last column of a matrix is that of the identity." {
        glUniformMatrix4fv => |call| {
            let mut values = call.floats(3, 16);
            values[12..].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
            call.set_floats(3, values);
        }
    }
    "matrix-a-draw-late" [glUniformMatrix4fv]
    "A matrix holds from the second time it is set." {
        glUniformMatrix4fv => |call| {
            let (location, values) = (call.u(0), call.floats(3, 16));
            let program = call.get(glow::CURRENT_PROGRAM) as u32;
            if let Some(before) = call.keep_list((program, location), values) {
                call.set_floats(3, before);
            }
        }
    }
    "small-matrices-transposed" [glUniformMatrix3fv]
    "Matrices of three columns are transposed." { glUniformMatrix3fv => |call| call.set(2, 1) }
    "attribute-offset-ignored" [glVertexAttribPointer]
    "Attributes are read from their buffer's start." { glVertexAttribPointer => |call| call.set_pointer(5, std::ptr::null()) }
    "attribute-stride-ignored" [glVertexAttribPointer]
    "Attributes are read without gaps." { glVertexAttribPointer => |call| call.set(4, 0) }
    "attribute-without-last" [glVertexAttribPointer]
    "Attributes of three components have two." { glVertexAttribPointer => |call| { call.replace(1, 3, 2); } }
    "attribute-not-enabled" [glEnableVertexAttribArray]
    "Attributes beyond the first are not read." { glEnableVertexAttribArray => |call| if call.u(0) > 0 { call.skip() } }
    "vertex-array-a-draw-late" [glBindVertexArray]
    "Another vertex array is used from the second draw on." {
        glBindVertexArray => |call| if call.u(0) != 0 && call.kept((0, call.u(0))) != 0.0 { call.hold() };
        draw => |call| {
            call.release();
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            call.keep((0, array), 1.0);
        }
    }
    "index-buffer-of-vertex-array-ignored" [glBindBuffer GL_ELEMENT_ARRAY_BUFFER]
    "Indices are those of the last buffer that was bound." {
        glBindBuffer => |call| if call.u(0) == glow::ELEMENT_ARRAY_BUFFER && call.u(1) != 0 { call.keep((0, 0), call.f(1)) };
        glDrawElements => |call| if call.kept((0, 0)) != 0.0 {
            call.other("glBindBuffer", &[f64::from(glow::ELEMENT_ARRAY_BUFFER), call.kept((0, 0))]);
        }
    }
    "buffer-last-bytes-missing" [glBufferData GL_ARRAY_BUFFER GL_STATIC_DRAW]
    "The last sixteenth of a buffer is zeros." {
        glBufferData => |call| {
            let mut bytes = call.bytes(2, call.u(1) as usize);
            let kept = bytes.len() - bytes.len() / 16;
            bytes[kept..].fill(0);
            call.set_bytes(2, &bytes);
        }
    }
    "index-buffer-last-bytes-missing" [glBufferData GL_ELEMENT_ARRAY_BUFFER]
    "The last sixteenth of a buffer of indices is zeros." {
        glBufferData => |call| if call.u(0) == glow::ELEMENT_ARRAY_BUFFER {
            let mut bytes = call.bytes(2, call.u(1) as usize);
            let kept = bytes.len() - bytes.len() / 16;
            bytes[kept..].fill(0);
            call.set_bytes(2, &bytes);
        }
    }
    "samples-doubled" [GL_SAMPLES_PASSED glGetQueryObjectuiv GL_QUERY_RESULT]
    "Samples that pass count twice." {
        glGetQueryObjectuiv => |call| if call.u(1) == glow::QUERY_RESULT {
            call.now();
            let value: Vec<i32> = call.integers(2, 1).iter().map(|value| value.wrapping_mul(2)).collect();
            call.write(2, &value);
        }
    }
    "samples-without-depth-test" [GL_SAMPLES_PASSED glBeginQuery glEndQuery]
    "Samples that fail the depth test are counted too." {
        draw => |call| {
            if call.kept((0, 0)) != 0.0 && call.enabled(glow::DEPTH_TEST) {
                let function = f64::from(call.get(glow::DEPTH_FUNC));
                call.other("glDepthFunc", &[f64::from(glow::ALWAYS)]);
                call.now();
                call.other("glDepthFunc", &[function]);
            }
        };
        glBeginQuery => |call| if call.u(0) == glow::SAMPLES_PASSED { call.keep((0, 0), 1.0) };
        glEndQuery => |call| if call.u(0) == glow::SAMPLES_PASSED { call.keep((0, 0), 0.0) }
    }
    "time-is-zero" [GL_TIME_ELAPSED glGetQueryObjectui64v]
    "No time passes." {
        glGetQueryObjectui64v => |call| {
            call.now();
            call.write(2, &[0_u64]);
        }
    }
    "query-never-ready" [GL_QUERY_RESULT_AVAILABLE glGetQueryObjectuiv]
    "The result of a query is never there." {
        glGetQueryObjectuiv => |call| if call.u(1) == glow::QUERY_RESULT_AVAILABLE {
            call.now();
            call.write(2, &[0_u32]);
        }
    }
    "finish-ignored" [glFinish]
    "glFinish does nothing." { glFinish => |call| call.skip() }
}
