//! Other ways to make the same picture, each independent of the renderer.
//!
//! - [`ray`]: exact visibility in f64 from the scene alone.
//! - [`semantics`]: GL's own rules, as checks of the driver.
//! - [`fixed_function`]: the same passes by the driver's fixed-function pipeline.

pub mod fixed_function;
pub mod ray;
pub mod semantics;
