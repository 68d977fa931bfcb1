//! GL functions that a layer may change, each with its signature, and a wrapper of each.

use std::ffi::c_void;

use super::call::{Invoke, dispatch};
use super::value::{Value, Word};

type Any = *const c_void;
type Out = *mut c_void;

/// Wrappers for functions, by their signatures.
macro_rules! functions {
    (@result) => { () };
    (@result $result:ty) => { $result };
    ($($name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)*) => {
        /// Names of all functions that have a wrapper.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];

        /// Parameters of a function, each its name and type, and the type of its result.
        pub fn signature(name: &str) -> Option<(&'static [[&'static str; 2]], &'static str)> {
            match name {
                $(stringify!($name) => Some((
                    &[$([stringify!($argument), stringify!($type)]),*],
                    stringify!($($result)?),
                )),)*
                _ => None,
            }
        }

        /// The wrapper of a function.
        pub fn wrapper(name: &str) -> Option<*const c_void> {
            match name {
                $(stringify!($name) => Some(wrappers::$name as *const c_void),)*
                _ => None,
            }
        }

        /// How a function is called by its address.
        pub fn invoke_of(name: &str) -> Option<(&'static str, Invoke)> {
            match name {
                $(stringify!($name) => Some((stringify!($name), invokes::$name)),)*
                _ => None,
            }
        }

        #[allow(non_snake_case, reason = "GL's names")]
        mod invokes {
            use super::*;

            $(pub unsafe fn $name(address: *const c_void, arguments: &[Value]) -> Value {
                type Function = unsafe extern "system" fn($($type),*) -> functions!(@result $($result)?);
                let [$($argument),*] = *arguments else { return Value::Nothing };
                // SAFETY: the address is that of the function of this name, which has this signature.
                unsafe { std::mem::transmute::<*const c_void, Function>(address)($(Word::unpack($argument)),*).pack() }
            })*
        }

        #[allow(non_snake_case, reason = "GL's names")]
        mod wrappers {
            use super::*;

            $(pub unsafe extern "system" fn $name($($argument: $type),*) -> functions!(@result $($result)?) {
                Word::unpack(dispatch(stringify!($name), &[$($argument.pack()),*], invokes::$name))
            })*
        }
    };
}

