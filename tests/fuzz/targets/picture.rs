//! Pictures that `glumbra compare` and `glumbra judge` read: PNG, EXR and NPY, told apart by their first bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = glumbra::pictures::read_bytes(bytes) {
        let raster = file.raster;
        assert_eq!(raster.data.len(), raster.size[0] as usize * raster.size[1] as usize * raster.channels);
    }
});
