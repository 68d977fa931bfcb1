//! Description of a batch's shaders in the terms of the fixed-function pipeline: plain values beside the program, for a
//! reader without shaders. Code that chooses the program sets them; tests compare the two.
//!
//! Colours are linear RGB. Images are named as the batch's inputs are, so that they follow when the list is
//! renumbered.

use std::borrow::Cow;

use glam::{DMat4, Vec4};

use crate::geometry::{ObjectLinear, Placement};
use crate::math::texgen::Texgen;

/// Description of a batch.
#[derive(Clone, Debug, PartialEq)]
pub enum FixedFunctionDesc {
    /// Depth only.
    Depth(Texturing),
    /// One colour, RGBA.
    Constant([f32; 4]),
    /// `(ambient + shade·diffuse)·decal + shade·specular`, summed over lights [LEC, "Advice for Shadowed Illumination
    /// Model"].
    Lit(Box<Lit>),
    /// The decal, and the gloss in alpha, for a pass that multiplies by both [GDC, "Three Passes"].
    Decal(Box<Decal>),
    /// A light's shade texture on the surfaces: its value as RGB and alpha 1 where the light reaches, 0 elsewhere.
    Sampled(Box<ShadeView>),
    /// The same value as alpha, without a colour [Segal 1992, 3.3].
    Alpha(Box<ShadeView>),
    /// Something that fixed function cannot express, in words.
    Shader(&'static str),
}

/// A surface's own textures: the inputs `decal_map`, `decal_alpha_map` and `alpha_map`, where the batch has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texturing {
    /// Generates (s, t) from the position in model space, in place of the mesh's coordinates.
    pub object_linear: Option<ObjectLinear>,
    /// The alpha test, GEQUAL 0.5.
    pub alpha_test: Option<AlphaTest>,
    /// True if the decal's RGB modulates diffuse and ambient light.
    pub decal: bool,
    /// Placement of the decal on the coordinates.
    pub decal_placement: Placement,
    /// Placement of the alpha map.
    pub alpha_placement: Placement,
}

/// Factors of alpha.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaTest {
    /// Opacity of the material, in [0, 1].
    pub opacity: f32,
    /// True if the decal's alpha is a factor.
    pub decal: bool,
    /// True if the alpha map's values are in its red channel, not in its alpha.
    pub map_in_red: bool,
}

/// Surfaces under the illumination formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Lit {
    /// Projection of the camera.
    pub clip_from_eye: DMat4,
    /// True: GL's lighting per vertex; false: Phong's, per fragment.
    pub per_vertex: bool,
    /// True if normals count; `false`: the diffuse colour as it is.
    pub lit: bool,
    /// True if ambient light is in the picture already, and only bounds what each vertex adds beside it.
    pub added: bool,
    /// The scene's ambient light times the material's.
    pub scene_ambient: [f32; 3],
    /// Ambient reflectance of the material; black if no light needs it.
    pub ambient: [f32; 3],
    /// Diffuse reflectance of the material; black without lights.
    pub diffuse: [f32; 3],
    /// Specular colour; black if no light has one.
    pub specular: [f32; 3],
    /// Specular exponent; 0 if no light is specular.
    pub shininess: f32,
    /// Textures of the surface.
    pub texturing: Texturing,
    /// Bumps; they are lit per fragment by one light.
    pub bumps: Option<BumpMap>,
    /// Lights in the scene's order.
    pub lights: Vec<FixedFunctionLight>,
}

/// Bumps by the inputs `normal_map`, of normals in tangent space with the dimming in alpha, and `unit_vectors`, a cube map that
/// normalises the light vector L, or the half-angle vector H of light that is specular alone. Diffuse light is dim (N' . L)
/// min(1, 8 L_z), specular light (N' . H)^8 min(1, 8 H_z) [GDC, "Per-Pixel Lighting Math"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BumpMap {
    /// True if the normal map's texels are in [-1, 1]; `false`: x as (x + 1) / 2.
    pub is_signed: bool,
}

