//! Pictures. The first byte chooses the name's ending, by which TGA is told.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((first, rest)) = bytes.split_first() else { return };
    let name = ["t.png", "t.jpg", "t.bmp", "t.tga"][usize::from(first % 4)];
    // The sizes that take the memory of a whole machine are refused elsewhere: by the limit on memory.
    let _ = glumbra::geometry::decode_texture(Path::new(name), rest);
});
