//! Newell's teapot, tessellated from its patches (`data/teapot.txt`), with the normals of the exact surface.

use glam::{DVec3, dvec3};

use super::Builder;
use crate::geometry::Mesh;

const PATCHES: &str = include_str!("../../../data/teapot.txt");

/// Cells along each side of a patch.
const CELLS: u32 = 16;

/// 4×4 control points: rows, then points in the row.
type Patch = [[DVec3; 4]; 4];

/// The teapot as glutSolidTeapot(1) places it: half size, y up, its middle height at y = 0.
pub(super) fn teapot() -> Mesh {
    let mut builder = Builder::default();
    for (mirrorings, patch) in patches() {
        for mirroring in mirrorings {
            add_patch(&mut builder, &patch, *mirroring);
        }
    }
    builder.finish("teapot")
}

/// Each patch of the file with the signs of x, y and z under which it occurs.
pub(super) fn patches() -> impl Iterator<Item = (&'static [DVec3], Patch)> {
    const TURN: &[DVec3] = &[DVec3::ONE, dvec3(-1.0, 1.0, 1.0), dvec3(-1.0, -1.0, 1.0), dvec3(1.0, -1.0, 1.0)];
    const MIRROR: &[DVec3] = &[DVec3::ONE, dvec3(1.0, -1.0, 1.0)];
    let mut lines = PATCHES.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    std::iter::from_fn(move || {
        let mirrorings = if lines.next()?.starts_with("turn") { TURN } else { MIRROR };
        let mut patch = Patch::default();
        for row in &mut patch {
            let mut numbers = lines.next()?.split_whitespace().filter_map(|word| word.parse::<f64>().ok());
            for point in row {
                *point = dvec3(numbers.next()?, numbers.next()?, numbers.next()?);
            }
        }
        Some((mirrorings, patch))
    })
}

/// Adds the patch with each coordinate multiplied by its sign in `mirroring`.
fn add_patch(builder: &mut Builder, patch: &Patch, mirroring: DVec3) {
    let first = builder.positions.len() as u32;
    let turned_over = mirroring.element_product() < 0.0;
    for row in 0..=CELLS {
        for column in 0..=CELLS {
            // A mirrored patch is run through backwards, which keeps its outside outside.
            let column = if turned_over { CELLS - column } else { column };
            let (u, v) = (super::fraction(column, CELLS), super::fraction(row, CELLS));
            let (position, normal) = evaluate(patch, u, v);
            builder.add_vertex(glut_from_newell(position * mirroring), y_up(normal * mirroring), [u, v]);
        }
    }
    builder.add_grid(first, CELLS, CELLS);
}

/// z up to y up.
fn y_up(vector: DVec3) -> DVec3 {
    dvec3(vector.x, vector.z, -vector.y)
}

/// Newell's z from 0 to 3.15 becomes GLUT's y from -0.75 to 0.825.
fn glut_from_newell(position: DVec3) -> DVec3 {
    0.5 * y_up(position - dvec3(0.0, 0.0, 1.5))
}

/// The point at `u` along the rows and `v` across them, in [0, 1], and the normal there, of any length.
fn evaluate(patch: &Patch, u: f64, v: f64) -> (DVec3, DVec3) {
    let rows = patch.map(|row| blend(&row, bernstein(u)));
    let slopes = patch.map(|row| blend(&row, bernstein_slope(u)));
    let position = blend(&rows, bernstein(v));
    let along_v = blend(&rows, bernstein_slope(v));
    let along_u = blend(&slopes, bernstein(v));
    let normal = along_u.cross(along_v);
    if normal.length_squared() > 1e-12 {
        return (position, normal);
    }
    // At a pole the row shrinks to a point. Close to it, along_u is nearly the mixed derivative times v - v_pole.
    let away = if v < 0.5 { 1.0 } else { -1.0 };
    let mixed = away * blend(&slopes, bernstein_slope(v));
    (position, mixed.cross(along_v))
}

fn bernstein(t: f64) -> [f64; 4] {
    let r = 1.0 - t;
    [r * r * r, 3.0 * t * (r * r), 3.0 * r * (t * t), t * t * t]
}

/// The derivatives of [`bernstein`], but for a factor of three.
fn bernstein_slope(t: f64) -> [f64; 4] {
    let r = 1.0 - t;
    [-r * r, r * r - 2.0 * t * r, 2.0 * t * r - t * t, t * t]
}

/// Summed from both ends, so that a curve run through backwards gives the same bits.
fn blend(points: &[DVec3; 4], weights: [f64; 4]) -> DVec3 {
    (points[0] * weights[0] + points[3] * weights[3]) + (points[1] * weights[1] + points[2] * weights[2])
}
