//! A photograph as surfaces look it up [Segal 1992, 3.1].

use super::guard::{LightPlane, Side};
use super::{Coordinates, Drawable, LightTerm, Viewer};
use crate::scene::{Hidden, Photo};

/// A photograph in the passes that draw surfaces.
#[derive(Clone, Debug)]
pub struct PhotoTerm {
    /// The photograph's camera as a light: its shade is 1 where the photograph shows a point. Its number follows those of
    /// the scene's lights.
    pub term: LightTerm,
    pub hidden: Hidden,
}

/// Tests whether no part of `item` shows its own colour, which light would change.
pub fn covers(photo: &Photo, item: &Drawable, viewer: &Viewer) -> bool {
    match photo.hidden {
        Hidden::Grey => true,
        Hidden::Leave => false,
        Hidden::Smear => {
            let coordinates = photo.projector.frustum().map(Coordinates::of_frustum);
            let plane = LightPlane::of(coordinates.as_ref(), true, viewer);
            plane.is_some_and(|plane| plane.side(item, viewer) == Side::Before)
        }
    }
}
