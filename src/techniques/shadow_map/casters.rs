//! Which of the scene's items are drawn into a light's map.

use glam::{DVec3, DVec4};

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

/// The items that can stand in the light's way inside its frustum's sides, up to its far plane.
pub fn in_frustum<'a>(view: &FrustumView<'a>, notes: &mut Notes) -> Vec<&'a Item> {
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
    warn_of_near(view, &casters, notes);
    casters
}

/// Whether some of the item may lie in the light's frustum, or between it and the light.
pub fn may_cast(view: &FrustumView<'_>, item: &Item) -> bool {
    let clip_from_model = view.clip_from_world() * item.world_from_model;
    frustum::overlap(&clip_from_model, &item.bounds) != Overlap::Outside || is_before_near(view, item)
}

/// Whether some of the item may lie between the light and its near plane. Parallel light has none.
pub fn is_before_near(view: &FrustumView<'_>, item: &Item) -> bool {
    let Rays::From { .. } = view.projector.rays else { return false };
    frustum::may_be_before_near(&(view.clip_from_world() * item.world_from_model), &item.bounds)
}

pub fn in_the_map(item: &Item, view: &LightView<'_>) -> String {
    format!("{} in the map of light {}", item.label, view.index)
}

/// Before its near plane a map has one depth alone: what casts there shadows all that lies beyond the plane, and nothing
/// before it. Says so where something seen may lie there, behind something else.
pub fn warn_of_near(view: &FrustumView<'_>, casters: &[&Item], notes: &mut Notes) {
    let Rays::From { near, position } = view.projector.rays else { return };
    let before: Vec<&Item> = casters.iter().copied().filter(|item| is_before_near(view, item)).collect();
    if before.is_empty() {
        return;
    }
    let camera = &view.scene.camera;
    let camera_clip = camera.clip_from_view(view.scene.aspect()) * camera.view_from_world();
    let is_inside = |clip: DVec4| clip.truncate().abs().max_element() <= clip.w;
    // Points of the item that are seen, lie in the light and before its near plane.
    let places = |item: &Item| -> Vec<DVec3> {
        let light_clip = view.clip_from_world();
        grid(item)
            .map(|point| item.world_from_model.transform_point3(point))
            .filter(|point| {
                let clip = light_clip * point.extend(1.0);
                clip.truncate().truncate().abs().max_element() <= clip.w
                    && clip.z < -clip.w
                    && is_inside(camera_clip * point.extend(1.0))
            })
            .collect()
    };
    let shaded = |item: &Item| {
        let places = places(item);
        let shades = |caster: &&Item| {
            let crossed = |point: &DVec3| middle_of_crossing(caster, *point, *point - position);
            !std::ptr::eq::<Item>(*caster, item) && places.iter().filter_map(crossed).any(|at| -1.0 < at && at < -1e-6)
        };
        before.iter().copied().find(shades)
    };
    let seen = view.items.iter().filter(|item| is_before_near(view, item));
    let Some((item, caster)) = seen.filter_map(|item| Some((item, shaded(item)?))).next() else { return };
    let of = format!("light {}'s near plane at {near}: ", view.index);
    // One is enough of each light, whose cube has six such planes.
    if !notes.warnings.iter().any(|warning| warning.starts_with(&of)) {
        let shadow = format!("{} lies before it in the shadow of {}", item.label, caster.label);
        notes.warnings.push(format!("{of}{shadow}, and is lit there: a map has no depths before its near plane"));
    }
}

/// A hundred points and more all over the item's box, in its model space.
fn grid(item: &Item) -> impl Iterator<Item = DVec3> {
    const STEPS: usize = 5;
    let (min, size) = (item.bounds.min, item.bounds.max - item.bounds.min);
    let share = |step: usize| step as f64 / (STEPS - 1) as f64;
    (0..STEPS.pow(3))
        .map(move |i| min + size * DVec3::new(share(i % STEPS), share(i / STEPS % STEPS), share(i / STEPS / STEPS)))
}

/// Where the line `point + t * way` is in the middle of the item's box; world space.
pub fn middle_of_crossing(item: &Item, point: DVec3, way: DVec3) -> Option<f64> {
    let model_from_world = item.world_from_model.inverse();
    let (point, way) = (model_from_world.transform_point3(point), model_from_world.transform_vector3(way));
    let (a, b) = ((item.bounds.min - point) / way, (item.bounds.max - point) / way);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter <= leave).then_some(0.5 * (enter + leave))
}
