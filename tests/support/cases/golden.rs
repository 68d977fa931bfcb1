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

/// Whether `ci/bless` asks for goldens.
pub fn blessing() -> bool {
    std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1")
}

/// Holds `actual` against `golden.png` in `folder`.
///
/// # Errors
///
/// A golden that is missing, unreadable, of another size or too different, and with `bless` every golden: it is drawn
/// anew.
pub fn check(actual: &Picture, folder: &Path, golden: &Golden, bless: bool) -> Result<(), (String, Option<Picture>)> {
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
    compare::compare(actual, &expected, &tolerance(folder, golden))
        .map(drop)
        .map_err(|error| (format!("{}: {error} ({})", path.display(), golden.why), Some(expected)))
}

/// On the driver of the goldens, the case's own. On another one edges of triangles and shadows fall differently in a
/// few pixels, so the maximum cannot hold there, and the mean and the share are what a pixel-wide rim amounts to.
fn tolerance(folder: &Path, golden: &Golden) -> Tolerance {
    let recorded = fs::read_to_string(folder.join(DRIVER_FILE)).unwrap_or_default();
    if recorded.trim() == draw::driver() {
        return Tolerance { max: golden.max / 255.0, mean: golden.mean / 255.0, share: 1.0 };
    }
    Tolerance { max: 1.0, mean: golden.mean.max(0.75) / 255.0, share: 1.0 }
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
