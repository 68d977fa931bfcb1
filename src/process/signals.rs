//! Signals that end the process, and an alarm that detects a driver that waits for ever.
//!
//! Mesa's llvmpipe waits without end for threads that could not be started (seen under a limit on memory). Such a process
//! uses no processor time at all, which a driver that draws, however slowly, does.

use std::mem::MaybeUninit;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicI64, AtomicU32, Ordering};

use libc::{c_int, c_void, siginfo_t};

use super::{commands, digits, doing, patience, say, unfinished};

/// Faults of the process itself, with their names.
pub(super) const CRASHES: [(c_int, &str); 5] = [
    (libc::SIGSEGV, "SIGSEGV"),
    (libc::SIGBUS, "SIGBUS"),
    (libc::SIGILL, "SIGILL"),
    (libc::SIGFPE, "SIGFPE"),
    (libc::SIGABRT, "SIGABRT"),
];

/// Requests to end.
const ENDS: [c_int; 3] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];

/// Successive checks without used processor time after which a working driver is given up.
const MOST_IDLE_TICKS: u32 = 6;
/// Processor time between two checks that counts as none, in microseconds; the check itself uses some.
const IDLE_MICROSECONDS: i64 = 1_000;

/// Seconds between two checks of the processor time: a sixth of [`patience`], rounded up.
static TICK_SECONDS: AtomicU32 = AtomicU32::new(0);

/// Successive checks that found no processor time used.
static IDLE_TICKS: AtomicU32 = AtomicU32::new(0);

pub(super) fn install() {
    for signal in CRASHES.iter().map(|(signal, _)| *signal).chain(ENDS) {
        handle(signal, on_end);
    }
    handle(libc::SIGALRM, on_alarm);
    TICK_SECONDS.store(patience().div_ceil(MOST_IDLE_TICKS), Ordering::Relaxed);
    doing::watch_by(watch);
    // SAFETY: an ignored SIGXFSZ makes a write beyond the limit fail with EFBIG.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// Starts or stops the checks of the processor time. Alarms come only while the driver is at work.
fn watch(begins: bool) {
    IDLE_TICKS.store(0, Ordering::Relaxed);
    // SAFETY: takes a number; 0 takes the alarm back.
    unsafe { libc::alarm(if begins { TICK_SECONDS.load(Ordering::Relaxed) } else { 0 }) };
}

/// In a child made by fork: the parent reports a crash.
pub(crate) fn uninstall() {
    for signal in CRASHES.iter().map(|(signal, _)| *signal).chain(ENDS).chain([libc::SIGALRM]) {
        // SAFETY: the default action is always allowed.
        unsafe { libc::signal(signal, libc::SIG_DFL) };
    }
}

type Handler = extern "C" fn(c_int, *mut siginfo_t, *mut c_void);

/// Former handler of each signal, by its number; the standard library finds overflowing stacks by SIGSEGV.
static mut BEFORE: [MaybeUninit<libc::sigaction>; 32] = [const { MaybeUninit::uninit() }; 32];

fn before(signal: c_int) -> *mut libc::sigaction {
    // SAFETY: the numbers of CRASHES, ENDS and SIGALRM are below 32 on every Unix.
    unsafe { (&raw mut BEFORE).cast::<libc::sigaction>().add(signal as usize) }
}

fn handle(signal: c_int, handler: Handler) {
    // SAFETY: the structures are filled before they are used; BEFORE is written only here, before there are threads.
    unsafe {
        let mut old = MaybeUninit::<libc::sigaction>::zeroed();
        if libc::sigaction(signal, null_mut(), old.as_mut_ptr()) != 0 {
            return;
        }
        // nohup and shells have programs ignore signals; that stays.
        if (*old.as_ptr()).sa_sigaction == libc::SIG_IGN {
            return;
        }
        before(signal).write(old.assume_init());
        let mut new = MaybeUninit::<libc::sigaction>::zeroed();
        let action = &mut *new.as_mut_ptr();
        action.sa_sigaction = handler as usize;
        action.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK | libc::SA_RESTART;
        libc::sigemptyset(&mut action.sa_mask);
        libc::sigaction(signal, action, null_mut());
    }
}

/// Prints the current work, removes unfinished files, and passes the signal on to its former handler.
extern "C" fn on_end(signal: c_int, info: *mut siginfo_t, _: *mut c_void) {
    if let Some((_, name)) = CRASHES.iter().find(|(known, _)| *known == signal) {
        let crashed = b"error: the OpenGL driver crashed (";
        let mut told = false;
        doing::steps(|what| {
            told = true;
            say(&[crashed, name.as_bytes(), b") while ", what.as_bytes(), b"\n"]);
        });
        if signal == libc::SIGABRT && !told {
            doing::last(|what| {
                say(&[crashed, name.as_bytes(), b") at the end of ", what.as_bytes(), b"\n"]);
                say(&[b"Its C++ code may have run out of memory (ulimit -v).\n"]);
            });
        }
    }
    commands::end_all();
    unfinished::remove_all();
    // SAFETY: BEFORE was filled for every signal that comes here. A fault comes again when its instruction is repeated; a
    // signal that was sent has to be sent again, and waits until this handler has returned.
    unsafe {
        libc::sigaction(signal, before(signal), null_mut());
        let was_sent = ENDS.contains(&signal) || info.is_null() || (*info).si_code <= 0;
        if was_sent {
            libc::raise(signal);
        }
    }
}

/// Ends a process whose driver is at work and has used no processor time for a while.
extern "C" fn on_alarm(_: c_int, _: *mut siginfo_t, _: *mut c_void) {
    static USED: AtomicI64 = AtomicI64::new(0);
    let used = processor_microseconds();
    let is_idle = used - USED.swap(used, Ordering::Relaxed) < IDLE_MICROSECONDS;
    let mut at_work = false;
    doing::steps(|_| at_work = true);
    let ticks = if is_idle && at_work { IDLE_TICKS.fetch_add(1, Ordering::Relaxed) + 1 } else { 0 };
    IDLE_TICKS.store(ticks, Ordering::Relaxed);
    if ticks >= MOST_IDLE_TICKS {
        let seconds = (ticks * TICK_SECONDS.load(Ordering::Relaxed)) as usize;
        let mut buffer = [0; 20];
        let seconds = digits(seconds, &mut buffer);
        doing::steps(|what| {
            let stopped = b"error: the OpenGL driver has done nothing for ";
            say(&[stopped, seconds, b" s while ", what.as_bytes(), b"\n"]);
        });
        say(&[b"Too little memory or too few threads (ulimit -v, ulimit -u) may be why. GLUMBRA_PATIENCE=SECONDS waits longer.\n"]);
        commands::end_all();
        unfinished::remove_all();
        // SAFETY: ends the process; a regular exit would wait for the driver's threads.
        unsafe { libc::_exit(1) };
    }
    if at_work {
        // SAFETY: takes a number.
        unsafe { libc::alarm(TICK_SECONDS.load(Ordering::Relaxed)) };
    }
}

/// Processor time of all threads of this process.
#[allow(clippy::unnecessary_cast)] // both parts have 32 bits on some systems
fn processor_microseconds() -> i64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the structure is this function's own.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as i64 * 1_000_000 + time.tv_nsec as i64 / 1_000
}
