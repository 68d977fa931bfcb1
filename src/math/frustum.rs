//! Tests of which boxes a clip volume can show: conservative, in f64, by homogeneous corners.

use glam::{DMat4, DVec3, DVec4};

use super::Aabb;

/// Overlap of a box and a clip volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// All corners are beyond one clip plane: nothing of the box can be drawn.
    Outside,
    /// Some of it may be inside.
    Partial,
    /// All of it is inside.
    Inside,
}

/// Tests a box against the clip volume `-w <= x, y, z <= w` (GL 4.6, 13.7). Never calls a visible box `Outside`; a box past
/// a frustum's corner may be called `Partial`. The slack of 2⁻²⁰ covers the driver's f32 transforms.
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
        false if beyond_a_face(&volume_of(clip_from_box), bounds) => Overlap::Outside,
        false => Overlap::Partial,
    }
}

/// Tests whether something of the box may be drawn under GL_DEPTH_CLAMP, where no near and no far plane clips.
pub fn may_show_clamped(clip_from_box: &DMat4, bounds: &Aabb) -> bool {
    if bounds.is_empty() {
        return false;
    }
    if *bounds == Aabb::EVERYTHING {
        return true;
    }
    let corners = bounds.corners().map(|corner| *clip_from_box * corner.extend(1.0));
    // Only w shows what lies where the sides meet, or behind that [GL 4.6, 13.7].
    corners.iter().any(|corner| corner.w >= -slack(corner))
        && (0..4).all(|plane| corners.iter().any(|corner| signed_distance(corner, plane) >= -slack(corner)))
}

/// Tests whether something of the box may lie within the sides of a perspective volume before its near plane: what
/// GL_DEPTH_CLAMP draws at the near plane's depth, and clipping would leave out.
pub fn may_be_before_near(clip_from_box: &DMat4, bounds: &Aabb) -> bool {
    let before = |corner: DVec3| {
        let clip = *clip_from_box * corner.extend(1.0);
        clip.z + clip.w < slack(&clip)
    };
    if !may_show_clamped(clip_from_box, bounds) || !bounds.corners().into_iter().any(before) {
        return false;
    }
    // The tip of the pyramid, where x, y and w are 0, and the square that the near plane cuts it off by.
    let box_from_clip = clip_from_box.inverse();
    let tip = box_from_clip.z_axis.truncate() / box_from_clip.z_axis.w;
    !beyond_a_face(&Aabb::from_points(corners(&box_from_clip).into_iter().take(4).chain([tip])), bounds)
}

/// The box, in the box's space, around the whole clip volume.
fn volume_of(clip_from_box: &DMat4) -> Aabb {
    Aabb::from_points(corners(&clip_from_box.inverse()))
}

/// Tests whether all of a clip volume, of which `volume` is the box in the box's own space, lies beyond one face of the box:
/// what the clip planes alone do not see of large boxes.
fn beyond_a_face(volume: &Aabb, bounds: &Aabb) -> bool {
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

/// The clip volume's planes in world space, their normals inwards and of unit length: `dot(plane, (x, y, z, 1)) >= 0`
/// inside. Left, right, bottom, top, near, far.
pub fn planes(clip_from_world: &DMat4) -> [DVec4; 6] {
    let rows = clip_from_world.transpose();
    let (x, y, z, w) = (rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis);
    [w + x, w - x, w + y, w - y, w + z, w - z].map(|plane| plane / plane.truncate().length())
}

/// The faces of a box, or of what a box is projected to, by its corners as [`Aabb::corners`] numbers them.
pub fn faces(corners: &[DVec3; 8]) -> [[DVec3; 4]; 6] {
    [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]]
        .map(|face| face.map(|corner| corners[corner]))
}

/// Part of a convex polygon on the inner side of `plane` [Sutherland and Hodgman 1974].
pub fn clip_polygon(polygon: &[DVec3], plane: &DVec4) -> Vec<DVec3> {
    let distance = |point: DVec3| plane.dot(point.extend(1.0));
    let mut clipped = Vec::with_capacity(polygon.len() + 1);
    for (index, &point) in polygon.iter().enumerate() {
        let next = polygon[(index + 1) % polygon.len()];
        let (here, there) = (distance(point), distance(next));
        if here >= 0.0 {
            clipped.push(point);
        }
        if (here >= 0.0) != (there >= 0.0) {
            clipped.push(point.lerp(next, here / (here - there)));
        }
    }
    clipped
}

/// Tests whether two convex volumes, each given by its `clip_from_world` and world-space corners, may meet: false only where
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
    fn a_square_is_clipped_at_a_corner() {
        let square = faces(&Aabb { min: DVec3::ZERO, max: DVec3::ONE }.corners())[4];
        let clipped = clip_polygon(&square, &DVec4::new(-1.0, -1.0, 0.0, 1.5));
        assert_eq!(clipped.len(), 5);
        assert!(clipped.iter().all(|p| p.x + p.y <= 1.5 + 1e-12 && p.min_element() >= 0.0 && p.max_element() <= 1.0));
        assert!(clip_polygon(&square, &DVec4::new(1.0, 0.0, 0.0, -2.0)).is_empty());
        for face in faces(&Aabb { min: DVec3::ZERO, max: DVec3::ONE }.corners()) {
            let normal = (face[1] - face[0]).cross(face[3] - face[0]);
            assert!(normal.length() == 1.0 && (face[2] - face[0]).dot(normal) == 0.0, "{face:?}");
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
