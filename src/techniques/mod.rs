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
use crate::scene::{Law, Light, LightKind, Reader, Scene, Settings, SettingsError, suggest};

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

    /// Reads the technique's keys of `[light.shadow]`, each with its default, and checks them one by one.
    ///
    /// # Errors
    ///
    /// A key with a wrong value, with its place in the scene file.
    fn check(&self, keys: &mut Reader<'_>) -> Result<(), SettingsError>;

    /// Reads the keys for a light of this `kind`, and refuses keys that exclude each other.
    ///
    /// # Errors
    ///
    /// A key with a wrong value, or one that excludes the light's kind or another key; with its place in the scene file.
    fn read(&self, keys: &mut Reader<'_>, kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError>;
}

/// A light's keys as its technique has read them.
pub trait ShadowSettings {
    /// Adds the passes that prepare the light to `list`, and returns the light's term for the lit pass. Notes in `notes` what
    /// it leaves out.
    ///
    /// # Errors
    ///
    /// A scene whose objects the technique cannot draw.
    fn describe(
        &self,
        view: &LightView<'_>,
        list: &mut PassList,
        notes: &mut Notes,
    ) -> Result<LightTerm, SettingsError>;
}

/// A light's technique, and the keys that it has read.
pub struct LightShadow {
    pub technique: &'static dyn Technique,
    pub settings: Box<dyn ShadowSettings>,
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

/// The technique of a light without `[light.shadow]`.
const NONE: &str = "none";

/// Every technique.
pub const TABLE: &[&dyn Technique] = &[
    &none::Unshadowed,
    &shadow_map::ShadowMap,
    &midpoint::Midpoint,
    &second_depth::SecondDepth,
    &shadow_volume::ShadowVolume,
];

/// Reads `[light.shadow]` of every light, in the scene's order. An absent table means none.
///
/// # Errors
///
/// A name that no row of the table has, a technique that does not serve such lights, a key that no technique reads, a key
/// with a wrong value.
pub fn read(scene: &Scene) -> Result<Vec<LightShadow>, SettingsError> {
    let one = |light: &Light| {
        let mut keys = light.shadow.read();
        let technique = chosen(&light.kind, &mut keys)?;
        check_law(light, technique, &keys)?;
        let settings = technique.read(&mut keys, &light.kind)?;
        check_others(technique, &mut keys)?;
        keys.finish()?;
        Ok(LightShadow { technique, settings })
    };
    scene.lights.iter().map(one).collect()
}

/// Refuses a shadow of a light that nothing occludes.
fn check_law(light: &Light, technique: &dyn Technique, keys: &Reader<'_>) -> Result<(), SettingsError> {
    if light.law == Law::Lit || technique.name() == NONE {
        return Ok(());
    }
    let name = technique.name();
    let message = format!(
        "cannot be \"{name}\" for a light of law = \"slide\", which passes through everything: choose \"{NONE}\", or law = \"lit\""
    );
    Err(keys.error("technique", message))
}

/// Checks the keys that only other techniques read: they may be present, so that only `technique` needs to be changed.
fn check_others(chosen: &dyn Technique, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
    TABLE.iter().filter(|row| row.name() != chosen.name()).try_for_each(|row| row.check(keys))
}

/// The keys of `[light.shadow]` that a technique reads.
pub fn keys(technique: &dyn Technique) -> Vec<&'static str> {
    let empty = Settings::default();
    let mut keys = empty.read();
    // A key that is absent has no wrong value.
    let _ = technique.check(&mut keys);
    keys.known().to_vec()
}

/// The technique that `[light.shadow]` of a light of this `kind` names.
fn chosen(kind: &LightKind, settings: &mut Reader<'_>) -> Result<&'static dyn Technique, SettingsError> {
    let name = settings.string("technique")?.unwrap_or(NONE);
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
