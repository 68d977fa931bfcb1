//! Errors against run time: how far a rendered shade is from ray-traced truth, over a grid of settings, and what each
//! costs. Drives frames and the ray tracer; names no technique and makes no GL call of its own.

pub mod measure;
#[doc(hidden)]
pub mod numbers;
#[cfg(test)]
mod samples;
pub mod show;
pub mod store;
