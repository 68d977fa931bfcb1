//! Pictures that cases make for themselves.

use fastrand::Rng;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// Noise in all four channels, as PNG: the same seed is the same picture.
pub fn noise([width, height]: [u32; 2], seed: u64) -> Vec<u8> {
    let mut rng = Rng::with_seed(seed);
    let texels: Vec<u8> = (0..4 * width as usize * height as usize).map(|_| rng.u8(..)).collect();
    let mut png = Vec::new();
    // Nothing fails that writes to memory; a case without its picture says so when it is loaded.
    let _ = PngEncoder::new(&mut png).write_image(&texels, width, height, ExtendedColorType::Rgba8);
    png
}
