//! Moves of camera and light by the mouse and the arrows.

use glam::{DQuat, DVec2, DVec3};

use super::Explorer;
use crate::math::Aabb;
use crate::scene::{Camera, LightKind};
use crate::viewer::orbit::{dolly, orbit};

/// Share of the distance to the target by which a key moves.
const STEP: f64 = 0.08;

/// Share of the distance to the farthest object by which the far plane lies behind it.
const ROOM: f64 = 1.05;

/// Share of the objects' radius that the near plane, and the eye from its target, keep at least.
const NEAREST: f64 = 5e-3;

/// Steepest look up or down, in degrees: `up` keeps its meaning.
const STEEPEST_DEGREES: f64 = 89.0;

impl Explorer {
    /// Angles of a drag: the window's height is half a turn.
    fn turn(&self, drag: DVec2) -> DVec2 {
        drag * std::f64::consts::PI / f64::from(self.size[1])
    }

    pub(super) fn orbit_camera(&mut self, drag: DVec2) {
        let turn = self.turn(drag);
        let camera = &mut self.scene.camera;
        camera.eye = orbit(camera.eye, camera.target, camera.up, DVec2::new(-turn.x, turn.y));
        self.reach_objects();
    }

    /// Turns the camera about its eye.
    pub(super) fn look(&mut self, drag: DVec2) {
        let turn = self.turn(drag) * (self.scene.camera.fov_y_radians / std::f64::consts::PI);
        let camera = &mut self.scene.camera;
        let ahead = camera.target - camera.eye;
        let (Some(direction), Some(right)) = (ahead.try_normalize(), ahead.cross(camera.up).try_normalize()) else {
            return;
        };
        let height = camera.up.dot(direction).clamp(-1.0, 1.0).asin();
        let steepest = STEEPEST_DEGREES.to_radians().max(height.abs());
        let rise = (height + turn.y).clamp(-steepest, steepest) - height;
        let turned = DQuat::from_axis_angle(camera.up, turn.x) * DQuat::from_axis_angle(right, rise);
        camera.target = camera.eye + turned * ahead;
        self.reach_objects();
    }

    /// Moves eye and target across, so that what is at the target's distance follows the mouse.
    pub(super) fn pan(&mut self, drag: DVec2) {
        let moved = across(&self.scene.camera, self.scene.camera.target, drag, self.size[1]);
        let camera = &mut self.scene.camera;
        camera.eye -= moved;
        camera.target -= moved;
        self.reach_objects();
    }

    /// Moves eye and target to the right, upwards and forwards, by steps.
    pub(super) fn walk(&mut self, [right, up, ahead]: [f64; 3]) {
        let camera = &mut self.scene.camera;
        let world_from_view = camera.view_from_world().inverse();
        let steps = world_from_view.transform_vector3(DVec3::new(right, up, -ahead));
        let moved = steps * STEP * camera.eye.distance(camera.target);
        camera.eye += moved;
        camera.target += moved;
        self.reach_objects();
    }

    pub(super) fn zoom(&mut self, steps: f64) {
        let least = NEAREST * self.scene.world_bounds().radius();
        let camera = &mut self.scene.camera;
        camera.eye = dolly(camera.eye, camera.target, steps, [least, f64::MAX.sqrt()]);
        self.reach_objects();
    }

    /// Moves the far plane behind all objects, or to where the file has it; and the near plane from where the file has it to
    /// before the objects.
    fn reach_objects(&mut self) {
        let bounds: Aabb = self.scene.world_bounds();
        let radius = bounds.radius();
        let distance = self.scene.camera.eye.distance(bounds.center());
        let Camera { near, far, .. } = self.base.camera;
        if radius.is_finite() && radius > 0.0 && distance.is_finite() {
            self.scene.camera.near = near.min((0.5 * (distance - radius)).max(NEAREST * radius));
            self.scene.camera.far = far.max(ROOM * (distance + radius));
        }
    }

    /// Moves the chosen light about what it points at; a point light about the objects' middle.
    pub(super) fn orbit_light(&mut self, drag: DVec2) {
        let turn = self.turn(drag);
        let turn = DVec2::new(turn.x, -turn.y);
        let middle = self.scene.world_bounds().center();
        let Some(light) = self.scene.lights.get_mut(self.light) else { return };
        match &mut light.kind {
            LightKind::Spot(spot) => {
                let frustum = &mut spot.frustum;
                frustum.position = orbit(frustum.position, frustum.target, frustum.up, turn);
            }
            LightKind::Point(point) => point.position = orbit(point.position, middle, DVec3::Y, turn),
            LightKind::Directional { direction } => {
                let turned = -orbit(-*direction, DVec3::ZERO, DVec3::Y, turn);
                *direction = turned.try_normalize().unwrap_or(*direction);
            }
        }
    }

    /// Moves the chosen light on the plane through it that faces the camera; parallel light stays.
    pub(super) fn slide_light(&mut self, drag: DVec2) {
        let (camera, height) = (self.scene.camera.clone(), self.size[1]);
        let Some(light) = self.scene.lights.get_mut(self.light) else { return };
        match &mut light.kind {
            LightKind::Spot(spot) => {
                let frustum = &mut spot.frustum;
                let place = frustum.position + across(&camera, frustum.position, drag, height);
                let ahead = (frustum.target - place).normalize_or_zero();
                // Not where its `up` would have no meaning, nor through its target.
                let is_clear = place.distance(frustum.target) >= 2.0 * frustum.near;
                if is_clear && ahead.cross(frustum.up).length() > 1e-3 {
                    frustum.position = place;
                }
            }
            LightKind::Point(point) => point.position += across(&camera, point.position, drag, height),
            LightKind::Directional { .. } => {}
        }
    }

    /// Moves the chosen light nearer to its target or to the objects' middle.
    pub(super) fn dolly_light(&mut self, steps: f64) {
        let middle = self.scene.world_bounds().center();
        let Some(light) = self.scene.lights.get_mut(self.light) else { return };
        match &mut light.kind {
            LightKind::Spot(spot) => {
                let frustum = &mut spot.frustum;
                let range = [2.0 * frustum.near, 0.95 * frustum.far];
                frustum.position = dolly(frustum.position, frustum.target, steps, range);
            }
            LightKind::Point(point) => {
                point.position = dolly(point.position, middle, steps, [2.0 * point.near, 0.95 * point.far]);
            }
            LightKind::Directional { .. } => {}
        }
    }
}

/// The way in the world that a drag is at a place.
fn across(camera: &Camera, place: DVec3, drag: DVec2, height: u32) -> DVec3 {
    let view_from_world = camera.view_from_world();
    let depth = (-view_from_world.transform_point3(place).z).abs().max(camera.near);
    let pixel = 2.0 * depth * (0.5 * camera.fov_y_radians).tan() / f64::from(height);
    view_from_world.inverse().transform_vector3(DVec3::new(drag.x, -drag.y, 0.0) * pixel)
}
