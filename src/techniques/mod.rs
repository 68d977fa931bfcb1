//! Shadow techniques, each describing passes as data. Uses lights, pass, scene, geometry and math; calls no GL.
//!
//! # How to add a technique
//!
//! See "Adding a row" in src/ARCHITECTURE.md. The plan, the device and the scene's reader need no change: scenes name the
//! technique in `[light.shadow]`, the plan calls it, the device draws its passes.
//!
//! `[light.shadow]` is read once, when a scene is loaded: first [`CommonKeys`], which every light has, then the technique's
//! own keys, into a type of its own that implements [`ShadowSettings`]. A wrong key, also of a light that is never drawn,
//! is an error of loading, with file and line. A plan then describes the lights that it draws, which cannot fail.

pub mod change;
pub mod claims;
mod common;
mod midpoint;
mod none;
mod read;
mod second_depth;
mod shadow_map;
mod shadow_volume;
mod stencil_guard;
pub mod vary;

use self::change::Change;
use self::claims::Claim;
pub use self::common::CommonKeys;
pub use self::read::{
    LightShadow, Techniques, keys, load, load_embedded, load_str, map_size, read, read_text, unshadowed, with_keys,
};
pub use self::shadow_map::bias::offset as map_offset;
pub use self::shadow_map::settings::{DEFAULT_SIZE as DEFAULT_MAP_SIZE, Settings as MapSettings};
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::PassList;
use crate::scene::{self, Entry, LightKind, Object, Reader, SettingsError};

/// A way to find which points a light reaches.
pub trait Technique: Sync {
    /// The value of `technique` in `[light.shadow]`.
    fn name(&self) -> &'static str;

    /// One line for tables and `--help`.
    fn summary(&self) -> &'static str;

    /// The document that it implements, for tables of techniques.
    fn source(&self) -> &'static str;

    /// Tests whether it finds the shade of such lights.
    ///
    /// # Errors
    ///
    /// The reason why not, as the end of a sentence that begins with the technique's name.
    fn serves(&self, kind: &LightKind) -> Result<(), &'static str>;

    /// Tests whether it draws shadows at all.
    fn draws_shadows(&self) -> bool {
        true
    }

    /// True if shadow edges are exact up to rounding, as with shadow volumes: then no wrong pixel is excused by a map's
    /// resolution.
    fn is_exact(&self) -> bool {
        false
    }

    /// Tests whether it reads casters' vertices, which the vertex stage then must not move.
    fn needs_vertices(&self) -> bool {
        false
    }

    /// Keys that `glumbra report` varies; it measures every combination of their values.
    fn axes(&self) -> &'static [Axis];

    /// Further sets of keys, each measured in combination only among themselves.
    fn more_axes(&self, _kind: &LightKind) -> &'static [&'static [Axis]] {
        &[]
    }

    /// Settings that `glumbra stress` tries for a light of this `kind`, one change at a time from the defaults.
    fn changes(&self, _kind: &LightKind) -> Vec<Change> {
        Vec::new()
    }

    /// Keys in TOML without which it refuses these `objects`; empty: it draws them by default.
    fn needed_keys(&self, _objects: &[Object]) -> &'static str {
        ""
    }

    /// Claims of its documents, which a report measures on its scene.
    fn claims(&self) -> &'static [Claim] {
        &[]
    }

    /// Validates this technique's own keys of `[light.shadow]` one by one, where another technique is chosen, and marks them as
    /// known. Keys of every light are not among them: see [`CommonKeys`].
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
pub trait ShadowSettings: Send + Sync {
    /// Adds the passes that prepare the light to `list`, and returns the light's term for the lit pass. Notes in `notes` what
    /// it leaves out. It cannot fail: everything that can be wrong is found by [`Technique::read`] and
    /// [`ShadowSettings::check`]. [`CommonKeys`] are applied to what it returns, and to its passes.
    fn describe(&self, view: &LightView<'_>, list: &mut PassList, notes: &mut Notes) -> LightTerm;

    /// Checks that the technique can draw the shadows of these `objects`, wherever the camera is.
    ///
    /// # Errors
    ///
    /// The objects that it cannot draw, with the place of the key that chooses the technique.
    fn check(&self, _kind: &LightKind, _objects: &[Object]) -> Result<(), SettingsError> {
        Ok(())
    }

    /// Settings of its map; `None`: it draws none.
    fn map(&self) -> Option<&MapSettings> {
        None
    }

    /// The key and the value for which the shadow is counted in the stencil buffer, if it is.
    fn counts_by(&self) -> Option<&'static str> {
        self.map().and_then(MapSettings::counts_by)
    }
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

impl Axis {
    /// The entry that one of its values makes.
    ///
    /// # Errors
    ///
    /// A value that is no TOML.
    pub fn entry(&self, value: &str) -> Result<Entry, scene::Error> {
        let table = scene::shadow_settings(&format!("{} = {value}", self.key))?;
        let missing = || SettingsError::new(&table.origin, format!("`{}` is missing", self.key));
        Ok(table.get(self.key).cloned().ok_or_else(missing)?)
    }
}

/// Every technique.
pub const TABLE: &[&dyn Technique] = &[
    &none::Unshadowed,
    &shadow_map::ShadowMap,
    &midpoint::Midpoint,
    &second_depth::SecondDepth,
    &shadow_volume::ShadowVolume,
];
