//! Light that differs over a spotlight's cross-section and along its axis: intensity maps and laws of distance [Segal 1992,
//! 3.2], and how their coordinates are interpolated [Segal 1992, 2]. Plain values; `resolve/beam.rs` and
//! `resolve/falloff.rs` read them.
//!
//! Places in a cross-section are (s, t) in [0, 1], s to the right and t upwards as the light sees them.

use std::sync::Arc;

use crate::geometry::Texture;

/// Filter of a light's image. None reads a texel beyond the image's border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFilter {
    /// The texel at the point.
    Nearest,
    /// The four texels around it.
    Linear,
    /// Between and within mipmap levels, by the image's own footprint in the picture.
    Trilinear,
}

/// Interpolation of a light's texture coordinates over a triangle [Segal 1992, 2].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// By GL: (s, t, r, q) with perspective.
    Perspective,
    /// (s, t, r, q) linearly in the picture: a mistake that makes images swim.
    Affine,
    /// (s, t, r, q) / w linearly in the picture, divided at each pixel [Segal 1992, Equations 7 and 8].
    Segal,
}

/// Intensity over a spotlight's cross-section, and the map that is made of it when the scene is loaded.
#[derive(Clone, Debug)]
pub struct LightBeam {
    /// Intensity by the angle from the axis.
    pub profile: BeamProfile,
    /// Picture that stands before the lamp and modulates its light.
    pub shield: Option<Arc<Texture>>,
    /// k₁ of a lens, in [-1, 1]: light of radius r comes from radius r (1 + k₁ r²), both as shares of the half height of
    /// the cross-section. What comes from beyond the cross-section is dark. It moves profile, shield and image.
    pub lens: f64,
    /// The product of profile and shield, through the lens; of the light's image too if there is a lens.
    pub map: Arc<Texture>,
    /// Greatest error of the map between its texels, in codes of 1/255, beside the rounding of its texels.
    pub map_error_codes: f64,
}

/// Intensity by the angle from the light's axis.
#[derive(Clone, Debug, PartialEq)]
pub enum BeamProfile {
    /// The same at every angle.
    Even,
    /// Intensities in [0, 1] at equal steps of tan θ from the axis to tan(cone / 2), linear between; the last goes on.
    Table(Vec<f64>),
    /// cosⁿ θ, as GL_SPOT_EXPONENT has it.
    Exponent(f64),
}

/// Intensity by the distance along a spotlight's axis. Distances below the near plane's and above the far plane's count as
/// theirs.
#[derive(Clone, Debug, PartialEq)]
pub struct Falloff {
    /// The law as written.
    pub law: FalloffLaw,
    /// The law as the texture has it.
    pub table: Arc<DistanceTable>,
}

/// A law of planar distance.
#[derive(Clone, Debug, PartialEq)]
pub enum FalloffLaw {
    /// Distances, each above the one before, with factors in [0, 1]; linear between, constant beyond.
    Table(Vec<[f64; 2]>),
    /// d₀ / d, at most 1.
    Inverse(f64),
    /// (d₀ / d)², at most 1.
    InverseSquare(f64),
}

/// A law of distance at even steps, as a 1D texture has it: linear between the centres of its texels. The first lies at the
/// near plane, the last at the far plane.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceTable {
    /// Factors, at least two; those above 1 count as 1. With [`TableSteps::Entries`] the distances come first.
    pub values: Arc<[f32]>,
    /// Quantity that the steps are even in.
    pub steps: TableSteps,
    /// Greatest error between the texels, in codes of 1/255.
    pub error_codes: f64,
}

/// Quantity that a table's steps are even in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableSteps {
    /// Depth in the light's window space, which is linear in 1/d.
    Depth,
    /// Distance along the light's axis.
    Distance,
    /// Logarithm of that distance.
    Logarithm,
    /// No even steps: the distances of the law's own table, in front of their factors. What lies between is exact.
    Entries,
}
