//! Shared by several tests.

pub mod contexts;
pub mod gl_headers;
pub mod lit_box;
#[cfg(unix)]
pub mod processes;
pub mod random;
pub mod replaced;
pub mod rims;
#[cfg(unix)]
pub mod shell;
pub mod window;
pub mod xvfb;
