//! Projections that maps are drawn from: the frustum of a spotlight, a face of the cube around a point light, the box
//! across a directional light's rays. Matrices alone; knows no settings and no pass.

use glam::{DMat4, DVec2, DVec3};

use super::Crop;
use crate::pass::CubeFace;
use crate::scene::{Frustum, Point};

/// One map's view of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Projector {
    /// `P_light`; its x and y axes stand alone, z is (linear in) the depth along the light.
    pub clip_from_light: DMat4,
    /// `L⁻¹`; the light looks along -z.
    pub light_from_world: DMat4,
    pub rays: Rays,
    /// The part of its square that the map covers.
    pub crop: Crop,
}

/// Position or direction of the light's rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rays {
    /// Rays from a point; depth begins at `near`, along the map's axis.
    From { position: DVec3, near: f64 },
    /// Parallel rays, with the direction in which they travel, of unit length.
    Along(DVec3),
}

impl Projector {
    pub fn of_frustum(frustum: &Frustum) -> Self {
        Self {
            clip_from_light: frustum.clip_from_view(),
            light_from_world: frustum.view_from_world(),
            rays: Rays::From { position: frustum.position, near: frustum.near },
            crop: Crop::WHOLE,
        }
    }

    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_light * self.light_from_world
    }

    /// The size of what the whole map shows at `distance` along its axis, along the longer of its sides.
    pub fn extent(&self, distance: f64) -> f64 {
        let scale = self.clip_from_light.x_axis.x.min(self.clip_from_light.y_axis.y);
        match self.rays {
            Rays::From { .. } => 2.0 * distance / scale,
            Rays::Along(_) => 2.0 / scale,
        }
    }
}

/// The frustum of a face of the cube around a point light, turned as cube maps have their texels [GL 4.6, table 8.19].
pub fn face_frustum(point: &Point, face: CubeFace) -> Frustum {
    let (direction, up) = match face {
        CubeFace::PositiveX => (DVec3::X, -DVec3::Y),
        CubeFace::NegativeX => (-DVec3::X, -DVec3::Y),
        CubeFace::PositiveY => (DVec3::Y, DVec3::Z),
        CubeFace::NegativeY => (-DVec3::Y, -DVec3::Z),
        CubeFace::PositiveZ => (DVec3::Z, -DVec3::Y),
        CubeFace::NegativeZ => (-DVec3::Z, -DVec3::Y),
    };
    let Point { position, near, far, .. } = *point;
    // A target so far away that its coordinates may round, but stay on the axis.
    let target = position + direction * position.abs().max_element().max(1.0);
    Frustum {
        position,
        target,
        up,
        cone_radians: std::f64::consts::FRAC_PI_2,
        aspect: 1.0,
        near,
        far,
        lean: DVec2::ZERO,
    }
}
