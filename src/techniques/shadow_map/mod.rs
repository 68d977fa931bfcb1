//! Shadow maps by the depth comparison of the texture unit [Williams 1978; HSM, "How To Do It"]. Every technique with a map
//! uses its parts.

mod behind;
pub(super) mod bias;
pub(super) mod casters;
mod changes;
mod cube;
pub(super) mod depth;
pub(super) mod fit;
pub(super) mod forecast;
mod map;
pub(super) mod parallel;
pub(super) mod settings;
mod simplified_casters;
mod tag;
pub(super) mod term;

use self::casters::casters;
use self::depth::DepthLayer;
use self::forecast::Stored;
use self::settings::Settings;
use super::change::Change;
use super::claims::{Claim, Contender, Quantity, Relation};
use super::{Axis, ShadowSettings, Technique};
use crate::lights::projector::Projector;
use crate::lights::{Drawable, FrustumView, LightTerm, LightView, MapInfo, Notes};
use crate::pass::PassList;
use crate::scene::{LightKind, Reader, SettingsError};

pub struct ShadowMap;

/// Claims that a constant cannot replace the slope factor [HSM, "Why Is Polygon Offset Needed?"].
const CLAIMS: &[Claim] = &[
    Claim {
        says: "a constant offset must be larger than a slope-scaled one for equal false shadow",
        quantity: Quantity::Offset,
        first: Contender::Constant,
        relation: Relation::Greater,
        second: Contender::SlopeScaled,
    },
    Claim {
        says: "a constant offset leaks more where light falls",
        quantity: Quantity::LeakFacing,
        first: Contender::Constant,
        relation: Relation::Greater,
        second: Contender::SlopeScaled,
    },
    // The slope factor has no bound at a caster's rim: surfaces turned away behind it are counted apart.
    Claim {
        says: "a constant offset leaks more, with what is turned away",
        quantity: Quantity::Leak,
        first: Contender::Constant,
        relation: Relation::Greater,
        second: Contender::SlopeScaled,
    },
];

impl Technique for ShadowMap {
    fn name(&self) -> &'static str {
        "shadow-map"
    }

    fn summary(&self) -> &'static str {
        "depth from the light, compared by the texture unit"
    }

    fn source(&self) -> &'static str {
        "Hardware Shadow Mapping"
    }

    fn serves(&self, _kind: &LightKind) -> Result<(), &'static str> {
        Ok(())
    }

    fn axes(&self) -> &'static [Axis] {
        settings::AXES
    }

    /// Point lights: `size` with `transfer`, stencil tags, kernels. Directional lights: all but the last, `guard`, because they
    /// have no back side.
    fn more_axes(&self, kind: &LightKind) -> &'static [&'static [Axis]] {
        match kind {
            LightKind::Point(_) => &settings::MORE_AXES[..3],
            LightKind::Directional { .. } => &settings::MORE_AXES[..settings::MORE_AXES.len() - 1],
            LightKind::Spot(_) => settings::MORE_AXES,
        }
    }

    fn changes(&self, kind: &LightKind) -> Vec<Change> {
        changes::changes(kind)
    }

    fn claims(&self) -> &'static [Claim] {
        CLAIMS
    }

    fn check(&self, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
        settings::read(keys).map(|_| ())
    }

    fn read(&self, keys: &mut Reader<'_>, kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError> {
        let settings = settings::read(keys)?;
        refuse(&settings, kind, keys)?;
        Ok(Box::new(settings))
    }
}

impl ShadowSettings for Settings {
    fn describe(&self, view: &LightView<'_>, list: &mut PassList, notes: &mut Notes) -> LightTerm {
        if let LightKind::Point(point) = &view.light().kind {
            return cube::describe(view, point, self, list, notes);
        }
        match one_view(view, self, notes) {
            Some(view) => one_map(view, self, list, notes),
            None => without_casters(view, notes),
        }
    }

    fn map(&self) -> Option<&Settings> {
        Some(self)
    }
}

/// Refuses keys that maps of such lights do not have.
pub(super) fn refuse(settings: &Settings, kind: &LightKind, keys: &Reader<'_>) -> Result<(), SettingsError> {
    match kind {
        LightKind::Spot(_) => Ok(()),
        LightKind::Directional { .. } => parallel::refuse(settings, keys),
        LightKind::Point(_) => cube::refuse(settings, keys),
    }
}

/// A light with one square map.
fn one_map(mut view: FrustumView<'_>, settings: &Settings, list: &mut PassList, notes: &mut Notes) -> LightTerm {
    let mut casters = casters(&view, settings, notes);
    view.projector.crop = fit::crop(&view, &mut casters, settings, notes);
    let view = &view;
    if casters.is_empty() && !view.keep_all {
        return without_casters(view, notes);
    }
    let offset = bias::offset(settings);
    let forecast = forecast::Map {
        settings,
        offset,
        stored: Stored::Nearest,
        casters: &casters,
        projectors: vec![view.projector.clone()],
    };
    forecast::warn(view, &forecast, notes);
    let fewer =
        if settings.simplified { simplified_casters::simplified(view, &casters, settings, notes) } else { Vec::new() };
    let fewer: Vec<&Drawable> = fewer.iter().collect();
    let casters = if settings.simplified { &fewer } else { &casters };
    let layer = DepthLayer::plain("depth", "map", offset.polygon, casters);
    let map = depth::draw(view, &layer, settings, list, notes);
    let mut term = term::term(view, map, settings, offset.texels);
    term.map_info = term.map_info.map(|info| MapInfo { polygon: offset.polygon, ..info });
    term
}

/// Refuses point lights, for techniques that draw one square map.
pub(super) fn has_one_map(kind: &LightKind) -> Result<(), &'static str> {
    match kind {
        LightKind::Spot(_) | LightKind::Directional { .. } => Ok(()),
        LightKind::Point(_) => Err("draws one square map, and a point light needs six"),
    }
}

/// The light as its one map sees it. `None`: a directional light that has nothing to shadow, or a point light, which has
/// six.
pub(super) fn one_view<'a>(view: &LightView<'a>, settings: &Settings, notes: &mut Notes) -> Option<FrustumView<'a>> {
    let projector = match &view.light().kind {
        LightKind::Spot(spot) => Some(Projector::of_frustum(&spot.frustum)),
        LightKind::Directional { direction } => parallel::projector(view, *direction, settings, notes),
        LightKind::Point(_) => None,
    };
    projector.map(|projector| FrustumView { light_view: *view, projector })
}

/// Term of a light in whose frustum nothing casts a visible shadow.
pub(super) fn without_casters(view: &LightView<'_>, notes: &mut Notes) -> LightTerm {
    let why = "no caster in the light's frustum shadows what is seen";
    notes.left_out(format!("the map of {}", view.name()), why);
    LightTerm::unshadowed(view.light(), view.index)
}
