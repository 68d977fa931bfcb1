//! No shadow: the light reaches everything in its cone, if it has one.

use super::{Axis, ShadowSettings, Technique};
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::PassList;
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

    fn draws_shadows(&self) -> bool {
        false
    }

    fn axes(&self) -> &'static [Axis] {
        &[]
    }

    fn check(&self, _keys: &mut Reader<'_>) -> Result<(), SettingsError> {
        Ok(())
    }

    fn read(&self, _keys: &mut Reader<'_>, _kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError> {
        Ok(Box::new(Self))
    }
}

impl ShadowSettings for Unshadowed {
    fn describe(&self, view: &LightView<'_>, _list: &mut PassList, _notes: &mut Notes) -> LightTerm {
        LightTerm::unshadowed(view.light(), view.index)
    }
}
