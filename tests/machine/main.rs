//! Tests of what a machine may lack: OSMesa, an X server, a file system that a test may mount. What is lacking here is
//! shown as ignored, with the reason. That is why they stand apart: `#[test]` knows at compile time only.
//!
//! `cargo test --test machine [FILTER]`

use std::process::ExitCode;

use libtest_mimic::{Arguments, Completion, Failed, Trial};

#[cfg(unix)]
mod disks;
mod drivers;

#[path = "../it/support/contexts.rs"]
mod contexts;
#[path = "../it/support/lit_box.rs"]
mod lit_box;
#[path = "../it/fixed_function/pipelines.rs"]
#[allow(dead_code, reason = "tests of the fixed-function pipeline use the rest")]
mod pipelines;
#[cfg(unix)]
#[path = "../it/support/shell.rs"]
#[allow(dead_code, reason = "tests of the machine's faults use the rest")]
mod shell;
#[path = "../it/support/xvfb.rs"]
mod xvfb;

/// Result of a test that does not fail, or cannot run on this machine.
type Done = Result<Completion, Failed>;

/// A name and a test.
type Test = (&'static str, fn() -> Done);

/// A list of tests by name.
macro_rules! tests {
    ($($name:ident),* $(,)?) => { &[$((stringify!($name), $name as fn() -> crate::Done)),*] };
}
use tests;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let mut tests = drivers::tests();
    #[cfg(unix)]
    tests.extend_from_slice(disks::TESTS);
    let trials = tests.into_iter().map(|(name, test)| Trial::ignorable_test(name, test)).collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}
