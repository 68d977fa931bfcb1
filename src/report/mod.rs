//! Errors against run time: how far a rendered shade is from the oracle's truth. Knows answers and pictures; no scene,
//! no technique, no GL.

mod band;
pub mod csv;
pub mod difference;
mod edges;
pub mod grid;
pub mod html;
pub mod merge;
pub mod metrics;
mod numbers;
pub mod plots;
pub mod results;
#[cfg(test)]
mod samples;
pub mod write;
