//! MTL files, by a model that uses the material `m`, and a texture `t.png` that is there.
#![no_main]

use libfuzzer_sys::fuzz_target;

const MODEL: &[u8] = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\nusemtl n\nf 3/1 2/1 1/1\n";
const TEXTURE: &[u8] = include_bytes!("../seeds/texture.png");

fuzz_target!(|bytes: &[u8]| {
    let model = glumbra_fuzz::file("model.obj", MODEL);
    glumbra_fuzz::file("t.png", TEXTURE);
    glumbra_fuzz::file("m.mtl", bytes);
    let _ = glumbra::geometry::load_obj(&model);
});
