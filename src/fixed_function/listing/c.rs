//! Words of C and names of GL.

use glam::DMat4;

use crate::pass::{Compare, CubeFace, DepthFormat, Face, Filter, Format, StencilOp, Storage, Wrap};

/// C text that is appended to.
#[derive(Default)]
pub struct Text(pub String);

impl Text {
    pub fn line(&mut self, text: &str) {
        self.0.push_str(text);
        self.0.push('\n');
    }

    /// A statement in a function.
    pub fn call(&mut self, call: &str) {
        self.line(&format!("    {call};"));
    }

    pub fn enable(&mut self, what: &str, on: bool) {
        self.call(&format!("gl{}({what})", if on { "Enable" } else { "Disable" }));
    }

    /// Loads the top of a matrix stack.
    pub fn load_matrix(&mut self, mode: &str, matrix: &DMat4) {
        self.call(&format!("glMatrixMode({mode})"));
        if *matrix == DMat4::IDENTITY {
            self.call("glLoadIdentity()");
        } else {
            self.call(&format!("glLoadMatrixf({})", columns(&matrix.as_mat4().to_cols_array(), 4)));
        }
    }
}

/// Text within a comment, on one line.
pub fn comment(text: &str) -> String {
    let one_line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    // Neither ends the comment, nor begins one in it; `?` would begin a trigraph.
    one_line.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
}

/// A float literal.
pub fn float(value: f32) -> String {
    match value {
        _ if value.is_nan() => String::from("(0.0f / 0.0f)"),
        f32::INFINITY => String::from("(1.0f / 0.0f)"),
        f32::NEG_INFINITY => String::from("(-1.0f / 0.0f)"),
        _ => format!("{value:?}f"),
    }
}

pub fn floats(values: &[f32]) -> String {
    values.iter().map(|value| float(*value)).collect::<Vec<_>>().join(", ")
}

/// A pointer to a vector.
pub fn vector(values: &[f32]) -> String {
    format!("(const GLfloat[]){{{}}}", floats(values))
}

/// A pointer to numbers in lines of `width`, as a matrix's columns.
pub fn columns(values: &[f32], width: usize) -> String {
    let lines = values.chunks(width).map(|line| format!("\n        {}", floats(line)));
    format!("(const GLfloat[]){{{}}}", lines.collect::<Vec<_>>().join(","))
}

pub fn boolean(on: bool) -> &'static str {
    if on { "GL_TRUE" } else { "GL_FALSE" }
}

pub fn compare(compare: Compare) -> &'static str {
    match compare {
        Compare::Never => "GL_NEVER",
        Compare::Less => "GL_LESS",
        Compare::LessEqual => "GL_LEQUAL",
        Compare::Equal => "GL_EQUAL",
        Compare::NotEqual => "GL_NOTEQUAL",
        Compare::GreaterEqual => "GL_GEQUAL",
        Compare::Greater => "GL_GREATER",
        Compare::Always => "GL_ALWAYS",
    }
}

pub fn stencil_op(op: StencilOp) -> &'static str {
    match op {
        StencilOp::Keep => "GL_KEEP",
        StencilOp::Zero => "GL_ZERO",
        StencilOp::Replace => "GL_REPLACE",
        StencilOp::Increment => "GL_INCR",
        StencilOp::IncrementWrap => "GL_INCR_WRAP",
        StencilOp::Decrement => "GL_DECR",
        StencilOp::DecrementWrap => "GL_DECR_WRAP",
        StencilOp::Invert => "GL_INVERT",
    }
}

pub fn face(face: Face) -> &'static str {
    match face {
        Face::Front => "GL_FRONT",
        Face::Back => "GL_BACK",
    }
}

pub fn face_name(face: CubeFace) -> &'static str {
    match face {
        CubeFace::PositiveX => "GL_TEXTURE_CUBE_MAP_POSITIVE_X",
        CubeFace::NegativeX => "GL_TEXTURE_CUBE_MAP_NEGATIVE_X",
        CubeFace::PositiveY => "GL_TEXTURE_CUBE_MAP_POSITIVE_Y",
        CubeFace::NegativeY => "GL_TEXTURE_CUBE_MAP_NEGATIVE_Y",
        CubeFace::PositiveZ => "GL_TEXTURE_CUBE_MAP_POSITIVE_Z",
        CubeFace::NegativeZ => "GL_TEXTURE_CUBE_MAP_NEGATIVE_Z",
    }
}

/// Binding target of a texture.
pub fn binding(storage: &Storage) -> &'static str {
    match storage {
        Storage::Cube(_) | Storage::UnitVectors => "GL_TEXTURE_CUBE_MAP",
        Storage::Line(_) | Storage::Values(_) => "GL_TEXTURE_1D",
        _ => "GL_TEXTURE_2D",
    }
}

/// Internal format, and format and type of texels.
pub fn format(format: Format) -> [&'static str; 3] {
    match format {
        Format::Rgba8 => ["GL_RGBA8", "GL_RGBA", "GL_UNSIGNED_BYTE"],
        Format::Rgba8Signed => ["GL_RGBA8_SNORM", "GL_RGBA", "GL_BYTE"],
        Format::Rgba32F => ["GL_RGBA32F", "GL_RGBA", "GL_FLOAT"],
        Format::R32F => ["GL_R32F", "GL_RED", "GL_FLOAT"],
        Format::Depth(depth) => {
            let internal = match depth {
                DepthFormat::Depth16 => "GL_DEPTH_COMPONENT16",
                DepthFormat::Depth24 => "GL_DEPTH_COMPONENT24",
                DepthFormat::Depth32 => "GL_DEPTH_COMPONENT32",
                DepthFormat::Depth32F => "GL_DEPTH_COMPONENT32F",
            };
            [internal, "GL_DEPTH_COMPONENT", "GL_FLOAT"]
        }
        Format::UnsizedDepth => ["GL_DEPTH_COMPONENT", "GL_DEPTH_COMPONENT", "GL_FLOAT"],
        Format::Depth24Stencil8 => ["GL_DEPTH24_STENCIL8", "GL_DEPTH_STENCIL", "GL_UNSIGNED_INT_24_8"],
    }
}

/// Filters of minification and magnification.
pub fn filters(filter: Filter) -> [&'static str; 2] {
    match filter {
        Filter::Nearest => ["GL_NEAREST", "GL_NEAREST"],
        Filter::Linear => ["GL_LINEAR", "GL_LINEAR"],
        Filter::Trilinear => ["GL_LINEAR_MIPMAP_LINEAR", "GL_LINEAR"],
    }
}

pub fn wrap(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "GL_REPEAT",
        Wrap::ClampToEdge => "GL_CLAMP_TO_EDGE",
        Wrap::ClampToBorder(_) => "GL_CLAMP_TO_BORDER",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_end_where_they_should() {
        assert_eq!(comment("a */ b\nc /* d ??/"), "a * / b c / * d ? ?/");
    }

    #[test]
    fn floats_are_literals_of_c() {
        assert_eq!(floats(&[1.0, -0.5, 1e-9, 3e20]), "1.0f, -0.5f, 1e-9f, 3e20f");
    }
}
