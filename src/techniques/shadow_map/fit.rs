//! The part of a light's frustum that its map must cover (`fit`): the part that holds casters, or of that the part that is
//! lit and seen. The light's reach stays the same; only the texels are placed where they are used.
//!
//! A lookup beyond the cropped map meets the texels at its rim (GL_CLAMP_TO_EDGE). They lie more than a filter's reach from
//! every caster and hold nothing, or nothing visible and lit lies there.

use glam::{DVec3, DVec4};

use super::bias;
use super::casters::may_cast;
use super::settings::{Bias, Fit, Mipmaps, Settings};
use crate::lights::caster_culling::Unseen;
use crate::lights::projector::Rays;
use crate::lights::{Crop, Drawable, FrustumView, Notes};
use crate::math::Aabb;
use crate::math::frustum::{self, clip_polygon};

/// Removes from `casters` those that shadow nothing in the scene, and finds the part of the light's frustum that the map
/// covers.
pub fn crop(view: &FrustumView<'_>, casters: &mut Vec<&Drawable>, settings: &Settings, notes: &mut Notes) -> Crop {
    if view.light().dust.is_some() {
        if settings.fit != Fit::None {
            let why = "the light's beam is seen in the air, all of it";
            notes.chosen(format!("map of {}", view.name()), "of the whole frustum", why);
        }
        return Crop::WHOLE;
    }
    let is_parallel = matches!(view.projector.rays, Rays::Along(_));
    // A map of one side's faces needs closed casters; a caster that shadows nothing need not be closed.
    if settings.fit == Fit::None && !is_parallel && settings.cull.is_none() {
        return Crop::WHOLE;
    }
    let unseen = Unseen::new(view, settings.size, 0.0);
    casters.retain(|item| {
        let idle = unseen.shadows_nothing(item);
        if idle {
            let what = format!("{} in the map of {}", item.label, view.name());
            notes.left_out(what, "it is flat, and nothing lies behind it");
        }
        !idle
    });
    if settings.fit == Fit::None {
        return Crop::WHOLE;
    }
    let needed = of_casters(view, &unseen);
    let needed = if settings.fit == Fit::View { needed.within(of_sight(view)) } else { needed };
    if needed.is_empty() {
        return Crop::WHOLE;
    }
    let fitted = widened(needed, settings).within(Crop::WHOLE);
    let share = fitted.half().element_product();
    notes.left_out(
        format!("{:.1} % of {}'s frustum in its map", 100.0 * (1.0 - share), view.name()),
        format!("nothing that is seen there can be shadowed: {:.2} times the texels a pixel", 1.0 / share),
    );
    fitted
}

/// A crop around every caster in the frustum, so that leaving items out moves no texel.
fn of_casters(view: &FrustumView<'_>, unseen: &Unseen) -> Crop {
    let clip_from_world = view.clip_from_world();
    let mut crop = Crop::NOTHING;
    for item in view.items.iter().filter(|item| item.casts_shadow && !unseen.shadows_nothing(item)) {
        let clip_from_model = clip_from_world * item.world_from_model;
        if !may_cast(view, item) {
            continue;
        }
        for corner in item.bounds.corners() {
            let clip = clip_from_model * corner.extend(1.0);
            if clip.w <= 0.0 {
                return Crop::WHOLE;
            }
            crop = crop.with(clip.truncate().truncate() / clip.w);
        }
    }
    crop.within(Crop::WHOLE)
}

/// A crop around the lit part of the scene's bounds that the camera sees. Every light's ray that meets the part that both
/// bounds and camera hold leaves it through one of its faces: so these are enough.
fn of_sight(view: &FrustumView<'_>) -> Crop {
    let camera_clip = view.camera.clip_from_world;
    let points = view
        .camera
        .visible
        .iter()
        .flat_map(|item| item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner)));
    let bounds = Aabb::from_points(points);
    let slack = DVec3::splat(1e-6 * bounds.radius());
    let bounds = Aabb { min: bounds.min - slack, max: bounds.max + slack };
    let light_clip = view.clip_from_world();
    // Only the light's sides: it lights everything from its position on.
    let light_sides: Vec<DVec4> = frustum::planes(&light_clip)[..4].to_vec();
    let camera_sides = frustum::planes(&camera_clip);
    let bounds_sides = sides(&bounds);
    let camera_faces = frustum::faces(&frustum::corners(&camera_clip.inverse()));
    let bounds_faces = frustum::faces(&bounds.corners());
    let mut crop = Crop::NOTHING;
    for (faces, others) in [(camera_faces, &bounds_sides), (bounds_faces, &camera_sides)] {
        for face in faces {
            let clipped = others.iter().chain(&light_sides).fold(face.to_vec(), |face, side| clip_polygon(&face, side));
            for point in clipped {
                let clip = light_clip * point.extend(1.0);
                // All sides of the light meet at its position, where the direction is undefined.
                if clip.w <= 0.0 {
                    return Crop::WHOLE;
                }
                crop = crop.with(clip.truncate().truncate() / clip.w);
            }
        }
    }
    crop
}

fn sides(bounds: &Aabb) -> [DVec4; 6] {
    let (min, max) = (bounds.min, bounds.max);
    [
        DVec4::new(1.0, 0.0, 0.0, -min.x),
        DVec4::new(-1.0, 0.0, 0.0, max.x),
        DVec4::new(0.0, 1.0, 0.0, -min.y),
        DVec4::new(0.0, -1.0, 0.0, max.y),
        DVec4::new(0.0, 0.0, 1.0, -min.z),
        DVec4::new(0.0, 0.0, -1.0, max.z),
    ]
}

/// `needed` with a rim that a lookup cannot reach across.
fn widened(needed: Crop, settings: &Settings) -> Crop {
    // A texel is the size-th part of the widened map.
    let share = (1.0 - 2.0 * rim_texels(settings) / f64::from(settings.size)).max(0.25);
    let (center, half) = (needed.center(), needed.half() / share);
    Crop { min: center - half, max: center + half }
}

/// A rim that a lookup cannot reach across, in texels, with one for the rounding of positions.
pub fn rim_texels(settings: &Settings) -> f64 {
    lookup_texels(settings, 1.0) + 1.0
}

/// Reach of a lookup from its point, in texels: the kernel's and the filter's, those of a normal offset, twice as wide ones
/// of a second level.
///
/// A normal offset moves a point by up to √2 times the kernel's and filter's reach, and its place in the map by no more
/// than that times `slant`, the secant of the greatest angle between the light's rays and its axis.
pub fn lookup_texels(settings: &Settings, slant: f64) -> f64 {
    let mut texels = bias::reach_texels(settings);
    if settings.bias == Bias::NormalOffset {
        texels *= 1.0 + std::f64::consts::SQRT_2 * slant;
    }
    if settings.mipmaps != Mipmaps::None {
        texels *= 2.0;
    }
    texels
}
