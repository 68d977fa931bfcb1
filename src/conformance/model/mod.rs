//! Parts that several models of GL share: numbers with a bound of the error that GL leaves a driver, GLSL's types and built-in
//! functions on them, and functions that are linear in the window.

pub mod number;
pub mod scalars;
pub mod value;
pub mod vectors;
pub mod window;
