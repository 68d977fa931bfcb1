//! Keys of `[light.shadow]` that every light has. They are read here; `LightShadow::describe` applies them after the
//! technique's own `describe` (`guard`: `stencil_guard.rs`), so that no technique can forget them.

use crate::lights::LightTerm;
use crate::lights::guard::Guard;
use crate::pass::{Pass, Redraw, Shade};
use crate::scene::{LightKind, Reader, SettingsError};

/// Keys that every light has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonKeys {
    /// `dimming`: the fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// `guard`: what keeps a spotlight from lighting what lies behind it.
    pub guard: Guard,
    /// `redraw`: when a light's passes are drawn again. `once`: only if a pass has changed; `always`: in every frame.
    pub redraw: Redraw,
}

impl Default for CommonKeys {
    fn default() -> Self {
        Self { dimming: 0.0, guard: Guard::Auto, redraw: Redraw::WhenChanged }
    }
}

impl CommonKeys {
    /// Reads the keys, each with its default.
    ///
    /// # Errors
    ///
    /// A wrong value, or a guard for a light that has nothing behind it; with its place.
    pub fn read(keys: &mut Reader<'_>, kind: &LightKind) -> Result<Self, SettingsError> {
        let common = Self::check(keys)?;
        if common.guard != Guard::Auto && !matches!(kind, LightKind::Spot(_)) {
            let light = kind.name();
            let why = "keeps a spotlight from lighting what lies behind it";
            return Err(keys.error("guard", format_args!("{why}; behind a {light} light lies nothing")));
        }
        Ok(common)
    }

    /// Reads the keys for any light.
    ///
    /// # Errors
    ///
    /// A wrong value, with its place.
    pub fn check(keys: &mut Reader<'_>) -> Result<Self, SettingsError> {
        let default = Self::default();
        let redraws = [("once", Redraw::WhenChanged), ("always", Redraw::Always)];
        Ok(Self {
            dimming: keys.number("dimming", 0.0..=1.0)?.map_or(default.dimming, |share| share as f32),
            guard: Guard::read(keys)?,
            redraw: keys.choice("redraw", &redraws)?.unwrap_or(default.redraw),
        })
    }

    /// Applies `dimming` and `redraw` to a term and to the passes that prepare it. Light without a shadow is not dimmed.
    pub fn apply(&self, term: &mut LightTerm, passes: &mut [Pass]) {
        if term.shade.meaning != Shade::Lit || term.counting.is_some() {
            term.dimming = self.dimming;
        }
        if self.redraw == Redraw::Always {
            passes.iter_mut().for_each(|pass| pass.redraw = Redraw::Always);
            term.counting.iter_mut().for_each(|counting| counting.redraw = Redraw::Always);
        }
    }
}
