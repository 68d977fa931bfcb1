//! Errors and warnings of geometry files. Every message begins with `file:line`.

use std::fmt;
use std::path::{Path, PathBuf};

/// Reason why a mesh or a texture cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("{}: cannot be read: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{}: is a directory, not a file", path.display())]
    Directory { path: PathBuf },
    #[error("{}:{line}: is not text: byte 0x{byte:02x}", path.display())]
    NotText { path: PathBuf, line: usize, byte: u8 },
    #[error("{}:{line}: {what}", path.display())]
    Malformed { path: PathBuf, line: usize, what: String },
    #[error("{}: at byte {offset}: {what}", path.display())]
    MalformedAt { path: PathBuf, offset: usize, what: String },
    #[error("{}: {place}: {what}", path.display())]
    Inside { path: PathBuf, place: String, what: String },
    #[error("{}: the scene has no triangles{why}", path.display())]
    NoTriangles { path: PathBuf, why: String },
    #[error("{}: this build does not read it: enable glumbra's cargo feature `{feature}`", path.display())]
    NotBuilt { path: PathBuf, feature: &'static str },
    #[error("{}: cannot be part of a program: it is read from its own file alone", path.display())]
    Embedded { path: PathBuf },
    #[error("{}: has no faces of three vertices or more", path.display())]
    NoFaces { path: PathBuf },
    #[error("{}: has more than {} {what}", path.display(), u32::MAX)]
    TooLarge { path: PathBuf, what: &'static str },
    #[error("{}: is not a picture that can be read: {source}", path.display())]
    Picture { path: PathBuf, source: image::ImageError },
    #[error("{}: is {width}x{height}; a texture has 1 to {limit} texels a side", path.display())]
    PictureSize { path: PathBuf, width: u32, height: u32, limit: u32 },
}

impl Error {
    pub(super) fn malformed(path: &Path, line: usize, what: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), line, what: what.into() }
    }
}

/// An oddity of a file that can still be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    pub path: PathBuf,
    /// Counted from 1; 0: the file as a whole.
    pub line: usize,
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.path.display(), self.message),
            line => write!(f, "{}:{line}: {}", self.path.display(), self.message),
        }
    }
}
