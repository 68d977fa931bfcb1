//! Choice of the way in which each caster is counted, and of casters that need not be: z-pass costs fewer fragments and no
//! caps, z-fail is right for any eye [GDC, "Alternative to Near Plane Capping: Carmack's Reverse"].

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
    let one = |caster: &CastingObject| {
        let volume = volume::VolumeHulls::new(&caster.bounds, &caster.world_from_model, source(view));
        if let Some(why) = why_unneeded(view, caster, &volume, &viewer).filter(|_| !view.keep_all) {
            notes.left_out(format!("the volume of {} for light {}", caster.label, view.index), why);
            return CountMethod::LeftOut;
        }
        match settings.method {
            Method::Auto => {
                let (way, name, why) = choose(caster, &volume, &viewer);
                notes.chosen(format!("{} for light {}", caster.label, view.index), name, why);
                way
            }
            Method::Parity => CountMethod::Parity,
            Method::ZPass => CountMethod::ZPass,
            Method::ZPassTwoSided => CountMethod::ZPassTwoSided,
            Method::ZPassCapped => CountMethod::ZPassCapped,
            Method::ZFail => CountMethod::ZFail,
            Method::ZFailClamped => CountMethod::ZFailClamped,
            Method::ZFailTruncated => CountMethod::ZFailTruncated,
        }
    };
    casting.iter().map(one).collect()
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
