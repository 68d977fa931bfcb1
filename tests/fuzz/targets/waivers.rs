//! Waivers of the driver check.
#![no_main]

use glumbra::conformance::waivers;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = glumbra_fuzz::file("waivers.toml", bytes);
    let _ = waivers::load(Some(&path));
});
