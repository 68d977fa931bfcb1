//! A picture as a file has it, and the sizes that are read.

use super::raster::Raster;

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
