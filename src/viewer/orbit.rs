//! Turning and moving about a point. Pure geometry.

use glam::{DMat4, DQuat, DVec2, DVec3};

/// An observer's height above the middle stays below this, so that `up` keeps its meaning.
const STEEPEST_DEGREES: f64 = 89.0;

/// `eye`, turned about `middle`: by `turn.x` about `up`, counter-clockwise from above, and by `turn.y` towards `up`.
pub fn orbit(eye: DVec3, middle: DVec3, up: DVec3, turn: DVec2) -> DVec3 {
    let offset = eye - middle;
    let Some(outwards) = offset.try_normalize() else { return eye };
    let Some(right) = up.cross(outwards).try_normalize() else { return eye };
    let height = up.dot(outwards).clamp(-1.0, 1.0).asin();
    let steepest = STEEPEST_DEGREES.to_radians().max(height.abs());
    let rise = (height + turn.y).clamp(-steepest, steepest) - height;
    let turned = DQuat::from_axis_angle(up, turn.x) * DQuat::from_axis_angle(right, -rise);
    middle + turned * offset
}

/// `eye` at another distance from `middle`: each step takes a tenth of it away, within `[nearest, farthest]`.
pub fn dolly(eye: DVec3, middle: DVec3, steps: f64, [nearest, farthest]: [f64; 2]) -> DVec3 {
    let offset = eye - middle;
    let distance = offset.length();
    // An eye that is already outside the range may stay, and come back.
    let (nearest, farthest) = (nearest.min(distance), farthest.max(distance));
    let wanted = (distance * 0.9_f64.powf(steps)).clamp(nearest, farthest);
    if distance > 0.0 { middle + offset * (wanted / distance) } else { eye }
}

/// Matrix that turns the world about `middle` by `turn.x` about `up` and then by `turn.y` about `right`.
pub fn turn_about(middle: DVec3, up: DVec3, right: DVec3, turn: DVec2) -> DMat4 {
    let turned = DQuat::from_axis_angle(right, turn.y) * DQuat::from_axis_angle(up, turn.x);
    DMat4::from_translation(middle) * DMat4::from_quat(turned) * DMat4::from_translation(-middle)
}

/// Distance from which a picture holds a sphere of `radius`: the planes of its narrower side touch it.
pub fn distance_of_sphere(radius: f64, fov_y_radians: f64, aspect: f64) -> f64 {
    let half = ((0.5 * fov_y_radians).tan() * aspect.min(1.0)).atan();
    radius / half.sin()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use glam::dvec2;

    use super::*;

    #[test]
    fn quarter_turns_lead_to_known_places() {
        let middle = DVec3::new(1.0, 2.0, 3.0);
        let at = |turn| orbit(middle + 2.0 * DVec3::Z, middle, DVec3::Y, turn) - middle;
        assert!(at(dvec2(FRAC_PI_2, 0.0)).abs_diff_eq(2.0 * DVec3::X, 1e-12));
        assert!(at(dvec2(-FRAC_PI_2, 0.0)).abs_diff_eq(-2.0 * DVec3::X, 1e-12));
        let raised = at(dvec2(0.0, FRAC_PI_2 / 3.0));
        assert!(raised.abs_diff_eq(2.0 * DVec3::new(0.0, 0.5, 0.75_f64.sqrt()), 1e-12), "{raised}");
    }

    #[test]
    fn an_orbit_keeps_its_distance_and_stops_short_of_the_pole() {
        let mut eye = DVec3::new(3.0, 1.0, -2.0);
        let distance = eye.length();
        for step in 0..200 {
            eye = orbit(eye, DVec3::ZERO, DVec3::Y, dvec2(0.3, if step < 100 { 0.2 } else { -0.2 }));
            assert!((eye.length() - distance).abs() < 1e-9);
            assert!(eye.y.abs() <= distance * 89.0_f64.to_radians().sin() + 1e-9, "{eye}");
        }
        assert!(eye.y < -0.99 * distance);
    }

    #[test]
    fn steps_in_and_out_end_at_the_ends() {
        let eye = DVec3::new(0.0, 0.0, 10.0);
        let back = dolly(dolly(eye, DVec3::ZERO, 3.0, [1.0, 50.0]), DVec3::ZERO, -3.0, [1.0, 50.0]);
        assert!(back.abs_diff_eq(eye, 1e-12));
        assert_eq!(dolly(eye, DVec3::ZERO, 1000.0, [1.0, 50.0]).z, 1.0);
        assert_eq!(dolly(eye, DVec3::ZERO, -1000.0, [1.0, 50.0]).z, 50.0);
        assert_eq!(dolly(eye, DVec3::ZERO, -1.0, [1.0, 5.0]).z, 10.0);
    }

    #[test]
    fn a_turned_world_keeps_its_middle() {
        let middle = DVec3::new(0.0, 0.7, 1.8);
        let turned = turn_about(middle, DVec3::Y, DVec3::X, dvec2(FRAC_PI_2, 0.0));
        assert!(turned.transform_point3(middle).abs_diff_eq(middle, 1e-12));
        assert!(turned.transform_point3(middle + DVec3::Z).abs_diff_eq(middle + DVec3::X, 1e-12));
    }

    #[test]
    fn a_sphere_fits_by_the_narrower_side() {
        let fov = 30.0_f64.to_radians();
        assert!((distance_of_sphere(2.0, fov, 1.0) - 2.0 / 15.0_f64.to_radians().sin()).abs() < 1e-12);
        assert_eq!(distance_of_sphere(2.0, fov, 2.0), distance_of_sphere(2.0, fov, 1.0));
        assert!(distance_of_sphere(2.0, fov, 0.5) > distance_of_sphere(2.0, fov, 1.0));
    }
}
