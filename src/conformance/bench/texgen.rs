//! Planes of glTexGen, as data.

use glam::DMat4;

/// glTexGen for all four coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlTexgen {
    /// EYE_LINEAR, else OBJECT_LINEAR.
    pub eye: bool,
    /// Rows give s, t, r and q of a vertex.
    pub planes: DMat4,
    /// The modelview when eye planes are given.
    pub modelview: DMat4,
}
