//! Pictures of other programs, read as floats.

use std::path::Path;

use super::raster::Raster;

/// Reads a PNG file of 8 or 16 bits: its colours, or as a shade its gray and its alpha.
///
/// # Errors
///
/// A file that cannot be read; a shade that is not gray.
pub(super) fn read(path: &Path, is_shade: bool) -> Result<Raster, String> {
    let image = image::open(path).map_err(|error| error.to_string())?;
    let size = [image.width(), image.height()];
    if !is_shade {
        return Ok(Raster { size, channels: 3, data: image.into_rgb32f().into_raw() });
    }
    let mut data = Vec::with_capacity(2 * size[0] as usize * size[1] as usize);
    for (x, y, pixel) in image.into_rgba32f().enumerate_pixels() {
        let [red, green, blue, alpha] = pixel.0;
        if red != green || red != blue {
            return Err(format!(
                "a shade must be gray: 1 lit, 0 shadowed; its pixel ({x}, {y}) is red {red}, green {green}, blue {blue}"
            ));
        }
        data.extend([red, f32::from(alpha > 0.0)]);
    }
    Ok(Raster { size, channels: 2, data })
}
