//! A seated cat on a round plinth: smoothly joined solids, chiselled by noise, as an uneven mesh like that of a scan.

use glam::{DVec3, dvec3};
use rayon::prelude::*;

use super::noise::{hash, noise};
use super::tetrahedra::{Lattice, polygonise};

/// Distance between lattice points, in the solids' units; it decides the number of triangles.
const STEP: f64 = 0.0233;
/// Scale from the solids' units to the model's, in which the cat is 1.6 high.
const SCALE: f64 = 1.6 / 1.492;

/// The statue's vertices and triangles, standing on y = 0.
pub fn sculpt() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut positions, triangles) = polygonise(&sample());
    for _ in 0..3 {
        relax(&mut positions, &triangles);
    }
    let lowest = positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    for position in &mut positions {
        *position = (*position - dvec3(0.0, lowest, 0.0)) * SCALE;
    }
    (positions, triangles)
}

/// The field on a lattice whose points stand unevenly.
fn sample() -> Lattice {
    let (low, high) = (dvec3(-0.56, -0.08, -0.56), dvec3(0.56, 1.58, 0.56));
    let size = ((high - low) / STEP).ceil().to_array().map(|n| n as usize + 1);
    let mut points = Vec::with_capacity(size.iter().product());
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                points.push(place(low + STEP * dvec3(x as f64, y as f64, z as f64), [x, y, z]));
            }
        }
    }
    let values = points.par_iter().map(|point| field(*point)).collect();
    Lattice { size, points, values }
}

/// A lattice point moved a little by chance, and with its neighbours, so that the mesh is fine here and coarse there.
fn place(point: DVec3, [x, y, z]: [usize; 3]) -> DVec3 {
    let [x, y, z] = [x as i64, y as i64, z as i64];
    let jitter = dvec3(hash(x, y, z, 1), hash(x, y, z, 2), hash(x, y, z, 3)) - 0.5;
    let swell = dvec3(noise(point * 5.0, 4), noise(point * 5.0, 5), noise(point * 5.0, 6));
    point + jitter * (0.4 * STEP) + swell * 0.028
}

/// Moves each vertex half-way to the middle of its neighbours, and back onto the surface.
fn relax(positions: &mut [DVec3], triangles: &[[u32; 3]]) {
    let mut sums = vec![(DVec3::ZERO, 0.0); positions.len()];
    for triangle in triangles {
        for k in 0..3 {
            let [a, b] = [triangle[k] as usize, triangle[(k + 1) % 3] as usize];
            sums[a].0 += positions[b];
            sums[a].1 += 1.0;
        }
    }
    positions.par_iter_mut().zip(sums).for_each(|(position, (sum, count))| {
        let moved = (*position + sum / f64::max(count, 1.0)) * 0.5;
        let (value, slope) = field_and_gradient(moved);
        let back = slope * (value / slope.length_squared().max(0.25));
        *position = moved - back.clamp_length_max(0.5 * STEP);
    });
}

fn field_and_gradient(p: DVec3) -> (f64, DVec3) {
    const H: f64 = 1e-4;
    let value = field(p);
    let along = |axis: DVec3| (field(p + axis * H) - value) / H;
    (value, dvec3(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)))
}

/// About the signed distance to the statue, negative inside.
fn field(p: DVec3) -> f64 {
    let cat = cat(p);
    // Strokes of a chisel, along the fur, and fine noise over all.
    let strokes = noise(dvec3(p.x * 34.0, p.y * 11.0 + p.z * 9.0, p.z * 30.0), 7);
    let grain = noise(p * 70.0, 8);
    let face = smoothstep(1.0, 1.12, p.y);
    let carved = cat + 0.0035 * (1.0 - 0.8 * face) * strokes + 0.0009 * grain;
    smooth_union(carved, plinth(p) + 0.0008 * grain, 0.04)
}