/// Decal and gloss.
#[derive(Clone, Debug, PartialEq)]
pub struct Decal {
    /// Projection of the camera.
    pub clip_from_eye: DMat4,
    /// Textures of the surface.
    pub texturing: Texturing,
    /// Source of alpha.
    pub gloss: GlossSource,
}

/// Source of a surface's gloss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlossSource {
    /// The gloss is 1.
    One,
    /// The decal's alpha.
    DecalAlpha,
    /// The input `gloss_map`, its red channel or its alpha.
    Map {
        /// True if the values are in the red channel.
        in_red: bool,
    },
}

impl FixedFunctionDesc {
    /// Projection of surfaces that are drawn through eye space; others have all of their transform in one matrix.
    pub fn clip_from_eye(&self) -> Option<DMat4> {
        match self {
            Self::Lit(lit) => Some(lit.clip_from_eye),
            Self::Decal(decal) => Some(decal.clip_from_eye),
            Self::Sampled(view) | Self::Alpha(view) => Some(view.clip_from_eye),
            Self::Depth(_) | Self::Constant(_) | Self::Shader(_) => None,
        }
    }

    /// Texture coordinates of the lights.
    pub fn projections(&self) -> Vec<&Projection> {
        match self {
            Self::Lit(lit) => lit.lights.iter().filter_map(|light| light.projection.as_ref()).collect(),
            Self::Sampled(view) | Self::Alpha(view) => view.projection.iter().collect(),
            Self::Depth(_) | Self::Constant(_) | Self::Decal(_) | Self::Shader(_) => Vec::new(),
        }
    }
}

/// One light of [`Lit`].
#[derive(Clone, Debug, PartialEq)]
pub struct FixedFunctionLight {
    /// Index into the scene's lights.
    pub index: usize,
    /// True if the angle to the normal counts; `false`: the light of a projector, which has no highlights either.
    pub cosine: bool,
    /// Position in eye space, homogeneous like GL_POSITION: w = 0 for parallel light, whose direction is towards it.
    pub position: [f32; 4],
    /// Ambient colour of the light.
    pub ambient: [f32; 3],
    /// Diffuse colour of the light.
    pub diffuse: [f32; 3],
    /// Specular colour of the light.
    pub specular: [f32; 3],
    /// GL's constant, linear and quadratic attenuation.
    pub attenuation: [f32; 3],
    /// The inputs that modulate diffuse and specular light, projected through the frustum.
    pub beams: Vec<Cow<'static, str>>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Factor of the diffuse light behind all else, in [0, 1].
    pub diffuse_weight: f32,
    /// Texture coordinates of the light; `None`: it reaches everywhere, and no lookup needs them.
    pub projection: Option<Projection>,
    /// Shade of the light at each point.
    pub shade: Shade,
}

/// A light's shade on the surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadeView {
    /// Projection of the camera.
    pub clip_from_eye: DMat4,
    /// Textures of the surface, for its alpha test.
    pub texturing: Texturing,
    /// As [`FixedFunctionLight::projection`].
    pub projection: Option<Projection>,
    /// Shade that is shown.
    pub shade: Shade,
}

/// Generation of a light's texture coordinates, and its reach in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Index of the light, as at the end of its uniforms' names.
    pub light: usize,
    /// Planes that make (s, t, r, q).
    pub texgen: Texgen,
    /// Scale and offset from (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// True if the light ends at the frustum's sides.
    pub bounded: bool,
    /// True if it reaches only into the circle inscribed in the square.
    pub cone: bool,
}

/// Source of a light's shade.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// The shade is 1.
    Lit,
    /// The shade is 0.
    Dark,
    /// The input of this name at (s/q, t/q, r/q), with a comparison if its sampler has one.
    Texture {
        /// Name of the input.
        input: Cow<'static, str>,
        /// True if r/q is clamped to [0, 1] although the format does not clamp it.
        clamped: bool,
    },
    /// Something that fixed function cannot express, in words.
    Shader(&'static str),
}
