//! A picture in 8-bit RGB on which legends and captions are drawn.

use std::convert::Infallible;

use embedded_graphics::mono_font::MonoFont;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::{FONT_6X10, FONT_7X13, FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, OriginDimensions, Pixel, Point, RgbColor, Size};
use embedded_graphics::text::{Baseline, Text};
use image::RgbImage;
use image::imageops::{FilterType, resize};

use crate::geometry::Texture;

/// Width and height of a letter in pixels.
pub const LETTER: [u32; 2] = [6, 10];

/// A size of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Font {
    /// 6 by 10 pixels a letter.
    Small,
    /// 7 by 13 pixels a letter.
    Text,
    /// 9 by 18 pixels a letter, bold.
    Title,
}

impl Font {
    /// Width and height of a letter in pixels.
    pub fn letter(self) -> [u32; 2] {
        match self {
            Self::Small => LETTER,
            Self::Text => [7, 13],
            Self::Title => [9, 18],
        }
    }

    fn letters(self) -> &'static MonoFont<'static> {
        match self {
            Self::Small => &FONT_6X10,
            Self::Text => &FONT_7X13,
            Self::Title => &FONT_9X18_BOLD,
        }
    }

    /// `text` in lines of at most `width` pixels, broken at spaces.
    pub fn wrap(self, text: &str, width: u32) -> Vec<String> {
        let most = (width / self.letter()[0]).max(1) as usize;
        let mut lines = vec![String::new()];
        for word in text.split_whitespace() {
            let last = lines.last_mut();
            match last {
                Some(line) if line.is_empty() => line.push_str(word),
                Some(line) if line.len() + 1 + word.len() <= most => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

/// RGB, eight bits each.
pub type Color = [u8; 3];

/// Rows from the top down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    size: [u32; 2],
    bytes: Vec<u8>,
}

impl Canvas {
    /// A canvas of one colour, `size` pixels wide and high.
    pub fn new(size: [u32; 2], color: Color) -> Self {
        let count = size[0] as usize * size[1] as usize;
        Self { size, bytes: color.iter().copied().cycle().take(3 * count).collect() }
    }

    /// From red, green and blue of each pixel; what is missing is black.
    pub fn of_bytes(size: [u32; 2], mut bytes: Vec<u8>) -> Self {
        bytes.resize(3 * size[0] as usize * size[1] as usize, 0);
        Self { size, bytes }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Red, green and blue of each pixel.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// As large as `most` allows, in its own proportions: averaged when it shrinks, in squares when it grows.
    pub fn fitted(&self, most: [u32; 2]) -> Self {
        let scale = (f64::from(most[0]) / f64::from(self.size[0])).min(f64::from(most[1]) / f64::from(self.size[1]));
        let size = self.size.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        let filter = if scale < 1.0 { FilterType::Triangle } else { FilterType::Nearest };
        match RgbImage::from_raw(self.size[0], self.size[1], self.bytes.clone()) {
            Some(image) if size != self.size => {
                Self { size, bytes: resize(&image, size[0], size[1], filter).into_raw() }
            }
            _ => self.clone(),
        }
    }

    /// Red, green and blue of each pixel.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// An opaque texture of it, rows from the bottom up.
    pub fn to_texture(&self, name: &str) -> Texture {
        let [width, height] = self.size;
        let rows = self.bytes.chunks_exact((3 * width as usize).max(1)).rev();
        let rgba = rows.flat_map(|row| row.as_chunks::<3>().0.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255])).collect();
        Texture { name: name.to_owned(), width, height, rgba, has_alpha: false }
    }

    /// Sets one pixel; outside of the picture nothing.
    pub fn set(&mut self, [x, y]: [u32; 2], color: Color) {
        if x < self.size[0] && y < self.size[1] {
            let first = 3 * (y as usize * self.size[0] as usize + x as usize);
            self.bytes[first..first + 3].copy_from_slice(&color);
        }
    }

    /// Fills a rectangle of `size` pixels from its upper left corner.
    pub fn fill(&mut self, [left, top]: [u32; 2], size: [u32; 2], color: Color) {
        for y in top..top.saturating_add(size[1]).min(self.size[1]) {
            for x in left..left.saturating_add(size[0]).min(self.size[0]) {
                self.set([x, y], color);
            }
        }
    }

    /// Copies another picture to `place`, its upper left corner.
    pub fn paste(&mut self, place: [u32; 2], other: &Self) {
        for (index, color) in other.bytes.as_chunks::<3>().0.iter().enumerate() {
            let (x, y) = (index as u32 % other.size[0], index as u32 / other.size[0]);
            self.set([place[0] + x, place[1] + y], *color);
        }
    }

    /// Writes a line of ASCII, its upper left corner at `place`.
    pub fn write(&mut self, place: [u32; 2], text: &str, color: Color) {
        self.write_in(Font::Small, place, text, color);
    }

    /// The same in another font.
    pub fn write_in(&mut self, font: Font, place: [u32; 2], text: &str, color: Color) {
        let style = MonoTextStyle::new(font.letters(), Rgb888::new(color[0], color[1], color[2]));
        let at = Point::new(place[0] as i32, place[1] as i32);
        let Ok(_) = Text::with_baseline(text, at, style, Baseline::Top).draw(self);
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.size[0], self.size[1])
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let bounds = self.bounding_box();
        for Pixel(point, color) in pixels.into_iter().filter(|Pixel(point, _)| bounds.contains(*point)) {
            self.set([point.x as u32, point.y as u32], [color.r(), color.g(), color.b()]);
        }
        Ok(())
    }
}
