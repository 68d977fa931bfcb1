//! The driver's current work, for the message of a crash. Several threads may work at once.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Current steps, each with a unique number.
static STEPS: Mutex<Vec<(u64, String)>> = Mutex::new(Vec::new());

/// The step that ended last. An exception of the driver's C++ code ends all steps on its way to where Rust aborts.
static LAST: Mutex<String> = Mutex::new(String::new());

/// Called when the first step begins (`true`) and when the last one ends (`false`).
static WATCH: OnceLock<fn(bool)> = OnceLock::new();

/// Has `watch` called from now on when the first step begins and when the last one ends.
#[cfg(unix)]
pub(super) fn watch_by(watch: fn(bool)) {
    WATCH.get_or_init(|| watch);
}

fn tell_watch(begins: bool) {
    if let Some(watch) = WATCH.get() {
        watch(begins);
    }
}

/// A step that lasts until this is dropped.
#[must_use]
pub(crate) struct Doing(u64);

/// Notes that the driver works on `what`, for example "opening a context". It may have further lines for earlier attempts.
pub(crate) fn doing(what: impl Into<String>) -> Doing {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let mut steps = STEPS.lock().unwrap_or_else(PoisonError::into_inner);
    steps.push((number, what.into()));
    if steps.len() == 1 {
        tell_watch(true);
    }
    Doing(number)
}

impl Drop for Doing {
    fn drop(&mut self) {
        let mut steps = STEPS.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = steps.iter().position(|(number, _)| *number == self.0) {
            *LAST.lock().unwrap_or_else(PoisonError::into_inner) = steps.remove(at).1;
        }
        if steps.is_empty() {
            tell_watch(false);
        }
    }
}

/// Gives the steps to `report`, latest last; none where another thread is just changing them. Waits for no lock, so that a
/// signal's handler may call it.
pub(super) fn steps(mut tell: impl FnMut(&str)) {
    if let Ok(steps) = STEPS.try_lock() {
        steps.iter().for_each(|(_, what)| tell(what));
    }
}

/// Gives the step that ended last to `report`; none where there was none, or another thread is just ending one.
pub(super) fn last(mut report: impl FnMut(&str)) {
    if let Ok(last) = LAST.try_lock()
        && !last.is_empty()
    {
        report(&last);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_ends_with_its_guard() {
        let told = |text: &str| {
            let mut found = false;
            steps(|what| found |= what == text);
            found
        };
        let outer = doing("a test's outer step");
        let inner = doing("a test's inner step");
        assert!(told("a test's outer step") && told("a test's inner step"));
        drop(outer);
        assert!(!told("a test's outer step") && told("a test's inner step"));
        drop(inner);
        assert!(!told("a test's inner step"));
    }
}