fn plinth(p: DVec3) -> f64 {
    let from_axis = (p.x * p.x + p.z * p.z).sqrt();
    let slab = |top: f64, bottom: f64, radius: f64, round: f64| {
        let half = 0.5 * (top - bottom);
        let out = dvec3(from_axis - radius + round, (p.y - 0.5 * (top + bottom)).abs() - half + round, 0.0);
        out.max(DVec3::ZERO).length() + out.x.max(out.y).min(0.0) - round
    };
    let foot = slab(0.055, 0.0, 0.50, 0.012);
    let stem = slab(0.12, 0.0, 0.455, 0.006);
    let top = slab(0.16, 0.10, 0.485, 0.018);
    smooth_union(smooth_union(foot, stem, 0.02), top, 0.02)
}

/// The cat, sitting upright and facing +z, its tail around its left side.
fn cat(p: DVec3) -> f64 {
    // Mirrored: all but head's turn and tail are alike on both sides.
    let m = dvec3(p.x.abs(), p.y, p.z);
    let mut d = ellipsoid(p, dvec3(0.0, 0.42, -0.14), dvec3(0.25, 0.30, 0.27));
    d = smooth_union(d, cone(p, dvec3(0.0, 0.50, -0.08), 0.22, dvec3(0.0, 0.94, 0.06), 0.135), 0.12);
    d = smooth_union(d, ellipsoid(p, dvec3(0.0, 0.80, 0.09), dvec3(0.155, 0.21, 0.14)), 0.08);
    let thigh = ellipsoid(m, dvec3(0.20, 0.35, -0.05), dvec3(0.11, 0.21, 0.23));
    d = smooth_union(d, thigh, 0.06);
    let shoulder = cone(m, dvec3(0.11, 0.76, 0.08), 0.085, dvec3(0.095, 0.50, 0.20), 0.066);
    let foreleg = cone(m, dvec3(0.095, 0.50, 0.20), 0.066, dvec3(0.088, 0.21, 0.265), 0.047);
    d = smooth_union(d, smooth_union(shoulder, foreleg, 0.03), 0.06);
    d = smooth_union(d, paws(m), 0.04);
    d = smooth_union(d, tail(p), 0.04);
    let head = head(turn_head(p));
    smooth_union(d, head, 0.05)
}

fn paws(m: DVec3) -> f64 {
    let mut d = ellipsoid(m, dvec3(0.09, 0.188, 0.30), dvec3(0.062, 0.048, 0.085));
    for x in [0.052, 0.09, 0.128] {
        let ahead = if x == 0.09 { 0.37 } else { 0.358 };
        d = smooth_union(d, ellipsoid(m, dvec3(x, 0.18, ahead), dvec3(0.023, 0.031, 0.033)), 0.01);
    }
    d = smooth_union(d, ellipsoid(m, dvec3(0.235, 0.19, 0.13), dvec3(0.062, 0.048, 0.13)), 0.02);
    for x in [0.20, 0.237, 0.274] {
        let ahead = if x == 0.237 { 0.25 } else { 0.237 };
        d = smooth_union(d, ellipsoid(m, dvec3(x, 0.181, ahead), dvec3(0.022, 0.03, 0.032)), 0.01);
    }
    d
}

/// Lies on the plinth from behind around the left side; its tip is lifted.
fn tail(p: DVec3) -> f64 {
    const KNOTS: [([f64; 3], f64); 7] = [
        ([0.02, 0.25, -0.33], 0.070),
        ([0.17, 0.215, -0.385], 0.060),
        ([0.315, 0.205, -0.29], 0.055),
        ([0.385, 0.203, -0.13], 0.052),
        ([0.395, 0.203, 0.05], 0.050),
        ([0.345, 0.21, 0.22], 0.046),
        ([0.235, 0.245, 0.345], 0.030),
    ];
    KNOTS.windows(2).fold(f64::INFINITY, |d, ends| {
        let [(a, ra), (b, rb)] = [ends[0], ends[1]];
        smooth_union(d, cone(p, a.into(), ra, b.into(), rb), 0.008)
    })
}

