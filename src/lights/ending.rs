//! Content of a surface's fragments.

use crate::pass::Chunk;

/// Content of a surface's fragments.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The illumination formula.
    Lit,
    /// Part of the illumination formula, for passes that put it together [GDC, "Three Passes"].
    Part(FormulaPart),
    /// A property of the surfaces, without light: its chunk has `main`.
    Surface { chunk: Chunk, shown: SurfaceProperty },
    /// A vector to one light in tangent space: its chunk has `main`. `half`: the half-angle vector.
    TangentVector { chunk: Chunk, half: bool },
    /// Factors of the colour, for passes that multiply them by blending.
    Factors(Factors),
    /// The shade of one light in alpha: its chunk has `main`, which calls `shade_@`.
    Alpha(Chunk),
    /// A view of one light: its chunk has `main`, and `shade` says whether it calls `shade_@`.
    View { chunk: Chunk, shade: bool },
    /// A slice of one light's beam: `chunk` has `main`, and reads the light's shade, colour, image and attenuation. `place`
    /// has what moves the light's texture coordinates before all that.
    Slice { chunk: Chunk, place: Option<Chunk> },
}

/// Property of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceProperty {
    /// The normal that light counts with, bumps included, in world space.
    Normal,
    /// The normal map, in tangent space.
    NormalMap,
    /// Diffuse colour times decal.
    Decal,
    /// Share of specular light.
    Gloss,
}

/// Part of `(ambient + diffuse) decal + specular`.
#[derive(Clone, Debug, PartialEq)]
pub enum FormulaPart {
    /// Ambient and diffuse light, without the decal.
    Diffuse,
    /// The decal, with the gloss in alpha: its chunk has `main`.
    Decal(Chunk),
    /// Specular light, without the gloss.
    Specular,
}

/// Factors of `color (ambient + light)`. The lights' part is there where a pass has lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// Chunk with `main`.
    pub chunk: Chunk,
    /// True if the scene's ambient light is added to the lights.
    pub ambient: bool,
    /// True if the surface's own colour, diffuse colour times decal, is a factor.
    pub color: bool,
}

impl Ending {
    /// Tests whether it shows light on surfaces; other endings show facts of one light, also where it does not reach.
    pub fn shows_light(&self) -> bool {
        matches!(self, Self::Lit | Self::Part(_) | Self::Factors(_))
    }

    /// Tests whether it shows the illumination formula, or light that is a part of it.
    pub fn is_lit(&self) -> bool {
        matches!(self, Self::Lit | Self::Part(FormulaPart::Diffuse | FormulaPart::Specular))
    }
}
