//! Pictures of any program: read from PNG, EXR and NPY files as floats, and compared pixel by pixel.
//!
//! `read.rs` tells the formats apart by their first bytes; `png_file.rs`, `exr_file.rs` and `npy_file.rs` read one each.
//! `compare.rs` holds two rasters against a tolerance, `comparison.rs` says which tolerance would pass, `flip.rs` what a
//! viewer would see.
//!
//! ```
//! use glumbra::pictures::{Comparison, Raster};
//!
//! # fn main() -> Result<(), String> {
//! let expected = Raster { size: [2, 1], channels: 1, data: vec![0.0, 1.0] };
//! let actual = Raster { size: [2, 1], channels: 1, data: vec![0.0, 0.5] };
//! let found = Comparison::of(&actual, &expected)?;
//! assert_eq!((found.difference.count, found.difference.at), (1, [1, 0]));
//! assert_eq!(found.share_beyond(0.25), 0.5, "half of the pixels differ by more than a quarter");
//! # Ok(())
//! # }
//! ```

#[doc(hidden)]
pub mod compare;
mod comparison;
#[cfg(feature = "exr")]
mod exr_file;
#[doc(hidden)]
pub mod flip;
mod npy_file;
mod picture_file;
mod png_file;
mod raster;
mod read;

pub use compare::{PixelDifference, Tolerance};
pub use comparison::Comparison;
#[doc(hidden)]
pub use comparison::alike;
#[doc(hidden)]
pub use picture_file::MOST_VALUES;
pub use picture_file::PictureFile;
pub use raster::Raster;
#[doc(hidden)]
pub use read::read_bytes;
pub use read::{Error, read};
