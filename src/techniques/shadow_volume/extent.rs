//! Planes beyond all that is seen, at which volumes may end, and casters that shadow nothing. Conservative, from bounding
//! boxes in world space.

use glam::DVec3;

use super::casters::CastingObject;
use crate::geometry::volume::LightSource;
use crate::lights::LightView;

/// `normal · x = distance`; beyond it is where the dot product is greater.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    pub normal: DVec3,
    pub distance: f64,
}

/// Error of f32 transforms, relative to the greatest operand.
const SLACK: f64 = 1.0 / (1 << 20) as f64;

/// Least sine of the angle between a ray and a plane; a flatter ray reaches the plane too late.
const STEEPNESS: f64 = 1e-2;

/// Least distance beyond all that is seen at which a volume ends, relative to its distance from the eye: more than a depth
/// buffer rounds by. It is not relative to the size of the scene: beneath an endless floor, sides would be as long.
const MARGIN: f64 = 1e-3;

/// A plane beyond the eye, the near rectangle and all that is seen, which every ray from the light through the caster's
/// box crosses: the one of six that cuts the volume shortest. `None`: none of the six does.
pub fn beyond_all(view: &LightView<'_>, caster: &CastingObject, source: LightSource) -> Option<Plane> {
    let bounds = view.camera.seen_bounds;
    let rounding = SLACK * bounds.min.abs().max(bounds.max.abs()).max_element();
    let box_corners = caster.bounds.corners().map(|corner| caster.world_from_model.transform_point3(corner));
    let faces = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| {
        [(axis, axis.dot(bounds.max)), (-axis, -axis.dot(bounds.min))]
            .map(|(normal, distance)| Plane { normal, distance: distance + rounding })
    });
    let length = |plane: &Plane| {
        let ways = box_corners.iter().map(|corner| {
            let away = source.away(*corner);
            let steepness = plane.normal.dot(away) / away.length();
            let gap = (plane.distance - plane.normal.dot(*corner)).max(0.0);
            if steepness > STEEPNESS { gap / steepness } else { f64::INFINITY }
        });
        ways.fold(0.0, f64::max)
    };
    let (shortest, plane) = faces.map(|plane| (length(&plane), plane)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    // No ray from the box is longer than that, nor farther from the eye.
    let eye = view.scene.camera.eye;
    let reach = box_corners.iter().map(|corner| corner.distance(eye)).fold(0.0, f64::max) + shortest;
    shortest.is_finite().then_some(Plane { distance: plane.distance + MARGIN * reach, ..plane })
}

/// Tests whether the caster is flat, and light, eye and all that is seen are on one side of its plane: then its volume holds
/// nothing that is seen, itself included.
pub fn is_flat_before_all(view: &LightView<'_>, caster: &CastingObject, source: LightSource) -> bool {
    let Some(axis) = caster.bounds.flat_axis() else { return false };
    let normal = caster.world_from_model.inverse().transpose().transform_vector3(axis).normalize();
    let middle = caster.world_from_model.transform_point3(caster.bounds.center());
    let height = |point: DVec3| normal.dot(point - middle);
    let above = -normal.dot(source.away(middle)); // the light's height, or for a direction its rise
    let side = above.signum();
    let slack = |point: DVec3| SLACK * (point.abs().max_element() + middle.abs().max_element());
    let is_before = |point: DVec3| side * height(point) >= -slack(point);
    let clear = |point: DVec3| side * height(point) > slack(point);
    let light_is_clear = side * above > SLACK * source.away(middle).length();
    let others = view
        .camera
        .visible
        .iter()
        .flat_map(|item| item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner)));
    // The box around all that is seen tells it at once where it lies on the lit side: a floor of many tiles is under it.
    let are_before = || {
        let is_above = |corner: DVec3| side * height(corner) >= 0.0;
        view.camera.seen_bounds.corners().into_iter().all(is_above) || { others }.all(is_before)
    };
    light_is_clear && clear(view.scene.camera.eye) && view.camera.near.into_iter().all(clear) && are_before()
}
