//! Shader variants as data: chunks in order, defines, attributes, uniforms by name.

use std::borrow::Cow;

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::Define;

/// A piece of GLSL with the name of its file under `glsl/`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Chunk {
    /// Path below `glsl/`, for errors and listings.
    pub name: Cow<'static, str>,
    /// GLSL text.
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
    /// Label, as `glumbra plan` and errors print it.
    pub label: String,
    /// Defines before the chunks of both stages.
    pub defines: Vec<Define>,
    /// Chunks of the vertex stage, in order.
    pub vertex: Vec<Chunk>,
    /// Chunks of the fragment stage, in order.
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
    /// `tangent`, vec3.
    Tangent = 3,
    /// `bitangent`, vec3.
    Bitangent = 4,
    /// `vertex_color`, vec3.
    Color = 5,
}

impl Attribute {
    /// All of them, by location.
    pub const ALL: [Self; 6] =
        [Self::Position, Self::Normal, Self::Texcoord, Self::Tangent, Self::Bitangent, Self::Color];

    /// The name in GLSL.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Texcoord => "texcoord",
            Self::Tangent => "tangent",
            Self::Bitangent => "bitangent",
            Self::Color => "vertex_color",
        }
    }

    /// Number of floats for each vertex.
    pub fn components(self) -> i32 {
        match self {
            Self::Position | Self::Normal | Self::Tangent | Self::Bitangent | Self::Color => 3,
            Self::Texcoord => 2,
        }
    }
}

/// A uniform by name, with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Uniform {
    /// Name in GLSL.
    pub name: Cow<'static, str>,
    /// Value, whose kind must be the type in GLSL.
    pub value: UniformValue,
}

/// Value of a uniform, by its GLSL type.
#[derive(Clone, Debug, PartialEq)]
pub enum UniformValue {
    /// `float`.
    Float(f32),
    /// `vec2`.
    Vec2(Vec2),
    /// `vec3`.
    Vec3(Vec3),
    /// `vec4`.
    Vec4(Vec4),
    /// `vec4[]`, from element 0.
    Vec4Array(Vec<Vec4>),
    /// `mat3`, in columns.
    Mat3(Mat3),
    /// `mat4`, in columns.
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

impl UniformValue {
    /// All numbers in it, in order.
    pub fn floats(&self) -> Vec<f32> {
        match self {
            Self::Float(value) => vec![*value],
            Self::Vec2(value) => value.to_array().into(),
            Self::Vec3(value) => value.to_array().into(),
            Self::Vec4(value) => value.to_array().into(),
            Self::Vec4Array(values) => values.iter().flat_map(|value| value.to_array()).collect(),
            Self::Mat3(value) => value.to_cols_array().into(),
            Self::Mat4(value) => value.to_cols_array().into(),
        }
    }
}

impl Uniform {
    /// The uniform `name` with this value.
    pub fn new(name: impl Into<Cow<'static, str>>, value: impl Into<UniformValue>) -> Self {
        Self { name: name.into(), value: value.into() }
    }

    /// `name_index`, as the `@` chunks declare it.
    pub fn of_light(name: &str, index: usize, value: impl Into<UniformValue>) -> Self {
        Self::new(format!("{name}_{index}"), value)
    }
}
