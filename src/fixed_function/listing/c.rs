//! GL's names of what a pass list has.

pub use crate::c_text::{Text, boolean, columns, comment, float, floats, vector};
use crate::pass::{Compare, CubeFace, DepthFormat, Face, Filter, Format, StencilOp, Storage, Wrap};

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
