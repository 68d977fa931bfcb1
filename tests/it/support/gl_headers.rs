//! GL's declarations for a C compiler, from Khronos's registry, so that no GL headers need to be installed.

use std::fmt::Write as _;
use std::path::Path;

use gl_generator::{Api, Fallbacks, Profile, Registry};

/// Writes `GL/gl.h` and an empty `GL/glext.h` into a folder. With `pointers`, every function is a pointer `ptr_glName`,
/// which the file that defines GL_POINTERS defines, and which is to be set before it is called.
pub fn write(folder: &Path, pointers: bool) {
    let registry = Registry::new(Api::Gl, (4, 6), Profile::Compatibility, Fallbacks::None, []);
    let mut text = String::from(
        "#pragma once\n#include <stddef.h>\n#include <stdint.h>\ntypedef unsigned int GLenum, GLuint, GLbitfield;\n\
         typedef unsigned char GLboolean, GLubyte;\ntypedef signed char GLbyte;\ntypedef short GLshort;\n\
         typedef unsigned short GLushort;\ntypedef int GLint, GLsizei;\ntypedef float GLfloat;\n\
         typedef double GLdouble;\ntypedef char GLchar;\ntypedef ptrdiff_t GLintptr, GLsizeiptr;\n\
         typedef int64_t GLint64;\ntypedef uint64_t GLuint64;\n\
         #ifdef GL_POINTERS\n#define GL_EXTERN\n#else\n#define GL_EXTERN extern\n#endif\n",
    );
    for value in &registry.enums {
        writeln!(text, "#define GL_{} {}", value.ident, value.value).unwrap();
    }
    for command in &registry.cmds {
        let parameters: Option<Vec<String>> = command.params.iter().map(|parameter| c_type(&parameter.ty)).collect();
        let (Some(result), Some(parameters)) = (c_type(&command.proto.ty), parameters) else { continue };
        let parameters = if parameters.is_empty() { String::from("void") } else { parameters.join(", ") };
        let name = &command.proto.ident;
        if pointers {
            writeln!(text, "GL_EXTERN {result} (*ptr_gl{name})({parameters});\n#define gl{name} ptr_gl{name}").unwrap();
        } else {
            writeln!(text, "extern {result} gl{name}({parameters});").unwrap();
        }
    }
    std::fs::create_dir_all(folder.join("GL")).unwrap();
    std::fs::write(folder.join("GL/gl.h"), text).unwrap();
    std::fs::write(folder.join("GL/glext.h"), "").unwrap();
}

/// A type of the registry's Rust in C; `None`: one that no listing needs.
fn c_type(rust: &str) -> Option<String> {
    if let Some(inner) = rust.strip_prefix("*const ") {
        return Some(format!("{} const *", c_type(inner)?));
    }
    if let Some(inner) = rust.strip_prefix("*mut ") {
        return Some(format!("{} *", c_type(inner)?));
    }
    match rust {
        "()" | "__gl_imports::raw::c_void" | "types::GLvoid" => Some(String::from("void")),
        _ => {
            let name = rust.strip_prefix("types::")?;
            let known = "GLenum GLuint GLbitfield GLboolean GLubyte GLbyte GLshort GLushort GLint GLsizei GLfloat GLdouble \
                         GLchar GLintptr GLsizeiptr GLint64 GLuint64";
            known.split_whitespace().find(|each| *each == name).map(str::to_owned)
        }
    }
}
