//! Bounds of the number of volumes that hold one point: a stencil count of 8 bits distinguishes 256.

use glam::{DMat4, DVec3};

use super::casters::CastingObject;
use crate::geometry::volume::SurfaceKind;
use crate::lights::LightView;
use crate::lights::box_raster::{BoxRaster, Sighting};
use crate::lights::projector::face_frustum;
use crate::math::{Aabb, spaces};
use crate::pass::CubeFace;
use crate::scene::LightKind;

/// Greatest number of volumes, wherever their casters stand: one for each triangle of an open shell, two for a closed one.
pub fn in_all(drawn: &[&CastingObject]) -> usize {
    drawn.iter().map(|caster| of(caster)).sum()
}

fn of(caster: &CastingObject) -> usize {
    let shells = caster.caster.shells().iter();
    shells.map(|shell| if shell.kind == SurfaceKind::Closed { 2 } else { shell.triangles.len() }).sum()
}

/// Greatest number of volumes whose casters one of the light's rays may meet: volumes that hold a point have their casters on
/// its way to the light.
pub fn on_a_ray(view: &LightView<'_>, drawn: &[&CastingObject]) -> usize {
    let corners = |caster: &&CastingObject| {
        caster.bounds.corners().map(|corner| caster.world_from_model.transform_point3(corner))
    };
    let most = |clip_from_world: DMat4, size: fn(DVec3) -> f64| {
        let see = |point: DVec3| Sighting::new(clip_from_world * point.extend(1.0), size(point));
        BoxRaster::new(drawn.iter().map(corners), see).most(|index| of(drawn[index as usize]))
    };
    let by_place = |point: DVec3| point.abs().max_element();
    match &view.light().kind {
        LightKind::Spot(spot) => most(spot.frustum.clip_from_world(), by_place),
        LightKind::Point(point) => {
            let faces = CubeFace::ALL.map(|face| most(face_frustum(point, face).clip_from_world(), by_place));
            faces.into_iter().max().unwrap_or(0)
        }
        LightKind::Directional { direction } => {
            let up = if direction.y.abs() < 0.99 { DVec3::Y } else { DVec3::Z };
            let light_from_world = spaces::view_from_world(DVec3::ZERO, *direction, up);
            let points = drawn.iter().flat_map(corners).map(|corner| light_from_world.transform_point3(corner));
            let bounds = Aabb::from_points(points);
            // Some room, so that no box ends at the raster's edge; all lie before an eye that is infinitely far away.
            let room = 1e-3 * bounds.radius() + f64::MIN_POSITIVE;
            let (min, max) = (bounds.min - room, bounds.max + room);
            most(spaces::orthographic(min, max) * light_from_world, |_| 0.0)
        }
    }
}
