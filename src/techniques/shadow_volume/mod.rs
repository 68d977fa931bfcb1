//! Stencil shadow volumes [Crow 1977; GDC, "Review: Stenciled Shadow Volumes"]: the stencil buffer counts the volumes that
//! hold a point; a point is lit where the count is 0.

mod casters;
mod choice;
mod counts;
mod doubt;
mod extent;
mod layers;
mod points;
mod settings;
mod shapes;

use self::casters::{CastingObject, casting_objects};
use self::choice::CountMethod;
use self::settings::Settings;
use self::shapes::Shape;
use super::change::Change;
use super::{Axis, ShadowSettings, Technique};
use crate::geometry::volume::{LightSource, SurfaceKind};
use crate::lights::light::StencilCount;
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::{PassList, Redraw};
use crate::scene::{LightKind, Reader, SettingsError};

pub struct ShadowVolume;

impl Technique for ShadowVolume {
    fn name(&self) -> &'static str {
        "shadow-volume"
    }

    fn summary(&self) -> &'static str {
        "volumes behind the casters, counted in the stencil buffer"
    }

    fn source(&self) -> &'static str {
        "GDC 2001, Stenciled Shadow Volumes"
    }

    fn serves(&self, _kind: &LightKind) -> Result<(), &'static str> {
        Ok(())
    }

    fn needs_vertices(&self) -> bool {
        true
    }

    fn axes(&self) -> &'static [Axis] {
        settings::AXES
    }

    fn is_exact(&self) -> bool {
        true
    }

    fn changes(&self, _kind: &LightKind) -> Vec<Change> {
        [settings::SHADE_CHANGES, settings::PICTURE_CHANGES].concat()
    }

    fn check(&self, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
        settings::read(keys).map(|_| ())
    }

    fn read(&self, keys: &mut Reader<'_>, _kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError> {
        Ok(Box::new(settings::read(keys)?))
    }
}

impl ShadowSettings for Settings {
    fn describe(&self, view: &LightView<'_>, _list: &mut PassList, notes: &mut Notes) -> LightTerm {
        let mut term = LightTerm::unshadowed(view.light(), view.index);
        let casting = casting_objects(view.items, view.derived);
        explain(view, &casting, notes);
        let ways = choice::ways(view, &casting, self, notes);
        let shapes = shapes::shapes(view, &casting, &ways, source(view), self, notes);
        if shapes.is_empty() {
            notes.left_out(format!("the count of light {}", view.index), "no caster shadows what is seen");
            return term;
        }
        if view.sampled_warnings {
            doubt::warn(view, &casting, &ways, self, notes);
        }
        term.counting = Some(counting(view, &shapes, self));
        term
    }

    fn counts_by(&self) -> Option<&'static str> {
        Some("technique = \"shadow-volume\"")
    }
}

fn counting(view: &LightView<'_>, shapes: &[Shape], settings: &Settings) -> StencilCount {
    let has = |wanted: CountMethod| shapes.iter().any(|shape| shape.way == wanted);
    StencilCount {
        passes: counts::passes(view, shapes, settings),
        redraw: Redraw::WhenChanged,
        of_all: false,
        // The end of a truncated volume may lie beyond the camera's far plane too.
        infinite: has(CountMethod::ZFail) || has(CountMethod::ZFailTruncated),
        clamped: has(CountMethod::ZFailClamped),
        casters: shapes.iter().filter(|shape| shape.meets_surface()).map(|shape| shape.object).collect(),
        ledge: has(CountMethod::ZPassCapped).then_some(settings.ledge),
        lighting: settings.lighting,
        scissor: if view.keep_all { None } else { view.camera.scissor(view.light(), view.scene.image.size) },
        volumes: shapes.iter().flat_map(|shape| shape.whole()).collect(),
        silhouettes: shapes.iter().map(|shape| shape.silhouette.clone()).collect(),
    }
}

/// Position of the light, or the direction to it, in world space.
fn source(view: &LightView<'_>) -> LightSource {
    match &view.light().kind {
        LightKind::Spot(spot) => LightSource::Point(spot.frustum.position),
        LightKind::Point(point) => LightSource::Point(point.position),
        LightKind::Directional { direction } => LightSource::Direction(-*direction),
    }
}

/// Notes how casters that are not closed are counted.
fn explain(view: &LightView<'_>, casting: &[CastingObject], notes: &mut Notes) {
    for caster in casting {
        let open = caster.caster.shells().iter().filter(|shell| shell.kind != SurfaceKind::Closed).count();
        if open > 0 {
            let all = caster.caster.shells().len();
            notes.chosen(
                format!("{} for light {}", caster.label, view.index),
                "counted by all its triangles",
                format!("{open} of {all} pieces are open, not a manifold, or look inwards"),
            );
        }
    }
}
