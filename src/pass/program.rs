//! Shader variants as data: chunks in order, defines, attributes, uniforms by name.

use std::borrow::Cow;

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::Define;

/// A piece of GLSL with the name of its file under `glsl/`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Chunk {
    pub name: Cow<'static, str>,
    pub text: Cow<'static, str>,
}

impl Chunk {
    /// The chunk for light `index`: every `@` in it becomes that number.
    pub fn for_light(&self, index: usize) -> Self {
        Self {
            name: format!("{} (light {index})", self.name).into(),
            text: self.text.replace('@', &index.to_string()).into(),
        }
    }
}

/// The [`Chunk`] of a file under `glsl/`.
macro_rules! glsl {
    ($path:literal) => {
        $crate::pass::Chunk {
            name: std::borrow::Cow::Borrowed($path),
            text: std::borrow::Cow::Borrowed(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/", $path))),
        }
    };
}
pub(crate) use glsl;

/// One shader variant. Two that are equal are compiled once.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Program {
    pub label: String,
    /// Defines before the chunks of both stages.
    pub defines: Vec<Define>,
    pub vertex: Vec<Chunk>,
    pub fragment: Vec<Chunk>,
    /// Attributes that the vertex stage reads; others are neither uploaded nor bound.
    pub attributes: Vec<Attribute>,
}

/// A vertex attribute at a fixed location.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Attribute {
    /// `position`, vec3.
    Position = 0,
    /// `normal`, vec3.
    Normal = 1,
    /// `texcoord`, vec2.
    Texcoord = 2,
}

impl Attribute {
    pub const ALL: [Self; 3] = [Self::Position, Self::Normal, Self::Texcoord];

    /// The name in GLSL.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Texcoord => "texcoord",
        }
    }

    pub fn components(self) -> i32 {
        match self {
            Self::Position | Self::Normal => 3,
            Self::Texcoord => 2,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Uniform {
    pub name: Cow<'static, str>,
    pub value: UniformValue,
}

#[derive(Clone, Debug, PartialEq)]
pub enum UniformValue {
    Float(f32),
    Vec2(Vec2),
    Vec3(Vec3),
    Vec4(Vec4),
    Vec4Array(Vec<Vec4>),
    Mat3(Mat3),
    Mat4(Mat4),
}

macro_rules! from_value {
    ($($type:ty => $variant:ident),*) => {
        $(impl From<$type> for UniformValue {
            fn from(value: $type) -> Self {
                Self::$variant(value)
            }
        })*
    };
}
from_value!(f32 => Float, Vec2 => Vec2, Vec3 => Vec3, Vec4 => Vec4, Vec<Vec4> => Vec4Array, Mat3 => Mat3, Mat4 => Mat4);

impl Uniform {
    pub fn new(name: impl Into<Cow<'static, str>>, value: impl Into<UniformValue>) -> Self {
        Self { name: name.into(), value: value.into() }
    }

    /// `name_index`, as the `@` chunks declare it.
    pub fn of_light(name: &str, index: usize, value: impl Into<UniformValue>) -> Self {
        Self::new(format!("{name}_{index}"), value)
    }
}
