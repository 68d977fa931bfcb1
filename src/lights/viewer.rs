//! The matrices of the picture that surfaces are drawn for.

use glam::DMat4;

use crate::scene::Scene;

/// Viewer that the surfaces are drawn for.
#[derive(Clone, Copy, Debug)]
pub struct Viewer {
    pub clip_from_eye: DMat4,
    pub eye_from_world: DMat4,
}

impl Viewer {
    /// The scene's camera.
    pub fn of_camera(scene: &Scene) -> Self {
        let camera = &scene.camera;
        Self { clip_from_eye: camera.clip_from_view(scene.aspect()), eye_from_world: camera.view_from_world() }
    }

    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_eye * self.eye_from_world
    }

    /// The distance of the near plane.
    pub fn near(&self) -> f64 {
        self.clip_from_eye.w_axis.z / (self.clip_from_eye.z_axis.z - 1.0)
    }
}
