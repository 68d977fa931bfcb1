//! Files that are being read, and how far: for a progress bar. Several threads may read at once.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Steps, the latest last.
static STEPS: Mutex<Vec<Arc<Step>>> = Mutex::new(Vec::new());

#[derive(Debug)]
struct Step {
    what: String,
    total: u64,
    done: AtomicU64,
}

/// A step that lasts until this is dropped.
#[derive(Debug)]
#[must_use]
pub(crate) struct Reading(Arc<Step>);

/// Notes that `total` bytes of `what`, for example a file's name, are being read.
pub(crate) fn reading(what: impl Into<String>, total: u64) -> Reading {
    let step = Arc::new(Step { what: what.into(), total, done: AtomicU64::new(0) });
    STEPS.lock().unwrap_or_else(PoisonError::into_inner).push(step.clone());
    Reading(step)
}

impl Reading {
    /// Counts `bytes` more as read.
    pub fn advance(&self, bytes: u64) {
        self.0.done.fetch_add(bytes, Ordering::Relaxed);
    }
}

impl Drop for Reading {
    fn drop(&mut self) {
        STEPS.lock().unwrap_or_else(PoisonError::into_inner).retain(|step| !Arc::ptr_eq(step, &self.0));
    }
}

/// A step of reading: its name, the bytes that were read, and all of its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    pub what: String,
    pub done: u64,
    pub total: u64,
}

/// The step that began last; `None`: nothing is being read.
pub fn progress() -> Option<Progress> {
    let steps = STEPS.lock().unwrap_or_else(PoisonError::into_inner);
    steps.last().map(|step| {
        let done = step.done.load(Ordering::Relaxed).min(step.total);
        Progress { what: step.what.clone(), done, total: step.total }
    })
}