functions! {
    // State.
    glEnable(what: u32);
    glDisable(what: u32);
    glHint(target: u32, mode: u32);
    glDepthFunc(function: u32);
    glDepthMask(on: u8);
    glDepthRange(near: f64, far: f64);
    glDepthRangef(near: f32, far: f32);
    glStencilFunc(function: u32, reference: i32, mask: u32);
    glStencilFuncSeparate(face: u32, function: u32, reference: i32, mask: u32);
    glStencilMask(mask: u32);
    glStencilMaskSeparate(face: u32, mask: u32);
    glStencilOp(fail: u32, depth_fail: u32, pass: u32);
    glStencilOpSeparate(face: u32, fail: u32, depth_fail: u32, pass: u32);
    glColorMask(red: u8, green: u8, blue: u8, alpha: u8);
    glColorMaski(buffer: u32, red: u8, green: u8, blue: u8, alpha: u8);
    glCullFace(face: u32);
    glFrontFace(winding: u32);
    glPolygonMode(face: u32, mode: u32);
    glPolygonOffset(factor: f32, units: f32);
    glPolygonOffsetClamp(factor: f32, units: f32, clamp: f32);
    glPolygonOffsetClampEXT(factor: f32, units: f32, clamp: f32);
    glBlendFunc(source: u32, destination: u32);
    glBlendFuncSeparate(source: u32, destination: u32, source_alpha: u32, destination_alpha: u32);
    glBlendEquation(equation: u32);
    glBlendEquationSeparate(rgb: u32, alpha: u32);
    glBlendColor(red: f32, green: f32, blue: f32, alpha: f32);
    glScissor(x: i32, y: i32, width: i32, height: i32);
    glViewport(x: i32, y: i32, width: i32, height: i32);
    glLineWidth(width: f32);
    glPointSize(size: f32);
    glPixelStorei(name: u32, value: i32);
    glPixelTransferf(name: u32, value: f32);
    glProvokingVertex(mode: u32);
    glClampColor(target: u32, clamp: u32);
    // Clears.
    glClear(mask: u32);
    glClearColor(red: f32, green: f32, blue: f32, alpha: f32);
    glClearDepth(depth: f64);
    glClearDepthf(depth: f32);
    glClearStencil(value: i32);
    glClearBufferfv(buffer: u32, index: i32, values: Any);
    glClearBufferiv(buffer: u32, index: i32, values: Any);
    glClearBufferfi(buffer: u32, index: i32, depth: f32, stencil: i32);
    // Textures and samplers.
    glActiveTexture(unit: u32);
    glBindTexture(target: u32, texture: u32);
    glTexParameteri(target: u32, name: u32, value: i32);
    glTexParameterf(target: u32, name: u32, value: f32);
    glTexParameterfv(target: u32, name: u32, values: Any);
    glTexParameteriv(target: u32, name: u32, values: Any);
    glBindSampler(unit: u32, sampler: u32);
    glSamplerParameteri(sampler: u32, name: u32, value: i32);
    glSamplerParameterf(sampler: u32, name: u32, value: f32);
    glSamplerParameterfv(sampler: u32, name: u32, values: Any);
    glTexImage1D(
        target: u32, level: i32, internal: i32, width: i32, border: i32, format: u32, kind: u32, texels: Any
    );
    glTexImage2D(
        target: u32, level: i32, internal: i32, width: i32, height: i32, border: i32, format: u32, kind: u32, texels: Any
    );
    glTexImage3D(
        target: u32, level: i32, internal: i32, width: i32, height: i32, depth: i32, border: i32, format: u32, kind: u32,
        texels: Any
    );
    glTexSubImage2D(
        target: u32, level: i32, x: i32, y: i32, width: i32, height: i32, format: u32, kind: u32, texels: Any
    );
    glTexStorage2D(target: u32, levels: i32, internal: u32, width: i32, height: i32);
    glTexImage2DMultisample(target: u32, samples: i32, internal: u32, width: i32, height: i32, fixed: u8);
    glGenerateMipmap(target: u32);
    glCopyTexImage2D(
        target: u32, level: i32, internal: u32, x: i32, y: i32, width: i32, height: i32, border: i32
    );
    glCopyTexSubImage2D(target: u32, level: i32, to_x: i32, to_y: i32, x: i32, y: i32, width: i32, height: i32);
    // Framebuffers and what is read of them.
    glBindFramebuffer(target: u32, framebuffer: u32);
    glFramebufferTexture(target: u32, point: u32, texture: u32, level: i32);
    glFramebufferTexture2D(target: u32, point: u32, place: u32, texture: u32, level: i32);
    glFramebufferTextureLayer(target: u32, point: u32, texture: u32, level: i32, layer: i32);
    glFramebufferRenderbuffer(target: u32, point: u32, place: u32, buffer: u32);
    glCheckFramebufferStatus(target: u32) -> u32;
    glBindRenderbuffer(target: u32, buffer: u32);
    glRenderbufferStorage(target: u32, internal: u32, width: i32, height: i32);
    glRenderbufferStorageMultisample(target: u32, samples: i32, internal: u32, width: i32, height: i32);
    glDrawBuffer(buffer: u32);
    glDrawBuffers(count: i32, buffers: Any);
    glReadBuffer(buffer: u32);
    glReadPixels(x: i32, y: i32, width: i32, height: i32, format: u32, kind: u32, pixels: Out);
    glBlitFramebuffer(
        x0: i32, y0: i32, x1: i32, y1: i32, to_x0: i32, to_y0: i32, to_x1: i32, to_y1: i32, mask: u32, filter: u32
    );
    glGetTexImage(target: u32, level: i32, format: u32, kind: u32, pixels: Out);
    glFinish();
    glFlush();
    // Programs.
    glCreateShader(kind: u32) -> u32;
    glShaderSource(shader: u32, count: i32, texts: Any, lengths: Any);
    glAttachShader(program: u32, shader: u32);
    glDetachShader(program: u32, shader: u32);
    glCompileShader(shader: u32);
    glLinkProgram(program: u32);
    glUseProgram(program: u32);
    glGetUniformLocation(program: u32, name: Any) -> i32;
    glBindAttribLocation(program: u32, index: u32, name: Any);
    glBindFragDataLocation(program: u32, color: u32, name: Any);
    glUniform1i(location: i32, x: i32);
    glUniform1f(location: i32, x: f32);
    glUniform2f(location: i32, x: f32, y: f32);
    glUniform3f(location: i32, x: f32, y: f32, z: f32);
    glUniform4f(location: i32, x: f32, y: f32, z: f32, w: f32);
    glUniform1fv(location: i32, count: i32, values: Any);
    glUniform2fv(location: i32, count: i32, values: Any);
    glUniform3fv(location: i32, count: i32, values: Any);
    glUniform4fv(location: i32, count: i32, values: Any);
    glUniform2i(location: i32, x: i32, y: i32);
    glUniform3i(location: i32, x: i32, y: i32, z: i32);
    glUniform4i(location: i32, x: i32, y: i32, z: i32, w: i32);
    glUniform1ui(location: i32, x: u32);
    glUniform2ui(location: i32, x: u32, y: u32);
    glUniform3ui(location: i32, x: u32, y: u32, z: u32);
    glUniform4ui(location: i32, x: u32, y: u32, z: u32, w: u32);
    glUniform1iv(location: i32, count: i32, values: Any);
    glUniform2iv(location: i32, count: i32, values: Any);
    glUniform3iv(location: i32, count: i32, values: Any);
    glUniform4iv(location: i32, count: i32, values: Any);
    glUniform1uiv(location: i32, count: i32, values: Any);
    glUniform2uiv(location: i32, count: i32, values: Any);
    glUniform3uiv(location: i32, count: i32, values: Any);
    glUniform4uiv(location: i32, count: i32, values: Any);
    glUniformMatrix2fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix2x3fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix2x4fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix3x2fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix3x4fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix4x2fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix4x3fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformBlockBinding(program: u32, index: u32, binding: u32);
    glUniformMatrix3fv(location: i32, count: i32, transpose: u8, values: Any);
    glUniformMatrix4fv(location: i32, count: i32, transpose: u8, values: Any);
    // Vertices and draws.
    glBindVertexArray(array: u32);
    glBindBuffer(target: u32, buffer: u32);
    glBufferData(target: u32, size: isize, bytes: Any, usage: u32);
    glBufferSubData(target: u32, offset: isize, size: isize, bytes: Any);
    glEnableVertexAttribArray(index: u32);
    glDisableVertexAttribArray(index: u32);
    glVertexAttribPointer(index: u32, size: i32, kind: u32, normalized: u8, stride: i32, offset: Any);
    glVertexAttribIPointer(index: u32, size: i32, kind: u32, stride: i32, offset: Any);
    glVertexAttrib1f(index: u32, x: f32);
    glVertexAttrib2f(index: u32, x: f32, y: f32);
    glVertexAttrib3f(index: u32, x: f32, y: f32, z: f32);
    glVertexAttrib4f(index: u32, x: f32, y: f32, z: f32, w: f32);
    glVertexAttribI4i(index: u32, x: i32, y: i32, z: i32, w: i32);
    glVertexAttribI4ui(index: u32, x: u32, y: u32, z: u32, w: u32);
    glCopyBufferSubData(from: u32, to: u32, read: isize, write: isize, size: isize);
    glBindBufferBase(target: u32, index: u32, buffer: u32);
    glBindBufferRange(target: u32, index: u32, buffer: u32, first: isize, size: isize);
    glDrawArraysInstancedBaseInstance(mode: u32, first: i32, count: i32, instances: i32, base: u32);
    glDrawElementsInstancedBaseVertex(mode: u32, count: i32, kind: u32, offset: Any, instances: i32, base: i32);
    glDrawArrays(mode: u32, first: i32, count: i32);
    glDrawArraysInstanced(mode: u32, first: i32, count: i32, instances: i32);
    glPrimitiveRestartIndex(index: u32);
    glDrawElements(mode: u32, count: i32, kind: u32, offset: Any);
    glDrawElementsInstanced(mode: u32, count: i32, kind: u32, offset: Any, instances: i32);
    glVertexAttribDivisor(index: u32, divisor: u32);
    glDrawElementsBaseVertex(mode: u32, count: i32, kind: u32, offset: Any, base: i32);
    // Queries.
    glBeginQuery(target: u32, query: u32);
    glEndQuery(target: u32);
    glGetQueryObjectiv(query: u32, name: u32, value: Out);
    glGetQueryObjectuiv(query: u32, name: u32, value: Out);
    glGetQueryObjectui64v(query: u32, name: u32, value: Out);
    glQueryCounter(query: u32, target: u32);
    glBeginConditionalRender(query: u32, mode: u32);
    glEndConditionalRender();
    glGetIntegerv(name: u32, values: Out);
    glGetFloatv(name: u32, values: Out);
    glGetTexLevelParameteriv(target: u32, level: i32, name: u32, value: Out);
    // Names of objects.
    glGenTextures(count: i32, names: Out);
    glGenSamplers(count: i32, names: Out);
    glDeleteSamplers(count: i32, names: Any);
    glGenFramebuffers(count: i32, names: Out);
    glGenRenderbuffers(count: i32, names: Out);
    glGenBuffers(count: i32, names: Out);
    glGenVertexArrays(count: i32, names: Out);
    glGenQueries(count: i32, names: Out);
    glCreateProgram() -> u32;
    // The fixed-function pipeline.
    glAlphaFunc(function: u32, reference: f32);
    glBegin(mode: u32);
    glEnd();
    glColor4f(red: f32, green: f32, blue: f32, alpha: f32);
    glColor4fv(values: Any);
    glNormal3fv(values: Any);
    glNormal3f(x: f32, y: f32, z: f32);
    glTexCoord4fv(values: Any);
    glMultiTexCoord4fv(unit: u32, values: Any);
    glVertex4fv(values: Any);
    glClientActiveTexture(unit: u32);
    glEnableClientState(array: u32);
    glDisableClientState(array: u32);
    glVertexPointer(size: i32, kind: u32, stride: i32, at: Any);
    glNormalPointer(kind: u32, stride: i32, at: Any);
    glTexCoordPointer(size: i32, kind: u32, stride: i32, at: Any);
    glMatrixMode(mode: u32);
    glLoadIdentity();
    glLoadMatrixf(values: Any);
    glLoadMatrixd(values: Any);
    glMultMatrixf(values: Any);
    glMultMatrixd(values: Any);
    glScalef(x: f32, y: f32, z: f32);
    glTranslatef(x: f32, y: f32, z: f32);
    glTexGeni(coordinate: u32, name: u32, value: i32);
    glTexGenfv(coordinate: u32, name: u32, values: Any);
    glTexGendv(coordinate: u32, name: u32, values: Any);
    glGetTexGenfv(coordinate: u32, name: u32, values: Out);
    glGetTexGendv(coordinate: u32, name: u32, values: Out);
    glTexEnvi(target: u32, name: u32, value: i32);
    glTexEnvf(target: u32, name: u32, value: f32);
    glTexEnvfv(target: u32, name: u32, values: Any);
    glShadeModel(mode: u32);
    glLightf(light: u32, name: u32, value: f32);
    glLightfv(light: u32, name: u32, values: Any);
    glLightModeli(name: u32, value: i32);
    glLightModelfv(name: u32, values: Any);
    glMaterialf(face: u32, name: u32, value: f32);
    glMaterialfv(face: u32, name: u32, values: Any);
    glColorMaterial(face: u32, name: u32);
    glFogf(name: u32, value: f32);
    glFogi(name: u32, value: i32);
    glFogfv(name: u32, values: Any);
    glRotatef(degrees: f32, x: f32, y: f32, z: f32);
    glPushMatrix();
    glPopMatrix();
    glPushAttrib(mask: u32);
    glPopAttrib();
    glClipPlane(plane: u32, equation: Any);
    glColor3f(red: f32, green: f32, blue: f32);
    glSecondaryColor3f(red: f32, green: f32, blue: f32);
    glSecondaryColor3fv(values: Any);
    glFogCoordf(value: f32);
    glTexCoord2f(s: f32, t: f32);
    glMultiTexCoord2f(unit: u32, s: f32, t: f32);
    glMultiTexCoord3f(unit: u32, s: f32, t: f32, r: f32);
    glVertex3f(x: f32, y: f32, z: f32);
    glColorPointer(size: i32, kind: u32, stride: i32, at: Any);
    glSecondaryColorPointer(size: i32, kind: u32, stride: i32, at: Any);
    glFogCoordPointer(kind: u32, stride: i32, at: Any);
    glNewList(list: u32, mode: u32);
    glEndList();
    glCallList(list: u32);
    glAccum(operation: u32, value: f32);
    glClearAccum(red: f32, green: f32, blue: f32, alpha: f32);
}
