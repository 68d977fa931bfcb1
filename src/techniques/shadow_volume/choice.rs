//! Choice of the way in which each caster is counted, and of casters that need not be: z-pass costs fewer fragments and no
//! caps, z-fail is right for any eye [GDC, "Alternative to Near Plane Capping: Carmack's Reverse"].

use rayon::prelude::*;

use super::casters::CastingObject;
use super::settings::{Method, Settings};
use super::{extent, source};
use crate::geometry::volume::{self, CameraHulls};
use crate::lights::{LightView, Notes};
use crate::math::frustum::{self, Overlap};

/// Method by which one caster's volume is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountMethod {
    LeftOut,
    Parity,
    ZPass,
    ZPassTwoSided,
    ZPassCapped,
    ZFail,
    ZFailClamped,
    ZFailTruncated,
}

/// Chooses a way for each caster.
pub fn ways(
    view: &LightView<'_>,
    casting: &[CastingObject],
    settings: &Settings,
    notes: &mut Notes,
) -> Vec<CountMethod> {
    let viewer = CameraHulls::new(&view.camera.clip_from_world);
    let ways = casting.par_iter().with_min_len(FEWEST_IN_PARALLEL).map(|caster| way(view, caster, settings, &viewer));
    let ways: Vec<Way> = ways.collect();
    for (caster, way) in casting.iter().zip(&ways) {
        let of = |caster: &CastingObject| format!("{} for light {}", caster.label, view.index);
        match *way {
            Way::Unneeded(why) => notes.left_out(format!("the volume of {}", of(caster)), why),
            Way::Chosen(_, name, why) => notes.chosen(of(caster), name, why),
            Way::Given(_) => {}
        }
    }
    ways.iter().map(Way::method).collect()
}

/// Casters that are not worth another core.
pub const FEWEST_IN_PARALLEL: usize = 32;

/// A caster's method, and why.
enum Way {
    Unneeded(&'static str),
    /// Method, its name, and why it was chosen.
    Chosen(CountMethod, &'static str, &'static str),
    /// By the scene.
    Given(CountMethod),
}

impl Way {
    fn method(&self) -> CountMethod {
        match *self {
            Self::Unneeded(_) => CountMethod::LeftOut,
            Self::Chosen(method, ..) | Self::Given(method) => method,
        }
    }
}

fn way(view: &LightView<'_>, caster: &CastingObject, settings: &Settings, viewer: &CameraHulls) -> Way {
    let volume = volume::VolumeHulls::new(&caster.bounds, &caster.world_from_model, source(view));
    if let Some(why) = why_unneeded(view, caster, &volume, viewer).filter(|_| !view.keep_all) {
        return Way::Unneeded(why);
    }
    Way::Given(match settings.method {
        Method::Auto => {
            let (method, name, why) = choose(caster, &volume, viewer);
            return Way::Chosen(method, name, why);
        }
        Method::Parity => CountMethod::Parity,
        Method::ZPass => CountMethod::ZPass,
        Method::ZPassTwoSided => CountMethod::ZPassTwoSided,
        Method::ZPassCapped => CountMethod::ZPassCapped,
        Method::ZFail => CountMethod::ZFail,
        Method::ZFailClamped => CountMethod::ZFailClamped,
        Method::ZFailTruncated => CountMethod::ZFailTruncated,
    })
}

fn why_unneeded(
    view: &LightView<'_>,
    caster: &CastingObject,
    volume: &volume::VolumeHulls,
    viewer: &CameraHulls,
) -> Option<&'static str> {
    if outside_cone(view, caster) {
        return Some("the caster is outside the light's cone");
    }
    let clip_from_model = view.camera.clip_from_world * caster.world_from_model;
    let is_seen = frustum::overlap(&clip_from_model, &caster.bounds) == Overlap::Inside;
    // What is seen whole shadows what lies behind it in view.
    if !is_seen && !volume.may_shadow_view(viewer) {
        return Some("its shadow falls outside the view");
    }
    extent::is_flat_before_all(view, caster, source(view))
        .then_some("it is flat, and all that is seen is on its lit side")
}

/// Tests whether a spotlight's light misses the caster.
fn outside_cone(view: &LightView<'_>, caster: &CastingObject) -> bool {
    view.light().frustum().is_some_and(|frustum| {
        let clip_from_model = frustum.unbounded().clip_from_world() * caster.world_from_model;
        frustum::overlap(&clip_from_model, &caster.bounds) == Overlap::Outside
    })
}

fn choose(
    caster: &CastingObject,
    volume: &volume::VolumeHulls,
    viewer: &CameraHulls,
) -> (CountMethod, &'static str, &'static str) {
    if caster.has_holes {
        (CountMethod::ZFail, "z-fail", "through its holes z-pass would see the volume's missing cap")
    } else if volume.may_hold_near(viewer) {
        (CountMethod::ZFail, "z-fail", "its volume may hold the eye's near rectangle")
    } else {
        (
            CountMethod::ZPassTwoSided,
            "z-pass",
            "its volume cannot meet the pyramid from the light to the near rectangle",
        )
    }
}
