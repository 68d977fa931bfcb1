//! The judges: other ways to make the same picture, each independent of what it judges.
//!
//! - [`ray`]: exact visibility in f64 from the scene alone.

pub mod ray;
