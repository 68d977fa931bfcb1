//! A light as its shadow volumes see it: a place, or a direction. Knows no scene.

use glam::{DMat4, DVec3, DVec4};

/// Position or direction of a light, in the space that the context names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// A point or spot light's position.
    Point(DVec3),
    /// A directional light: the direction *towards* it, of any length above 0.
    Direction(DVec3),
}

impl LightSource {
    /// The same light in another space; `target_from_self` is affine. Exactness begins after this step: the sides of a
    /// triangle's plane are decided exactly for the light that comes out of it.
    pub fn transformed(self, target_from_self: &DMat4) -> Self {
        match self {
            Self::Point(position) => Self::Point(target_from_self.transform_point3(position)),
            Self::Direction(direction) => Self::Direction(target_from_self.transform_vector3(direction)),
        }
    }

    /// Homogeneous: w is 1 for a position and 0 for a direction.
    pub fn homogeneous(self) -> DVec4 {
        match self {
            Self::Point(position) => position.extend(1.0),
            Self::Direction(direction) => direction.extend(0.0),
        }
    }

    /// Vector from the light through `point`, of any length; 0 if the light is at the point.
    pub fn away(self, point: DVec3) -> DVec3 {
        match self {
            Self::Point(position) => point - position,
            Self::Direction(direction) => -direction,
        }
    }

    /// Tests whether all rays are parallel, so that a volume ends in one point at infinity.
    pub fn is_parallel(self) -> bool {
        matches!(self, Self::Direction(_))
    }
}
