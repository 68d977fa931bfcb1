//! What fragments of a surface show.

use crate::pass::Chunk;

/// What a fragment of the surface shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The illumination formula.
    Lit,
    /// A view of one light: its chunk has `main`, and `shade` says whether it calls `shade_@`.
    View { chunk: Chunk, shade: bool },
}
