//! Grid files.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = glumbra_fuzz::file("grid.toml", bytes);
    if let Ok(settings) = glumbra::report::grid::load(&path) {
        for setting in settings.iter().take(100) {
            let _ = glumbra::scene::shadow_settings(&setting.to_inline());
        }
    }
});
