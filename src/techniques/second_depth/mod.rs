//! Second-depth shadow maps: only the faces that look away from the light are drawn into the map [Wang and Molnar 1994;
//! HSM, "Advantages and Limitations"].
//!
//! A lit surface is compared with the far side of its own caster, a caster's thickness away, so that it needs no polygon
//! offset. A surface that looks away from the light is compared with itself, and errs; its shading is dark in any case. An
//! open caster is refused. With `closed = "assume"` its back faces alone are drawn: parts that face the light then cast no
//! shadow, and a warning names the caster if that makes pixels wrong.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::change::{Change, of_shade};
use super::claims::{Claim, Contender, Quantity, Relation};
use super::shadow_map::casters::{casters, may_meet};
use super::shadow_map::depth::{self, DepthLayer};
use super::shadow_map::settings::{self as map, Settings};
use super::shadow_map::{self, fit, parallel, term};
use super::{Axis, ShadowSettings, Technique};
use crate::lights::caster_culling::shadows_nothing;
use crate::lights::drawable::items_of;
use crate::lights::projector::Projector;
use crate::lights::{Drawable, LightTerm, LightView, Notes};
use crate::math::Aabb;
use crate::pass::{Face, PassList, PolygonOffset};
use crate::scene::{LightKind, Object, Place, Reader, SettingsError};
use crate::techniques::shadow_map::forecast::{self, Stored};

pub struct SecondDepth;

const BARE: Contender = Contender::Keys("technique = \"second-depth\", closed = \"assume\"");

/// Claims of [HSM, "Advantages and Limitations"].
const CLAIMS: &[Claim] = &[
    Claim::needs_no_offset(BARE),
    Claim {
        says: "moves the error to faces turned away from the light",
        quantity: Quantity::WrongAway,
        first: BARE,
        relation: Relation::Greater,
        second: Contender::SlopeScaled,
    },
    Claim {
        says: "is no more wrong than a tuned offset on faces turned to the light",
        quantity: Quantity::WrongFacing,
        first: BARE,
        relation: Relation::AtMost(1.0),
        second: Contender::SlopeScaled,
    },
];

const AXES: &[Axis] = &[
    Axis { key: "size", values: &["512", "1024", "2048"], quick: &["1024"] },
    // An open floor casts no shadow here; that is harmless, because nothing lies below it.
    Axis { key: "closed", values: &["\"assume\""], quick: &["\"assume\""] },
];

const CHANGES: &[Change] = &of_shade(["filter = \"nearest\"", "kernel = \"3x3\"", "fit = \"view\""]);

impl Technique for SecondDepth {
    fn name(&self) -> &'static str {
        "second-depth"
    }

    fn summary(&self) -> &'static str {
        "a map of the faces turned away from the light, for closed casters; no polygon offset"
    }

    fn source(&self) -> &'static str {
        "Hardware Shadow Mapping, on Wang and Molnar"
    }

    fn serves(&self, kind: &LightKind) -> Result<(), &'static str> {
        shadow_map::has_one_map(kind)
    }

    fn axes(&self) -> &'static [Axis] {
        AXES
    }

    fn changes(&self, _kind: &LightKind) -> Vec<Change> {
        CHANGES.to_vec()
    }

    /// A scene with an open caster needs the user's word for it.
    fn needed_keys(&self, objects: &[Object]) -> &'static str {
        let mut casters = objects.iter().filter(|object| object.casts_shadow);
        let is_closed =
            |object: &Object| object.wave.is_none() && object.mesh.is_closed() && object.mesh.signed_volume() > 0.0;
        if casters.all(is_closed) { "" } else { "closed = \"assume\"" }
    }

    fn claims(&self) -> &'static [Claim] {
        CLAIMS
    }

    fn check(&self, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
        read(keys).map(|_| ())
    }

    fn read(&self, keys: &mut Reader<'_>, kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError> {
        let settings = read(keys)?;
        shadow_map::refuse(&settings.map, kind, keys)?;
        Ok(Box::new(settings))
    }
}

/// Keys of the map, which leaves out faces towards the light, and the key of closed casters.
struct SecondDepthSettings {
    map: Settings,
    /// True if casters are assumed to be closed.
    is_assumed: bool,
    /// The key `technique`.
    place: Place,
}

