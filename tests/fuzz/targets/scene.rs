//! Scene files and --set: the scene, then after each byte of value 1 a change. What loads is planned, for small pictures.
#![no_main]

use glumbra::plan::{self, Request};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut parts = bytes.split(|byte| *byte == 1);
    let path = glumbra_fuzz::file("scene.toml", parts.next().unwrap_or_default());
    let overrides: Vec<String> = parts.map(|part| String::from_utf8_lossy(part).into_owned()).collect();
    if let Ok(settings) = glumbra::scene::settings(&path, &overrides) {
        let _ = settings.to_toml();
    }
    if let Ok(loaded) = glumbra::load(&path, &overrides) {
        let request = Request { sampled_warnings: false, ..Request::default() };
        if let Ok(plan) = plan::make(&loaded.scene, &request) {
            let _ = plan.summary().to_string();
        }
    }
});
