//! The ray tracer against shadows known in closed form, and against itself where the answer must not change.

mod closed_form;
mod doubt;
mod robust;
pub mod scenes;
