//! Movement of a vertex by a wave, in f64, and the error of f32. The ray tracer's own: it shares no formula with the
//! renderer.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use crate::geometry::{Mesh, Wave};

/// Point moved by a wave: along its reach, by the sine of how many wavelengths the point is away along its axis.
pub(super) fn moved(place: DVec3, wave: &Wave) -> DVec3 {
    let turns = wave.vector.x * place.x + wave.vector.y * place.y + wave.vector.z * place.z + wave.phase;
    place + wave.reach * ((turns - turns.floor()) * TAU).sin()
}

/// Normal of a surface that a wave moves, at a point of it at rest; of unit length. The surface's tangents move by the
/// columns of the wave's derivative; a normal goes by their cross products, which turn with a surface that folds over.
pub(super) fn turned(normal: DVec3, place: DVec3, wave: &Wave) -> DVec3 {
    turned_by(normal, place, wave).normalize_or(normal)
}

/// Directions of a surface, the normal last, which is of unit length: the others as shares of its length, as sums of them move.
pub(super) fn turned_axes(axes: [DVec3; 3], place: DVec3, wave: &Wave) -> [DVec3; 3] {
    let turned = axes.map(|axis| turned_by(axis, place, wave));
    let length = turned[2].length();
    if length > 0.0 { turned.map(|axis| axis / length) } else { axes }
}

fn turned_by(normal: DVec3, place: DVec3, wave: &Wave) -> DVec3 {
    let turns = wave.vector.dot(place) + wave.phase;
    let swing = wave.reach * (TAU * (TAU * (turns - turns.floor())).cos());
    let [x, y, z] = [0, 1, 2].map(|k| DVec3::AXES[k] + swing * wave.vector[k]);
    normal.x * y.cross(z) + normal.y * z.cross(x) + normal.z * x.cross(y)
}

/// Error of f32 in a vertex that a wave moves: the turns are a sum of four products, each with its factors rounded; a sine
/// is good to 2^-20 on the least of drivers; the sum is rounded once more.
pub(super) fn error(wave: &Wave, mesh: &Mesh, world_from_model: &DMat4) -> f64 {
    let rounding = 0.5 * f64::from(f32::EPSILON);
    let size = |position: &[f32; 3]| DVec3::from_array(position.map(f64::from)).length();
    let size = mesh.positions.iter().map(size).fold(0.0, f64::max);
    let turns = 6.0 * rounding * (wave.vector.length() * size + 1.0);
    let error = wave.reach.length() * (TAU * turns + 2.0_f64.powi(-20) + rounding) + rounding * size;
    let axes = [world_from_model.x_axis, world_from_model.y_axis, world_from_model.z_axis];
    error * axes.iter().map(|axis| axis.truncate().length_squared()).sum::<f64>().sqrt()
}
