//! An interpreter of the GLSL that the renderer's shaders use, on numbers with bounds of error.

mod compile;
mod expressions;
mod functions;
mod ops;
mod run;
mod statements;
#[cfg(test)]
mod tests;
mod tokens;

pub use compile::{Unknown, compile};
pub use ops::{Compiled, Slot, Varies};
pub use run::{Asked, Detail, LANES, Lanes, Machine, NoTextures, Textures, either_of};
