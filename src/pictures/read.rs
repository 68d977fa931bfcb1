//! Reads picture files, whichever format they have.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

#[cfg(feature = "exr")]
use super::exr_file;
use super::picture_file::PictureFile;
use super::{npy_file, png_file};

/// Reason why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// There is no such file, or it may not be read.
    #[error("{path}: {error}", path = .path.display())]
    Read { path: PathBuf, error: io::Error },
    /// The file is no picture, a broken one, or one of a kind that is not read.
    #[error("{path}: {what}", path = .path.display())]
    Broken { path: PathBuf, what: String },
}

/// Reads a picture: PNG of 8 or 16 bits (and fewer), EXR with one channel or several, NPY of shape (height, width) or
/// (height, width, channels). The first bytes decide, not the name.
///
/// # Errors
///
/// A file that cannot be read or is no whole picture of these kinds, and one with more than [`super::MOST_VALUES`] values.
pub fn read(path: &Path) -> Result<PictureFile, Error> {
    let bytes = fs::read(path).map_err(|error| Error::Read { path: path.to_owned(), error })?;
    read_bytes(&bytes).map_err(|what| Error::Broken { path: path.to_owned(), what })
}

/// Reads a picture from a file's content.
///
/// # Errors
///
/// As [`read`], in words that do not name the file.
pub fn read_bytes(bytes: &[u8]) -> Result<PictureFile, String> {
    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
    const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];
    const NPY: &[u8] = b"\x93NUMPY";
    if bytes.starts_with(PNG) {
        png_file::decode(bytes)
    } else if bytes.starts_with(EXR) {
        #[cfg(feature = "exr")]
        return Ok(PictureFile { raster: exr_file::decode(bytes)?, texts: Vec::new() });
        #[cfg(not(feature = "exr"))]
        Err(String::from("this build reads no .exr files: enable glumbra's cargo feature `exr`"))
    } else if bytes.starts_with(NPY) {
        Ok(PictureFile { raster: npy_file::decode(bytes)?, texts: Vec::new() })
    } else {
        Err(String::from("is no PNG, EXR or NPY file"))
    }
}
