//! Errors against run time: how far a rendered shade is from the oracle's truth. Knows answers and pictures; no scene,
//! no technique, no GL.

mod band;
mod edges;
pub mod grid;
pub mod metrics;
pub mod results;
pub mod run;
pub mod tune;
