//! Tests of which part of a volume a camera may see, and whether the eye may be in it: conservative, from bounding boxes in
//! f64. The answer is never no where the exact answer is yes. World space. Knows no scene.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::LightSource;
use crate::math::{Aabb, frustum, hull};
use hull::Hull;

/// Convex hulls of a camera's near rectangle, of its frustum and of its rays.
#[derive(Clone, Debug)]
pub struct CameraHulls {
    near: Hull,
    frustum: Hull,
    rays: Hull,
}

impl CameraHulls {
    /// `clip_from_world` is invertible and has a finite far plane, beyond which nothing is visible.
    pub fn new(clip_from_world: &DMat4) -> Self {
        let corners = frustum::corners(&clip_from_world.inverse());
        let [near, far] = [[0, 1, 3, 2].map(|k| corners[k]), [4, 5, 7, 6].map(|k| corners[k])];
        let rays = [0, 1, 2, 3].map(|k| far[k] - near[k]);
        Self { near: Hull::polygon(&near), frustum: Hull::frustum(&near, &far), rays: Hull::cone(&rays) }
    }
}

/// Convex hulls of a caster's box, of its shadow volume and of the volume's far end.
#[derive(Clone, Debug)]
pub struct VolumeHulls {
    body: Hull,
    volume: Hull,
    far_end: Hull,
}

impl VolumeHulls {
    /// `bounds` in model space; `source` in world space.
    pub fn new(bounds: &Aabb, world_from_model: &DMat4, source: LightSource) -> Self {
        let body = Hull::parallelepiped(bounds, world_from_model);
        let away: Vec<DVec3> = match source {
            // Inside or all but touching: which way the shadow falls is left to rounding.
            LightSource::Point(_) if touches(bounds, source.transformed(&world_from_model.inverse())) => {
                [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]).collect()
            }
            LightSource::Point(_) => body.points.iter().map(|corner| source.away(*corner)).collect(),
            LightSource::Direction(direction) => vec![-direction],
        };
        Self { volume: body.swept(&away), far_end: Hull::cone(&away), body }
    }

    /// Tests whether the volume may hold a point of the camera's near rectangle: whether the caster may meet the pyramid that
    /// the light spans with it. If not, plain z-pass counts right.
    pub fn may_hold_near(&self, viewer: &CameraHulls) -> bool {
        !hull::are_apart(&self.volume, &viewer.near)
    }

    /// Tests whether the volume may meet the view frustum; if not, it is of no use to the picture.
    pub fn may_shadow_view(&self, viewer: &CameraHulls) -> bool {
        !hull::are_apart(&self.volume, &viewer.frustum)
    }

    /// Tests whether the caster itself may be in view, and with it the volume's cap at the light's end.
    pub fn light_cap_may_be_seen(&self, viewer: &CameraHulls) -> bool {
        !hull::are_apart(&self.body, &viewer.frustum)
    }

    /// Tests whether the camera may look at the volume's far end at infinity.
    pub fn far_cap_may_be_seen(&self, viewer: &CameraHulls) -> bool {
        !hull::are_apart(&self.far_end, &viewer.rays)
    }

    /// Tests whether the caster may stand between the light and something it lights: `reach` is convex and holds the light
    /// and all that it lights.
    pub fn may_matter_within(&self, reach: &Hull) -> bool {
        !hull::are_apart(&self.body, reach)
    }
}

/// Tests whether a light is in the box, or within the error of f32 transforms of it.
fn touches(bounds: &Aabb, source: LightSource) -> bool {
    let LightSource::Point(light) = source else { return false };
    let size = light.abs().max(bounds.min.abs()).max(bounds.max.abs()).max_element();
    let slack = DVec3::splat(size / f64::from(1 << 20));
    light.cmpge(bounds.min - slack).all() && light.cmple(bounds.max + slack).all()
}

