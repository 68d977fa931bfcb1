//! Errors against run time: how far a rendered shade is from the oracle's truth, over a grid of settings, and what each
//! costs. Drives frames and the oracle; names no technique and makes no GL call of its own.

mod band;
pub mod claimed;
pub mod claims;
pub mod csv;
pub mod difference;
mod edges;
pub mod fingerprint;
pub mod grid;
pub mod html;
pub mod journal;
pub mod kept;
pub mod merge;
pub mod metrics;
mod numbers;
pub mod picks;
pub mod pictures;
pub mod plots;
pub mod results;
pub mod run;
#[cfg(test)]
mod samples;
pub mod tune;
pub mod write;
