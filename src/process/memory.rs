//! The commands' allocator: the system's, with an error instead of an abort if there is no memory left.

use std::alloc::{GlobalAlloc, Layout, System};

use super::{commands, digits, doing, say, unfinished};

/// The system's allocator. A failed allocation ends the process with an error and exit status 1, and its unfinished files
/// are removed.
///
/// The standard library would abort. Going on is impossible: the caller may hold locks, and an allocator must not unwind.
#[derive(Debug)]
pub struct Memory;

// SAFETY: every request is the system allocator's, with the same arguments.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        had(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        had(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller promises.
        had(unsafe { System.realloc(old, layout, size) }, size)
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(old, layout) }
    }
}

fn had(memory: *mut u8, bytes: usize) -> *mut u8 {
    if memory.is_null() {
        run_out(bytes);
    }
    memory
}

#[cold]
fn run_out(bytes: usize) -> ! {
    let mut buffer = [0; 20];
    say(&[b"error: out of memory: ", digits(bytes, &mut buffer), b" bytes more cannot be had"]);
    doing::steps(|what| say(&[b"; while ", what.lines().next().unwrap_or_default().as_bytes()]));
    say(&[b". Smaller pictures (--size) and shadow maps (light.shadow.size) take less.\n"]);
    commands::end_all();
    unfinished::remove_all();
    leave()
}

#[cfg(unix)]
fn leave() -> ! {
    // SAFETY: ends the process; what runs at a regular exit (the driver's own handlers) would want memory.
    unsafe { libc::_exit(1) }
}

#[cfg(not(unix))]
fn leave() -> ! {
    std::process::exit(1)
}
