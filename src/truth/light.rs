//! The light as a place or a direction, an axis and an angle: where it comes from and what its shape holds.

use glam::{DVec2, DVec3};

use super::answers::Reason;
use super::beam::{Apex, BeamSide};
use crate::scene::{Frustum, Light, LightKind, LightShape};

pub(super) struct Lamp {
    source: Origin,
    shape: Shape,
}

/// Position or direction of a light.
#[derive(Clone, Copy)]
enum Origin {
    At(DVec3),
    /// From infinitely far away. `travel`: the way of the light, of unit length; a ball holds all that it may meet.
    Along {
        travel: DVec3,
        center: DVec3,
        radius: f64,
    },
}

/// Region that the light reaches, and the layout of a map of it.
enum Shape {
    /// `axes`: ahead, right, up; of unit length and square to each other.
    /// `aspect`: width over height of the frustum, which `half_angle_radians` is the half of the upright angle of.
    Spot { axes: [DVec3; 3], ends: LightShape, half_angle_radians: f64, aspect: f64, near: f64, far: f64 },
    /// Every way, between near and far along the nearest coordinate axis.
    Cube { near: f64, far: f64 },
    /// Everywhere. A map would be the square around the ball that holds all the scene, as the light sees it.
    Square { right: DVec3, up: DVec3, center: DVec3, radius: f64 },
}

impl Lamp {
    /// `center` and `radius`: of a ball that holds all that may be in the light's way.
    pub fn new(light: &Light, center: DVec3, radius: f64) -> Self {
        match &light.kind {
            LightKind::Spot(spot) => {
                let Frustum { position, target, up, cone_radians, aspect, near, far, .. } = spot.frustum;
                let ahead = (target - position).normalize();
                let right = ahead.cross(up).normalize();
                let axes = [ahead, right, right.cross(ahead)];
                let (ends, half_angle_radians) = (spot.shape, 0.5 * cone_radians);
                let shape = Shape::Spot { axes, ends, half_angle_radians, aspect, near, far };
                Self { source: Origin::At(position), shape }
            }
            LightKind::Point(point) => {
                let (near, far) = (point.near, point.far);
                Self { source: Origin::At(point.position), shape: Shape::Cube { near, far } }
            }
            LightKind::Directional { direction } => {
                let travel = direction.normalize();
                let (right, up) = travel.any_orthonormal_pair();
                Self {
                    source: Origin::Along { travel, center, radius },
                    shape: Shape::Square { right, up, center, radius },
                }
            }
        }
    }

    /// Light from straight above, for a scene that has none.
    pub fn above(center: DVec3, radius: f64) -> Self {
        let travel = -DVec3::Y;
        let (right, up) = travel.any_orthonormal_pair();
        Self { source: Origin::Along { travel, center, radius }, shape: Shape::Square { right, up, center, radius } }
    }

    /// The same light from another place, if it has one.
    pub fn moved(self, way: DVec3) -> Self {
        let source = match self.source {
            Origin::At(position) => Origin::At(position + way),
            parallel @ Origin::Along { .. } => parallel,
        };
        Self { source, ..self }
    }

    pub fn is_finite(&self) -> bool {
        let (Origin::At(vector) | Origin::Along { travel: vector, .. }) = self.source;
        vector.is_finite()
            && match &self.shape {
                Shape::Spot { axes, half_angle_radians, aspect, .. } => {
                    axes.iter().all(|axis| axis.is_finite()) && *half_angle_radians > 0.0 && *aspect > 0.0
                }
                Shape::Cube { near, far } => 0.0 < *near && near < far,
                Shape::Square { center, radius, .. } => center.is_finite() && radius.is_finite(),
            }
    }

    /// Apex of a beam to `base`.
    pub fn apex(&self, base: DVec3) -> Apex {
        match self.source {
            Origin::At(position) => Apex::At(position),
            // Back to before the ball, however far behind it the base lies.
            Origin::Along { travel, center, radius } => {
                Apex::Infinity { travel, length: travel.dot(base - center).max(0.0) + 1.5 * radius }
            }
        }
    }

    /// Position; `None`: infinitely far away.
    pub fn place(&self) -> Option<DVec3> {
        if let Origin::At(position) = self.source { Some(position) } else { None }
    }

