//! Casters whose shadow the camera cannot see: conservative, from bounding boxes.
//!
//! A box shadows the points c + t (c - L) with c in the box, t >= 0 and L the light's position, or c + t d with the
//! direction d of parallel light. Once all eight corners have crossed one face of the scene's bounds, there is nothing left
//! to shadow; up to there, the hull of the corners and their crossings holds the shadow. If that hull, grown by a filter's
//! reach, lies beyond one of the camera's planes, no visible point looks the caster up.

use glam::{DVec3, DVec4};

use super::projector::Rays;
use super::{Drawable, FrustumView};
use crate::math::Aabb;
use crate::math::frustum::planes;

/// Reach of one comparison's lookup, in texels: a linear filter's neighbour, Direct3D's half texel and rounding.
const REACH_TEXELS: f64 = 4.0;

/// Finds the casters of one light that matter to the picture.
pub struct Unseen {
    scene_bounds: Aabb,
    rays: Rays,
    /// World space; the normals, of unit length, point inwards.
    camera_planes: [DVec4; 6],
    /// Length of the texels that a lookup reaches: at a distance of 1 from the light, or anywhere in parallel light.
    reach: f64,
}

impl Unseen {
    /// A test for a map of `texels` a side, looked up within `reach` texels beside a filter's own.
    pub fn new(view: &FrustumView<'_>, texels: u32, reach: f64) -> Self {
        Self {
            scene_bounds: view.camera.scene_bounds,
            rays: view.projector.rays,
            camera_planes: planes(&view.camera.clip_from_world),
            reach: (REACH_TEXELS + reach) * view.projector.extent(1.0) / f64::from(texels),
        }
    }

    /// Tests whether `item` and all that it can shadow lie outside the camera's frustum.
    pub fn shadow_of(&self, item: &Drawable) -> bool {
        let corners = item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner));
        let Some(end) = end_of_shadow(self.rays, &self.scene_bounds, &corners) else { return false };
        let ends = corners.map(|corner| corner + end * way(self.rays, corner));
        self.camera_planes.iter().any(|plane| {
            corners.iter().chain(&ends).all(|point| {
                let reach = self.reach_at(*point);
                // The slack of 2^-20 covers the driver's f32 transforms.
                let slack = 2.0_f64.powi(-20) * (point.abs().max_element() + plane.w.abs());
                plane.dot(point.extend(1.0)) < -reach - slack
            })
        })
    }

    fn reach_at(&self, point: DVec3) -> f64 {
        match self.rays {
            Rays::From { position, .. } => self.reach * point.distance(position),
            Rays::Along(_) => self.reach,
        }
    }

    /// As [`shadows_nothing`], for this light.
    pub fn shadows_nothing(&self, item: &Drawable) -> bool {
        shadows_nothing(self.rays, &self.scene_bounds, item)
    }
}

/// Tests whether `item` is flat and nothing within the bounds of a scene, in world space, lies behind it: it cannot shadow
/// itself.
pub fn shadows_nothing(rays: Rays, scene_bounds: &Aabb, item: &Drawable) -> bool {
    let corners = item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner));
    let is_flat = item.bounds.flat_axis().is_some();
    is_flat && end_of_shadow(rays, scene_bounds, &corners).is_some_and(|end| end <= 1e-9)
}

/// Vector along the ray through a point, of any length.
fn way(rays: Rays, point: DVec3) -> DVec3 {
    match rays {
        Rays::From { position, .. } => point - position,
        Rays::Along(direction) => direction,
    }
}

/// The least t by which all corners have crossed some face of the scene's bounds; `None` if there is none.
fn end_of_shadow(rays: Rays, bounds: &Aabb, corners: &[DVec3; 8]) -> Option<f64> {
    let time = |corner: &DVec3, axis: usize, bound: f64, sign: f64| {
        let speed = sign * way(rays, *corner)[axis];
        (speed > 0.0).then(|| (sign * (bound - corner[axis]) / speed).max(0.0))
    };
    let faces = (0..3).flat_map(|axis| [(axis, bounds.max[axis], 1.0), (axis, bounds.min[axis], -1.0)]);
    let ends = faces.filter_map(|(axis, bound, sign)| {
        corners.iter().map(|corner| time(corner, axis, bound, sign)).try_fold(0.0, |end: f64, t| t.map(|t| end.max(t)))
    });
    ends.min_by(f64::total_cmp).filter(|end| end.is_finite())
}
