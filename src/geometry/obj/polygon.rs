//! Cuts polygons into triangles: a fan if that is right, else by clipping ears.

use glam::{DVec2, DVec3};

/// Larger concave polygons are fanned: cutting ears takes time with their square.
pub(super) const MOST_CORNERS_TO_CLIP: usize = 8192;

/// Cuts the polygon whose corners are `indices` into `positions`; calls `emit` with each triangle, all wound as it is.
///
/// Right for planar simple polygons, concave ones too. Others give some `n - 2` triangles; fewer than three corners give none.
/// False: the polygon is concave and too large to clip, so that it is fanned, and its triangles overlap.
pub(in crate::geometry) fn triangulate(
    indices: &[u32],
    positions: &[[f32; 3]],
    emit: &mut impl FnMut([u32; 3]),
) -> bool {
    if indices.len() < 3 {
        return true;
    }
    if let &[a, b, c] = indices {
        emit([a, b, c]);
        return true;
    }
    let corners: Vec<DVec3> =
        indices.iter().map(|index| glam::Vec3::from_array(positions[*index as usize]).as_dvec3()).collect();
    let flat = flatten(&corners);
    let is_fan_right = is_fan_right(&flat);
    if is_fan_right || flat.len() > MOST_CORNERS_TO_CLIP {
        for k in 2..indices.len() {
            emit([indices[0], indices[k - 1], indices[k]]);
        }
        return is_fan_right;
    }
    clip_ears(&flat, &mut |triangle: [usize; 3]| emit(triangle.map(|k| indices[k])));
    true
}

/// The corners in the plane of their polygon, wound counter-clockwise; scaled to keep products finite.
fn flatten(corners: &[DVec3]) -> Vec<DVec2> {
    let origin = corners[0];
    let scale = corners.iter().map(|corner| (*corner - origin).abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let local: Vec<DVec3> = corners.iter().map(|corner| (*corner - origin) / scale).collect();
    // Newell's sum: twice the polygon's area along each axis.
    let normal: DVec3 = (0..local.len()).map(|k| local[k].cross(local[(k + 1) % local.len()])).sum();
    let Some(normal) = normal.try_normalize() else {
        return vec![DVec2::ZERO; corners.len()];
    };
    let (right, above) = normal.any_orthonormal_pair();
    local.iter().map(|corner| DVec2::new(corner.dot(right), corner.dot(above))).collect()
}

/// Twice the signed area of a triangle.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Tests whether no triangle of the fan about the first corner is turned over.
fn is_fan_right(flat: &[DVec2]) -> bool {
    (2..flat.len()).all(|k| area(flat[0], flat[k - 1], flat[k]) >= -1e-12)
}

/// Cuts off, again and again, the first corner that is an ear; where there is none, any corner.
fn clip_ears(flat: &[DVec2], emit: &mut impl FnMut([usize; 3])) {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut at = 0;
    let mut refused = 0;
    while left.len() > 3 {
        let count = left.len();
        let ear = [left[(at + count - 1) % count], left[at % count], left[(at + 1) % count]];
        if refused < count && !is_ear(ear, &left, flat) {
            refused += 1;
            at = (at + 1) % count;
            continue;
        }
        emit(ear);
        left.remove(at % count);
        refused = 0;
        // The next to be tried is the corner after the ear: going on around makes fewer slivers than a fan.
        at %= left.len();
    }
    emit([left[0], left[1], left[2]]);
}

/// Tests whether the corner in the middle is convex and no other corner lies in its triangle.
fn is_ear(ear: [usize; 3], left: &[usize], flat: &[DVec2]) -> bool {
    let [a, b, c] = ear.map(|k| flat[k]);
    if area(a, b, c) <= 0.0 {
        return false;
    }
    left.iter().filter(|k| !ear.contains(k)).map(|k| flat[*k]).all(|point| {
        let outside = area(a, b, point) < 0.0 || area(b, c, point) < 0.0 || area(c, a, point) < 0.0;
        // A corner at the very place of one of the ear's (a keyhole) does not lie in it.
        outside || point == a || point == b || point == c
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(outline: &[[f32; 2]]) -> Vec<f64> {
        let positions: Vec<[f32; 3]> = outline.iter().map(|[x, y]| [*x, *y, 2.0]).collect();
        let indices: Vec<u32> = (0..positions.len() as u32).collect();
        let mut areas = Vec::new();
        triangulate(&indices, &positions, &mut |triangle| {
            let [a, b, c] = triangle.map(|k| glam::Vec2::from_array(outline[k as usize]).as_dvec2());
            areas.push(0.5 * area(a, b, c));
        });
        areas
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let arrow = [[0.0, 1.0], [-1.0, -1.0], [0.0, 0.0], [1.0, -1.0]];
        let u = [
            [2.0, 2.0],
            [2.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [2.5, 3.0],
            [2.5, 1.0],
            [2.0, 1.0],
        ];
        let comb = [
            [0., 0.],
            [9., 0.],
            [9., 3.],
            [8., 1.],
            [7., 3.],
            [6., 1.],
            [5., 3.],
            [4., 1.],
            [3., 3.],
            [2., 1.],
            [1., 3.],
        ];
        for (outline, expected) in [(&arrow[..], 1.0), (&u[..], 8.0), (&comb[..], 17.5)] {
            for turned in 0..outline.len() {
                let mut outline = outline.to_vec();
                outline.rotate_left(turned);
                let areas = areas(&outline);
                assert_eq!(areas.len(), outline.len() - 2);
                assert!(areas.iter().all(|area| *area >= 0.0), "{outline:?} {areas:?}");
                assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-9, "{outline:?} {areas:?}");
            }
        }
    }

    #[test]
    fn polygons_without_area_and_crossing_ones_still_give_triangles() {
        assert_eq!(areas(&[[0.0, 0.0]; 5]).len(), 3);
        assert_eq!(areas(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).len(), 2);
    }
}