    /// From a point to the light; of unit length for one that is infinitely far away.
    pub fn towards(&self, point: DVec3) -> DVec3 {
        match self.source {
            Origin::At(position) => position - point,
            Origin::Along { travel, .. } => -travel,
        }
    }

    /// The distance along the light's axis (a point light's: along the nearest coordinate axis); 1 for parallel light.
    pub fn depth_at(&self, point: DVec3) -> f64 {
        match &self.shape {
            Shape::Spot { .. } | Shape::Cube { .. } => self.depth(point),
            Shape::Square { .. } => 1.0,
        }
    }

    /// Distance from `from` to `to` along the light's axis at `to`, in world units.
    pub fn depth_between(&self, from: DVec3, to: DVec3) -> f64 {
        self.axis_at(to).dot(to - from)
    }

    /// The way that a map's depth grows at a point: the spotlight's axis, the coordinate axis of a cube's face, or the way
    /// of parallel light. Of unit length.
    fn axis_at(&self, point: DVec3) -> DVec3 {
        let from_light = -self.towards(point);
        match &self.shape {
            Shape::Spot { axes: [ahead, ..], .. } => *ahead,
            Shape::Cube { .. } => {
                let axis = from_light.abs().max_position();
                DVec3::AXES[axis] * from_light[axis].signum()
            }
            Shape::Square { .. } => from_light,
        }
    }

    /// Slope of a plane through `point` across a map: depth along the axis, over a length across it at the point's own
    /// depth.
    pub fn slope(&self, point: DVec3, normal: DVec3) -> f64 {
        let axis = self.axis_at(point);
        let ray = -self.towards(point) / self.depth_at(point);
        normal.cross(axis).length() / normal.dot(ray).abs()
    }

    /// The halves of a square around `point` across the light's axis, `reach` at distance 1 along it, or in world units
    /// for parallel light, whose maps may be turned any way: there the square holds every turned one.
    pub fn footprint(&self, point: DVec3, reach: f64) -> [DVec3; 2] {
        let reach = reach * self.depth_at(point);
        match &self.shape {
            Shape::Spot { axes: [_, right, up], .. } => [*right * reach, *up * reach],
            Shape::Cube { .. } => {
                let from_light = -self.towards(point);
                let size = from_light.abs();
                // The two axes of the face that the point lies in.
                if size.x >= size.y && size.x >= size.z {
                    [DVec3::Y * reach, DVec3::Z * reach]
                } else if size.y >= size.z {
                    [DVec3::X * reach, DVec3::Z * reach]
                } else {
                    [DVec3::X * reach, DVec3::Y * reach]
                }
            }
            Shape::Square { right, up, .. } => [*right, *up].map(|side| side * reach * std::f64::consts::SQRT_2),
        }
    }

    /// The distance that near and far are measured by.
    fn depth(&self, point: DVec3) -> f64 {
        let from_light = -self.towards(point);
        match &self.shape {
            Shape::Spot { axes, .. } => axes[0].dot(from_light),
            Shape::Cube { .. } => from_light.abs().max_element(),
            Shape::Square { .. } => f64::INFINITY,
        }
    }

    /// Place of the point in a map that holds all of the light, in half sides of the map (see
    /// [`crate::truth::Hit::in_map`]).
    pub fn in_map(&self, point: DVec3) -> DVec3 {
        match &self.shape {
            Shape::Spot { axes, half_angle_radians, aspect, .. } => {
                let [depth, right, up] = axes.map(|axis| -axis.dot(self.towards(point)));
                if depth <= 0.0 {
                    return DVec3::INFINITY;
                }
                (DVec2::new(right / aspect, up) / (depth * half_angle_radians.tan())).extend(0.0)
            }
            Shape::Cube { .. } => -self.towards(point) / self.depth(point),
            Shape::Square { right, up, center, radius } => {
                let from_center = (point - center) / radius;
                DVec3::new(right.dot(from_center), up.dot(from_center), 0.0)
            }
        }
    }

