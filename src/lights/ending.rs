//! Content of a surface's fragments.

use crate::pass::Chunk;

/// Content of a surface's fragments.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The illumination formula.
    Lit,
    /// A view of one light: its chunk has `main`, and `shade` says whether it calls `shade_@`.
    View { chunk: Chunk, shade: bool },
}
