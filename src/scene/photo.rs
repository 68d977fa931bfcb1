//! Photographs of a scene: which there are, and their pictures [Segal 1992, 3.1].

use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec3;

use super::{LightKind, Object, Photo, Scene};
use crate::geometry::Texture;

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
    let mut known = HashSet::new();
    let photos = objects.iter().filter_map(|object| object.photo.as_ref());
    photos.filter(|photo| known.insert(Arc::as_ptr(photo))).collect()
}
