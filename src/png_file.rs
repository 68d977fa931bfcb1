//! PNG files: the only encoder of the program, and the texts by which a file says what it shows.

use std::io::{self, Write};

/// Texts of a PNG about itself: all that decides its pixels, and no time. An empty text is left out. The encoder adds the
/// program and its version.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PngTexts(Vec<(&'static str, String)>);

impl PngTexts {
    /// Keyword of what a picture is.
    pub const TITLE: &'static str = "Title";
    /// Keyword of the program and its version.
    pub const SOFTWARE: &'static str = "Software";
    /// Keyword of the scene's file.
    pub const SCENE: &'static str = "Scene";
    /// Keyword of changes to the scene, as `--set` takes them.
    pub const OVERRIDES: &'static str = "Overrides";
    /// Keyword of each light's technique.
    pub const TECHNIQUE: &'static str = "Technique";
    /// Keyword of GL_RENDERER and GL_VERSION.
    pub const DRIVER: &'static str = "Driver";

    /// Texts of a picture of which this can be said.
    pub fn titled(title: impl Into<String>) -> Self {
        Self::default().with(Self::TITLE, title)
    }

    /// The same with one more. Keywords have at most 79 letters of Latin-1.
    #[must_use]
    pub fn with(mut self, keyword: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        if !text.is_empty() {
            self.0.push((keyword, text));
        }
        self
    }

    /// Keywords and texts in their order.
    pub fn as_slice(&self) -> &[(&'static str, String)] {
        &self.0
    }
}

/// Channels of a picture, each of 8 or 16 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PngColor {
    Gray,
    GrayAlpha,
    Rgb,
    Rgba,
}

/// Work that goes into a small file. The pixels are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PngEffort {
    Fast,
    Balanced,
    High,
}

/// A picture to encode: rows from the top down.
#[derive(Clone, Copy, Debug)]
pub struct PngPicture<'a> {
    pub size: [u32; 2],
    pub color: PngColor,
    /// 16 bits a channel, in the machine's order, in place of 8.
    pub is_deep: bool,
    pub bytes: &'a [u8],
}

/// Writes a PNG with these texts, and with the program's name unless they have one.
///
/// # Errors
///
/// Bytes that are not of the size, a keyword that a PNG cannot have, and those of `file`.
pub fn write(
    file: impl Write,
    picture: &PngPicture<'_>,
    effort: PngEffort,
    texts: &[(&str, String)],
) -> io::Result<()> {
    let [width, height] = picture.size;
    let mut encoder = png::Encoder::new(file, width, height);
    let (compression, filter) = match effort {
        PngEffort::Fast => (png::Compression::Fast, png::Filter::Up),
        PngEffort::Balanced => (png::Compression::Balanced, png::Filter::Adaptive),
        PngEffort::High => (png::Compression::High, png::Filter::Adaptive),
    };
    encoder.set_compression(compression);
    encoder.set_filter(filter);
    encoder.set_color(match picture.color {
        PngColor::Gray => png::ColorType::Grayscale,
        PngColor::GrayAlpha => png::ColorType::GrayscaleAlpha,
        PngColor::Rgb => png::ColorType::Rgb,
        PngColor::Rgba => png::ColorType::Rgba,
    });
    encoder.set_depth(if picture.is_deep { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    let software = (PngTexts::SOFTWARE, concat!("glumbra ", env!("CARGO_PKG_VERSION")).to_owned());
    let named = texts.iter().any(|(keyword, _)| *keyword == PngTexts::SOFTWARE);
    for (keyword, text) in (!named).then_some(&software).into_iter().chain(texts) {
        // Plain chunks hold Latin-1 only.
        match text.is_ascii() {
            true => encoder.add_text_chunk((*keyword).to_owned(), text.clone())?,
            false => encoder.add_itxt_chunk((*keyword).to_owned(), text.clone())?,
        }
    }
    let mut writer = encoder.write_header()?;
    if picture.is_deep {
        let codes = picture.bytes.as_chunks::<2>().0.iter();
        let swapped: Vec<u8> = codes.flat_map(|code| u16::from_ne_bytes(*code).to_be_bytes()).collect();
        writer.write_image_data(&swapped)?;
    } else {
        writer.write_image_data(picture.bytes)?;
    }
    Ok(writer.finish()?)
}

/// The bytes of an RGB picture of 8 bits a channel as a small PNG.
///
/// # Errors
///
/// As [`write`].
pub fn of_rgb(picture: &image::RgbImage, texts: &PngTexts) -> io::Result<Vec<u8>> {
    let size = [picture.width(), picture.height()];
    let picture = PngPicture { size, color: PngColor::Rgb, is_deep: false, bytes: picture.as_raw() };
    let mut file = Vec::new();
    write(&mut file, &picture, PngEffort::Balanced, texts.as_slice())?;
    Ok(file)
}
