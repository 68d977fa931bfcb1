//! Items that the camera sees, from bounding boxes in world space, and the pixels that a light may reach. Conservative.

use glam::{DMat4, DVec3};

use super::{Drawable, Viewer};
use crate::geometry::volume;
use crate::math::Aabb;
use crate::math::frustum::{self, Overlap, corners};
use crate::scene::{Light, Scene};

/// The camera of a scene, and what it sees. Found once a plan.
#[derive(Clone, Debug)]
pub struct CameraView<'a> {
    pub viewer: Viewer,
    pub clip_from_world: DMat4,
    /// Corners of the near rectangle, in world space.
    pub near: [DVec3; 4],
    /// Drawables that may be in view.
    pub visible: Vec<&'a Drawable>,
    /// The eye, the near rectangle, and the boxes of all that is in view.
    pub seen_bounds: Aabb,
    /// The boxes of all drawables.
    pub scene_bounds: Aabb,
}

impl<'a> CameraView<'a> {
    /// The view of `scene`'s camera upon `items`.
    pub fn new(scene: &Scene, items: &'a [Drawable]) -> Self {
        let viewer = Viewer::of_camera(scene);
        let clip_from_world = viewer.clip_from_world();
        let is_seen = |item: &&Drawable| {
            frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) != Overlap::Outside
        };
        let visible: Vec<&Drawable> = items.iter().filter(is_seen).collect();
        let [a, b, c, d, ..] = corners(&clip_from_world.inverse());
        let start = Aabb::from_points([a, b, c, d, scene.camera.eye]);
        let world = |item: &Drawable| item.bounds.transformed(&item.world_from_model);
        Self {
            viewer,
            clip_from_world,
            near: [a, b, c, d],
            seen_bounds: visible.iter().fold(start, |bounds, item| bounds.union(world(item))),
            visible,
            scene_bounds: items.iter().map(world).fold(Aabb::EMPTY, Aabb::union),
        }
    }

    /// The pixels that a spotlight's frustum may cover, where they are fewer than the picture's. Other lights may reach all
    /// pixels.
    pub fn scissor(&self, light: &Light, size: [u32; 2]) -> Option<[u32; 4]> {
        let frustum = light.frustum()?;
        let bounds = self.seen_bounds;
        // Its pyramid, from the light to beyond all that is seen.
        let depth = bounds.corners().map(|corner| corner.distance(frustum.position)).into_iter().fold(0.0, f64::max);
        let side = depth * frustum.tangents();
        let world_from_light = frustum.view_from_world().inverse();
        let base = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| world_from_light.transform_point3(DVec3::new(side.x * x, side.y * y, -depth)));
        let points: Vec<DVec3> = base.into_iter().chain([frustum.position]).collect();
        // No pixel: the light contributes nothing, and the plan has left it out already.
        volume::scissor(&points, &self.clip_from_world, size).filter(|scissor| *scissor != [0, 0, size[0], size[1]])
    }
}
