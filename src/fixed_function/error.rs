//! Errors of the fixed-function pipeline, and the passes that it cannot draw.

use crate::context::compatibility::BindingError;
use crate::device;

/// Something of a pass list that the fixed-function pipeline cannot compute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inexpressible {
    /// The pass's label.
    pub pass: String,
    /// The draws that it is about, by their labels.
    pub what: String,
    pub why: String,
}

impl std::fmt::Display for Inexpressible {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "\"{}\", {}: {}", self.pass, self.what, self.why)
    }
}

/// Reason why a list was not drawn by the fixed-function pipeline. A picture is never drawn in part.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Binding(#[from] BindingError),
    #[error(transparent)]
    Device(#[from] device::Error),
    #[error("the fixed-function pipeline cannot draw this scene:{}", lines(.0))]
    Inexpressible(Vec<Inexpressible>),
}

fn lines(all: &[Inexpressible]) -> String {
    all.iter().map(|each| format!("\n  {each}")).collect()
}
