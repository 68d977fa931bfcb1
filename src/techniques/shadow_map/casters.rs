//! Which of the scene's items are drawn into a light's map.

use glam::{DMat4, DVec4};

use super::bias;
use super::settings::{Bias, Mipmaps, Settings};
use crate::math::frustum::{self, Overlap};
use crate::techniques::projector::Rays;
use crate::techniques::unseen::Unseen;
use crate::techniques::{FrustumView, Item, LightView, Notes};

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
pub fn reach(settings: &Settings) -> f64 {
    let kernel = bias::kernel_reach(settings);
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

pub fn in_the_map(item: &Item, view: &LightView<'_>) -> String {
    format!("{} in the map of light {}", item.label, view.index)
}

/// A caster between the light and its near plane casts no shadow from what is cut off: say so. Parallel light has none.
pub fn warn_of_near(view: &FrustumView<'_>, item: &Item, notes: &mut Notes) {
    let Rays::From { near, .. } = view.projector.rays else { return };
    // The pyramid's tip, by the map's own sides.
    let clip = view.projector.clip_from_light;
    let tip = DMat4::from_cols(clip.x_axis, clip.y_axis, DVec4::new(0.0, 0.0, -1.002, -1.0), DVec4::Z * -2e-3 * near);
    let clip_from_model = tip * view.projector.light_from_world * item.world_from_model;
    if frustum::overlap(&clip_from_model, &item.bounds) != Overlap::Outside {
        let warning = format!(
            "{} may come nearer to light {} than its near plane at {near}: what lies before that plane casts no shadow",
            item.label, view.index,
        );
        if !notes.warnings.contains(&warning) {
            notes.warnings.push(warning);
        }
    }
}
