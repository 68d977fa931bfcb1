//! Files that are being written beside their names, so that a process that is ended removes them.

use std::ffi::CString;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

static FILES: Mutex<Vec<CString>> = Mutex::new(Vec::new());

/// A file that is unfinished until this is dropped.
#[must_use]
pub(crate) struct Unfinished(Option<CString>);

/// Notes that the file at `path` is to be removed if the process ends now.
pub(crate) fn unfinished(path: &Path) -> Unfinished {
    // A path that cannot be a C string cannot be a file either.
    let name = CString::new(path.as_os_str().as_encoded_bytes()).ok();
    FILES.lock().unwrap_or_else(PoisonError::into_inner).extend(name.clone());
    Unfinished(name)
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut files = FILES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(place) = files.iter().position(|name| Some(name) == self.0.as_ref()) {
            files.swap_remove(place);
        }
    }
}

/// Removes all of them. Takes no memory and waits for no lock, so that a signal's handler may call it.
pub(super) fn remove_all() {
    #[cfg(unix)]
    if let Ok(files) = FILES.try_lock() {
        for name in files.iter() {
            // SAFETY: the name ends with a zero. A file that is gone already is no loss.
            unsafe { libc::unlink(name.as_ptr()) };
        }
    }
}