/// Turns the head a little to its left, about the axis of the neck (3-4-5 scaled: no angle is needed).
fn turn_head(p: DVec3) -> DVec3 {
    let (cosine, sine) = (12.0 / 13.0, 5.0 / 13.0);
    let q = p - dvec3(0.0, 0.0, 0.10);
    dvec3(cosine * q.x - sine * q.z, q.y, sine * q.x + cosine * q.z) + dvec3(0.0, 0.0, 0.10)
}

fn head(p: DVec3) -> f64 {
    let m = dvec3(p.x.abs(), p.y, p.z);
    let mut d = cone(p, dvec3(0.0, 0.92, 0.07), 0.125, dvec3(0.0, 1.14, 0.10), 0.11);
    d = smooth_union(d, ellipsoid(p, dvec3(0.0, 1.20, 0.13), dvec3(0.178, 0.152, 0.162)), 0.05);
    d = smooth_union(d, ellipsoid(m, dvec3(0.09, 1.145, 0.185), dvec3(0.085, 0.07, 0.075)), 0.05);
    // Brow and bridge of the nose.
    d = smooth_union(d, cone(p, dvec3(0.0, 1.275, 0.235), 0.035, dvec3(0.0, 1.19, 0.312), 0.024), 0.04);
    d = smooth_union(d, ellipsoid(m, dvec3(0.075, 1.272, 0.235), dvec3(0.055, 0.02, 0.03)), 0.03);
    // Eyes: a hollow, and the ball in it.
    d = smooth_difference(d, ellipsoid(m, dvec3(0.078, 1.222, 0.292), dvec3(0.046, 0.032, 0.04)), 0.025);
    d = smooth_union(d, ellipsoid(m, dvec3(0.076, 1.222, 0.258), dvec3(0.034, 0.028, 0.026)), 0.022);
    let mut muzzle = ellipsoid(m, dvec3(0.038, 1.128, 0.29), dvec3(0.05, 0.041, 0.05));
    muzzle = smooth_union(muzzle, ellipsoid(p, dvec3(0.0, 1.088, 0.268), dvec3(0.035, 0.028, 0.036)), 0.012);
    d = smooth_union(d, muzzle, 0.025);
    d = smooth_union(d, ellipsoid(p, dvec3(0.0, 1.168, 0.332), dvec3(0.026, 0.016, 0.018)), 0.008);
    ears(d, m)
}

fn ears(d: f64, m: DVec3) -> f64 {
    // Flattened along z, hollow in front.
    let flat = |p: DVec3| dvec3(p.x, p.y, (p.z - 0.105) * 1.7);
    let ear = cone(flat(m), dvec3(0.105, 1.30, 0.0), 0.078, dvec3(0.148, 1.458, -0.01), 0.034);
    let hollow = cone(flat(m), dvec3(0.105, 1.31, 0.088), 0.052, dvec3(0.138, 1.395, 0.064), 0.010);
    let ear = smooth_difference(ear, hollow, 0.014);
    smooth_union(d, ear, 0.025)
}

/// About the distance to an ellipsoid.
fn ellipsoid(p: DVec3, center: DVec3, radii: DVec3) -> f64 {
    let q = (p - center) / radii;
    let steepness = (q / radii).length();
    let k = q.length();
    if steepness < 1e-9 { -radii.min_element() } else { k * (k - 1.0) / steepness }
}

/// About the distance to a stick whose radius goes from `ra` at `a` to `rb` at `b`.
fn cone(p: DVec3, a: DVec3, ra: f64, b: DVec3, rb: f64) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (p - a - along * t).length() - (ra + (rb - ra) * t)
}

/// The smaller of both, rounded where they differ by less than `k`.
fn smooth_union(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// `a` without `b`.
fn smooth_difference(a: f64, b: f64, k: f64) -> f64 {
    -smooth_union(-a, b, k)
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
