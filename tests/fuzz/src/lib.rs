//! Shared by the targets: a folder for the files that glumbra reads by name.

use std::cell::LazyCell;
use std::path::{Path, PathBuf};

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| {
        // In memory where the system has that: a target writes thousands of files a second.
        let memory = Path::new("/dev/shm");
        let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        folder.expect("a folder for the input can be made")
    });
}

/// A file of this name that holds `bytes`, in a folder of this process alone.
pub fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    std::fs::write(&path, bytes).expect("the input can be written");
    path
}

/// The folder of [`file`].
pub fn folder() -> PathBuf {
    FOLDER.with(|folder| folder.path().to_owned())
}
