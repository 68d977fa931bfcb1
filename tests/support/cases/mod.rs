//! Pixel cases: one folder a case, `data/cases/<technique>/<case>/` with a `case.toml` that says what must be seen.
//! Everything here judges pictures from outside: it reads the resolved scene, never matrices, planes or pass lists.

pub mod check;
pub mod compare;
pub mod draw;
pub mod file;
pub mod formula;
pub mod golden;
pub mod picture;
