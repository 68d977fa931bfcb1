//! Meanings of the parameters of GL's functions: enums, objects, and how much memory a pointer stands for.

use super::pixels::{Layout, Scalar};
use crate::conformance::layer::call::Call;
use crate::conformance::layer::value::Value;
use crate::context::compatibility::raw;

/// Kinds of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    Texture,
    Sampler,
    Framebuffer,
    Renderbuffer,
    Buffer,
    VertexArray,
    Query,
    Shader,
    Program,
    /// Location of a uniform.
    Location,
}

impl Kind {
    /// The kind of what a glGen function makes.
    pub fn of_maker(function: &str) -> Option<Self> {
        Some(match function {
            "glGenTextures" => Self::Texture,
            "glGenSamplers" => Self::Sampler,
            "glGenFramebuffers" => Self::Framebuffer,
            "glGenRenderbuffers" => Self::Renderbuffer,
            "glGenBuffers" => Self::Buffer,
            "glGenVertexArrays" => Self::VertexArray,
            "glGenQueries" => Self::Query,
            _ => return None,
        })
    }

    /// Name of a variable.
    pub fn word(self) -> &'static str {
        match self {
            Self::Texture => "texture",
            Self::Sampler => "sampler",
            Self::Framebuffer => "framebuffer",
            Self::Renderbuffer => "renderbuffer",
            Self::Buffer => "buffer",
            Self::VertexArray => "vertex_array",
            Self::Query => "query",
            Self::Shader => "shader",
            Self::Program => "program",
            Self::Location => "location",
        }
    }
}

/// Meaning of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    Number,
    Enum,
    Bits,
    Object(Kind),
    Location,
    Data,
    /// A string.
    Name,
    /// Texts of a shader, and their lengths.
    Sources,
    Lengths,
    Offset,
    Out,
}

/// The meaning of a parameter by its function, name and type.
pub fn meaning(function: &str, parameter: &str, kind: &str, value: Value) -> Meaning {
    match kind {
        "Out" => return Meaning::Out,
        "Any" => {
            return match parameter {
                "offset" => Meaning::Offset,
                "name" => Meaning::Name,
                "texts" => Meaning::Sources,
                "lengths" => Meaning::Lengths,
                _ => Meaning::Data,
            };
        }
        "u32" | "i32" => {}
        _ => return Meaning::Number,
    }
    match (function, parameter) {
        ("glClear" | "glBlitFramebuffer", "mask") => Meaning::Bits,
        (_, "mask" | "index" | "reference" | "count" | "x" | "y" | "width" | "height" | "level") => Meaning::Number,
        ("glBindBuffer" | "glBindBufferBase" | "glBindBufferRange", "buffer") => Meaning::Object(Kind::Buffer),
        ("glBindRenderbuffer" | "glFramebufferRenderbuffer", "buffer") => Meaning::Object(Kind::Renderbuffer),
        (_, "base" | "binding" | "first" | "instances") => Meaning::Number,
        (function, "z" | "w") if function.starts_with("glUniform") || function.starts_with("glVertexAttrib") => {
            Meaning::Number
        }
        ("glColorMaski", "buffer") | ("glBindSampler", "unit") => Meaning::Number,
        (_, "texture") => Meaning::Object(Kind::Texture),
        (_, "framebuffer") => Meaning::Object(Kind::Framebuffer),
        (_, "sampler") => Meaning::Object(Kind::Sampler),
        (_, "program") => Meaning::Object(Kind::Program),
        (_, "shader") => Meaning::Object(Kind::Shader),
        (_, "query") => Meaning::Object(Kind::Query),
        ("glBindVertexArray", "array") => Meaning::Object(Kind::VertexArray),
        (_, "location") => Meaning::Location,
        ("glTexImage1D" | "glTexImage2D" | "glTexImage3D", "internal") => Meaning::Enum,
        // Values of parameters are enums or numbers: no enum of theirs is below 0x100 but GL_NONE.
        (_, "value") => {
            let is_enum =
                value.number() >= 256.0 && !function.starts_with("glPixel") && !function.starts_with("glUniform");
            if is_enum { Meaning::Enum } else { Meaning::Number }
        }
        _ if kind == "u32" => Meaning::Enum,
        _ => Meaning::Number,
    }
}

/// Components of a pixel's format.
fn components(format: u32) -> usize {
    match format {
        glow::RGBA | glow::BGRA => 4,
        glow::RGB | glow::BGR => 3,
        glow::RG | raw::LUMINANCE_ALPHA => 2,
        _ => 1,
    }
}

