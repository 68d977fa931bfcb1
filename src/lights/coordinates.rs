//! Texture coordinates of a light's map.

use glam::DMat4;

use crate::math::texgen::{SetUp, Spaces, Split, scale_bias};
use crate::scene::Frustum;

/// Eye-linear texture coordinates: the matrices that they are made of, and the space that the planes are specified in.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// `S`: texture space from the light's clip space.
    pub texture_from_light_clip: DMat4,
    /// Movement of receivers before that, in the light's clip space, so that they do not shade themselves.
    pub receiver_bias: DMat4,
    /// `P_light`, of whatever the technique draws from the light.
    pub light_clip_from_light: DMat4,
    /// `L⁻¹`.
    pub light_from_world: DMat4,
    pub set_up: SetUp,
    pub split: Split,
}

impl Coordinates {
    /// Coordinates of a frustum [HSM, Appendix A]: (s/q, t/q, r/q) in [0, 1] inside it.
    pub fn of_frustum(frustum: &Frustum) -> Self {
        Self {
            texture_from_light_clip: scale_bias(0.5, 0.5),
            receiver_bias: DMat4::IDENTITY,
            light_clip_from_light: frustum.clip_from_view(),
            light_from_world: frustum.view_from_world(),
            set_up: SetUp::World,
            split: Split::Planes,
        }
    }

    /// Matrices for texture coordinate generation, for an eye.
    pub fn spaces(&self, eye_from_world: DMat4) -> Spaces {
        Spaces {
            texture_from_light_clip: self.texture_from_light_clip * self.receiver_bias,
            light_clip_from_light: self.light_clip_from_light,
            light_from_world: self.light_from_world,
            eye_from_world,
        }
    }
}
