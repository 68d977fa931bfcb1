//! Pictures with their own channels and depth: what is read is written in the same format, so that texels that only move
//! keep their values.

use std::path::Path;

use image::{ColorType, DynamicImage};

use crate::geometry::{Error, text, texture};
use crate::png_file::{self, PngColor, PngEffort, PngPicture, PngTexts};

/// A picture of 8 or 16 bits a channel, rows from the top down.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    pub size: [u32; 2],
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub channels: usize,
    /// 16 bits a channel in place of 8.
    pub is_deep: bool,
    /// Codes, from 0 to 255 or 65535.
    pub samples: Vec<u16>,
}

impl Raster {
    /// Reads a PNG, JPEG, BMP or TGA.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, is no such picture, or is too large.
    pub fn load(path: &Path) -> Result<Self, Error> {
        Ok(Self::of_image(texture::decode(path, &text::read(path)?)?))
    }

    /// The picture's codes. Floats become 16 bits.
    pub fn of_image(picture: DynamicImage) -> Self {
        let size = [picture.width(), picture.height()];
        let (channels, is_deep) = match picture.color() {
            ColorType::L8 => (1, false),
            ColorType::La8 => (2, false),
            ColorType::Rgb8 => (3, false),
            ColorType::Rgba8 => (4, false),
            ColorType::L16 => (1, true),
            ColorType::La16 => (2, true),
            ColorType::Rgb16 => (3, true),
            _ => (4, true),
        };
        let samples = match (channels, is_deep) {
            (1, false) => codes(&picture.into_luma8()),
            (2, false) => codes(&picture.into_luma_alpha8()),
            (3, false) => codes(&picture.into_rgb8()),
            (4, false) => codes(&picture.into_rgba8()),
            (1, _) => codes(&picture.into_luma16()),
            (2, _) => codes(&picture.into_luma_alpha16()),
            (3, _) => codes(&picture.into_rgb16()),
            _ => codes(&picture.into_rgba16()),
        };
        Self { size, channels, is_deep, samples }
    }

    /// A picture of the same kind, black.
    pub(super) fn black(&self, size: [u32; 2]) -> Self {
        let count = self.channels * size[0] as usize * size[1] as usize;
        Self { size, samples: vec![0; count], ..*self }
    }

    /// A texel's codes.
    pub fn texel(&self, [x, y]: [u32; 2]) -> &[u16] {
        let first = self.channels * (y as usize * self.size[0] as usize + x as usize);
        &self.samples[first..first + self.channels]
    }

    /// The bytes of a PNG with these texts.
    ///
    /// # Errors
    ///
    /// Those of the encoder.
    pub fn to_png(&self, texts: &PngTexts) -> std::io::Result<Vec<u8>> {
        let color = match self.channels {
            1 => PngColor::Gray,
            2 => PngColor::GrayAlpha,
            3 => PngColor::Rgb,
            _ => PngColor::Rgba,
        };
        let bytes: Vec<u8> = match self.is_deep {
            false => self.samples.iter().map(|code| *code as u8).collect(),
            true => self.samples.iter().flat_map(|code| code.to_ne_bytes()).collect(),
        };
        let picture = PngPicture { size: self.size, color, is_deep: self.is_deep, bytes: &bytes };
        let mut file = Vec::new();
        png_file::write(&mut file, &picture, PngEffort::Balanced, texts.as_slice())?;
        Ok(file)
    }
}

fn codes<T: Copy + Into<u16>>(samples: &[T]) -> Vec<u16> {
    samples.iter().map(|sample| (*sample).into()).collect()
}
