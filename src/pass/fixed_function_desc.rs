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
    /// A light's shade texture on the surfaces: its value as RGB and alpha 1 where the light reaches, 0 elsewhere.
    Sampled(Box<ShadeView>),
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
    pub opacity: f32,
    /// True if the decal's alpha is a factor.
    pub decal: bool,
    /// True if the alpha map's values are in its red channel, not in its alpha.
    pub map_in_red: bool,
}

/// Surfaces under the illumination formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Lit {
    pub clip_from_eye: DMat4,
    /// True: GL's lighting per vertex; false: Phong's, per fragment.
    pub per_vertex: bool,
    /// True if normals count; `false`: the diffuse colour as it is.
    pub lit: bool,
    /// The scene's ambient light times the material's.
    pub scene_ambient: [f32; 3],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    /// Specular colour; black if no light has one.
    pub specular: [f32; 3],
    pub shininess: f32,
    pub texturing: Texturing,
    pub lights: Vec<FixedFunctionLight>,
}

/// One light of [`Lit`].
#[derive(Clone, Debug, PartialEq)]
pub struct FixedFunctionLight {
    /// Index into the scene's lights.
    pub index: usize,
    /// Position in eye space, homogeneous like GL_POSITION: w = 0 for parallel light, whose direction is towards it.
    pub position: [f32; 4],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// GL's constant, linear and quadratic attenuation.
    pub attenuation: [f32; 3],
    /// The inputs that modulate diffuse and specular light, projected through the frustum.
    pub beams: Vec<Cow<'static, str>>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Texture coordinates of the light; `None`: it reaches everywhere, and no lookup needs them.
    pub projection: Option<Projection>,
    pub shade: Shade,
}

/// The view that shows a light's shade.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadeView {
    pub clip_from_eye: DMat4,
    pub texturing: Texturing,
    /// As [`FixedFunctionLight::projection`].
    pub projection: Option<Projection>,
    pub shade: Shade,
}

/// Generation of a light's texture coordinates, and its reach in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Index of the light, as at the end of its uniforms' names.
    pub light: usize,
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
        input: Cow<'static, str>,
        /// True if r/q is clamped to [0, 1] although the format does not clamp it.
        clamped: bool,
    },
    /// Something that fixed function cannot express, in words.
    Shader(&'static str),
}
