//! Files of instances: JSON Lines. What loads is as many objects as the file has lines.
#![no_main]

use libfuzzer_sys::fuzz_target;

const SCENE: &[u8] = b"[[object]]\nmesh = \"box\"\ninstances = \"places.jsonl\"\n";

fuzz_target!(|bytes: &[u8]| {
    glumbra_fuzz::file("places.jsonl", bytes);
    if let Ok(loaded) = glumbra::load(&glumbra_fuzz::file("scene.toml", SCENE), &[]) {
        assert!(loaded.scene.objects.len() <= bytes.len());
    }
});
