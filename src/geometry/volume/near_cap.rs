//! Volumes closed at the camera's near plane, for z-pass whatever the eye's place [GDC 2001, near clip plane capping;
//! C7]. In view space: there, points of the near plane keep all their digits however small near is.

use std::ops::Range;

use glam::DMat4;

use super::{Caster, Outline};

/// How an outline's vertices land on the near plane when projected away from the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Landing {
    /// None of them, nor any piece between them: nothing to cap.
    #[default]
    None,
    /// All: the "easy" case.
    All,
    /// Some: the "hard" case.
    Some,
}

/// The part of an infinite shadow volume beyond the near plane: sides and near cap (no light cap and no far cap: z-pass
/// never counts them). Buffers are kept from one cut to the next.
///
/// View space. Triangles run counter-clockwise seen from outside the volume *in view space*, for mirroring transforms
/// too: the caller draws them by `clip_from_view` alone and never turns the front face. Near-cap triangles lie at
/// z = -near exactly and always face the eye.
#[derive(Clone, Debug, Default)]
pub struct CappedVolume {
    vertices: Vec<[f32; 4]>,
    indices: Vec<u32>,
    sides: Range<u32>,
    near_cap: Range<u32>,
    landing: Landing,
}

impl CappedVolume {
    /// View space; w is 1 or 0.
    pub fn vertices(&self) -> &[[f32; 4]] {
        &self.vertices
    }

    /// Three a triangle, into [`CappedVolume::vertices`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Of [`CappedVolume::indices`]; cut off at the near plane.
    pub fn sides(&self) -> Range<u32> {
        self.sides.clone()
    }

    /// What of the near plane lies in shadow; see [`crate::math::ledge`] for how to draw it.
    pub fn near_cap(&self) -> Range<u32> {
        self.near_cap.clone()
    }

    pub fn landing(&self) -> Landing {
        self.landing
    }

    /// Fills the buffers with the volume of `outline`, which was found for `caster`, cut at z = -`near` of view space.
    pub fn cut(&mut self, caster: &Caster, outline: &Outline, view_from_model: &DMat4, near: f64) {
        let _ = (caster, outline, view_from_model, near);
    }
}
