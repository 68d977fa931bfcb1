//! The ledge [GDC, "Building a "Ledge" at the Front of the Depth Buffer"]: a piece of the depth range in front of the
//! scene's own, in which caps at the near plane are drawn and never clipped.
//!
//! The scene is drawn with depth range [n, f] and projection (N, F), volumes with [n', f] and (N', F), n' < n. Window
//! depth falls with 1/z and both reach f at F, so the two agree everywhere if they agree at one more place:
//! N' = (f - n) N F / ((n' - n) N + (f - n') F). (The slide prints another sign in the denominator; for n' = n it does
//! not give N.)

use glam::DMat4;

use super::spaces::perspective;

/// Depth codes that are kept free between the caps and the scene: fixed-point conversion may miss by one code on either
/// side, and a window transform in f32 by one more.
pub const GUARD_CODES: u32 = 4;

/// Computes N' for which depths of the volumes are comparable with those of the scene. `0 <= n' <= n < f <= 1`, `0 < near <
/// far`.
pub fn volume_near(near: f64, far: f64, scene_depth_near: f64, volume_depth_near: f64, depth_far: f64) -> f64 {
    let (n, n_volume, f) = (scene_depth_near, volume_depth_near, depth_far);
    (f - n) * near * far / ((n_volume - n) * near + (f - n_volume) * far)
}

/// Depth ranges and projections of scene and volumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledge {
    /// Near and far of glDepthRange for the scene: (n, f).
    pub scene_range: [f64; 2],
    /// Depth range of a volume's sides: (n', f).
    pub volume_range: [f64; 2],
    /// Depth range of caps on the near plane: (n', n'), so that each lies exactly at n', whatever its z.
    pub cap_range: [f64; 2],
    /// N'.
    pub volume_near: f64,
    /// `clip_from_view` of sides and caps; its x and y rows are those of the scene's projection to the bit.
    pub volume_clip_from_view: DMat4,
}

impl Ledge {
    /// The thinnest ledge that keeps [`GUARD_CODES`] between caps and scene, for a depth buffer of `depth_bits` bits
    /// (1..=32; the significand's 24 for floats) and the camera's projection. The ledge begins at depth 0.
    pub fn new(fov_y_radians: f64, aspect: f64, near: f64, far: f64, depth_bits: u32) -> Self {
        let codes = f64::from(depth_bits.clamp(1, 32)).exp2() - 1.0;
        // One code more than requested: n itself is rounded to one.
        let scene_near = (f64::from(GUARD_CODES + 1) / codes).min(0.5);
        Self::with_ranges(fov_y_radians, aspect, near, far, [0.0, scene_near, 1.0])
    }

    /// A ledge with the ranges `[n', n, f]`.
    pub fn with_ranges(fov_y_radians: f64, aspect: f64, near: f64, far: f64, ranges: [f64; 3]) -> Self {
        let [volume_depth, scene_depth, depth_far] = ranges;
        let volume_near = volume_near(near, far, scene_depth, volume_depth, depth_far);
        Self {
            scene_range: [scene_depth, depth_far],
            volume_range: [volume_depth, depth_far],
            cap_range: [volume_depth, volume_depth],
            volume_near,
            volume_clip_from_view: perspective(fov_y_radians, aspect, volume_near, far),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_is_met_to_seven_digits() {
        // Check value: n 0.1, n' 0.05, f 1, N 1, F 100.
        assert!((volume_near(1.0, 100.0, 0.1, 0.05, 1.0) - 0.947_867_3).abs() < 5e-8);
        assert_eq!(volume_near(1.0, 100.0, 0.1, 0.1, 1.0), 1.0);
    }

    #[test]
    fn depths_agree_and_rows_x_and_y_are_equal_to_the_bit() {
        for (near, far, ranges) in
            [(1.0, 100.0, [0.05, 0.1, 1.0]), (1e-3, 1e4, [0.0, 0.01, 0.9]), (0.5, 0.75, [0.25, 0.5, 1.0])]
        {
            let scene = perspective(0.7, 1.3, near, far);
            let ledge = Ledge::with_ranges(0.7, 1.3, near, far, ranges);
            for row in [0, 1, 3] {
                assert_eq!(scene.row(row), ledge.volume_clip_from_view.row(row));
                assert_eq!(scene.as_mat4().row(row), ledge.volume_clip_from_view.as_mat4().row(row));
            }
            let window = |clip: &DMat4, range: [f64; 2], z: f64| {
                let depth = clip.project_point3(glam::DVec3::new(0.0, 0.0, z)).z;
                0.5 * ((range[1] - range[0]) * depth + range[0] + range[1])
            };
            for k in 0..=20 {
                let z = -near * (far / near).powf(f64::from(k) / 20.0);
                let [a, b] =
                    [window(&scene, ledge.scene_range, z), window(&ledge.volume_clip_from_view, ledge.volume_range, z)];
                // f64 rounding of the two products.
                assert!((a - b).abs() < 1e-12, "{near} {far} {z}: {a} {b}");
            }
            assert!(ledge.volume_near < near);
        }
    }

    #[test]
    fn four_codes_stay_free_between_caps_and_scene() {
        for bits in [16, 24, 32] {
            let ledge = Ledge::new(0.7, 1.0, 0.1, 50.0, bits);
            let codes = f64::from(bits).exp2() - 1.0;
            let gap = (ledge.scene_range[0] * codes).round() - (ledge.cap_range[1] * codes).round();
            assert!(gap >= 4.0, "{bits}: {gap}");
        }
    }
}
