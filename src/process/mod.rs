//! Last messages and clean-up when a process cannot go on: a driver that crashes or stops, memory that runs out, a signal
//! that ends it.
//!
//! The library notes the driver's current work (`doing`), its unfinished files (`unfinished`), and the commands that it runs
//! (`commands`). A command turns this on:
//! by [`guard`] for signals, and by [`Memory`] as its allocator.

mod commands;
mod doing;
mod memory;
mod notes;
mod reading;
#[cfg(unix)]
mod signals;
mod unfinished;
#[doc(hidden)]
pub mod work;

pub(crate) use commands::start;
pub(crate) use doing::doing;
pub use memory::Memory;
pub(crate) use notes::{listen, note};
pub use reading::{Progress, progress};
pub(crate) use reading::{Reading, reading};
#[cfg(unix)]
pub(crate) use signals::uninstall;
pub(crate) use unfinished::{Unfinished, unfinished};

/// Installs handlers: a signal that ends this process prints the current work and removes unfinished files. A limit on the
/// size of files (RLIMIT_FSIZE) becomes an error of the write that meets it. To be called once, before there are threads.
#[cfg(unix)]
pub fn guard() {
    if let Err(warning) = set_patience() {
        say(&[warning.as_bytes()]);
    }
    signals::install();
}

/// Does nothing: this system has no signals.
#[cfg(not(unix))]
pub fn guard() {}

/// Seconds that a driver may do nothing before it is given up, unless GLUMBRA_PATIENCE says otherwise.
const PATIENCE: u32 = 30;

/// Seconds that a driver may do nothing before it is given up: GLUMBRA_PATIENCE, from 1 to 3600. An error if it is set and
/// is no such number.
fn set_patience() -> Result<u32, String> {
    let Some(text) = std::env::var_os("GLUMBRA_PATIENCE") else { return Ok(PATIENCE) };
    let seconds = text.to_str().and_then(|text| text.parse().ok()).filter(|seconds| (1..=3600).contains(seconds));
    seconds.ok_or_else(|| {
        format!(
            "warning: GLUMBRA_PATIENCE={} is no number of seconds from 1 to 3600; {PATIENCE} is used\n",
            text.display()
        )
    })
}

/// Seconds that a driver may do nothing before it is given up.
pub(crate) fn patience() -> u32 {
    set_patience().unwrap_or(PATIENCE)
}

/// Ends the process at once, without what the driver has registered for a regular end: it might wait for ever.
pub fn leave(status: i32) -> ! {
    commands::end_all();
    unfinished::remove_all();
    #[cfg(unix)]
    // SAFETY: ends the process.
    unsafe {
        libc::_exit(status)
    }
    #[cfg(not(unix))]
    std::process::exit(status)
}

/// Name of a signal that ended another process.
#[cfg(unix)]
pub fn signal_name(signal: i32) -> String {
    let ends =
        [(libc::SIGKILL, "SIGKILL"), (libc::SIGTERM, "SIGTERM"), (libc::SIGINT, "SIGINT"), (libc::SIGSYS, "SIGSYS")];
    let known = signals::CRASHES.iter().chain(&ends).find(|(known, _)| *known == signal);
    known.map_or_else(|| format!("signal {signal}"), |(_, name)| (*name).to_owned())
}

/// Writes on standard error without taking memory or a lock.
fn say(parts: &[&[u8]]) {
    for part in parts {
        #[cfg(unix)]
        // SAFETY: the pointer and length are of one slice. What cannot be written is lost: there is nowhere else to say it.
        unsafe {
            libc::write(libc::STDERR_FILENO, part.as_ptr().cast(), part.len());
        }
        #[cfg(not(unix))]
        {
            use std::io::Write;
            let _ = std::io::stderr().write_all(part);
        }
    }
}

/// Writes `number` in decimal digits at the end of `buffer`, and gives these digits. Takes no memory.
fn digits(mut number: usize, buffer: &mut [u8; 20]) -> &[u8] {
    let mut start = buffer.len();
    while start > 0 {
        start -= 1;
        buffer[start] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    &buffer[start..]
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn numbers_have_their_digits() {
        for number in [0, 7, 10, 64_000_000, usize::MAX] {
            assert_eq!(digits(number, &mut [0; 20]), number.to_string().as_bytes());
        }
    }
}
