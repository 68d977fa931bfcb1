//! Letters of legends and sheets: Inter (data/fonts/) in two weights, antialiased. Knows no picture.

use ab_glyph::{Font, FontRef, InvalidFont, ScaleFont, point};

/// Thickness of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FontWeight {
    Regular,
    SemiBold,
}

/// Look of a line of text; sizes are those of the font's em.
#[derive(Clone, Copy, Debug)]
pub struct TextStyle {
    pub weight: FontWeight,
    pub size: f32,
    /// RGB, eight bits each.
    pub color: [u8; 3],
}

/// The fonts.
pub struct Letters {
    regular: FontRef<'static>,
    semi_bold: FontRef<'static>,
}

impl Letters {
    /// Reads the fonts, which are compiled into the program.
    ///
    /// # Errors
    ///
    /// A font file that is damaged.
    pub fn load() -> Result<Self, InvalidFont> {
        Ok(Self {
            regular: FontRef::try_from_slice(include_bytes!("../../data/fonts/Inter-Regular.otf"))?,
            semi_bold: FontRef::try_from_slice(include_bytes!("../../data/fonts/Inter-SemiBold.otf"))?,
        })
    }

    /// The letters of `text` that the fonts lack.
    pub fn missing(&self, text: &str) -> Vec<char> {
        let fonts = [&self.regular, &self.semi_bold];
        text.chars().filter(|letter| fonts.iter().any(|font| font.glyph_id(*letter).0 == 0)).collect()
    }

    /// Width of a line in the unit of the style's size.
    pub fn width(&self, style: &TextStyle, text: &str) -> f32 {
        let font = self.scaled(style);
        text.chars().map(|letter| font.h_advance(font.glyph_id(letter))).sum()
    }

    /// `text` in lines of at most `width`, broken at spaces; one word may be longer.
    pub fn wrap(&self, style: &TextStyle, text: &str, width: f32) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.width(style, &format!("{line} {word}")) <= width => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }

    /// Calls `ink` with column and row of each pixel that the text covers, from the left end of its base line, and the
    /// covered share of the pixel, in [0, 1]. `shift`: offset of the letters in pixels.
    pub fn cover(&self, style: &TextStyle, text: &str, shift: [f32; 2], mut ink: impl FnMut(i32, i32, f32)) {
        let font = self.scaled(style);
        let mut x = shift[0];
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            let glyph = id.with_scale_and_position(font.scale(), point(x, shift[1]));
            x += font.h_advance(id);
            if let Some(outline) = font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|column, row, covered| {
                    ink(corner.x as i32 + column as i32, corner.y as i32 + row as i32, covered.clamp(0.0, 1.0));
                });
            }
        }
    }

    fn scaled(&self, style: &TextStyle) -> ab_glyph::PxScaleFont<&FontRef<'static>> {
        let font = match style.weight {
            FontWeight::Regular => &self.regular,
            FontWeight::SemiBold => &self.semi_bold,
        };
        let em = font.units_per_em().unwrap_or(1000.0);
        font.as_scaled(style.size * font.height_unscaled() / em)
    }
}
