//! Goldens guard against change and nothing else: what is right is for picks and relations to say. A missing golden
//! fails; blessing writes it and fails too, so that a run that wrote one is never green.

use std::fs;
use std::path::Path;

use super::compare::{self, Tolerance};
use super::draw;
use super::file::Golden;
use super::picture::Picture;

/// The driver that drew the golden beside it, one line.
const DRIVER_FILE: &str = "golden.driver";

/// Differences that another driver may make in a picture: rims move by a pixel, and colours by a few codes. By softpipe,
/// which shares no code with llvmpipe's rasterizer, 0.37 % of a golden's pixels differ by more than 16/255, in lines one
/// pixel wide, and the mean difference is 0.40/255. A picture without a shadow of 3x3 pixels differs from its golden in a
/// square, however small a share of the picture that is.
const OTHER: Tolerance = Tolerance { max: 1.0, mean: 0.75 / 255.0, share: 0.006, slight: 16.0 / 255.0, spot: Some(3) };

/// Tests whether `ci/bless` runs, which writes goldens.
pub fn blessing() -> bool {
    std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1")
}

/// Compares `actual` with `golden.png` in `folder`. Returns the comparison and its result.
///
/// # Errors
///
/// A golden that is missing, unreadable, of another size or too different, and with `bless` every golden, after it is
/// written.
pub fn check(
    actual: &Picture,
    folder: &Path,
    golden: &Golden,
    bless: bool,
) -> Result<String, (String, Option<Picture>)> {
    let path = folder.join("golden.png");
    if bless {
        return Err((write(actual, folder, &path), None));
    }
    if !path.is_file() {
        let name = path.display();
        return Err((
            format!("{name}: there is no golden (ci/bless makes it, once the picture is known to be right)"),
            None,
        ));
    }
    let expected = Picture::read_png(&path).map_err(|error| (error, None))?;
    let recorded = fs::read_to_string(folder.join(DRIVER_FILE)).unwrap_or_default();
    let (tolerance, how) = tolerance(recorded.trim(), &draw::driver(), golden);
    compare::compare(actual, &expected, &tolerance)
        .map(|found| format!("{how}: {found}"))
        .map_err(|error| (format!("{}: {how}: {error} ({})", path.display(), golden.why), Some(expected)))
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

fn write(actual: &Picture, folder: &Path, path: &Path) -> String {
    let written = actual.write_png(path).and_then(|()| {
        let file = folder.join(DRIVER_FILE);
        fs::write(&file, draw::driver() + "\n").map_err(|error| format!("{}: {error}", file.display()))
    });
    match written {
        Ok(()) => format!("{}: written; look at it, then run the test again", path.display()),
        Err(error) => error,
    }
}
