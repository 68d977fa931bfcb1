//! Items that the camera sees, from bounding boxes in world space, and the pixels that a light may reach. Conservative.

use glam::{DMat4, DVec3};

use super::{Drawable, LightView};
use crate::geometry::volume;
use crate::math::Aabb;
use crate::math::frustum::{self, Overlap, corners};

/// The eye, the near rectangle, and the boxes of all that is in view.
pub fn bounds(view: &LightView<'_>) -> Aabb {
    let near = corners(&clip_from_world(view).inverse()).into_iter().take(4).chain([view.scene.camera.eye]);
    let start = Aabb::from_points(near);
    items(view).fold(start, |bounds, item| bounds.union(item.bounds.transformed(&item.world_from_model)))
}

/// Items in view.
pub fn items<'a>(view: &LightView<'a>) -> impl Iterator<Item = &'a Drawable> {
    let clip_from_world = clip_from_world(view);
    let is_seen = move |item: &&Drawable| {
        frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) != Overlap::Outside
    };
    view.items.iter().filter(is_seen)
}

/// The camera's `clip_from_world`.
pub fn clip_from_world(view: &LightView<'_>) -> DMat4 {
    view.scene.camera.clip_from_view(view.scene.aspect()) * view.scene.camera.view_from_world()
}

/// The pixels that a spotlight's frustum may cover, where they are fewer than the picture's. Other lights reach them all.
pub fn scissor(view: &LightView<'_>) -> Option<[u32; 4]> {
    let frustum = view.light().frustum()?;
    let bounds = self::bounds(view);
    // Its pyramid, from the light to beyond all that is seen.
    let depth = bounds.corners().map(|corner| corner.distance(frustum.position)).into_iter().fold(0.0, f64::max);
    let side = depth * (0.5 * frustum.cone_radians).tan();
    let world_from_light = frustum.view_from_world().inverse();
    let base = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| world_from_light.transform_point3(DVec3::new(side * x, side * y, -depth)));
    let points: Vec<DVec3> = base.into_iter().chain([frustum.position]).collect();
    let size = view.scene.image.size;
    // No pixel at all: the light contributes nothing, and the plan has seen that already.
    volume::scissor(&points, &clip_from_world(view), size).filter(|scissor| *scissor != [0, 0, size[0], size[1]])
}
