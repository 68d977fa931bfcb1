//! Times of several runs.

use serde::{Deserialize, Serialize};

/// Times of several runs in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The middle run, or the mean of the two middle ones.
    pub median: f64,
    /// The fastest run.
    pub least: f64,
    /// The slowest run.
    pub greatest: f64,
    /// Number of runs.
    pub runs: usize,
}

impl Spread {
    /// Statistics of at least one time.
    pub fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
        let runs = sorted.len();
        let median = if runs % 2 == 1 { at(runs / 2) } else { 0.5 * (at(runs / 2) + at((runs / 2).saturating_sub(1))) };
        Self { median, least: at(0), greatest: at(runs.saturating_sub(1)), runs }
    }
}
