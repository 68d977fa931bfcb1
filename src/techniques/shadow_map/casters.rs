//! Items that are drawn into a light's map.

use super::bias;
use super::settings::{Bias, Mipmaps, Settings};
use crate::lights::caster_culling::Unseen;
use crate::lights::projector::{Projector, Rays};
use crate::lights::{Drawable, FrustumView, LightView, Notes};
use crate::math::frustum::{self, Overlap};

/// Items that can block light inside its frustum, and whose shadow can be seen.
pub fn casters<'a>(view: &FrustumView<'a>, settings: &Settings, notes: &mut Notes) -> Vec<&'a Drawable> {
    let mut casters = in_frustum(view, notes);
    if !view.shown_whole && !view.keep_all {
        let unseen = Unseen::new(view, settings.size, reach(settings));
        casters.retain(|item| {
            let is_unseen = unseen.shadow_of(item);
            if is_unseen {
                notes.left_out(in_the_map(item, view), "the camera sees nothing that it shadows");
            }
            !is_unseen
        });
    }
    casters
}

/// Reach of kernels, normal offsets and the coarser of two levels, in addition to the filter's own, in texels.
pub fn reach(settings: &Settings) -> f64 {
    let kernel = bias::kernel_reach(settings);
    match (settings.mipmaps, settings.bias) {
        (Mipmaps::None, Bias::NormalOffset) => kernel + std::f64::consts::SQRT_2 * bias::reach_texels(settings),
        (Mipmaps::None, _) => kernel,
        (Mipmaps::EightTaps, _) => 2.0 * (kernel + 2.0),
        (Mipmaps::All, _) => f64::from(settings.size),
    }
}

/// Items that can block light inside its frustum's sides, up to its far plane.
pub fn in_frustum<'a>(view: &FrustumView<'a>, notes: &mut Notes) -> Vec<&'a Drawable> {
    let mut casters = Vec::new();
    for item in view.items {
        if !item.casts_shadow {
            notes.left_out(in_the_map(item, view), "casts_shadow = false");
        } else if !view.keep_all && !may_cast(view, item) {
            notes.left_out(in_the_map(item, view), "outside the light's frustum");
        } else {
            casters.push(item);
        }
    }
    casters
}

/// Tests whether some of the item may lie in the light's frustum, or between it and the light.
pub fn may_cast(view: &FrustumView<'_>, item: &Drawable) -> bool {
    may_meet(&view.projector, item)
}

/// As [`may_cast`], for a map's projection.
pub fn may_meet(projector: &Projector, item: &Drawable) -> bool {
    let clip_from_model = projector.clip_from_world() * item.world_from_model;
    frustum::overlap(&clip_from_model, &item.bounds) != Overlap::Outside || is_nearer(projector, item)
}

/// Tests whether some of the item may lie between the light and its near plane. Parallel light has no near plane.
pub fn is_before_near(view: &FrustumView<'_>, item: &Drawable) -> bool {
    is_nearer(&view.projector, item)
}

fn is_nearer(projector: &Projector, item: &Drawable) -> bool {
    let Rays::From { .. } = projector.rays else { return false };
    frustum::may_be_before_near(&(projector.clip_from_world() * item.world_from_model), &item.bounds)
}

pub fn in_the_map(item: &Drawable, view: &LightView<'_>) -> String {
    format!("{} in the map of {}", item.label, view.name())
}
