//! `[camera]`: every key may be absent; what is missing is framed on the scene's objects.

use glam::DVec3;

use crate::math::Aabb;
use crate::scene::frame;
use crate::scene::settings::{Settings, SettingsError};
use crate::scene::{Camera, Object};

/// `[camera]` as written; what depends on the objects comes later.
pub(super) struct Written {
    settings: Settings,
    eye: Option<DVec3>,
    target: Option<DVec3>,
    fov_y_radians: f64,
    near: Option<f64>,
    far: Option<f64>,
}

/// Reads and checks what can be checked without the objects.
pub(super) fn read(table: Option<&Settings>) -> Result<Written, SettingsError> {
    let settings = table.cloned().unwrap_or_default();
    let mut reader = settings.read();
    let (eye, target) = (reader.vector("eye")?, reader.vector("target")?);
    match (eye, target) {
        (Some(eye), Some(target)) => reader.up(["eye", "target"], eye, target).map(drop)?,
        _ => reader.vector("up").map(drop)?,
    }
    let fov_y_radians = reader.angle_between("fov_y", 1.0, 179.0)?.unwrap_or(frame::FOV_Y_DEGREES.to_radians());
    let [near, far] = reader.near_and_far()?;
    reader.finish()?;
    Ok(Written { eye, target, fov_y_radians, near, far, settings })
}

impl Written {
    /// The camera, framed on `objects` where it is not written; `aspect` is the picture's width over its height.
    pub fn complete(self, objects: &[Object], aspect: f64) -> Result<Camera, SettingsError> {
        let corners: Vec<DVec3> = objects.iter().flat_map(|object| object.world_bounds().corners()).collect();
        let bounds = Aabb::from_points(corners.iter().copied());
        let radius = frame::working_radius(&bounds);
        let (eye, target) = self.eye_and_target(&corners, &bounds, radius, aspect);
        let mut reader = self.settings.read();
        let up = reader.up(["eye", "target"], eye, target)?;
        let mut camera = Camera { eye, target, up, fov_y_radians: self.fov_y_radians, near: 0.0, far: 0.0 };
        let [near, far] = frame::depth_range(&corners, &camera, radius);
        camera.near = self.near.unwrap_or_else(|| self.far.map_or(near, |far| near.min(far / 2.0)));
        camera.far = self.far.unwrap_or_else(|| far.max(2.0 * camera.near));
        reader.check_far(camera.near, camera.far)?;
        Ok(camera)
    }

    fn eye_and_target(&self, corners: &[DVec3], bounds: &Aabb, radius: f64, aspect: f64) -> (DVec3, DVec3) {
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            return (eye, target);
        }
        let reach = |target: DVec3| corners.iter().map(|corner| corner.distance(target)).fold(radius, f64::max);
        match (self.eye, self.target) {
            (Some(eye), _) if eye == bounds.center() => (eye, eye - frame::THREE_QUARTER * radius),
            (Some(eye), _) => (eye, bounds.center()),
            (None, Some(target)) => {
                let distance = frame::sphere_distance(reach(target), self.fov_y_radians, aspect);
                (target + frame::THREE_QUARTER.normalize() * distance, target)
            }
            (None, None) => frame::fit(corners, frame::THREE_QUARTER, self.fov_y_radians, aspect, radius),
        }
    }
}
