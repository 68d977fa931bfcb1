//! Measuring: pictures of many settings against exact visibility and exact colours, and their times.

mod band;
#[cfg(feature = "report")]
pub mod claims;
pub mod colors;
#[cfg(feature = "report")]
mod costs;
pub mod difference;
mod edges;
#[cfg(feature = "report")]
pub mod fit;
pub mod flip;
#[cfg(feature = "report")]
pub mod grid;
#[cfg(feature = "report")]
pub mod light_claims;
pub mod metrics;
#[cfg(feature = "report")]
pub mod options;
#[cfg(feature = "report")]
pub mod paired;
#[cfg(feature = "report")]
pub mod picks;
#[cfg(feature = "report")]
pub mod reference;
#[cfg(feature = "report")]
pub mod run;
#[cfg(feature = "report")]
pub mod sweeps;
#[cfg(feature = "report")]
pub mod tune;
