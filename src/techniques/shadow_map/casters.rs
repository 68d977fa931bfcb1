//! Which of the scene's items are drawn into a light's map.

use super::bias;
use super::settings::{Bias, Mipmaps, Settings};
use crate::math::frustum::{self, Overlap};
use crate::scene::Frustum;
use crate::techniques::unseen::Unseen;
use crate::techniques::{FrustumView, Item, Notes};

/// The items that can stand in the light's way inside its frustum and whose shadow can be seen.
pub fn casters<'a>(view: &FrustumView<'a>, settings: &Settings, notes: &mut Notes) -> Vec<&'a Item> {
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

/// What kernels, normal offsets and the coarser of two levels reach beside a filter's own, in texels.
fn reach(settings: &Settings) -> f64 {
    let kernel = bias::reach_texels(settings) - bias::filter_reach(settings);
    match (settings.mipmaps, settings.bias) {
        (Mipmaps::None, Bias::NormalOffset) => kernel + std::f64::consts::SQRT_2 * bias::reach_texels(settings),
        (Mipmaps::None, _) => kernel,
        (Mipmaps::EightTaps, _) => 2.0 * (kernel + 2.0),
        (Mipmaps::All, _) => f64::from(settings.size),
    }
}

/// The items that can stand in the light's way inside its frustum.
pub fn in_frustum<'a>(view: &FrustumView<'a>, notes: &mut Notes) -> Vec<&'a Item> {
    let clip_from_world = view.clip_from_world();
    let mut casters = Vec::new();
    for item in view.items {
        let clip_from_model = clip_from_world * item.world_from_model;
        if !item.casts_shadow {
            notes.left_out(in_the_map(item, view), "casts_shadow = false");
        } else if !view.keep_all && frustum::overlap(&clip_from_model, &item.bounds) == Overlap::Outside {
            notes.left_out(in_the_map(item, view), "outside the light's frustum");
        } else {
            warn_of_near(view, item, notes);
            casters.push(item);
        }
    }
    casters
}

fn in_the_map(item: &Item, view: &FrustumView<'_>) -> String {
    format!("{} in the map of light {}", item.label, view.index)
}

/// A caster between the light and its near plane casts no shadow from what is cut off: say so.
fn warn_of_near(view: &FrustumView<'_>, item: &Item, notes: &mut Notes) {
    let near = view.frustum.near;
    let cut_off = Frustum { near: 1e-3 * near, far: near, ..view.frustum.clone() };
    let clip_from_model = cut_off.clip_from_world() * item.world_from_model;
    if frustum::overlap(&clip_from_model, &item.bounds) != Overlap::Outside {
        notes.warnings.push(format!(
            "{} may come nearer to light {} than its near plane at {}: what lies before that plane casts no shadow",
            item.label, view.index, near
        ));
    }
}
