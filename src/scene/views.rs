//! The matrices and bounds that follow from a scene's values.

use glam::DMat4;

use super::{Camera, Image, Light, LightKind, Object, Scene};
use crate::math::{Aabb, spaces};

impl Image {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }
}

impl Scene {
    /// The picture's width over its height.
    pub fn aspect(&self) -> f64 {
        self.image.aspect()
    }

    /// The box around all objects, in world space.
    pub fn world_bounds(&self) -> Aabb {
        self.objects.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.world_bounds()))
    }
}

impl Camera {
    pub fn view_from_world(&self) -> DMat4 {
        spaces::view_from_world(self.eye, self.target, self.up)
    }

    /// `aspect` is the picture's width over its height.
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        spaces::perspective(self.fov_y_radians, aspect, self.near, self.far)
    }
}

impl Light {
    pub fn view_from_world(&self) -> DMat4 {
        spaces::view_from_world(self.position, self.target, self.up)
    }

    /// The symmetric, square frustum whose full angle is the light's cone.
    pub fn clip_from_view(&self) -> DMat4 {
        let LightKind::Spot { cone_radians, .. } = self.kind;
        spaces::perspective(cone_radians, 1.0, self.near, self.far)
    }
}

impl Object {
    /// The box around the mesh's own box, in world space.
    pub fn world_bounds(&self) -> Aabb {
        self.mesh.bounds.transformed(&self.world_from_model)
    }
}
