//! A cube map of unit vectors, as a lookup with GL's linear filter finds it [GL 4.6, 8.13 and Table 8.19].

use glam::DVec3;

use super::span::Ball;

/// Accuracy of a filter's weights, as a share of the difference between texels.
const WEIGHTS: f64 = 2.0 / 256.0;

/// Error of a filtered vector that is rounded to codes of 255 once more: half of one, doubled, along its longest part.
const ROUNDED: f64 = 1.0 / 255.0;

/// The vector that a map of `size` texels a side has in the direction of `way`. Without a direction it may be any.
pub(super) fn lookup(size: u32, seamless: bool, way: Ball) -> Ball {
    let length = way.at.length();
    if length <= way.error || length == 0.0 {
        return Ball { at: DVec3::ZERO, error: 1.01 };
    }
    let count = f64::from(size);
    // Index of the largest part, and the others on the face.
    let parts = way.at.to_array();
    let main = (0..3).max_by(|a, b| parts[*a].abs().total_cmp(&parts[*b].abs())).unwrap_or(2);
    let [across, along] = [(main + 1) % 3, (main + 2) % 3];
    let place = |axis: usize| 0.5 * (parts[axis] / parts[main].abs() + 1.0) * count - 0.5;
    let (x, y) = (place(across), place(along));
    let (left, low) = (x.floor(), y.floor());
    let mut error = 0.0;
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(dx, dy)| {
        let weight = (1.0 - (x - left - dx).abs()) * (1.0 - (y - low - dy).abs());
        let at = [left + dx, low + dy];
        let beyond = at.map(|at| at < 0.0 || at > count - 1.0);
        let vector = match (beyond, seamless) {
            ([true, true], true) => {
                // A texel that no face has: the others' mean.
                error = 2.0 / count;
                texel(main, [across, along], parts[main].signum(), at.map(|at| at.clamp(0.0, count - 1.0)), count)
            }
            ([true, false], true) => beside(main, [across, along], parts[main].signum(), at, count),
            ([false, true], true) => beside(main, [along, across], parts[main].signum(), [at[1], at[0]], count),
            _ => texel(main, [across, along], parts[main].signum(), at.map(|at| at.clamp(0.0, count - 1.0)), count),
        };
        (weight, vector)
    });
    // On an edge of the cube either face may be looked up.
    let border = parts[across].abs().max(parts[along].abs()) / parts[main].abs();
    if !seamless && border > 1.0 - 1e-5 {
        error += 2.0 / count;
    }
    let at: DVec3 = corners.iter().map(|(weight, vector)| *weight * *vector).sum();
    let contrast = corners.iter().map(|(_, vector)| vector.distance(corners[0].1)).fold(0.0, f64::max);
    let rounded = if contrast > 0.0 { ROUNDED } else { 0.0 };
    Ball { at, error: error + rounded + contrast * WEIGHTS + 1.5 * way.error / (length - way.error) }
}

/// The packed vector of a texel of the face across axis `main`.
fn texel(main: usize, sides: [usize; 2], sign: f64, at: [f64; 2], count: f64) -> DVec3 {
    let mut parts = [0.0; 3];
    parts[main] = sign;
    for (side, at) in sides.into_iter().zip(at) {
        parts[side] = (2.0 * at + 1.0) / count - 1.0;
    }
    packed(DVec3::from_array(parts))
}

/// The texel of the neighbouring face that touches this one's, of which the first coordinate is beyond the edge.
fn beside(main: usize, [out, along]: [usize; 2], sign: f64, at: [f64; 2], count: f64) -> DVec3 {
    let mut parts = [0.0; 3];
    parts[out] = if at[0] < 0.0 { -1.0 } else { 1.0 };
    parts[main] = sign * (1.0 - 1.0 / count);
    parts[along] = (2.0 * at[1] + 1.0) / count - 1.0;
    packed(DVec3::from_array(parts))
}

/// A direction in codes of 255, c = round(255 (x / 2 + 1 / 2)), and back.
fn packed(way: DVec3) -> DVec3 {
    let unit = way / way.length();
    DVec3::from_array(unit.to_array().map(|part| 2.0 * (255.0 * (0.5 * part + 0.5)).round() / 255.0 - 1.0))
}
