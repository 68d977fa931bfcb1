//! Smooth noise from an integer hash.

use glam::DVec3;

/// A number in [0, 1) that looks random, the same for the same lattice point and `seed`.
pub fn hash(x: i64, y: i64, z: i64, seed: u64) -> f64 {
    let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for value in [x, y, z] {
        h = (h ^ value as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
        h ^= h >> 32;
    }
    h = h.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    (h >> 11) as f64 / (1u64 << 53) as f64
}

/// Value noise in [-1, 1] with features of size 1; its first and second derivatives are continuous.
pub fn noise(p: DVec3, seed: u64) -> f64 {
    tiled_noise(p, i64::MAX, seed)
}

/// [`noise`] that repeats in x and y after `period` lattice points.
pub fn tiled_noise(p: DVec3, period: i64, seed: u64) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let [x, y, z] = [cell.x as i64, cell.y as i64, cell.z as i64];
    let at = |dx: i64, dy: i64, dz: i64| hash((x + dx).rem_euclid(period), (y + dy).rem_euclid(period), z + dz, seed);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |dy, dz| mix(at(0, dy, dz), at(1, dy, dz), w.x);
    let plane = |dz| mix(row(0, dz), row(1, dz), w.y);
    2.0 * mix(plane(0), plane(1), w.z) - 1.0
}
