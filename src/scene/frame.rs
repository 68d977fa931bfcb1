//! Where a camera stands that sees given points and nothing more than it must, and between which planes. Pure geometry, no settings.

use glam::DVec3;

use super::{Camera, Object};
use crate::math::{Aabb, spaces};

/// The part of the picture's half height and half width that framed points may reach.
const MARGIN: f64 = 0.82;

/// The far plane of a supplied camera or map is at most this many times as far as the near plane.
const DEPTH_RATIO: f64 = 1e3;

/// The default vertical angle of a camera.
pub(super) const FOV_Y_DEGREES: f64 = 40.0;

/// From what is looked at to a pleasant three-quarter view: from the front, the right and a little above.
pub(super) const THREE_QUARTER: DVec3 = DVec3::new(0.55, 0.52, 0.8);

/// The radius to work with: never zero, and not below what f32 resolves at the box's place.
pub(super) fn working_radius(bounds: &Aabb) -> f64 {
    let least = bounds.min.abs().max(bounds.max.abs()).max_element() * 1e-5;
    let radius = bounds.radius().max(least);
    if radius > 0.0 { radius } else { 1.0 }
}

/// Eye and target that hold all `points` tightly within a picture, looking against `toward_eye`.
///
/// Each side plane of the frustum, moved with the eye, touches the outermost point; the wider of the two directions
/// decides the distance. `points` are not empty; `radius` is their [`working_radius`].
pub(super) fn fit(points: &[DVec3], toward_eye: DVec3, fov_y_radians: f64, aspect: f64, radius: f64) -> (DVec3, DVec3) {
    let center = Aabb::from_points(points.iter().copied()).center();
    let toward_eye = toward_eye.normalize() * radius;
    let view_from_world = spaces::view_from_world(center + toward_eye, center, DVec3::Y);
    let tan_y = (0.5 * fov_y_radians).tan() * MARGIN;
    let tan_x = tan_y * aspect;
    let seen: Vec<DVec3> = points.iter().map(|point| view_from_world.transform_point3(*point)).collect();
    let most = |reach: &dyn Fn(&DVec3) -> f64| seen.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
    let right = most(&|point| point.x + tan_x * point.z);
    let left = most(&|point| -point.x + tan_x * point.z);
    let above = most(&|point| point.y + tan_y * point.z);
    let below = most(&|point| -point.y + tan_y * point.z);
    let front = most(&|point| point.z);
    let z = ((right + left) / (2.0 * tan_x)).max((above + below) / (2.0 * tan_y)).max(front + 0.1 * radius);
    let eye = DVec3::new(0.5 * (right - left), 0.5 * (above - below), z);
    let world_from_view = view_from_world.inverse();
    let eye_world = world_from_view.transform_point3(eye);
    // The target: straight ahead, at the depth of the middle, which is one radius before the view's origin.
    let ahead = DVec3::new(eye.x, eye.y, (-radius).min(eye.z - 0.1 * radius));
    (eye_world, world_from_view.transform_point3(ahead))
}

/// How far from its middle a sphere of `radius` is held by the picture.
pub(super) fn sphere_distance(radius: f64, fov_y_radians: f64, aspect: f64) -> f64 {
    let tan = (0.5 * fov_y_radians).tan() * MARGIN * aspect.min(1.0);
    radius / tan.atan().sin()
}

/// Near and far planes around `points` as `camera` sees them (its own planes are not read).
pub(super) fn depth_range(points: &[DVec3], camera: &Camera, radius: f64) -> [f64; 2] {
    let view_from_world = camera.view_from_world();
    let depths = points.iter().map(|point| -view_from_world.transform_point3(*point).z);
    let (least, most) =
        depths.fold((f64::INFINITY, 0.0_f64), |(least, most), depth| (least.min(depth), most.max(depth)));
    range_around(least, most, radius)
}

/// Near and far planes of the faces of a cube map at `position`, around all `objects` (one or more).
pub(super) fn cube_range(position: DVec3, objects: &[Object]) -> [f64; 2] {
    let depth = |point: DVec3| (point - position).abs().max_element();
    let (mut least, mut most, mut all) = (f64::INFINITY, 0.0_f64, Aabb::EMPTY);
    for bounds in objects.iter().map(Object::world_bounds) {
        least = least.min(depth(position.max(bounds.min).min(bounds.max)));
        most = bounds.corners().into_iter().map(depth).fold(most, f64::max);
        all = all.union(bounds);
    }
    range_around(least, most, working_radius(&all))
}

/// Planes with some room around depths in [least, most].
fn range_around(least: f64, most: f64, radius: f64) -> [f64; 2] {
    let far = (1.1 * most).max(radius);
    [(0.5 * least).clamp(far / DEPTH_RATIO, 0.5 * far), far]
}
