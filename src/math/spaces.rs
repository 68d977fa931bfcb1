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
