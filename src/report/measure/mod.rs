//! Measuring: pictures of many settings against exact visibility and exact colours, and their times.

mod band;
pub mod claims;
pub mod colors;
mod costs;
pub mod difference;
mod edges;
pub mod fit;
pub mod flip;
pub mod grid;
pub mod light_claims;
pub mod metrics;
pub mod options;
pub mod paired;
pub mod picks;
pub mod reference;
pub mod run;
pub mod sweeps;
pub mod tune;
