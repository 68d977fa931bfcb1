//! No shadow: the light reaches all that its cone holds.

use super::{Axis, LightTerm, LightView, Notes, TABLE, Technique};
use crate::pass::{PassList, glsl};
use crate::scene::{LightKind, Reader, SettingsError};

pub struct Unshadowed;

impl Technique for Unshadowed {
    fn name(&self) -> &'static str {
        "none"
    }

    fn summary(&self) -> &'static str {
        "no shadow: everything that the light can reach is lit"
    }

    fn source(&self) -> &'static str {
        "GL 4.6 compatibility, 12.2"
    }

    fn serves(&self, _kind: &LightKind) -> Result<(), &'static str> {
        Ok(())
    }

    fn axes(&self) -> &'static [Axis] {
        &[]
    }

    /// Keys of the other techniques may stand, so that `technique` alone can be switched; they are checked all the same.
    fn check(&self, settings: &mut Reader<'_>) -> Result<(), SettingsError> {
        TABLE.iter().filter(|row| row.name() != self.name()).try_for_each(|row| row.check(settings))
    }

    fn describe(
        &self,
        view: &LightView<'_>,
        settings: &mut Reader<'_>,
        _list: &mut PassList,
        _notes: &mut Notes,
    ) -> Result<LightTerm, SettingsError> {
        self.check(settings)?;
        Ok(LightTerm::new(view.scene, view.index, glsl!("light/unshadowed.frag")))
    }
}
