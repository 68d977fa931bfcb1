//! Options of a run.

use crate::context::ContextRequest;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct MeasureOptions {
    /// Index of the measured light.
    pub light: usize,
    /// Timed frames for each row, at least 1.
    pub runs: usize,
    /// Rows measured at once.
    pub jobs: usize,
    /// The I-th of N parts, I from 1.
    pub shard: (usize, usize),
    /// The edge band's half width in texels of the map.
    pub band_texels: f64,
    /// Context that the rows are drawn on.
    pub context: ContextRequest,
}
