//! Shadow maps by the depth comparison of the texture unit [Hardware Shadow Mapping; techniques A1–A10];
//! its parts are what every technique with a map is made of.

pub(super) mod bias;
pub(super) mod casters;
pub(super) mod depth;
pub(super) mod fit;
pub(super) mod settings;
pub(super) mod term;
mod texel;

use self::casters::casters;
use self::depth::Layer;
use super::{Axis, FrustumView, Item, LightTerm, LightView, Notes, Technique};
use crate::pass::PassList;
use crate::scene::{LightKind, Reader, SettingsError};

pub struct ShadowMap;

impl Technique for ShadowMap {
    fn name(&self) -> &'static str {
        "shadow-map"
    }

    fn summary(&self) -> &'static str {
        "depth from the light, compared by the texture unit"
    }

    fn source(&self) -> &'static str {
        "Hardware Shadow Mapping; techniques A1-A10, A12"
    }

    fn serves(&self, kind: &LightKind) -> Result<(), &'static str> {
        has_one_frustum(kind)
    }

    fn axes(&self) -> &'static [Axis] {
        settings::AXES
    }

    fn more_axes(&self) -> &'static [&'static [Axis]] {
        settings::MORE_AXES
    }

    fn check(&self, settings: &mut Reader<'_>) -> Result<(), SettingsError> {
        settings::read(settings).map(|_| ())
    }

    fn describe(
        &self,
        view: &LightView<'_>,
        keys: &mut Reader<'_>,
        list: &mut PassList,
        notes: &mut Notes,
    ) -> Result<LightTerm, SettingsError> {
        let mut settings = settings::read(keys)?;
        let view = &view.in_its_frustum(keys)?;
        let mut casters = casters(view, &settings, notes);
        settings.crop = fit::crop(view, &mut casters, &settings, notes);
        if casters.is_empty() && !view.keep_all {
            return Ok(without_casters(view, settings.dimming, notes));
        }
        let offset = bias::offset(&settings);
        let fewer = if settings.simplified { texel::simplified(view, &casters, &settings, notes) } else { Vec::new() };
        let fewer: Vec<&Item> = fewer.iter().collect();
        let casters = if settings.simplified { &fewer } else { &casters };
        let layer = Layer { name: "depth", image: "map", ending: None, offset: offset.polygon, casters };
        let map = depth::draw(view, &layer, &settings, list, notes);
        Ok(term::term(view, map, &settings, offset.texels))
    }
}

/// Whether one map in perspective holds all that such a light lights.
pub(super) fn has_one_frustum(kind: &LightKind) -> Result<(), &'static str> {
    match kind {
        LightKind::Spot(_) => Ok(()),
        LightKind::Point(_) => Err("draws one square map, and a point light's six come with the cube map"),
        LightKind::Directional { .. } => {
            Err("draws its map in perspective, and a directional light's comes with the orthographic map")
        }
    }
}

/// A light in whose frustum nothing casts a shadow that is seen.
pub(super) fn without_casters(view: &FrustumView<'_>, dimming: f32, notes: &mut Notes) -> LightTerm {
    let why = "no caster in the light's frustum shadows what is seen";
    notes.left_out(format!("the map of light {}", view.index), why);
    let mut term = LightTerm::unshadowed(view.scene, view.index);
    term.dimming = dimming;
    term
}
