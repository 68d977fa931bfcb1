//! What several tests need.

pub mod xvfb;