impl ShadowSettings for SecondDepthSettings {
    fn describe(&self, view: &LightView<'_>, list: &mut PassList, notes: &mut Notes) -> LightTerm {
        let settings = &self.map;
        let Some(mut view) = shadow_map::one_view(view, settings, notes) else {
            return shadow_map::without_casters(view, notes);
        };
        let mut casters = casters(&view, settings, notes);
        view.projector.crop = fit::crop(&view, &mut casters, settings, notes);
        let view = &view;
        if casters.is_empty() && !view.keep_all {
            return shadow_map::without_casters(view, notes);
        }
        let offset = PolygonOffset { factor: 0.0, units: 0.0 };
        let layer = DepthLayer::plain("second depth", "map", offset, &casters);
        let map = depth::draw(view, &layer, settings, list, notes);
        notes.left_out(format!("faces towards {} in its map", view.name()), "the far sides cast the same shadow");
        let forecast = forecast::Map {
            settings,
            offset: forecast::NO_OFFSET,
            stored: Stored::Nearest,
            casters: &casters,
            projectors: vec![view.projector.clone()],
        };
        forecast::warn(view, &forecast, notes);
        term::term(view, map, settings, 0.0)
    }

    /// Refuses casters without a far side, and names each. A caster that shadows nothing need not be closed.
    fn check(&self, kind: &LightKind, objects: &[Object]) -> Result<(), SettingsError> {
        if self.is_assumed {
            return Ok(());
        }
        let items = items_of(objects, None);
        let mut is_closed = closed_test();
        let (mut open, mut named) = (Vec::new(), HashSet::new());
        for item in self.casters(&items, kind) {
            if !is_closed(item) && named.insert(item.label.as_str()) {
                open.push(item.label.as_str());
            }
        }
        if open.is_empty() {
            return Ok(());
        }
        let message = format!(
            "= \"second-depth\" needs closed casters whose faces look outwards; open: {}. Give them casts_shadow = false, \
             or draw their back faces alone with closed = \"assume\" (--set light.shadow.closed=assume)",
            open.join(", ")
        );
        Err(self.place.error(message))
    }

    fn map(&self) -> Option<&Settings> {
        Some(&self.map)
    }
}

impl SecondDepthSettings {
    /// Items that may cast a shadow in the light's map, for any camera.
    fn casters<'a>(&self, items: &'a [Drawable], kind: &LightKind) -> Vec<&'a Drawable> {
        let projector = match kind {
            LightKind::Spot(spot) => Some(Projector::of_frustum(&spot.frustum)),
            LightKind::Directional { direction } => {
                parallel::around(items, *direction, &self.map).map(|(projector, _)| projector)
            }
            LightKind::Point(_) => None,
        };
        let Some(projector) = projector else { return Vec::new() };
        let world = |item: &Drawable| item.bounds.transformed(&item.world_from_model);
        let bounds = items.iter().map(world).fold(Aabb::EMPTY, Aabb::union);
        let casts = |item: &&Drawable| {
            item.casts_shadow && may_meet(&projector, item) && !shadows_nothing(projector.rays, &bounds, item)
        };
        items.iter().filter(casts).collect()
    }
}

fn read(keys: &mut Reader<'_>) -> Result<SecondDepthSettings, SettingsError> {
    let is_assumed = keys.choice("closed", &[("assume", true), ("check", false)])?.unwrap_or(false);
    let map = Settings { cull: Some(Face::Front), ..map::read(keys)? };
    Ok(SecondDepthSettings { map, is_assumed, place: keys.place("technique") })
}

/// Tests whether an item has a far side all over: each mesh is examined once.
fn closed_test() -> impl FnMut(&Drawable) -> bool {
    let mut known: HashMap<*const crate::geometry::Mesh, bool> = HashMap::new();
    move |item| {
        if item.needs_alpha_test() || item.wave.is_some_and(|wave| wave.folds()) {
            return false;
        }
        let mesh = Arc::as_ptr(&item.mesh.0);
        let is_closed = || item.mesh.is_closed() && item.mesh.signed_volume() > 0.0;
        item.closed || *known.entry(mesh).or_insert_with(is_closed)
    }
}
