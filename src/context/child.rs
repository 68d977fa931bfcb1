//! Runs work that may crash in a child process first.

/// Does `work` in a copy of this process, and returns whether the copy survived.
///
/// # Errors
///
/// The way it ended: by a signal, or not at all.
#[cfg(unix)]
pub(super) fn survives(work: impl FnOnce()) -> Result<(), String> {
    // SAFETY: the child goes on with this thread alone, and leaves by _exit. Locks that other threads held stay locked in it;
    // should it wait for one, it is ended below.
    match unsafe { libc::fork() } {
        -1 => Err(format!("cannot be tried in a child process: {}", std::io::Error::last_os_error())),
        0 => {
            crate::process::uninstall();
            without_core_file();
            work();
            // SAFETY: ends the child without what this process has registered for its own end.
            unsafe { libc::_exit(0) }
        }
        child => end_of(child),
    }
}

/// Elsewhere there is no fork, and no OSMesa either.
#[cfg(not(unix))]
pub(super) fn survives(_work: impl FnOnce()) -> Result<(), String> {
    Ok(())
}

#[cfg(unix)]
fn without_core_file() {
    let none = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the structure is this function's own.
    unsafe { libc::setrlimit(libc::RLIMIT_CORE, &none) };
}

/// Waits for the end of a child, for a while.
#[cfg(unix)]
fn end_of(child: libc::pid_t) -> Result<(), String> {
    use std::time::{Duration, Instant};
    const BETWEEN: Duration = Duration::from_millis(2);
    let patience = Duration::from_secs(u64::from(crate::process::patience()));
    let start = Instant::now();
    let mut status = 0;
    loop {
        // SAFETY: the child is this process's own and has not been waited for; it is again after it was ended.
        match unsafe { libc::waitpid(child, &mut status, libc::WNOHANG) } {
            0 if start.elapsed() < patience => std::thread::sleep(BETWEEN),
            0 => {
                // SAFETY: as above.
                unsafe {
                    libc::kill(child, libc::SIGKILL);
                    libc::waitpid(child, &mut status, 0);
                }
                return Err(format!("does not answer in {} s, tried in a child process", patience.as_secs()));
            }
            -1 => return Err(format!("cannot be waited for: {}", std::io::Error::last_os_error())),
            _ if libc::WIFSIGNALED(status) => {
                return Err(format!("crashes ({}), tried in a child process", signal_name(libc::WTERMSIG(status))));
            }
            _ => return Ok(()),
        }
    }
}

#[cfg(unix)]
fn signal_name(signal: libc::c_int) -> String {
    match signal {
        libc::SIGSEGV => "SIGSEGV".to_owned(),
        libc::SIGABRT => "SIGABRT".to_owned(),
        libc::SIGBUS => "SIGBUS".to_owned(),
        other => format!("signal {other}"),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::survives;

    #[test]
    fn a_crash_in_a_child_is_told_and_survived() {
        assert_eq!(survives(|| ()), Ok(()));
        let crash = || {
            // SAFETY: ends the child.
            unsafe { libc::raise(libc::SIGSEGV) };
        };
        assert_eq!(survives(crash), Err("crashes (SIGSEGV), tried in a child process".to_owned()));
    }
}
