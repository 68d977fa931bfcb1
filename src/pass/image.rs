//! Images that passes draw into and read from, and how they are sampled.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;
use std::mem::{Discriminant, discriminant};
use std::sync::Arc;

use super::Compare;
use crate::geometry::Texture;
use crate::geometry::bump::TexelLevels;
use crate::process::work;

/// Index into [`super::PassList::images`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ImageId(pub usize);

/// Description of an image: what the device makes for it.
#[derive(Clone, Debug)]
pub struct ImageDesc {
    /// Label, as `glumbra plan` prints it.
    pub label: String,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Format of a texel.
    pub format: Format,
    /// Kind of GL object, and where its texels come from.
    pub storage: Storage,
}

impl PartialEq for ImageDesc {
    fn eq(&self, other: &Self) -> bool {
        work::count_comparison();
        (self.size, self.format) == (other.size, other.format)
            && self.label == other.label
            && self.storage == other.storage
    }
}

/// Storage of an image's texels, and their origin.
#[derive(Clone, Debug)]
pub enum Storage {
    /// A texture that passes draw or copy into and sample.
    Texture,
    /// A texture with so many mipmap levels, at least one, each drawn by a pass of its own.
    Mipmapped(u32),
    /// A cube map, six square faces of the image's size.
    Cube(Cube),
    /// A renderbuffer: drawn into, never sampled.
    Renderbuffer,
    /// A texture filled from the CPU, with mipmaps.
    Uploaded(Arc<Texture>),
    /// A texture filled from the CPU, each level with texels of its own.
    Levels(Arc<TexelLevels>),
    /// A cube map of unit vectors, each through the middle of its texel.
    UnitVectors,
    /// A 1D texture of these RGBA texels, of one level.
    Line(&'static [[u8; 4]]),
    /// A 1D texture of these values, red in 32-bit floats, of one level.
    Values(Arc<[f32]>),
}

impl Storage {
    /// Number of faces of a cube map; otherwise 1.
    pub fn layers(&self) -> u64 {
        if let Self::Cube(_) | Self::UnitVectors = self { 6 } else { 1 }
    }

    /// Tests whether there are texels of smaller levels beside those of the image's size.
    pub fn is_mipmapped(&self) -> bool {
        matches!(self, Self::Uploaded(_) | Self::Levels(_) | Self::Mipmapped(2..))
    }
}

impl PartialEq for Storage {
    fn eq(&self, other: &Self) -> bool {
        work::count_comparison();
        match (self, other) {
            (Self::Texture, Self::Texture) | (Self::Renderbuffer, Self::Renderbuffer) => true,
            (Self::Mipmapped(a), Self::Mipmapped(b)) => a == b,
            (Self::Cube(a), Self::Cube(b)) => a == b,
            (Self::Uploaded(a), Self::Uploaded(b)) => Arc::ptr_eq(a, b),
            (Self::Levels(a), Self::Levels(b)) => Arc::ptr_eq(a, b),
            (Self::UnitVectors, Self::UnitVectors) => true,
            (Self::Line(a), Self::Line(b)) => a == b,
            (Self::Values(a), Self::Values(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// Images whose texels come from the CPU, by the place of these in memory: a list of any length finds one at once.
#[derive(Clone, Debug, Default)]
pub struct FilledImages(HashMap<(Discriminant<Storage>, usize, [u32; 2]), ImageId>);

impl FilledImages {
    /// Entry of an image of a size; `None` where passes draw it.
    pub(super) fn of(&mut self, storage: &Storage, size: [u32; 2]) -> Option<&mut ImageId> {
        let texels = match storage {
            Storage::Texture | Storage::Mipmapped(_) | Storage::Cube(_) | Storage::Renderbuffer => return None,
            Storage::Uploaded(texture) => Arc::as_ptr(texture) as usize,
            Storage::Levels(levels) => Arc::as_ptr(levels) as usize,
            Storage::UnitVectors => 0,
            Storage::Line(texels) => texels.as_ptr() as usize,
            Storage::Values(values) => values.as_ptr() as usize,
        };
        Some(self.0.entry((discriminant(storage), texels, size)).or_insert(ImageId(usize::MAX)))
    }
}

/// It follows from the images.
impl PartialEq for FilledImages {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Faces of a cube map that passes draw, and what the others hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    /// Drawn faces, in the order of [`CubeFace::ALL`].
    pub drawn: [bool; 6],
    /// Depth of every texel of a face that no pass draws.
    pub rest: f32,
}

/// A face of a cube map, in GL's order; named by the axis that it is looked along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CubeFace {
    /// GL_TEXTURE_CUBE_MAP_POSITIVE_X.
    PositiveX,
    /// GL_TEXTURE_CUBE_MAP_NEGATIVE_X.
    NegativeX,
    /// GL_TEXTURE_CUBE_MAP_POSITIVE_Y.
    PositiveY,
    /// GL_TEXTURE_CUBE_MAP_NEGATIVE_Y.
    NegativeY,
    /// GL_TEXTURE_CUBE_MAP_POSITIVE_Z.
    PositiveZ,
    /// GL_TEXTURE_CUBE_MAP_NEGATIVE_Z.
    NegativeZ,
}

impl CubeFace {
    /// All six, in GL's order.
    pub const ALL: [Self; 6] =
        [Self::PositiveX, Self::NegativeX, Self::PositiveY, Self::NegativeY, Self::PositiveZ, Self::NegativeZ];

    /// `+x` and so on.
    pub fn name(self) -> &'static str {
        ["+x", "-x", "+y", "-y", "+z", "-z"][self as usize]
    }
}

/// Format of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// GL_RGBA8.
    Rgba8,
    /// GL_RGBA8_SNORM.
    Rgba8Signed,
    /// GL_RGBA32F.
    Rgba32F,
    /// One 32-bit float.
    R32F,
    /// Depth with a stated number of bits.
    Depth(DepthFormat),
    /// Unsized: the driver chooses the bits [GL 4.6, 8.5.1].
    UnsizedDepth,
    /// Packed: separate depth and stencil attachments are optional, and llvmpipe has none [GL 4.6, 9.4.2].
    Depth24Stencil8,
}

impl Format {
    /// Tests whether it is attached as depth.
    pub fn has_depth(self) -> bool {
        matches!(self, Self::Depth(_) | Self::UnsizedDepth | Self::Depth24Stencil8)
    }

    /// Bytes of a texel as commonly stored; 24-bit depth takes four, and so does an unsized one.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Rgba8 | Self::Rgba8Signed => 4,
            Self::Rgba32F => 16,
            Self::R32F => 4,
            Self::Depth(DepthFormat::Depth16) => 2,
            Self::Depth(_) | Self::UnsizedDepth | Self::Depth24Stencil8 => 4,
        }
    }
}

/// Sized depth formats [GL 4.6, table 8.13].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// GL_DEPTH_COMPONENT16, fixed point.
    Depth16,
    /// GL_DEPTH_COMPONENT24, fixed point.
    Depth24,
    /// GL_DEPTH_COMPONENT32, fixed point.
    Depth32,
    /// GL_DEPTH_COMPONENT32F, floating point.
    Depth32F,
}

