//! Compositions: the passes in which light becomes a picture. Folders are the rows of [`TABLE`]; files beside them are shared
//! parts and `dust`.
//!
//! # How to add a composition
//!
//! 1. A folder here with a type that implements [`Composition`]; its shaders in a folder of the same name under `glsl/`.
//! 2. Its row in [`TABLE`].
//! 3. A case folder of the same name under `data/cases/`.
//!
//! A composition's code depends on light terms, not on techniques; surfaces are given to it as a function, [`passes::Surfaces`].

mod alpha_shadows;
pub mod dust;
pub mod focus;
mod groups;
mod layer;
mod once;
mod parts;
pub mod passes;
pub mod projection;
mod single_pass;
mod slide_projector;
mod stencil_counted;
mod three_pass;

use self::passes::Passes;
use self::projection::CameraProjection;
use crate::lights::LightTerm;
use crate::pass::{ImageId, Target};
use crate::scene::Scene;
use crate::views::View;

/// A way to make a picture of lights and surfaces.
pub trait Composition: Sync {
    /// The name; of its folders too, with underscores in `src/` and `glsl/`.
    fn name(&self) -> &'static str;

    /// True if it draws this scene with these lights: by `[shading] passes`, and by whether a light counts in the stencil buffer.
    fn serves(&self, scene: &Scene, terms: &[&LightTerm]) -> bool;

    /// Tests whether its picture of these lights has a stencil buffer.
    fn needs_stencil(&self, passes: &Passes<'_>, terms: &[&LightTerm]) -> bool;

    /// Checks that it can draw these lights together.
    ///
    /// # Errors
    ///
    /// Lights that exclude each other.
    fn check(&self, scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error>;

    /// Adds the passes of the picture: all surfaces in the light of `terms`. `lens`: the camera's projection and depth range.
    ///
    /// # Errors
    ///
    /// A light whose transform has no inverse.
    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error>;

    /// Adds the passes of a picture beside the picture (`--aov`) of one light, and returns the image that they end in. `None`:
    /// it has no passes of its own; one pass of the surfaces shows it.
    ///
    /// # Errors
    ///
    /// A view of what the light does not have.
    fn view(
        &self,
        _passes: &mut Passes<'_>,
        _view: View,
        _label: &str,
        _term: &LightTerm,
    ) -> Result<Option<ImageId>, Error> {
        Ok(None)
    }
}

/// Every composition.
pub const TABLE: &[&dyn Composition] = &[
    &single_pass::SinglePass,
    &three_pass::ThreePass,
    &stencil_counted::StencilCounted,
    &slide_projector::SlideProjector,
    &alpha_shadows::AlphaShadows,
];

/// Reason why lights cannot be drawn together.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("no composition draws lights {lights:?} in one picture")]
    Unserved { lights: Vec<usize> },
    #[error(
        "--aov {view}: light {light} counts no shadow volumes: give it a technique that does, such as \"shadow-volume\""
    )]
    NoCount { view: &'static str, light: usize },
    #[error(
        "guard = \"clip-plane\" (light {light}) cannot be combined with a stencil-counted light (light {counted}): clipping changes depth values, and that light is drawn with depth EQUAL. Choose another guard."
    )]
    CutDepths { light: usize, counted: usize },
    #[error(
        "guard = \"clip-plane\" (light {light}) cannot be combined with {lights} lights: clipping changes depth values, and lights that do not fit into one pass are added with depth EQUAL. Choose another guard."
    )]
    CutGroups { light: usize, lights: usize },
    #[error(
        "ledge of light {second} differs from that of light {first}: the picture has one depth buffer; give both the same depths"
    )]
    TwoLedges { first: usize, second: usize },
    /// A dusty light's technique finds no shade between surfaces.
    #[error(
        "[light.dust] of light {light} needs shadows in the air, and {why}. Choose technique = \"shadow-map\", \"second-depth\" or \"none\""
    )]
    DustUnshadowed {
        /// Index into the scene's lights.
        light: usize,
        /// Reason: what the light's technique does instead.
        why: &'static str,
    },
    /// A light of the slide projector's passes has the law of lit surfaces.
    #[error(
        "passes = \"slide\" projects images and lights nothing: light {light} (\"{name}\") has law = \"lit\". Give it law = \"slide\" and no shadow, or choose passes = \"one\"."
    )]
    NoSlide { light: usize, name: String },
    /// A light of the passes with destination alpha keeps its shade in the stencil buffer.
    #[error(
        "passes = \"shadow\" keeps a light's shade in alpha: light {light} counts or tags its shadow in the stencil buffer. Choose a shadow map that is looked up by the shader (into = \"shader\", another guard than \"stencil\"), or passes = \"one\"."
    )]
    CountedShade { light: usize },
    /// A clip plane cuts surfaces that passes with depth test EQUAL draw again.
    #[error(
        "guard = \"clip-plane\" (light {light}) cannot be combined with passes = \"shadow\": clipping changes depth values, and lights are added with depth EQUAL. Choose another guard."
    )]
    CutShade { light: usize },
    /// A light's lens points cannot be added one by one.
    #[error(
        "`focus` of light {light}: its lens points are added one by one with depth EQUAL and a stencil bit for each, and the light {why}. Choose a technique with a map, such as \"shadow-map\", and guard = \"auto\""
    )]
    FocusCounted {
        /// Index into the scene's lights.
        light: usize,
        /// Reason, as the end of a sentence that begins with the light.
        why: &'static str,
    },
    #[error(
        "`focus` of light {light}: lighting per vertex is clamped as a whole, not lens point by lens point. Leave out `lighting` of [shading], or `focus`"
    )]
    FocusPerVertex { light: usize },
    /// A counted light beside bumps in three passes.
    #[error(
        "bump = \"three-pass\" multiplies the decal into the light of all pixels at once: light {light} is counted in the stencil buffer, and joins where its count is 0. Choose bump = \"one-pass\", which adds a light with its decal, or a technique with a map."
    )]
    CountedParts { light: usize },
    /// A clip plane cuts surfaces that the second and third pass draw again.
    #[error(
        "guard = \"clip-plane\" (light {light}) cannot be combined with bump = \"three-pass\": clipping changes depth values, and decals and highlights are added with depth EQUAL. Choose another guard."
    )]
    CutParts { light: usize },
    /// Photographs beside bumps in three passes.
    #[error(
        "bump = \"three-pass\" puts surfaces' colours together from light, decal and highlights, and a photograph is none of them. Choose bump = \"one-pass\" or \"reference\", or leave out `photo`."
    )]
    PhotoParts,
    #[error("light {light}: the transform to its map has no inverse: choose near and far with a smaller ratio")]
    Singular { light: usize },
}

/// The composition that draws these lights of `scene`.
///
/// # Errors
///
/// Lights that no row of the table serves.
pub fn chosen(scene: &Scene, terms: &[&LightTerm]) -> Result<&'static dyn Composition, Error> {
    let found = TABLE.iter().find(|row| row.serves(scene, terms));
    found.copied().ok_or_else(|| Error::Unserved { lights: terms.iter().map(|term| term.index).collect() })
}
