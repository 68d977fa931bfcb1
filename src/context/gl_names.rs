//! GL's constants and names that glow does not have.

/// GL_DEPTH_COMPONENT32, which OpenGL ES and so glow do not know.
pub const DEPTH_COMPONENT32: u32 = 0x81A7;

/// GL's name of an error code.
pub fn error_name(code: u32) -> String {
    match code {
        glow::INVALID_ENUM => "GL_INVALID_ENUM".to_owned(),
        glow::INVALID_VALUE => "GL_INVALID_VALUE".to_owned(),
        glow::INVALID_OPERATION => "GL_INVALID_OPERATION".to_owned(),
        glow::STACK_OVERFLOW => "GL_STACK_OVERFLOW".to_owned(),
        glow::STACK_UNDERFLOW => "GL_STACK_UNDERFLOW".to_owned(),
        glow::OUT_OF_MEMORY => "GL_OUT_OF_MEMORY".to_owned(),
        glow::INVALID_FRAMEBUFFER_OPERATION => "GL_INVALID_FRAMEBUFFER_OPERATION".to_owned(),
        glow::CONTEXT_LOST => "GL_CONTEXT_LOST".to_owned(),
        _ => format!("GL error {code:#06x}"),
    }
}