/// The pixels that the convex hull of `points` (world space) may cover: `[x, y, width, height]` as for glScissor, y up, in
/// a picture of `size` pixels. `None`: no pixel. It is one pixel wider than exact arithmetic gives.
pub fn scissor(points: &[DVec3], clip_from_world: &DMat4, size: [u32; 2]) -> Option<[u32; 4]> {
    let clip: Vec<DVec4> = points.iter().map(|point| *clip_from_world * point.extend(1.0)).collect();
    let ahead = |point: &DVec4| point.z + point.w;
    // Corners ahead of the near plane, and where the ways between corners cross it.
    let mut kept: Vec<DVec4> = clip.iter().copied().filter(|point| ahead(point) >= 0.0).collect();
    for a in clip.iter().filter(|point| ahead(point) >= 0.0) {
        for b in clip.iter().filter(|point| ahead(point) < 0.0) {
            kept.push(a.lerp(*b, ahead(a) / (ahead(a) - ahead(b))));
        }
    }
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for point in kept.iter().filter(|point| point.w > 0.0) {
        let pixel = (0.5 * point.truncate().truncate() / point.w + 0.5) * DVec2::new(size[0].into(), size[1].into());
        (low, high) = (low.min(pixel), high.max(pixel));
    }
    let sides = [0, 1].map(|axis| {
        let limit = f64::from(size[axis]);
        let (start, end) = ((low[axis] - 1.0).floor().clamp(0.0, limit), (high[axis] + 1.0).ceil().clamp(0.0, limit));
        // An infinite `low` is above an infinite `high`: nothing was kept.
        (start < end).then_some((start as u32, (end - start) as u32))
    });
    let [Some((x, width)), Some((y, height))] = sides else { return None };
    Some([x, y, width, height])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::{perspective, view_from_world};

    fn camera(eye: DVec3, target: DVec3) -> DMat4 {
        perspective(0.9, 1.5, 0.1, 40.0) * view_from_world(eye, target, DVec3::Y)
    }

    fn cube() -> Aabb {
        Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE }
    }

    #[test]
    fn known_places_of_box_light_and_eye() {
        let above = LightSource::Point(DVec3::Y * 5.0);
        let sun = LightSource::Direction(DVec3::Y * 5.0);
        let side = camera(DVec3::new(8.0, 0.0, 0.0), DVec3::ZERO);
        let below = camera(DVec3::new(0.0, -3.0, 0.01), DVec3::new(0.0, -9.0, 0.0));
        let aside = camera(DVec3::new(8.0, 0.0, 0.0), DVec3::new(16.0, 3.0, 0.0));
        let at_sky = camera(DVec3::new(8.0, 2.0, 0.0), DVec3::new(6.0, 12.0, 0.0));
        // Near, view, light cap, far cap.
        for (case, source, clip, expected) in [
            ("beside", above, side, [false, true, true, false]),
            ("beside, sun", sun, side, [false, true, true, false]),
            ("below", above, below, [true, true, false, true]),
            ("below, sun", sun, below, [true, true, false, true]),
            ("looking away", above, aside, [false, false, false, false]),
            ("at the sky", sun, at_sky, [false, false, false, false]),
        ] {
            let (viewer, casting) = (CameraHulls::new(&clip), VolumeHulls::new(&cube(), &DMat4::IDENTITY, source));
            let found = [
                casting.may_hold_near(&viewer),
                casting.may_shadow_view(&viewer),
                casting.light_cap_may_be_seen(&viewer),
                casting.far_cap_may_be_seen(&viewer),
            ];
            assert_eq!(found, expected, "{case}");
        }
    }

    #[test]
    fn a_light_that_touches_may_shadow_everything() {
        let viewer = CameraHulls::new(&camera(DVec3::new(0.0, 3.0, 0.01), DVec3::new(0.0, 9.0, 0.0)));
        for (y, expected) in [(1.0 + 1e-7, true), (1.0 - 1e-7, true), (1.001, false)] {
            let light = LightSource::Point(DVec3::new(0.2, y, 0.3));
            let casting = VolumeHulls::new(&cube(), &DMat4::IDENTITY, light);
            assert_eq!(casting.far_cap_may_be_seen(&viewer), expected, "{y}");
            assert_eq!(casting.may_shadow_view(&viewer), expected, "{y}");
        }
    }

    #[test]
    fn scissors_hold_what_they_are_made_for_and_little_more() {
        let clip = camera(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
        let [x, y, width, height] = scissor(&cube().corners(), &clip, [300, 200]).unwrap();
        // The near face, half 1 at distance 4: 1 / (4 tan 0.45) of half the height of 200.
        let half = 100.0 / (4.0 * 0.45f64.tan());
        let expected = [150.0 - half - 1.0, 100.0 - half - 1.0].map(|v: f64| v.floor() as u32);
        assert_eq!([x, y], expected);
        assert_eq!([width, height], [300 - 2 * x, 200 - 2 * y]);
        assert_eq!(scissor(&[DVec3::Z * 9.0, DVec3::Z * 8.0], &clip, [300, 200]), None);
        // Around the eye: everything.
        let around = Aabb { min: DVec3::splat(-50.0), max: DVec3::splat(50.0) };
        assert_eq!(scissor(&around.corners(), &clip, [300, 200]), Some([0, 0, 300, 200]));
    }
}
