//! No shadow: the light reaches all that its cone holds.

use super::{Axis, LightTerm, LightView, Notes, TABLE, Technique};
use crate::pass::{PassList, Shade, glsl};
use crate::scene::{Reader, SettingsError};

pub struct Unshadowed;

impl Technique for Unshadowed {
    fn name(&self) -> &'static str {
        "none"
    }

    fn summary(&self) -> &'static str {
        "no shadow: everything in the light's cone is lit"
    }

    fn source(&self) -> &'static str {
        "GL 4.6 compatibility, 12.2"
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
        Ok(LightTerm::new(view.index, glsl!("light/unshadowed.frag"), Shade::Lit))
    }
}
