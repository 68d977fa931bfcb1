//! Atomic file writes: each file is written under another name and synced, and then all are renamed. Knows no format.
//!
//! An unfinished file is called `.NAME.glumbra-XXXXXX.tmp` and is locked while it is written. A process that is killed
//! leaves it there, without a lock, and the next one that writes into the folder removes it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::process::{Unfinished, unfinished};

/// Common part of the names of unfinished files.
const MARK: &str = ".glumbra-";
const ENDING: &str = ".tmp";
/// Letters between the two, chosen at random.
const RANDOM_LETTERS: usize = 6;

/// Writes all of `paths`, or none: `write` gets each one's place in `paths` and the name to write to.
///
/// A path that is a link is followed, and its target is replaced. A pipe or a device is written to directly.
///
/// # Errors
///
/// The first file that could not be written, by its place; what was written beside is removed.
pub(crate) fn write_all(
    paths: &[&Path],
    mut write: impl FnMut(usize, &Path) -> io::Result<()>,
) -> Result<(), (usize, io::Error)> {
    let mut written: Vec<Beside> = Vec::new();
    for (index, path) in paths.iter().enumerate() {
        let failed = |error| (index, error);
        if paths[..index].contains(path) {
            return Err(failed(io::Error::other("two of the files to write have this name")));
        }
        let beside = Beside::new(path).map_err(failed)?;
        write(index, beside.file.path()).and_then(|()| beside.file.as_file().sync_all()).map_err(failed)?;
        written.push(beside);
    }
    for (index, beside) in written.into_iter().enumerate() {
        beside.finish().map_err(|error| (index, error))?;
    }
    Ok(())
}

/// Tries whether `path` can be written, as [`write_all`] would begin; leaves nothing.
///
/// # Errors
///
/// The error that [`write_all`] would end with.
#[cfg_attr(not(all(feature = "check", feature = "cli")), allow(dead_code, reason = "for commands that write late"))]
pub(crate) fn try_to_write(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Beside::new(path).map(drop)
}

/// A file that is being written, and its target. It is removed on drop.
struct Beside {
    file: NamedTempFile,
    target: Target,
    _unfinished: Unfinished,
}

impl Beside {
    fn new(path: &Path) -> io::Result<Self> {
        let target = Target::of(path)?;
        let folder = match &target {
            Target::File(path) => folder_of(path).to_owned(),
            Target::Stream(_) => std::env::temp_dir(),
        };
        remove_stale(&folder);
        let prefix = format!(".{}{MARK}", short_name(path));
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(ENDING).rand_bytes(RANDOM_LETTERS);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the process's umask
        loop {
            let file = builder.tempfile_in(&folder).map_err(plain)?;
            let unfinished = unfinished(file.path());
            if cfg!(unix) {
                // If files cannot be locked, no process treats it as stale either.
                let _ = file.as_file().lock();
            }
            // Another process may have removed it as stale before it was locked.
            if file.path().exists() {
                return Ok(Self { file, target, _unfinished: unfinished });
            }
        }
    }

    /// Renames the file, or copies it to the stream.
    fn finish(self) -> io::Result<()> {
        match &self.target {
            Target::File(path) => self.file.persist(path).map(drop).map_err(|error| error.error),
            Target::Stream(path) => {
                let mut stream = OpenOptions::new().write(true).open(path)?;
                io::copy(&mut File::open(self.file.path())?, &mut stream).map(drop)
            }
        }
    }
}

/// Target of a path.
enum Target {
    /// A regular file, or one that is yet to be made.
    File(PathBuf),
    /// A pipe or a device.
    Stream(PathBuf),
}

impl Target {
    fn of(path: &Path) -> io::Result<Self> {
        match fs::metadata(path) {
            Ok(found) if found.is_file() => fs::canonicalize(path).map(Self::File),
            Ok(found) if !found.is_dir() => Ok(Self::Stream(path.to_owned())),
            _ => Ok(Self::File(follow(path))),
        }
    }
}

