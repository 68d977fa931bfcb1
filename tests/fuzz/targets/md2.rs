//! MD2 files, their poses, and their bytes written again.
#![no_main]

use std::path::Path;

use glumbra::geometry::md2::{self, Model, NormalSource, Pose};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = md2::read(bytes, Path::new("model.md2")) else { return };
    let again = md2::read(&md2::write(&file), Path::new("again.md2"));
    assert_eq!(again.ok().as_ref(), Some(&file));
    let model = Model::new(file, "model.md2", |_| ());
    let pose = Pose { frames: [0, model.frame_count() - 1], blend: 0.25 };
    for source in [NormalSource::File, NormalSource::Recomputed] {
        let _ = glumbra::geometry::topology::inspect(&model.mesh(&pose, source));
    }
});
