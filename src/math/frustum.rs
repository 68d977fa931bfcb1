//! Which boxes a clip volume can show: conservative tests, in f64, of homogeneous corners.

use glam::{DMat4, DVec3, DVec4};

use super::Aabb;

/// What of a box lies in a clip volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// All corners are beyond one clip plane: nothing of the box can be drawn.
    Outside,
    /// Some of it may be inside.
    Partial,
    /// All of it is inside.
    Inside,
}

/// Holds a box against the clip volume `-w <= x, y, z <= w` (GL 4.6, 13.7). Never calls a visible box `Outside`; a box
/// past a frustum's corner may be called `Partial`. The slack of 2⁻²⁰ covers the driver's f32 transforms.
pub fn overlap(clip_from_box: &DMat4, bounds: &Aabb) -> Overlap {
    if bounds.is_empty() {
        return Overlap::Outside;
    }
    if *bounds == Aabb::EVERYTHING {
        return Overlap::Partial;
    }
    let corners = bounds.corners().map(|corner| *clip_from_box * corner.extend(1.0));
    let mut inside = true;
    for plane in 0..6 {
        let within = corners.iter().filter(|corner| signed_distance(corner, plane) >= -slack(corner)).count();
        if within == 0 {
            return Overlap::Outside;
        }
        inside &= within == 8;
    }
    match inside {
        true => Overlap::Inside,
        false if beyond_a_face(clip_from_box, bounds) => Overlap::Outside,
        false => Overlap::Partial,
    }
}

/// Whether the whole clip volume lies beyond one face of the box: what the clip planes alone do not see of large boxes.
fn beyond_a_face(clip_from_box: &DMat4, bounds: &Aabb) -> bool {
    let box_from_clip = clip_from_box.inverse();
    let volume = Aabb::from_points(corners(&box_from_clip));
    if !(volume.min.is_finite() && volume.max.is_finite()) {
        return false;
    }
    let slack = DVec3::splat(2.0_f64.powi(-20) * (volume.radius() + bounds.radius()));
    (volume.min - slack).cmpgt(bounds.max).any() || (volume.max + slack).cmplt(bounds.min).any()
}

/// The distance of a clip-space point from plane `index` (left, right, bottom, top, near, far), positive inside.
fn signed_distance(clip: &DVec4, index: usize) -> f64 {
    let value = clip[index / 2];
    if index.is_multiple_of(2) { clip.w + value } else { clip.w - value }
}

fn slack(clip: &DVec4) -> f64 {
    2.0_f64.powi(-20) * clip.abs().max_element()
}

/// The eight corners of the clip volume in world space; the near corners first.
pub fn corners(world_from_clip: &DMat4) -> [DVec3; 8] {
    let cube = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };
    cube.corners().map(|corner| world_from_clip.project_point3(corner))
}

/// Whether two convex volumes, each given by its `clip_from_world` and world-space corners, may meet: false only where
/// a clip plane of one has all corners of the other beyond it.
pub fn may_meet(a_clip: &DMat4, a_corners: &[DVec3; 8], b_clip: &DMat4, b_corners: &[DVec3; 8]) -> bool {
    let beyond = |clip: &DMat4, corners: &[DVec3; 8]| {
        (0..6).any(|plane| {
            corners.iter().all(|corner| {
                let c = *clip * corner.extend(1.0);
                signed_distance(&c, plane) < -slack(&c)
            })
        })
    };
    !beyond(a_clip, b_corners) && !beyond(b_clip, a_corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::{perspective, view_from_world};

    fn camera() -> DMat4 {
        perspective(90.0_f64.to_radians(), 1.0, 1.0, 10.0) * view_from_world(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y)
    }

    fn cube_at(center: DVec3, half: f64) -> Aabb {
        Aabb { min: center - half, max: center + half }
    }

    #[test]
    fn boxes_before_behind_and_across_the_planes() {
        let clip = camera();
        for (center, half, expected) in [
            (DVec3::new(0.0, 0.0, -5.0), 1.0, Overlap::Inside),
            (DVec3::new(0.0, 0.0, 5.0), 1.0, Overlap::Outside),
            (DVec3::new(0.0, 0.0, -1.0), 0.5, Overlap::Partial),
            (DVec3::new(0.0, 0.0, -12.0), 1.0, Overlap::Outside),
            (DVec3::new(20.0, 0.0, -5.0), 1.0, Overlap::Outside),
            (DVec3::new(5.0, 0.0, -5.0), 1.0, Overlap::Partial),
            (DVec3::ZERO, 100.0, Overlap::Partial),
            // Large, and past an edge of the frustum: no clip plane has all of its corners beyond.
            (DVec3::new(0.0, -111.0, 0.0), 100.0, Overlap::Outside),
        ] {
            assert_eq!(overlap(&clip, &cube_at(center, half)), expected, "{center} {half}");
        }
    }

    #[test]
    fn a_touching_box_is_never_outside() {
        assert_ne!(overlap(&camera(), &cube_at(DVec3::new(0.0, 0.0, -11.0), 1.0)), Overlap::Outside);
    }

    #[test]
    fn frusta_that_look_away_from_each_other_do_not_meet() {
        let ahead = camera();
        let other = perspective(1.0, 1.0, 1.0, 10.0) * view_from_world(DVec3::Z, 2.0 * DVec3::Z, DVec3::Y);
        let (a, b) = (corners(&ahead.inverse()), corners(&other.inverse()));
        assert!(!may_meet(&ahead, &a, &other, &b));
        assert!(may_meet(&ahead, &a, &ahead, &a));
    }
}
