//! A photograph that is projected back onto what it shows [Segal 1992, 3.1].

use std::sync::Arc;

use glam::DVec3;

use super::{Light, LightKind, Object, Scene};
use crate::geometry::Texture;

/// A photograph of objects, and the camera that took it.
#[derive(Clone, Debug)]
pub struct Photo {
    /// The camera as a spotlight that projects the photograph back: its frustum is the camera's, its image the photograph,
    /// its shadow settings those of the depth map that tells what the camera saw. It lights nothing.
    pub projector: Light,
    /// Content of points that the photograph does not show.
    pub hidden: Hidden,
}

/// Content of points that a photograph does not show: beyond its frame, behind its eye, or hidden from its eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// The photograph all the same, without a test of depth: what lies behind something shows its colours. Beyond the frame
    /// those of the frame's edge; behind the eye the material's own colour, lit.
    Smear,
    /// Grey, 128 of 255.
    Grey,
    /// The material's own colour, lit.
    Leave,
}

impl Photo {
    /// The photograph's texels.
    pub fn image(&self) -> Option<&Arc<Texture>> {
        self.projector.spot()?.image.as_ref()
    }

    /// The same photograph, taken from a place moved by `by`.
    pub(super) fn moved(&self, by: DVec3) -> Self {
        let mut moved = self.clone();
        if let LightKind::Spot(spot) = &mut moved.projector.kind {
            spot.frustum.position += by;
            spot.frustum.target += by;
        }
        moved
    }
}

impl Scene {
    /// The photographs of all objects, each once, in the order of the objects.
    pub fn photos(&self) -> Vec<&Arc<Photo>> {
        photos_of(&self.objects)
    }
}

/// The photographs of `objects`, each once, in their order.
pub fn photos_of(objects: &[Object]) -> Vec<&Arc<Photo>> {
    let mut found: Vec<&Arc<Photo>> = Vec::new();
    for photo in objects.iter().filter_map(|object| object.photo.as_ref()) {
        if !found.iter().any(|known| Arc::ptr_eq(known, photo)) {
            found.push(photo);
        }
    }
    found
}
