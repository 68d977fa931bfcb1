//! Shadow techniques, each describing passes as data. Knows scene, pass, geometry and math; no GL.
//!
//! # How to add a technique
//!
//! 1. A folder here with a type that implements [`Technique`]; its shaders in a folder of the same name under `glsl/`,
//!    whose README says what a shade must define and what it may read.
//! 2. Its row in [`TABLE`].
//! 3. A case folder of the same name under `data/cases/`.
//!
//! Nothing else changes: scenes name it in `[light.shadow]`, the plan calls it, the device draws its passes.

pub mod claims;
mod midpoint;
mod none;
mod second_depth;
mod shadow_map;
mod shadow_volume;

use self::claims::Claim;
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::PassList;
use crate::scene::{LightKind, Reader, Scene, Settings, SettingsError, suggest};

/// A way to find which points a light reaches.
pub trait Technique: Sync {
    /// The value of `technique` in `[light.shadow]`.
    fn name(&self) -> &'static str;

    /// One line for tables and `--help`.
    fn summary(&self) -> &'static str;

    /// The document and section that it implements.
    fn source(&self) -> &'static str;

    /// Tests whether it finds the shade of such lights.
    ///
    /// # Errors
    ///
    /// The reason why not, as the end of a sentence that begins with the technique's name.
    fn serves(&self, kind: &LightKind) -> Result<(), &'static str>;

    /// Tests whether it reads casters' vertices, which the vertex stage then must not move.
    fn needs_vertices(&self) -> bool {
        false
    }

    /// Keys that a report varies, with their values.
    fn axes(&self) -> &'static [Axis];

    /// Smaller grids beside that of [`Technique::axes`], for keys that need not be crossed with all others.
    fn more_axes(&self, _kind: &LightKind) -> &'static [&'static [Axis]] {
        &[]
    }

    /// Claims of its documents, which a report measures on its scene.
    fn claims(&self) -> &'static [Claim] {
        &[]
    }

    /// Validates the technique's keys of `[light.shadow]` without planning anything.
    ///
    /// # Errors
    ///
    /// A key with a wrong value, with its place in the scene file.
    fn check(&self, settings: &mut Reader<'_>) -> Result<(), SettingsError>;

    /// Reads the technique's keys of `[light.shadow]`, adds the passes that prepare the light to `list`, and returns the
    /// light's term for the lit pass. Notes what it leaves out in `notes`.
    ///
    /// # Errors
    ///
    /// A light that it does not serve, a key with a wrong value; with its place in the scene file.
    fn describe(
        &self,
        view: &LightView<'_>,
        settings: &mut Reader<'_>,
        list: &mut PassList,
        notes: &mut Notes,
    ) -> Result<LightTerm, SettingsError>;
}

/// A key of `[light.shadow]` that a report varies.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    pub key: &'static str,
    /// Values in TOML.
    pub values: &'static [&'static str],
    /// Fewer values, for a quick report.
    pub quick: &'static [&'static str],
}

/// Every technique.
pub const TABLE: &[&dyn Technique] = &[
    &none::Unshadowed,
    &shadow_map::ShadowMap,
    &midpoint::Midpoint,
    &second_depth::SecondDepth,
    &shadow_volume::ShadowVolume,
];

/// Checks the keys that only other techniques read: they may be present, so that only `technique` needs to be changed.
///
/// # Errors
///
/// A key with a wrong value, with its place in the scene file.
pub fn check_others(chosen: &dyn Technique, settings: &mut Reader<'_>) -> Result<(), SettingsError> {
    TABLE.iter().filter(|row| row.name() != chosen.name()).try_for_each(|row| row.check(settings))
}

/// The keys of `[light.shadow]` that a technique reads.
pub fn keys(technique: &dyn Technique) -> Vec<&'static str> {
    let empty = Settings::default();
    let mut keys = empty.read();
    // A key that is absent has no wrong value.
    let _ = technique.check(&mut keys);
    keys.known().to_vec()
}

/// Tests whether the technique of some light of the scene reads casters' vertices.
pub fn needs_vertices(scene: &Scene) -> bool {
    scene.lights.iter().any(|source| {
        let mut keys = source.shadow.read();
        chosen(&source.kind, &mut keys).is_ok_and(|technique| technique.needs_vertices())
    })
}

/// The technique that `[light.shadow]` of a light of this `kind` names; an absent table means none.
///
/// # Errors
///
/// A name that no row of the table has, or one whose technique does not serve such lights.
pub fn chosen(kind: &LightKind, settings: &mut Reader<'_>) -> Result<&'static dyn Technique, SettingsError> {
    let name = settings.string("technique")?.unwrap_or("none");
    let Some(technique) = TABLE.iter().find(|row| row.name() == name) else {
        let names = TABLE.iter().map(|row| row.name());
        return Err(settings.error("technique", format_args!("cannot be \"{name}\": {}", suggest(name, names))));
    };
    technique.serves(kind).map_err(|why| {
        let light = kind.name();
        settings.error("technique", format_args!("cannot be \"{name}\" for a {light} light: it {why}"))
    })?;
    Ok(*technique)
}
