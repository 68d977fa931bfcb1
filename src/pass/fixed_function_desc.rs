//! What a batch's shaders compute, in the terms of the fixed-function pipeline: plain values beside the program, for a
//! reader that has no shaders. Who writes the program sets them; tests hold the two readings against each other.
//!
//! Colours are linear RGB. Images are named as the batch's inputs are, so that they follow when the list is
//! renumbered.

use std::borrow::Cow;

use glam::{DMat4, Vec4};

use crate::geometry::{ObjectLinear, Placement};
use crate::math::texgen::Texgen;

/// What a batch draws.
#[derive(Clone, Debug, PartialEq)]
pub enum FixedFunctionDesc {
    /// Depth alone.
    Depth(Texturing),
    /// One colour, RGBA.
    Constant([f32; 4]),
    /// `(ambient + shade·diffuse)·decal + shade·specular`, summed over lights [techniques A12].
    Lit(Box<Lit>),
    /// A light's shade texture on the surfaces: its value as RGB and alpha 1 where the light reaches, 0 elsewhere.
    Sampled(Box<Sampled>),
    /// Something that fixed function has no words for: what that is.
    Shader(&'static str),
}

/// A surface's own textures: the inputs `decal_map`, `decal_alpha_map` and `alpha_map`, where the batch has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texturing {
    /// Generates (s, t) from the position in model space, in place of the mesh's coordinates.
    pub object_linear: Option<ObjectLinear>,
    /// The alpha test, GEQUAL 0.5.
    pub alpha_test: Option<AlphaTest>,
    /// Whether the decal's RGB modulates diffuse and ambient light.
    pub decal: bool,
    /// Where the decal lies on the coordinates.
    pub decal_placement: Placement,
    /// Where the alpha map does.
    pub alpha_placement: Placement,
}

/// What alpha is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaTest {
    pub opacity: f32,
    /// Whether the decal's alpha is a factor.
    pub decal: bool,
    /// Whether the alpha map stands in its red channel, not in its alpha.
    pub map_in_red: bool,
}

/// Surfaces under the illumination formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Lit {
    pub clip_from_eye: DMat4,
    /// GL's lighting per vertex; else Phong's, per fragment.
    pub per_vertex: bool,
    /// Whether normals count; `false`: the diffuse colour as it is.
    pub lit: bool,
    /// The scene's ambient light times the material's.
    pub scene_ambient: [f32; 3],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    /// Black where no light has a specular colour.
    pub specular: [f32; 3],
    pub shininess: f32,
    pub texturing: Texturing,
    pub lights: Vec<FixedFunctionLight>,
}

/// One light of [`Lit`].
#[derive(Clone, Debug, PartialEq)]
pub struct FixedFunctionLight {
    /// Into the scene's lights.
    pub index: usize,
    /// In eye space, homogeneous as GL_POSITION is: w = 0 for parallel light, whose direction is towards it.
    pub position: [f32; 4],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// GL's constant, linear and quadratic attenuation.
    pub attenuation: [f32; 3],
    /// The input that modulates diffuse and specular light, projected through the frustum.
    pub beam: Option<Cow<'static, str>>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// `None`: it reaches everywhere, and nothing is looked up by coordinates of it.
    pub projection: Option<Projection>,
    pub shade: Shade,
}

/// The view that shows a light's shade.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    pub clip_from_eye: DMat4,
    pub texturing: Texturing,
    /// As [`FixedFunctionLight::projection`].
    pub projection: Option<Projection>,
    pub shade: Shade,
}

/// How a light's texture coordinates are generated, and where it reaches by them.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Which light's it is: the index that the light's uniforms end in.
    pub light: usize,
    pub texgen: Texgen,
    /// Scale and offset from (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// Whether the light ends at the frustum's sides.
    pub bounded: bool,
    /// Whether it reaches only into the circle inscribed in the square.
    pub cone: bool,
}

/// Where a light's shade comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// It is 1.
    Lit,
    /// It is 0.
    Dark,
    /// The input of this name at (s/q, t/q, r/q), by its sampler; compared where that compares.
    Texture {
        input: Cow<'static, str>,
        /// Whether r/q is clamped to [0, 1] although the format does not clamp it.
        clamped: bool,
    },
    /// Something that fixed function has no words for: what that is.
    Shader(&'static str),
}
