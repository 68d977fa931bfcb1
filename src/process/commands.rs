//! Commands that this process runs, each in a process group of its own: what a command has started ends with it, and all
//! ends with this process.

use std::io;
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

/// Process groups of running commands; 0: a free place.
static GROUPS: [AtomicI32; 64] = [const { AtomicI32::new(0) }; 64];

/// A running command. It is ended on drop.
pub(crate) struct Running {
    child: Child,
    /// Its place in [`GROUPS`]; none where all are taken.
    place: Option<usize>,
    has_ended: bool,
}

/// Starts `command` in a process group of its own.
///
/// # Errors
///
/// The system's, for a program that cannot be run.
pub(crate) fn start(command: &mut Command) -> io::Result<Running> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let child = command.spawn()?;
    let group = i32::try_from(child.id()).unwrap_or(0);
    let take = |place: &AtomicI32| place.compare_exchange(0, group, Ordering::Relaxed, Ordering::Relaxed).is_ok();
    let place = GROUPS.iter().position(take);
    Ok(Running { child, place, has_ended: false })
}

impl Running {
    /// Waits for the end; `None` if it does not come until `deadline`.
    ///
    /// # Errors
    ///
    /// The system's.
    pub(crate) fn wait(&mut self, deadline: Instant) -> io::Result<Option<ExitStatus>> {
        const LONGEST: Duration = Duration::from_millis(20);
        let mut pause = Duration::from_millis(1);
        loop {
            if let Some(status) = self.child.try_wait()? {
                self.has_ended = true;
                self.forget();
                return Ok(Some(status));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            std::thread::sleep(pause.min(left));
            pause = (2 * pause).min(LONGEST);
        }
    }

    fn forget(&mut self) {
        if let Some(place) = self.place.take() {
            GROUPS[place].store(0, Ordering::Relaxed);
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !self.has_ended {
            #[cfg(unix)]
            end_group(i32::try_from(self.child.id()).unwrap_or(0));
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
        self.forget();
    }
}

#[cfg(unix)]
fn end_group(group: i32) {
    // 1 and 0 would be other processes than the command's.
    if group > 1 {
        // SAFETY: takes numbers. The group's first process has not been waited for, so that its number is not another's.
        unsafe { libc::kill(-group, libc::SIGKILL) };
    }
}

/// Ends all of them. Takes no memory and waits for no lock, so that a signal's handler may call it.
pub(super) fn end_all() {
    #[cfg(unix)]
    for place in &GROUPS {
        end_group(place.swap(0, Ordering::Relaxed));
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Running {
        start(Command::new("sh").args(["-c", script])).unwrap()
    }

    #[test]
    fn an_end_is_waited_for_and_a_deadline_is_kept() {
        let soon = || Instant::now() + Duration::from_secs(20);
        assert_eq!(shell("exit 3").wait(soon()).unwrap().unwrap().code(), Some(3));
        let begin = Instant::now();
        let mut slow = shell("sleep 60 & sleep 60");
        assert!(slow.wait(Instant::now() + Duration::from_millis(50)).unwrap().is_none());
        drop(slow);
        assert!(begin.elapsed() < Duration::from_secs(20));
    }
}