    /// Part of `span` of a ray, by its parameter, in which the light's frustum may hold it: between the near and far planes
    /// and the four sides. `None`: the light has no frustum, or the ray misses it.
    pub fn span(&self, origin: DVec3, direction: DVec3, span: [f64; 2]) -> Option<[f64; 2]> {
        let Shape::Spot { axes, half_angle_radians, aspect, near, far, .. } = &self.shape else { return None };
        let from = self.place().map(|place| origin - place)?;
        let tangent = half_angle_radians.tan();
        let [ahead, right, up] = *axes;
        // Each is at least 0 within: a constant, and a slope along the ray.
        let beside = ahead * tangent * *aspect;
        let sides = [beside - right, beside + right, ahead * tangent - up, ahead * tangent + up]
            .map(|normal| [normal.dot(from), normal.dot(direction)]);
        let planes = [[ahead.dot(from) - near, ahead.dot(direction)], [far - ahead.dot(from), -ahead.dot(direction)]];
        let mut span = span;
        for [constant, slope] in sides.into_iter().chain(planes) {
            let at = -constant / slope;
            match slope {
                _ if slope == 0.0 && constant < 0.0 => return None,
                _ if slope > 0.0 => span[0] = span[0].max(at),
                _ if slope < 0.0 => span[1] = span[1].min(at),
                _ => {}
            }
        }
        (span[0] < span[1]).then_some(span)
    }

    /// `Ok(true)`: all of `point ± spread` is lit by the light's shape; `Ok(false)`: none of it.
    ///
    /// Distance to the sides is concave, and so or convex are the distances to the planes; over a parallelogram neither
    /// the rise nor the fall of such a function from the middle is more than the largest change to a corner.
    pub fn holds(&self, point: DVec3, spread: &[DVec3; 2], error: f64) -> Result<bool, Reason> {
        let side = |inside: &dyn Fn(DVec3) -> f64| {
            let value = inside(point);
            let [a, b] = *spread;
            let moved = [a + b, a - b, b - a, -a - b]
                .into_iter()
                .fold(0.0, |most: f64, offset| most.max((inside(point + offset) - value).abs()));
            match value {
                _ if value.abs() <= moved + error => BeamSide::Near,
                _ if value > 0.0 => BeamSide::Beyond,
                _ => BeamSide::Before,
            }
        };
        let ends = [
            (Reason::ConeEdge, side(&|at| self.inside_sides(at))),
            (Reason::ClipPlane, side(&|at| self.beyond_near(at))),
            (Reason::ClipPlane, side(&|at| self.before_far(at))),
        ];
        if ends.iter().any(|(_, side)| *side == BeamSide::Before) {
            return Ok(false);
        }
        ends.iter().find(|(_, side)| *side == BeamSide::Near).map_or(Ok(true), |(reason, _)| Err(*reason))
    }

    /// Tests the point itself, without error.
    pub fn holds_exactly(&self, point: DVec3) -> bool {
        [self.inside_sides(point), self.beyond_near(point), self.before_far(point)].iter().all(|inside| *inside >= 0.0)
    }

    /// Tests whether a point lies between the planes of the light's map.
    pub fn is_between_planes(&self, point: DVec3) -> bool {
        self.beyond_near(point) >= 0.0 && self.before_far(point) >= 0.0
    }

    /// Distance to the cone's or the frustum's surface, positive inside. Never steeper than 1, as are the next two.
    fn inside_sides(&self, point: DVec3) -> f64 {
        let Shape::Spot { axes, ends, half_angle_radians, aspect, .. } = &self.shape else { return UNBOUNDED };
        let [depth, right, up] = axes.map(|axis| -axis.dot(self.towards(point)));
        let (sin, cos) = half_angle_radians.sin_cos();
        match ends {
            LightShape::Cone => depth * sin - right.hypot(up) * cos,
            LightShape::Frustum if *aspect == 1.0 => depth * sin - right.abs().max(up.abs()) * cos,
            LightShape::Frustum => {
                let (sin_right, cos_right) = (aspect * half_angle_radians.tan()).atan().sin_cos();
                (depth * sin - up.abs() * cos).min(depth * sin_right - right.abs() * cos_right)
            }
        }
    }

    fn beyond_near(&self, point: DVec3) -> f64 {
        match &self.shape {
            Shape::Spot { near, .. } | Shape::Cube { near, .. } => self.depth(point) - near,
            Shape::Square { .. } => UNBOUNDED,
        }
    }

    fn before_far(&self, point: DVec3) -> f64 {
        match &self.shape {
            Shape::Spot { far, .. } | Shape::Cube { far, .. } => far - self.depth(point),
            Shape::Square { .. } => UNBOUNDED,
        }
    }
}

/// The distance to an end that a light does not have; finite, so that differences of it are 0.
const UNBOUNDED: f64 = f64::MAX;
