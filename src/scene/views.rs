//! The matrices and bounds that follow from a scene's values.

use glam::{DMat4, DVec3};

use super::{Camera, Frustum, Image, Light, LightKind, Object, Scene, Spot};
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
    pub fn spot(&self) -> Option<&Spot> {
        if let LightKind::Spot(spot) = &self.kind { Some(spot) } else { None }
    }

    /// What a spotlight sees; other lights have no one frustum.
    pub fn frustum(&self) -> Option<&Frustum> {
        self.spot().map(|spot| &spot.frustum)
    }

    /// Where the light stands; `None` for one that is infinitely far away.
    pub fn position(&self) -> Option<DVec3> {
        match &self.kind {
            LightKind::Spot(spot) => Some(spot.frustum.position),
            LightKind::Point(point) => Some(point.position),
            LightKind::Directional { .. } => None,
        }
    }

    /// Constant, linear and quadratic; (1, 0, 0) for a light that is as bright everywhere.
    pub fn attenuation(&self) -> [f32; 3] {
        match &self.kind {
            LightKind::Spot(spot) => spot.attenuation,
            LightKind::Point(point) => point.attenuation,
            LightKind::Directional { .. } => [1.0, 0.0, 0.0],
        }
    }
}

impl LightKind {
    /// The value of `kind` in a scene file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Spot(_) => "spot",
            Self::Point(_) => "point",
            Self::Directional { .. } => "directional",
        }
    }
}

impl Frustum {
    pub fn view_from_world(&self) -> DMat4 {
        spaces::view_from_world(self.position, self.target, self.up)
    }

    pub fn clip_from_view(&self) -> DMat4 {
        spaces::perspective(self.cone_radians, 1.0, self.near, self.far)
    }

    /// The same pyramid from its very apex to far beyond its far plane: what the light can light.
    pub fn unbounded(&self) -> Self {
        Self { near: 1e-3 * self.near, far: 1e3 * self.far, ..self.clone() }
    }

    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_view() * self.view_from_world()
    }
}

impl Object {
    /// The box around the mesh's own box, grown by its wave, in world space.
    pub fn world_bounds(&self) -> Aabb {
        let bounds = self.wave.map_or(self.mesh.bounds, |wave| wave.bounds(self.mesh.bounds));
        bounds.transformed(&self.world_from_model)
    }
}
