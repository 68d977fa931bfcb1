//! Grid files.
#![no_main]

use glumbra::report::measure::grid;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = glumbra_fuzz::file("grid.toml", bytes);
    if let Ok(settings) = grid::load(&path) {
        for setting in settings.iter().take(100) {
            let _ = glumbra::scene::shadow_settings(&grid::to_inline(setting));
        }
    }
});
