//! Matrices and bounds of a scene.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use super::{Camera, Frustum, Image, Light, LightKind, Object, Scene, Spot};
use crate::geometry::Texture;
use crate::math::{Aabb, spaces};

/// Ratio of distance from the world's origin to size from which a scene is moved.
const FAR: f64 = 8.0;

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

    /// The same scene moved to where the eye is near the world's origin, so that products of matrices lose nothing of
    /// f64; `None`: it is as near as it is large. Moved by a power of two not below the scene's size, coordinates keep
    /// all of their digits.
    pub fn brought_near(&self) -> Option<Self> {
        let places = self.lights.iter().filter_map(Light::position).chain([self.camera.eye]);
        let size = 2.0 * places.fold(self.world_bounds(), Aabb::including).radius();
        let away = self.camera.eye.abs().max_element();
        if !(size.is_finite() && size > 0.0 && away > FAR * size) {
            return None;
        }
        let step = size.log2().ceil().exp2();
        let origin = (self.camera.eye / step).round() * step;
        let mut scene = self.clone();
        let mut ends = vec![&mut scene.camera.eye, &mut scene.camera.target];
        for light in &mut scene.lights {
            match &mut light.kind {
                LightKind::Spot(spot) => ends.extend([&mut spot.frustum.position, &mut spot.frustum.target]),
                LightKind::Point(point) => ends.push(&mut point.position),
                LightKind::Directional { .. } => {}
            }
        }
        ends.into_iter().for_each(|end| *end -= origin);
        scene.objects.iter_mut().for_each(|object| object.world_from_model.w_axis -= origin.extend(0.0));
        Some(scene)
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

    /// Frustum of a spotlight; other lights have none.
    pub fn frustum(&self) -> Option<&Frustum> {
        self.spot().map(|spot| &spot.frustum)
    }

    /// Position of the light; `None` if it is infinitely far away.
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

impl Spot {
    /// The image that is projected beside the beam's map: none if a lens moves it, for the map has it then.
    pub fn plain_image(&self) -> Option<&Arc<Texture>> {
        let has_lens = self.beam.as_ref().is_some_and(|beam| beam.lens != 0.0);
        self.image.as_ref().filter(|_| !has_lens)
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
        spaces::perspective(self.cone_radians, self.aspect, self.near, self.far)
    }

    /// Half its width and half its height at distance 1.
    pub fn tangents(&self) -> DVec2 {
        let tan = (0.5 * self.cone_radians).tan();
        DVec2::new(tan * self.aspect, tan)
    }

    /// The same pyramid from its apex to far beyond its far plane: the region that the light can reach.
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
