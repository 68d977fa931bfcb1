//! Sweeps behind claims of documents as a report holds them: plain values, written as JSON and read back.

use serde::{Deserialize, Serialize};

use super::claimed::Measurement;

/// One quantity over the values of another, for the claims that rest on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimSweep {
    /// Name; unique among a scene's sweeps of claims.
    pub name: String,
    /// Document and section.
    pub source: String,
    /// Set-up in a sentence or two.
    pub says: String,
    /// Varied quantity, with its unit.
    pub x: String,
    /// True if `x` is evenly spaced and may be 0; `false`: it grows by factors.
    pub is_even: bool,
    /// Measured quantity, with its unit.
    pub y: String,
    /// Settings that are compared.
    pub series: Vec<ClaimSeries>,
}

/// Points of one setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimSeries {
    /// Name, for the legend.
    pub name: String,
    /// Points in the order of `x`.
    pub points: Vec<ClaimPoint>,
    /// Fit of the points with its range, in a sentence; empty: there is none.
    pub fit: String,
}

/// One value of the varied quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimPoint {
    /// Its value, in the unit of [`ClaimSweep::x`].
    pub x: f64,
    /// Number in the unit of [`ClaimSweep::y`], or the reason why there is none.
    pub measured: Measurement,
}

impl ClaimSeries {
    /// The measured pairs of `x` and number.
    pub fn pairs(&self) -> Vec<[f64; 2]> {
        self.points.iter().filter_map(|point| Some([point.x, point.measured.value?])).collect()
    }
}
