//! Reading of `[light.shadow]` and of a photograph's `map`, which a shadow technique does while a scene is loaded: techniques stand above scenes.

use super::{LightKind, Object, Settings, SettingsError, Shadow};

/// Reads `[light.shadow]` while a scene is loaded.
pub trait ReadShadow {
    /// Reads the table `written` of a light of this `kind` in a scene with these `objects`.
    ///
    /// # Errors
    ///
    /// A key that is unknown or has a wrong value, keys that exclude each other, a light or objects that the technique
    /// cannot draw; each with its place in the scene file.
    fn read(&self, written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError>;

    /// Reads the table `map` of a photograph, whose camera is a spotlight of this `kind`.
    ///
    /// # Errors
    ///
    /// As [`ReadShadow::read`].
    fn read_photo(&self, written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError>;
}
