//! A picture as floats, whatever it was read from, and PNG files of it.

use std::path::Path;

use image::RgbImage;

use crate::device::Pixels;
use crate::output::atomic_write;
use crate::png_file::{self, PngTexts};

/// Channels side by side, rows from the top down. Colours and shade in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// 3 of a colour, 4 with its alpha; 2 of a shade (its value, and 1 where the light reaches or 0); 1 of a grey picture or
    /// a depth. Files may have more.
    pub channels: usize,
    /// The values, `channels` for each pixel.
    pub data: Vec<f32>,
}

impl Raster {
    /// The channels of the pixel in column `x`, row `y`, from the top left; nothing outside the picture.
    pub fn pixel(&self, [x, y]: [u32; 2]) -> &[f32] {
        let first = (y as usize * self.size[0] as usize + x as usize) * self.channels;
        self.data.get(first..first + self.channels).unwrap_or_default()
    }

    /// The channels of each pixel, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = &[f32]> {
        self.data.chunks_exact(self.channels)
    }

    /// Red, green and blue of a picture; shade and alpha of a shade view; a depth.
    pub fn of(pixels: &Pixels, shade: bool) -> Self {
        let keep: &[usize] = if shade { &[0, 3] } else { &[0, 1, 2] };
        let picked = |data: &[f32]| data.chunks_exact(4).flat_map(|p| keep.iter().map(|c| p[*c])).collect();
        let (channels, data) = match pixels {
            Pixels::Rgba8 { data, .. } => {
                (keep.len(), picked(&data.iter().map(|v| f32::from(*v) / 255.0).collect::<Vec<_>>()))
            }
            Pixels::RgbaF32 { data, .. } => (keep.len(), picked(data)),
            Pixels::Depth { data, .. } => (1, data.clone()),
            Pixels::Stencil { data, .. } => (1, data.iter().map(|value| f32::from(*value)).collect()),
        };
        Self { size: pixels.size(), channels, data }
    }

    /// The picture in 8 bits a channel, as [`Raster::to_png`] has it.
    fn to_shown(&self) -> Option<RgbImage> {
        let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let rgb = self.pixels().flat_map(|p| match *p {
            [gray] => [byte(gray); 3],
            [_, 0.0] => [60, 60, 160],
            [gray, _] => [byte(gray); 3],
            [r, g, b] | [r, g, b, _] => [byte(r), byte(g), byte(b)],
            _ => [255, 0, 255],
        });
        RgbImage::from_raw(self.size[0], self.size[1], rgb.collect())
    }

    /// The picture as a PNG file of 8 bits a channel: gray for one or two channels (what the light does not reach is
    /// blue), RGB for three.
    ///
    /// # Errors
    ///
    /// A size that a PNG file cannot have.
    pub fn to_png(&self) -> Result<Vec<u8>, String> {
        self.to_described_png(&PngTexts::default())
    }

    fn to_described_png(&self, texts: &PngTexts) -> Result<Vec<u8>, String> {
        let picture = self.to_shown().ok_or("odd size")?;
        png_file::of_rgb(&picture, texts).map_err(|error| error.to_string())
    }

    /// Writes [`Raster::to_png`]'s file.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), String> {
        self.write_described_png(path, &PngTexts::default())
    }

    /// The same with texts in the file.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    #[doc(hidden)]
    pub fn write_described_png(&self, path: &Path, texts: &PngTexts) -> Result<(), String> {
        let file = self.to_described_png(texts)?;
        let written = atomic_write::write_all(&[path], |_, path| std::fs::write(path, &file));
        written.map_err(|(_, error)| format!("{}: {error}", path.display()))
    }

    /// Difference of each pixel from `other`'s, from black to white at 16/255 and beyond. `None`: the shapes differ.
    pub fn difference(&self, other: &Self) -> Option<Self> {
        if self.size != other.size || self.channels != other.channels {
            return None;
        }
        let data = self.data.iter().zip(&other.data).map(|(a, b)| (a - b).abs() * 255.0 / 16.0);
        Some(Self { data: data.collect(), ..self.clone() }.opaque())
    }

    /// Red, green and blue: of a grey picture its grey thrice, without alpha. `None`: it has more than four channels.
    pub fn to_rgb(&self) -> Option<Self> {
        let rgb = |p: &[f32]| match *p {
            [gray] | [gray, _] => [gray; 3],
            [r, g, b] | [r, g, b, _] => [r, g, b],
            _ => [0.0; 3],
        };
        (1..=4).contains(&self.channels).then(|| Self {
            size: self.size,
            channels: 3,
            data: self.pixels().flat_map(rgb).collect(),
        })
    }

    /// The picture in 8 bits, as [`Raster::to_rgb`]. `None`: it has more than four channels.
    pub fn to_image(&self) -> Option<RgbImage> {
        let byte = |value: &f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let rgb = self.to_rgb()?;
        RgbImage::from_raw(self.size[0], self.size[1], rgb.data.iter().map(byte).collect())
    }

    /// A shade view without its alpha, so that differences of either are seen.
    fn opaque(self) -> Self {
        if self.channels != 2 {
            return self;
        }
        let data = self.pixels().map(|p| p.iter().copied().fold(0.0, f32::max)).collect();
        Self { channels: 1, data, ..self }
    }
}
