//! The light as a place, an axis and an angle: what its cone or square frustum holds.

use glam::{DVec2, DVec3};

use super::beam::Side;
use super::truth::Reason;
use crate::scene::{Frustum, Light, LightKind, LightShape};

pub(super) struct Lamp {
    pub position: DVec3,
    /// Ahead, right, up; of unit length and square to each other.
    axes: [DVec3; 3],
    shape: LightShape,
    half_angle_radians: f64,
    pub near: f64,
    far: f64,
}

impl Lamp {
    pub fn new(light: &Light) -> Option<Self> {
        let LightKind::Spot(spot) = &light.kind else { return None };
        let Frustum { position, target, up, cone_radians, near, far } = spot.frustum;
        let ahead = (target - position).normalize();
        let right = ahead.cross(up).normalize();
        Some(Self {
            position,
            axes: [ahead, right, right.cross(ahead)],
            shape: spot.shape,
            half_angle_radians: 0.5 * cone_radians,
            near,
            far,
        })
    }

    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.axes.iter().all(|axis| axis.is_finite()) && self.half_angle_radians > 0.0
    }

    /// The distance along the light's axis.
    pub fn depth(&self, point: DVec3) -> f64 {
        self.axes[0].dot(point - self.position)
    }

    /// Where the square frustum holds the point, each coordinate in [-1, 1] inside; infinite behind the light.
    pub fn in_frustum(&self, point: DVec3) -> DVec2 {
        let [depth, right, up] = self.local(point);
        if depth <= 0.0 {
            return DVec2::INFINITY;
        }
        DVec2::new(right, up) / (depth * self.half_angle_radians.tan())
    }

    fn local(&self, point: DVec3) -> [f64; 3] {
        self.axes.map(|axis| axis.dot(point - self.position))
    }

    /// Distance to the cone's or the frustum's surface, positive inside. Concave, and never steeper than 1.
    fn depth_inside_sides(&self, point: DVec3) -> f64 {
        let [depth, right, up] = self.local(point);
        let beside = match self.shape {
            LightShape::Cone => right.hypot(up),
            LightShape::Frustum => right.abs().max(up.abs()),
        };
        let (sin, cos) = self.half_angle_radians.sin_cos();
        depth * sin - beside * cos
    }

    fn depth_inside_planes(&self, point: DVec3) -> f64 {
        let depth = self.depth(point);
        (depth - self.near).min(self.far - depth)
    }

    /// `Ok(true)`: all of `point ± spread` is lit by the light's shape; `Ok(false)`: none of it.
    ///
    /// The two functions are concave, so over a parallelogram neither their rise nor their fall from the middle is more
    /// than the largest fall to a corner.
    pub fn holds(&self, point: DVec3, spread: &[DVec3; 2], error: f64) -> Result<bool, Reason> {
        let side = |inside: &dyn Fn(DVec3) -> f64| {
            let value = inside(point);
            let [a, b] = *spread;
            let moved = [a + b, a - b, b - a, -a - b]
                .into_iter()
                .fold(0.0, |most: f64, offset| most.max((inside(point + offset) - value).abs()));
            match value {
                _ if value.abs() <= moved + error => Side::Near,
                _ if value > 0.0 => Side::Beyond,
                _ => Side::Before,
            }
        };
        let sides = side(&|at| self.depth_inside_sides(at));
        let planes = side(&|at| self.depth_inside_planes(at));
        match (sides, planes) {
            (Side::Before, _) | (_, Side::Before) => Ok(false),
            (Side::Near, _) => Err(Reason::ConeEdge),
            (_, Side::Near) => Err(Reason::ClipPlane),
            (Side::Beyond, Side::Beyond) => Ok(true),
        }
    }

    /// What the point itself says.
    pub fn holds_exactly(&self, point: DVec3) -> bool {
        self.depth_inside_sides(point) >= 0.0 && self.depth_inside_planes(point) >= 0.0
    }
}
