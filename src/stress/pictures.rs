//! Pictures that cases make for themselves.

use std::f64::consts::TAU;

use fastrand::Rng;

use crate::png_file::{self, PngColor, PngEffort, PngPicture, PngTexts};

/// Noise in all four channels, as PNG: the same seed is the same picture.
pub fn noise([width, height]: [u32; 2], seed: u64) -> Vec<u8> {
    let mut rng = Rng::with_seed(seed);
    let texels: Vec<u8> = (0..4 * width as usize * height as usize).map(|_| rng.u8(..)).collect();
    let picture = PngPicture { size: [width, height], color: PngColor::Rgba, is_deep: false, bytes: &texels };
    encode(&picture, format!("noise of seed {seed}"))
}

/// Heights of hills that repeat, as PNG of one channel, of 16 bits where `deep`: the same seed is the same picture.
pub fn hills([width, height]: [u32; 2], deep: bool, seed: u64) -> Vec<u8> {
    let mut rng = Rng::with_seed(seed);
    let waves: Vec<[f64; 4]> = (0..4).map(|_| [0, 1, 2, 3].map(|_| rng.f64())).collect();
    let at = |x: u32, y: u32| {
        let [s, t] = [f64::from(x) / f64::from(width), f64::from(y) / f64::from(height)];
        let wave = |[a, b, phase, size]: &[f64; 4]| {
            size * (TAU * ((4.0 * a).floor() * s + (4.0 * b).floor() * t + phase)).sin()
        };
        0.5 + 0.12 * waves.iter().map(wave).sum::<f64>()
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let bytes: Vec<u8> = match deep {
        true => texels.flat_map(|(x, y)| ((65535.0 * at(x, y)) as u16).to_ne_bytes()).collect(),
        false => texels.map(|(x, y)| (255.0 * at(x, y)) as u8).collect(),
    };
    let picture = PngPicture { size: [width, height], color: PngColor::Gray, is_deep: deep, bytes: &bytes };
    encode(&picture, format!("hills of seed {seed}"))
}

fn encode(picture: &PngPicture<'_>, title: String) -> Vec<u8> {
    let mut png = Vec::new();
    // Nothing fails that writes to memory; a case without its picture says so when it is loaded.
    let _ = png_file::write(&mut png, picture, PngEffort::Fast, PngTexts::titled(title).as_slice());
    png
}
