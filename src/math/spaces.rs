//! The matrices between spaces.

use glam::{DMat4, DVec3, DVec4};

/// `view_from_world` of an observer at `eye` looking at `target`, x right, y up, -z ahead (gluLookAt).
///
/// `eye` and `target` differ and `up` is not parallel to the view direction.
pub fn view_from_world(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    let back = (eye - target).normalize();
    let right = up.cross(back).normalize();
    let above = back.cross(right);
    DMat4::from_cols(
        DVec4::new(right.x, above.x, back.x, 0.0),
        DVec4::new(right.y, above.y, back.y, 0.0),
        DVec4::new(right.z, above.z, back.z, 0.0),
        DVec4::new(-right.dot(eye), -above.dot(eye), -back.dot(eye), 1.0),
    )
}

/// `clip_from_view` of a symmetric perspective (gluPerspective); `aspect` is width over height.
pub fn perspective(fov_y_radians: f64, aspect: f64, near: f64, far: f64) -> DMat4 {
    let f = 1.0 / (0.5 * fov_y_radians).tan();
    let depth = near - far;
    DMat4::from_cols(
        DVec4::new(f / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, f, 0.0, 0.0),
        DVec4::new(0.0, 0.0, (far + near) / depth, -1.0),
        DVec4::new(0.0, 0.0, 2.0 * far * near / depth, 0.0),
    )
}

/// `clip_from_view` of the same perspective with its far plane at infinity: points with w = 0 ahead of the eye land on
/// depth 1 exactly and are never clipped by it [Everitt and Kilgard 2002]. Its x, y and w rows are those of [`perspective`] to the
/// bit.
pub fn infinite_perspective(fov_y_radians: f64, aspect: f64, near: f64) -> DMat4 {
    let f = 1.0 / (0.5 * fov_y_radians).tan();
    DMat4::from_cols(
        DVec4::new(f / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, f, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1.0, -1.0),
        DVec4::new(0.0, 0.0, -2.0 * near, 0.0),
    )
}

/// `clip_from_view` of a parallel projection (glOrtho) of the box from `min` to `max`, whose depth runs from max.z, before
/// the viewer, to min.z.
pub fn orthographic(min: DVec3, max: DVec3) -> DMat4 {
    let size = max - min;
    let middle = -(max + min) / size;
    DMat4::from_cols(
        DVec4::new(2.0 / size.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / size.y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -2.0 / size.z, 0.0),
        DVec4::new(middle.x, middle.y, -middle.z, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_infinite_perspective_is_the_finite_ones_limit() {
        let (finite, infinite) = (perspective(0.9, 1.5, 0.1, 1e12), infinite_perspective(0.9, 1.5, 0.1));
        assert!(finite.abs_diff_eq(infinite, 1e-12));
        for row in [0, 1, 3] {
            assert_eq!(finite.row(row), infinite.row(row));
        }
        let far = infinite * DVec4::new(0.3, -0.2, -1.0, 0.0);
        assert_eq!(far.z, far.w);
        assert_eq!((infinite * DVec4::new(0.0, 0.0, -0.1, 1.0)).z, -0.1);
    }
}
