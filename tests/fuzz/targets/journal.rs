//! The journal of a report that was cut short.
#![no_main]

use glumbra::report::store::journal;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    glumbra_fuzz::file("report.journal.jsonl", bytes);
    let _ = journal::done(&glumbra_fuzz::folder(), "f1", |_, _| journal::Known::Row);
});
