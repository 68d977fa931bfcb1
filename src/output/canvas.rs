//! A picture in 8-bit RGB on which legends and captions are drawn.

use image::RgbImage;
use image::imageops::{FilterType, resize};

use super::letters::{FontWeight, Letters, TextStyle};
use crate::geometry::Texture;

/// Height of a line of text in pixels.
pub const LINE: u32 = 14;

/// The em of a legend's letters, and their base line below a line's upper edge, in pixels.
const EM: f32 = 11.0;
const BASE: i32 = 10;

/// Look of text; nothing, if the fonts that are compiled in were damaged.
fn style(color: Color) -> Option<(Letters, TextStyle)> {
    Some((Letters::load().ok()?, TextStyle { weight: FontWeight::Regular, size: EM, color }))
}

/// Width of a line of text in pixels, rounded up.
pub fn text_width(text: &str) -> u32 {
    style([0; 3]).map_or(0, |(letters, style)| letters.width(&style, text).ceil() as u32)
}

/// `text` in lines of at most `width` pixels, broken at spaces.
pub fn wrapped(text: &str, width: u32) -> Vec<String> {
    style([0; 3]).map_or_else(Vec::new, |(letters, style)| letters.wrap(&style, text, width as f32))
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

    /// Writes a line of text, its upper left corner at `place`.
    pub fn write(&mut self, place: [u32; 2], text: &str, color: Color) {
        let Some((letters, style)) = style(color) else { return };
        let [left, top] = place.map(|side| i32::try_from(side).unwrap_or(i32::MAX / 2));
        letters.cover(&style, text, [0.0; 2], |column, row, covered| {
            let place = [left.saturating_add(column), top.saturating_add(BASE + row)].map(u32::try_from);
            if let [Ok(x), Ok(y)] = place {
                self.blend([x, y], color, covered);
            }
        });
    }

    /// Covers a share of one pixel, in [0, 1]; outside of the picture nothing.
    fn blend(&mut self, [x, y]: [u32; 2], color: Color, covered: f32) {
        if x < self.size[0] && y < self.size[1] {
            let first = 3 * (y as usize * self.size[0] as usize + x as usize);
            for (old, new) in self.bytes[first..first + 3].iter_mut().zip(color) {
                *old = (f32::from(*old) + covered * (f32::from(new) - f32::from(*old))).round() as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_as_wide_as_it_says_and_stays_on_its_line() {
        let (text, ink) = ("8 and more: 12345 px, Wgjqy", [230, 230, 230]);
        let width = text_width(text);
        let mut canvas = Canvas::new([width + 8, LINE + 8], [0; 3]);
        canvas.write([4, 4], text, ink);
        let inked = |x: u32, y: u32| canvas.bytes()[3 * (y * (width + 8) + x) as usize] > 0;
        let places: Vec<[u32; 2]> =
            (0..LINE + 8).flat_map(|y| (0..width + 8).map(move |x| [x, y])).filter(|[x, y]| inked(*x, *y)).collect();
        assert!(places.len() > 200, "{} pixels", places.len());
        // A letter may reach over its own advance by less than a pixel.
        assert!(places.iter().all(|[x, y]| (3..width + 5).contains(x) && (4..4 + LINE).contains(y)), "{places:?}");
        assert_eq!(Letters::load().map(|letters| letters.missing(text)).unwrap(), Vec::<char>::new());
        assert_eq!(wrapped("one two three", text_width("one two")), ["one two", "three"]);
    }
}
