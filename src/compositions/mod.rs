//! Compositions: in which passes light becomes a picture.

pub mod passes;
pub mod projection;
mod stencil_counted;
