//! Compositions: the passes in which light becomes a picture. Each is a row of [`TABLE`].
//!
//! # How to add a composition
//!
//! 1. A folder here with a type that implements [`Composition`]; its shaders in a folder of the same name under `glsl/`.
//! 2. Its row in [`TABLE`].
//! 3. A case folder of the same name under `data/cases/`.
//!
//! A composition reads light terms, never a technique; surfaces are given to it as a function, [`passes::Surfaces`].

pub mod dust;
pub mod focus;
mod groups;
mod layer;
pub mod passes;
pub mod projection;
mod single_pass;
mod stencil_counted;

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

    /// Tests whether it draws pictures in which these lights meet.
    fn serves(&self, terms: &[&LightTerm]) -> bool;

    /// Tests whether its picture of these lights has a stencil buffer.
    fn needs_stencil(&self, scene: &Scene, terms: &[&LightTerm]) -> bool;

    /// Checks that it can draw these lights together.
    ///
    /// # Errors
    ///
    /// Lights that exclude each other.
    fn check(&self, scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error>;

    /// Adds the passes of the picture: all surfaces in the light of `terms`.
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

    /// Adds the passes of a view of one light, and returns the image that they end in. `None`: one pass of the surfaces
    /// shows the view.
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
pub const TABLE: &[&dyn Composition] = &[&single_pass::SinglePass, &stencil_counted::StencilCounted];

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
        /// Reason, as the end of a sentence.
        why: &'static str,
    },
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
    #[error("light {light}: the transform to its map has no inverse: choose near and far with a smaller ratio")]
    Singular { light: usize },
}

/// The composition that draws these lights.
///
/// # Errors
///
/// Lights that no row of the table serves.
pub fn chosen(terms: &[&LightTerm]) -> Result<&'static dyn Composition, Error> {
    let found = TABLE.iter().find(|row| row.serves(terms));
    found.copied().ok_or_else(|| Error::Unserved { lights: terms.iter().map(|term| term.index).collect() })
}