impl DepthFormat {
    /// The bits that the format names.
    pub fn bits(self) -> u32 {
        match self {
            Self::Depth16 => 16,
            Self::Depth24 => 24,
            Self::Depth32 | Self::Depth32F => 32,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rgba8 => "RGBA8",
            Self::Rgba8Signed => "RGBA8_SNORM",
            Self::Rgba32F => "RGBA32F",
            Self::R32F => "R32F",
            Self::Depth(DepthFormat::Depth16) => "DEPTH_COMPONENT16",
            Self::Depth(DepthFormat::Depth24) => "DEPTH_COMPONENT24",
            Self::Depth(DepthFormat::Depth32) => "DEPTH_COMPONENT32",
            Self::Depth(DepthFormat::Depth32F) => "DEPTH_COMPONENT32F",
            Self::UnsizedDepth => "DEPTH_COMPONENT",
            Self::Depth24Stencil8 => "DEPTH24_STENCIL8",
        })
    }
}

/// An image bound to a shader's sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// The sampler uniform.
    pub name: Cow<'static, str>,
    /// Image that is sampled.
    pub image: ImageId,
    /// Way in which it is sampled.
    pub sampler: Sampler,
}

/// Sampling of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// GL_TEXTURE_MIN_FILTER and GL_TEXTURE_MAG_FILTER.
    pub filter: Filter,
    /// GL_TEXTURE_WRAP_S and GL_TEXTURE_WRAP_T.
    pub wrap: Wrap,
    /// GL_TEXTURE_COMPARE_MODE = GL_COMPARE_REF_TO_TEXTURE with this function; `None`: GL_NONE.
    pub compare: Option<Compare>,
    /// Value of both GL_TEXTURE_MIN_LOD and GL_TEXTURE_MAX_LOD, in halves of a level; `None`: GL's defaults, which clamp
    /// nothing.
    pub lod_halves: Option<u8>,
}

/// Filter of a sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// GL_NEAREST.
    Nearest,
    /// GL_LINEAR; drivers average the results of a comparison, too (percentage closer filtering).
    Linear,
    /// GL_LINEAR_MIPMAP_LINEAR, magnified by GL_LINEAR.
    Trilinear,
}

/// Addressing of coordinates outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// GL_REPEAT.
    Repeat,
    /// GL_CLAMP_TO_EDGE.
    ClampToEdge,
    /// Texels beyond [0, 1] have this value in all components [GL 4.6, 8.14.2].
    ClampToBorder(Border),
}

/// Border of a texture, equal in all components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Border {
    /// 0: for a depth map, nearest.
    Zero,
    /// 1: for a depth map, farthest.
    One,
}

impl Border {
    /// GL_TEXTURE_BORDER_COLOR.
    pub fn color(self) -> [f32; 4] {
        match self {
            Self::Zero => [0.0; 4],
            Self::One => [1.0; 4],
        }
    }
}
