//! Measuring: pictures of many settings against exact visibility, and their times.

mod band;
pub mod claims;
pub mod colors;
mod costs;
pub mod difference;
mod edges;
pub mod grid;
pub mod metrics;
pub mod options;
pub mod picks;
pub mod run;
pub mod tune;
