//! Files that are whole or not there: each is written beside its name, then all are renamed. Knows no format.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes all of `paths`, or none: `write` gets each one's place in `paths` and the name to write to.
///
/// # Errors
///
/// The first file that could not be written, by its place; what was written beside is removed.
pub(crate) fn write_all(
    paths: &[&Path],
    mut write: impl FnMut(usize, &Path) -> io::Result<()>,
) -> Result<(), (usize, io::Error)> {
    let mut written: Vec<PathBuf> = Vec::new();
    let mut result = Ok(());
    for (index, path) in paths.iter().enumerate() {
        let temporary = temporary(path);
        result = write(index, &temporary).map_err(|error| (index, error));
        written.push(temporary);
        if result.is_err() {
            break;
        }
    }
    for (index, temporary) in written.iter().enumerate() {
        if result.is_ok() {
            result = fs::rename(temporary, paths[index]).map_err(|error| (index, error));
        }
        if result.is_err() {
            // Best effort: the error that counts is the one above.
            let _ = fs::remove_file(temporary);
        }
    }
    result
}

/// Unique to this process and name, in the same folder, so that the rename is one step.
fn temporary(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_failure_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|name| folder.path().join(name));
        let write = |index: usize, temporary: &Path| match index {
            0 => fs::write(temporary, "a"),
            _ => fs::write(temporary, "half").and(Err(io::Error::other("full"))),
        };
        let (index, error) = write_all(&[&paths[0], &paths[1]], write).unwrap_err();
        assert_eq!((index, error.to_string().as_str()), (1, "full"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn an_older_file_is_replaced_in_one_step() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "old").unwrap();
        write_all(&[&path], |_, temporary| {
            fs::write(temporary, "new")?;
            assert_eq!(fs::read(&path)?, b"old");
            Ok(())
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
