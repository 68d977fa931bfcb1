//! The part of a light's frustum that its map covers.

use glam::{DMat4, DVec2, Vec4};

/// A rectangle of a light's normalised device coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    pub min: DVec2,
    pub max: DVec2,
}

impl Crop {
    pub const WHOLE: Self = Self { min: DVec2::NEG_ONE, max: DVec2::ONE };
    pub const NOTHING: Self = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };

    pub fn center(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    /// Converts the map's normalised device coordinates to the light's.
    pub fn light_clip(&self, map: DVec2) -> DVec2 {
        self.center() + self.half() * map
    }

    /// Half its size; (1, 1) for the whole.
    pub fn half(&self) -> DVec2 {
        0.5 * (self.max - self.min)
    }

    pub fn with(self, point: DVec2) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    pub fn within(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    pub fn is_empty(&self) -> bool {
        self.min.cmpge(self.max).any()
    }

    /// Matrix from the light's clip space to the map's.
    pub fn map_clip_from_light_clip(&self) -> DMat4 {
        DMat4::from_scale(self.half().recip().extend(1.0)) * DMat4::from_translation(-self.center().extend(0.0))
    }

    /// Scale and offset from (s, t) over the cropped square to (s, t) over the frustum's.
    pub fn frustum_from_map(&self) -> Vec4 {
        let (scale, offset) = (self.half(), 0.5 + 0.5 * self.min);
        Vec4::new(scale.x as f32, scale.y as f32, offset.x as f32, offset.y as f32)
    }
}
