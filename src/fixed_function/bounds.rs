//! Bounds of a batch's draws in a light's texture coordinates, from their bounding boxes: a case that cannot occur needs no
//! texture unit. Knows no GL.

use glam::{DMat4, Mat4};

use crate::pass::{Batch, Draw, Projection};

/// Cases that may occur in a batch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoordinateRange {
    /// q <= 0: behind the light.
    pub behind: bool,
    /// r > q, before the light.
    pub above_one: bool,
    /// r < 0, before the light.
    pub below_zero: bool,
}

/// Over all corners of all boxes: r, q and r - q are linear over a box, so that its corners have their extremes.
///
/// # Errors
///
/// A draw without its modelview.
pub fn of(batch: &Batch, projection: &Projection) -> Result<CoordinateRange, String> {
    let texgen = &projection.texgen;
    let coordinates_from_eye = texgen.texture_matrix * texgen.eye_planes;
    let mut reach = CoordinateRange::default();
    for draw in &batch.draws {
        let coordinates_from_model = coordinates_from_eye * eye_from_model(draw)?.as_dmat4();
        extend(&mut reach, &coordinates_from_model, draw);
    }
    Ok(reach)
}

fn extend(reach: &mut CoordinateRange, coordinates_from_model: &DMat4, draw: &Draw) {
    /// The driver's coordinates are of 32 bits.
    const SLACK: f64 = 1e-5;
    for corner in draw.bounds.corners() {
        let at = *coordinates_from_model * corner.extend(1.0);
        let slack = SLACK * at.abs().max_element();
        reach.behind |= at.w <= slack;
        reach.above_one |= at.z - at.w > -slack;
        reach.below_zero |= at.z < slack;
    }
}

/// The draw's modelview.
///
/// # Errors
///
/// A draw that does not say it.
pub fn eye_from_model(draw: &Draw) -> Result<Mat4, String> {
    let matrix = draw.eye_from_model.map(|matrix| matrix.as_mat4());
    matrix.ok_or_else(|| format!("the draw of {} has no modelview matrix", draw.label))
}
