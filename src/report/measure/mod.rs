//! Measuring: pictures of many settings against exact visibility and exact colours, and their times.

pub mod claims;
mod costs;
pub mod documents;
pub mod fit;
pub mod grid;
pub mod light_claims;
pub mod options;
pub mod paired;
pub mod picks;
pub mod reference;
pub mod run;
pub mod sweeps;
pub mod tune;
