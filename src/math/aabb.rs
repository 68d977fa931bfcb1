//! Axis-aligned boxes.

use glam::{DMat4, DVec3};

use crate::process::work;

/// An axis-aligned box; empty when any `min` component exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    pub min: DVec3,
    pub max: DVec3,
}

impl Aabb {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box that contains everything.
    pub const EVERYTHING: Self = Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The axis along which it has no extent; `None` where it has some along each.
    pub fn flat_axis(&self) -> Option<DVec3> {
        DVec3::AXES.into_iter().find(|axis| axis.dot(self.max - self.min) == 0.0)
    }

    /// The smallest box around `points`.
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::including)
    }

    pub fn including(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Half the length of the diagonal.
    pub fn radius(&self) -> f64 {
        0.5 * (self.max - self.min).length()
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        work::count_box();
        std::array::from_fn(|i| {
            DVec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }

    /// The box around this box's corners mapped by an affine `target_from_self`.
    pub fn transformed(&self, target_from_self: &DMat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::from_points(self.corners().map(|corner| target_from_self.transform_point3(corner)))
    }
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}