/// Follows a link whose target does not exist yet; returns any other path itself.
fn follow(path: &Path) -> PathBuf {
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = folder_of(&path).join(next),
            Err(_) => break,
        }
    }
    path
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// As much of a file's name as leaves room for what is put around it: file systems allow 255 bytes.
fn short_name(path: &Path) -> String {
    const LONGEST: usize = 200;
    let mut name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    while name.len() > LONGEST {
        name.pop();
    }
    name
}

/// Removes what processes that were killed have left in `folder`. Failures are ignored. Outside Unix a lock would keep this
/// process itself from writing, so that stale files cannot be recognised.
fn remove_stale(folder: &Path) {
    if !cfg!(unix) {
        return;
    }
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        if !is_unfinished(&entry.file_name().to_string_lossy()) || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let Ok(file) = OpenOptions::new().write(true).open(entry.path()) else { continue };
        match file.try_lock() {
            Ok(()) => drop(fs::remove_file(entry.path())),
            Err(TryLockError::WouldBlock | TryLockError::Error(_)) => {}
        }
    }
}

/// Tests whether a file of this name is one of [`Beside`].
fn is_unfinished(name: &str) -> bool {
    let random = name.strip_suffix(ENDING).and_then(|rest| rest.rsplit_once(MARK)).map(|(_, random)| random);
    name.starts_with('.')
        && random.is_some_and(|random| {
            random.len() == RANDOM_LETTERS && random.bytes().all(|letter| letter.is_ascii_alphanumeric())
        })
}

/// The system's own error, without the name of the unfinished file that `tempfile` puts around it.
fn plain(error: io::Error) -> io::Error {
    let inner = error.get_ref().and_then(std::error::Error::source);
    let code = inner.and_then(|inner| inner.downcast_ref::<io::Error>()).and_then(io::Error::raw_os_error);
    code.map_or(error, io::Error::from_raw_os_error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

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
        assert_eq!(names(folder.path()), [""; 0]);
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
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn two_files_of_one_name_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let (index, error) = write_all(&[&path, &path], |_, temporary| fs::write(temporary, "x")).unwrap_err();
        assert_eq!((index, error.to_string().as_str()), (1, "two of the files to write have this name"));
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn what_a_killed_process_left_is_removed_and_what_another_writes_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let kept = [".a.tmp", ".b.glumbra-abc.tmp", "c.glumbra-abcdef.tmp", ".live.png.glumbra-AAAAAA.tmp"];
        let stale = [".a.png.glumbra-a1B2c3.tmp", ".other.glumbra-000000.tmp"];
        for name in kept.iter().chain(&stale) {
            fs::write(path(name), "half").unwrap();
        }
        let live = OpenOptions::new().write(true).open(path(kept[3])).unwrap();
        live.lock().unwrap();
        write_all(&[&path("a.png")], |_, temporary| fs::write(temporary, "a")).unwrap();
        let mut expected: Vec<&str> = kept.into_iter().chain(["a.png"]).collect();
        expected.sort_unstable();
        assert_eq!(names(folder.path()), expected);
    }

    #[test]
    fn a_long_name_can_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ä".repeat(125));
        write_all(&[&path], |_, temporary| fs::write(temporary, "x")).unwrap();
        assert_eq!(names(folder.path()), ["ä".repeat(125)]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_also_to_a_file_that_is_not_there_yet() {
        let folder = tempfile::tempdir().unwrap();
        let elsewhere = folder.path().join("elsewhere");
        fs::create_dir(&elsewhere).unwrap();
        let (first, second) = (folder.path().join("first"), folder.path().join("second"));
        std::os::unix::fs::symlink("second", &first).unwrap();
        std::os::unix::fs::symlink("elsewhere/target", &second).unwrap();
        for text in ["new", "newer"] {
            write_all(&[&first], |_, temporary| fs::write(temporary, text)).unwrap();
            assert_eq!(fs::read_to_string(elsewhere.join("target")).unwrap(), text);
            assert!(first.is_symlink() && second.is_symlink());
        }
        assert_eq!(names(&elsewhere), ["target"]);
        assert_eq!(names(folder.path()), ["elsewhere", "first", "second"]);
    }
}
