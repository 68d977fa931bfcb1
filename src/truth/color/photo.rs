//! Photographs on a surface [Segal 1992, 3.1]: the photograph's colour where a ray from the surface meets its eye, by a
//! projection of places and angles.

use std::sync::Arc;

use glam::DVec2;

use super::bounds::Bounds;
use super::lamp::Source;
use super::surface::Shaded;
use crate::scene::{Hidden, Photo, Scene};
use crate::truth::around::Surroundings;
use crate::truth::primary::SeenPoint;
use crate::truth::{Error, Options};

/// Texels of a depth map by which an edge in it may be misplaced: half a texel by the sample, one by a filter, and half for
/// the offset that keeps surfaces from hiding themselves.
const REACH_TEXELS: f64 = 2.0;

/// Share of that reach by which something may rise before the visible surface, at an inner corner, without hiding it: less
/// than the offset forgives.
const RISE: f64 = 0.125;

/// Share of that reach, for a slope of 1, by which the other face of a fold may be nearer to the eye: a polygon offset by the
/// slope forgives no more where a flat face meets a steep one.
const FORGIVEN: f64 = 1.5;

/// Grey of [`Hidden::Grey`].
const GREY: f64 = 128.0 / 255.0;

/// A photograph, with the rays to its eye.
pub(super) struct Photograph<'a> {
    photo: &'a Arc<Photo>,
    source: Source<'a>,
    around: Surroundings<'a>,
    /// Reach of doubt on the plane at distance 1 along its axis; 0: no map, or an exact one.
    reach: f64,
}

/// The photographs of a scene.
pub(super) fn of_scene<'a>(scene: &'a Scene, options: &Options) -> Result<Vec<Photograph<'a>>, Error> {
    let of = |photo: &'a Arc<Photo>| {
        let around = Surroundings::of_light(scene, &photo.projector, options)?;
        let tangents = photo.projector.frustum().map_or(0.0, |frustum| frustum.tangents().max_element());
        let reach = options.photo_map_size.map_or(0.0, |size| REACH_TEXELS * 2.0 * tangents / f64::from(size));
        Ok(Photograph { photo, source: Source::through(&photo.projector, DVec2::ZERO), around, reach })
    };
    scene.photos().into_iter().map(of).collect()
}

impl Photograph<'_> {
    pub fn is(&self, photo: &Arc<Photo>) -> bool {
        Arc::ptr_eq(self.photo, photo)
    }

    /// The surface's colour in the pixel, where its own is `own`.
    pub fn on(&self, seen: &SeenPoint<'_>, [x, y]: [u32; 2], surface: &Shaded<'_>, own: [Bounds; 3]) -> [Bounds; 3] {
        let (shown, hidden) = match self.photo.hidden {
            Hidden::Smear => (self.source.is_ahead(&surface.at), own),
            Hidden::Leave => (self.is_shown(seen, [x, y], surface), own),
            Hidden::Grey => (self.is_shown(seen, [x, y], surface), [Bounds::exactly(GREY); 3]),
        };
        if shown.least == shown.most && shown.value == 0.0 {
            return hidden;
        }
        let color = self.source.photograph(&surface.at);
        [0, 1, 2].map(|k: usize| shown.chosen(color[k], hidden[k]))
    }

    /// 1 where the photograph's eye sees the point within its frame.
    fn is_shown(&self, seen: &SeenPoint<'_>, [x, y]: [u32; 2], surface: &Shaded<'_>) -> Bounds {
        let inside = self.source.reach(&surface.at);
        if inside.most == 0.0 {
            return inside;
        }
        let tracer = &self.around.tracer;
        let shade = super::shade(tracer, seen);
        if self.reach == 0.0 || shade.jumps {
            return inside.times(shade);
        }
        let scale = tracer.lamp.depth_at(seen.position) * self.reach;
        let slope = |slope: f64| scale * (1.0 + slope);
        let doubtful = self.around.around(x, y, self.reach).is_none_or(|around| {
            let thin = |gap: f64, own: f64| gap < slope(own + around.slope);
            let rises = around.rise > RISE * scale;
            let folds = around.nearer.iter().any(|near| near.by > scale * (FORGIVEN * near.slope + RISE));
            // What rises or folds may hide a point that is seen; one that is hidden has a blocker before it.
            let hides = shade.value > 0.5 && (rises || folds);
            around.edge || hides || around.blockers.iter().any(|blocker| thin(blocker.gap, blocker.slope))
        });
        inside.times(if doubtful { Bounds::anything(shade.value) } else { shade })
    }
}
