//! OBJ files. Material libraries that they name are not there.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = glumbra_fuzz::file("model.obj", bytes);
    if let Ok((mesh, _)) = glumbra::geometry::load_obj(&path) {
        let _ = glumbra::geometry::topology::inspect(&mesh);
    }
});