/// Layout of pixels in the caller's memory; `row`: pixels of a row, 0 for its width.
pub fn pixels_of(format: u32, kind: u32, [width, height]: [usize; 2], alignment: usize, row: usize) -> Layout {
    let scalar = match kind {
        glow::UNSIGNED_BYTE => Scalar::U8,
        glow::BYTE => Scalar::I8,
        glow::UNSIGNED_SHORT => Scalar::U16,
        glow::SHORT => Scalar::I16,
        glow::UNSIGNED_INT => Scalar::U32,
        glow::INT => Scalar::I32,
        glow::UNSIGNED_INT_24_8 => Scalar::Depth24Stencil8,
        _ => Scalar::F32,
    };
    let components = match kind {
        glow::UNSIGNED_INT_24_8 | glow::FLOAT_32_UNSIGNED_INT_24_8_REV => 2,
        _ => components(format),
    };
    let mut layout = Layout { scalar, components, width, height, stride: 0 };
    let used = if row == 0 { width } else { row };
    layout.stride = (used * layout.element()).next_multiple_of(alignment.max(1));
    layout
}

/// Type and bytes of what a call reads at its pointer; `None`: unknown. `unpack`: alignment and row length.
pub fn data_of(call: &Call, unpack: [usize; 2]) -> Option<(Scalar, usize)> {
    let size = |index: usize| call.i(index).max(0) as usize;
    let texels = |sides: [usize; 3], format: usize| {
        let layout =
            pixels_of(call.u(format), call.u(format + 1), [sides[0], sides[1] * sides[2]], unpack[0], unpack[1]);
        let scalar = if layout.scalar == Scalar::Depth24Stencil8 { Scalar::U32 } else { layout.scalar };
        (scalar, layout.bytes())
    };
    let floats = |count: usize| (Scalar::F32, 4 * count);
    Some(match call.name {
        "glTexImage1D" => texels([size(3), 1, 1], 5),
        "glTexImage2D" => texels([size(3), size(4), 1], 6),
        "glTexImage3D" => texels([size(3), size(4), size(5)], 7),
        "glTexSubImage2D" => texels([size(4), size(5), 1], 6),
        "glBufferData" | "glBufferSubData" => {
            let bytes = call.f(if call.name == "glBufferData" { 1 } else { 2 }) as usize;
            let scalar = match call.u(0) {
                glow::ELEMENT_ARRAY_BUFFER if bytes.is_multiple_of(4) => Scalar::U32,
                glow::ELEMENT_ARRAY_BUFFER => Scalar::U16,
                _ => Scalar::F32,
            };
            (scalar, bytes)
        }
        "glUniform1fv" => floats(size(1)),
        "glUniform2fv" => floats(2 * size(1)),
        "glUniform3fv" => floats(3 * size(1)),
        "glUniform4fv" => floats(4 * size(1)),
        "glUniform1iv" => (Scalar::I32, 4 * size(1)),
        "glUniform2iv" => (Scalar::I32, 8 * size(1)),
        "glUniform3iv" => (Scalar::I32, 12 * size(1)),
        "glUniform4iv" => (Scalar::I32, 16 * size(1)),
        "glUniform1uiv" => (Scalar::U32, 4 * size(1)),
        "glUniform2uiv" => (Scalar::U32, 8 * size(1)),
        "glUniform3uiv" => (Scalar::U32, 12 * size(1)),
        "glUniform4uiv" => (Scalar::U32, 16 * size(1)),
        "glUniformMatrix2fv" => floats(4 * size(1)),
        "glUniformMatrix2x3fv" | "glUniformMatrix3x2fv" => floats(6 * size(1)),
        "glUniformMatrix2x4fv" | "glUniformMatrix4x2fv" => floats(8 * size(1)),
        "glUniformMatrix3x4fv" | "glUniformMatrix4x3fv" => floats(12 * size(1)),
        "glUniformMatrix3fv" => floats(9 * size(1)),
        "glUniformMatrix4fv" => floats(16 * size(1)),
        "glTexParameterfv" | "glSamplerParameterfv" => {
            floats(if call.u(1) == glow::TEXTURE_BORDER_COLOR { 4 } else { 1 })
        }
        "glTexParameteriv" => {
            let four = matches!(call.u(1), glow::TEXTURE_SWIZZLE_RGBA | glow::TEXTURE_BORDER_COLOR);
            (Scalar::I32, if four { 16 } else { 4 })
        }
        "glClearBufferfv" => floats(if call.u(0) == glow::COLOR { 4 } else { 1 }),
        "glClearBufferiv" => (Scalar::I32, if call.u(0) == glow::COLOR { 16 } else { 4 }),
        "glDrawBuffers" => (Scalar::U32, 4 * size(0)),
        "glColor4fv" | "glTexCoord4fv" | "glMultiTexCoord4fv" | "glVertex4fv" | "glLightModelfv" => floats(4),
        "glTexEnvfv" | "glTexGenfv" | "glFogfv" => floats(4),
        "glNormal3fv" => floats(3),
        "glTexGendv" => (Scalar::F64, 32),
        "glMaterialfv" => floats(if call.u(1) == raw::SHININESS { 1 } else { 4 }),
        "glLightfv" => match call.u(1) {
            raw::SPOT_DIRECTION => floats(3),
            raw::AMBIENT | raw::DIFFUSE | raw::SPECULAR | raw::POSITION => floats(4),
            _ => floats(1),
        },
        "glLoadMatrixf" | "glMultMatrixf" => floats(16),
        "glLoadMatrixd" | "glMultMatrixd" => (Scalar::F64, 128),
        _ => return None,
    })
}
