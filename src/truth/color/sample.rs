//! A point as light needs it.

use glam::DVec3;

/// A point that a pixel shows.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub position: DVec3,
    /// Vectors by which the sample's place in its pixel may move the point. `error`: radius of a ball around it, besides.
    pub spread: [DVec3; 2],
    pub error: f64,
    /// Ways that the point moves by from a pixel to those beside it.
    pub beside: [DVec3; 2],
}
