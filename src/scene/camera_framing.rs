//! Position, near and far planes of a camera that frames given points tightly. Pure geometry, no settings.

use glam::DVec3;

use super::sight::{Pyramid, Span};
use super::{Camera, Object, Spot};
use crate::math::{Aabb, spaces};

/// The part of the picture's half height and half width that framed points may reach.
const MARGIN: f64 = 0.82;

/// Ratio of far to near plane if nothing is in view.
const DEPTH_RATIO: f64 = 1e3;

/// Distance of a supplied near plane, as a share of the nearest distance in view.
const ROOM: f64 = 0.8;

/// Greatest distance of the target over a supplied near plane, whatever is cut. A depth buffer of 24 bits then resolves a
/// thousandth of the target's distance ([`depth_step`]).
const STIFFEST: f64 = (1 << 14) as f64;

/// The default vertical angle of a camera.
pub(super) const FOV_Y_DEGREES: f64 = 40.0;

/// Direction from the target to the eye of a three-quarter view: from the front, the right and a little above.
pub(super) const THREE_QUARTER: DVec3 = DVec3::new(0.55, 0.52, 0.8);

/// The radius to work with: never zero, nor so small that f64 does not resolve it at the box's place.
pub(super) fn working_radius(bounds: &Aabb) -> f64 {
    let place = bounds.min.abs().max(bounds.max.abs()).max_element();
    match bounds.radius() {
        radius if radius > 1e-12 * place => radius,
        _ if place > 0.0 => 1e-5 * place,
        _ => 1.0,
    }
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

/// Distance from which a picture holds a sphere of `radius`.
pub(super) fn sphere_distance(radius: f64, fov_y_radians: f64, aspect: f64) -> f64 {
    let tan = (0.5 * fov_y_radians).tan() * MARGIN * aspect.min(1.0);
    radius / tan.atan().sin()
}

/// Near and far planes of `camera` (its own are ignored): just before the nearest surface in view, and behind everything
/// ahead. `points`: the corners of boxes around all objects.
pub(super) fn depth_range(points: &[DVec3], camera: &Camera, seen: Span, radius: f64) -> [f64; 2] {
    let view_from_world = camera.view_from_world();
    let depths = points.iter().map(|point| -view_from_world.transform_point3(*point).z);
    let far = (1.1 * depths.fold(0.0_f64, f64::max)).max(radius);
    [near_before(seen, far, camera.eye.distance(camera.target)), far]
}

/// Near and far planes of a spotlight (its own are ignored), around the contents of its frustum.
pub(super) fn spot_range(spot: &Spot, objects: &[Object]) -> [f64; 2] {
    let frustum = spot.reach();
    let behind = frustum.position.distance(spot.frustum.position);
    let pyramid = Pyramid::of_frustum(&frustum);
    let seen = objects.iter().fold(Span::EMPTY, |span, object| span.union(pyramid.span(object)));
    let seen = Span { least: seen.least - behind, most: seen.most - behind, ..seen };
    let reach = spot.frustum.position.distance(spot.frustum.target);
    let far = if seen.is_empty() { 2.0 * reach } else { 1.1 * seen.most };
    let near = near_before(seen, far, reach);
    // Before the boxes too, if that costs little: maps choose casters by their boxes.
    let boxes = objects.iter().map(|object| pyramid.span_of_box(object).least).fold(f64::INFINITY, f64::min);
    let near = near.min(0.99 * (boxes - behind)).max(0.25 * near);
    // A map cannot show surfaces at the light's own position.
    [near, far.max(2.0 * near)]
}

/// Near and far planes of the faces of a cube map at `position`, around all `objects` (one or more).
pub(super) fn cube_range(position: DVec3, objects: &[Object]) -> [f64; 2] {
    let faces = Pyramid::of_cube(position);
    let spans = objects.iter().flat_map(|object| faces.iter().map(|face| face.span(object)));
    let seen = spans.fold(Span::EMPTY, Span::union);
    let far = if seen.is_empty() || seen.most <= 0.0 { 1.0 } else { 1.1 * seen.most };
    // There is no target: only surfaces at its own position are cut.
    let aim = if ROOM * seen.least < far / f64::from(1 << 24) { far } else { 0.0 };
    [near_before(seen, far, aim), far]
}

/// A near plane just before the nearest visible surface. Farther away it would cut; nearer it would waste the depth
/// buffer's precision, which is proportional to its distance. `aim`: distance of the target.
fn near_before(seen: Span, far: f64, aim: f64) -> f64 {
    let near = if seen.is_empty() { far / DEPTH_RATIO } else { ROOM * seen.least };
    near.max(aim.min(far) / STIFFEST).min(0.5 * far)
}

/// The least depth difference that a buffer of 24 bits resolves at `depth`, behind a near plane at `near`: its step in
/// window space, 2⁻²⁴, is so long there.
pub(super) fn depth_step(near: f64, depth: f64) -> f64 {
    depth * (depth / near) / f64::from(1 << 24)
}

/// Depth beyond which everything lies within two steps of 2⁻²⁴ of the cleared value of a 24-bit depth buffer. The buffer
/// rounds by half a step, and f32 by about one near depth 1: surfaces there are lost, or share one depth.
pub(super) fn last_depth([near, far]: [f64; 2]) -> f64 {
    1.0 / (1.0 / (f64::from(1 << 23) * near) + 1.0 / far)
}
