//! Content of a surface's fragments.

use crate::pass::Chunk;

/// Content of a surface's fragments.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The illumination formula.
    Lit,
    /// A view of one light: its chunk has `main`, and `shade` says whether it calls `shade_@`.
    View { chunk: Chunk, shade: bool },
    /// A slice of one light's beam: `chunk` has `main`, and reads the light's shade, colour, image and attenuation. `place`
    /// has what moves the light's texture coordinates before all that.
    Slice { chunk: Chunk, place: Option<Chunk> },
}
