//! A progress bar while a scene's files are read, where that takes long.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::screen::Screen;
use crate::process;

/// Time before the bar is shown, and between two looks at how far reading is.
const TICK: Duration = Duration::from_millis(100);
/// Looks before the bar is shown: most scenes are read by then.
const PATIENCE: u32 = 5;
const TEMPLATE: &str = "reading {msg} [{wide_bar}] {percent} %";

/// A bar on standard error until this is dropped.
pub(super) struct ReadingBar {
    watcher: Option<(Arc<AtomicBool>, JoinHandle<()>)>,
}

impl ReadingBar {
    /// Begins to watch what this process reads. Where no thread can be had there is no bar.
    pub fn start(screen: Screen) -> Self {
        if !screen.shows_progress() {
            return Self { watcher: None };
        }
        let is_read = Arc::new(AtomicBool::new(false));
        let seen = is_read.clone();
        let thread = thread::Builder::new().name(String::from("progress")).spawn(move || watch(screen, &seen));
        Self { watcher: thread.ok().map(|thread| (is_read, thread)) }
    }
}

impl Drop for ReadingBar {
    fn drop(&mut self) {
        if let Some((is_read, thread)) = self.watcher.take() {
            is_read.store(true, Ordering::Relaxed);
            thread.thread().unpark();
            // A bar that has failed does no harm to what was read.
            let _ = thread.join();
        }
    }
}

fn watch(screen: Screen, is_read: &AtomicBool) {
    let mut bar = None;
    for tick in 0.. {
        if is_read.load(Ordering::Relaxed) {
            break;
        }
        thread::park_timeout(TICK);
        if tick < PATIENCE || is_read.load(Ordering::Relaxed) {
            continue;
        }
        let Some(progress) = process::progress() else { continue };
        let bar = bar.get_or_insert_with(|| screen.bar(progress.total, TEMPLATE));
        bar.set_message(progress.what);
        bar.set_length(progress.total);
        bar.set_position(progress.done);
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
}
