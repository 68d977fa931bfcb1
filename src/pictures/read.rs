//! Reads picture files, whichever format they have.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::raster::Raster;
use super::{exr_file, npy_file, png_file};

/// The greatest number of values, pixels times channels, of a picture that is read: 512 MiB of floats.
pub const MOST_VALUES: usize = 1 << 27;

/// Values of a picture for each byte of its file, at most. Deflate makes no more than 1032 of a byte, and a bit is a pixel at
/// least: a file with less is cut off, and nothing is reserved for it.
const MOST_PER_BYTE: usize = 1 << 14;

/// A picture as a file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFile {
    /// The values: codes of 8 or 16 bits over their greatest, in [0, 1], and floats as they are. No gamma is applied.
    pub raster: Raster,
    /// Text chunks of a PNG, in the order of the file: keyword and text.
    pub texts: Vec<(String, String)>,
}

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
/// A file that cannot be read or is no whole picture of these kinds, and one with more than [`MOST_VALUES`] values.
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
        Ok(PictureFile { raster: exr_file::decode(bytes)?, texts: Vec::new() })
    } else if bytes.starts_with(NPY) {
        Ok(PictureFile { raster: npy_file::decode(bytes)?, texts: Vec::new() })
    } else {
        Err(String::from("is no PNG, EXR or NPY file"))
    }
}

/// Number of values of a picture of this size, if it is one that `bytes` of a file can hold.
pub(super) fn check_size([width, height]: [usize; 2], channels: usize, bytes: usize) -> Result<usize, String> {
    if width == 0 || height == 0 || channels == 0 || u32::try_from(width.max(height)).is_err() {
        return Err(format!("{width}x{height} with {channels} channels is no picture's size"));
    }
    let values = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(channels));
    match values {
        Some(values) if values <= MOST_VALUES && values / MOST_PER_BYTE <= bytes => Ok(values),
        Some(values) if values <= MOST_VALUES => {
            Err(format!("is cut off: {bytes} bytes cannot hold {width}x{height} pixels with {channels} channels"))
        }
        _ => Err(format!(
            "{width}x{height} pixels with {channels} channels are more than can be compared: at most {MOST_VALUES} values"
        )),
    }
}
