//! Goldens guard against change and nothing else: what is right is for picks and relations to say. A missing golden
//! fails; blessing writes it and fails too, so that a run that wrote one is never green.

use std::fs;
use std::path::Path;

use super::file::Golden;
use crate::pictures::compare::{self, Tolerance};
use crate::pictures::{self, Raster};
use crate::png_file::PngTexts;

/// The driver that drew the golden beside it, one line.
const DRIVER_FILE: &str = "golden.driver";

/// Differences that another driver may make in a picture: rims move by a pixel, and colours by a few codes. By softpipe,
/// which shares no code with llvmpipe's rasterizer, 0.37 % of a golden's pixels differ by more than 16/255, in lines one
/// pixel wide, and the mean difference is 0.40/255. A picture without a shadow of 3x3 pixels differs from its golden in a
/// square, however small a share of the picture that is.
const OTHER: Tolerance = Tolerance { max: 1.0, mean: 0.75 / 255.0, share: 0.006, slight: 16.0 / 255.0, spot: Some(3) };

/// Name of the golden in its case's folder.
pub const GOLDEN: &str = "golden.png";

/// A golden's file.
#[derive(Clone, Debug)]
pub struct GoldenFile<'a> {
    /// The case's folder.
    pub folder: &'a Path,
    /// Texts of the PNG, if it is written.
    pub texts: PngTexts,
}

/// Result of a comparison with a golden.
#[derive(Clone, Debug)]
pub enum GoldenResult {
    /// It is like the golden: how it was compared, and by how much it differs.
    Same(String),
    /// It is not, or there is none.
    Wrong {
        /// Words for it.
        why: String,
        /// The golden, where it could be read.
        expected: Option<Raster>,
    },
    /// The golden was written.
    Written(String),
}

/// Compares `actual`, drawn by `driver`, with the golden `of` a case. With `bless` it is written instead.
///
/// # Errors
///
/// A golden that cannot be written.
pub fn check(
    actual: &Raster,
    golden: &Golden,
    of: &GoldenFile<'_>,
    driver: &str,
    bless: bool,
) -> Result<GoldenResult, String> {
    let path = of.folder.join(GOLDEN);
    if bless {
        return write(actual, of, &path, driver).map(GoldenResult::Written);
    }
    if !path.is_file() {
        let name = path.display();
        let why = format!("{name}: there is no golden (--bless writes it, once the picture is known to be right)");
        return Ok(GoldenResult::Wrong { why, expected: None });
    }
    let expected = match read(&path) {
        Ok(expected) => expected,
        Err(why) => return Ok(GoldenResult::Wrong { why, expected: None }),
    };
    let recorded = fs::read_to_string(of.folder.join(DRIVER_FILE)).unwrap_or_default();
    let (tolerance, how) = tolerance(recorded.trim(), driver, golden);
    Ok(match compare::compare(actual, &expected, &tolerance) {
        Ok(found) => GoldenResult::Same(format!("{how}: {found}")),
        Err(error) => {
            let why = format!("{}: {how}: {error} ({})", path.display(), golden.why);
            GoldenResult::Wrong { why, expected: Some(expected) }
        }
    })
}

/// Reads the red, green and blue of a picture.
///
/// # Errors
///
/// A file that cannot be read, or is no picture.
pub fn read(path: &Path) -> Result<Raster, String> {
    let raster = pictures::read(path).map_err(|error| error.to_string())?.raster;
    raster.to_rgb().ok_or_else(|| format!("{}: has {} channels", path.display(), raster.channels))
}

/// On the driver of the golden, the case's own tolerance; on another one [`OTHER`]. With it, what the golden was compared
/// with, in words.
fn tolerance(recorded: &str, here: &str, golden: &Golden) -> (Tolerance, String) {
    let Golden { max, mean, .. } = golden;
    if recorded == here {
        let how = format!("compared with the golden of this driver, by {max}/255 at most and {mean}/255 in the mean");
        return (Tolerance { max: max / 255.0, mean: mean / 255.0, share: 1.0, ..Tolerance::EXACT }, how);
    }
    let from = if recorded.is_empty() { "a driver that is not recorded" } else { recorded };
    let how = format!(
        "compared with the golden of another driver, {from}, by {:.2}/255 in the mean and {:.1} % of the pixels beyond {:.0}/255",
        255.0 * OTHER.mean,
        100.0 * OTHER.share,
        255.0 * OTHER.slight
    );
    (OTHER, how)
}

fn write(actual: &Raster, of: &GoldenFile<'_>, path: &Path, driver: &str) -> Result<String, String> {
    actual.write_described_png(path, &of.texts)?;
    let file = of.folder.join(DRIVER_FILE);
    fs::write(&file, format!("{driver}\n")).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(format!("{}: written; look at the picture, then run again", path.display()))
}
