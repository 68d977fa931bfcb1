//! Typed GL over glow: the only GL of the renderer beside the contexts themselves.

pub mod debug;
pub mod probe;
pub mod queries;
