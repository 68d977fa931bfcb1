//! Pictures as files: PNG to look at, EXR and NPY with exact 32-bit values. Everything is written beside its name and
//! renamed when it is whole (`atomic_write.rs`).

pub(crate) mod atomic_write;
#[doc(hidden)]
pub mod canvas;
mod counts;
mod density;
mod exact;
#[doc(hidden)]
pub mod json;
#[doc(hidden)]
pub mod letters;

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::device::Pixels;
use crate::png_file::{self, PngColor, PngEffort, PngPicture, PngTexts};
use crate::views::View;

/// Reason why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// The file could not be written.
    #[error("{path}: cannot be written: {reason}", path = .path.display())]
    Write { path: PathBuf, reason: String },
    /// The file's folder is missing; it is never made.
    #[error("{path}: the folder {folder} does not exist", path = .path.display(), folder = .folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    /// The name is that of a folder.
    #[error("{path}: is a folder; name a file that ends in .png, .exr or .npy", path = .path.display())]
    Folder { path: PathBuf },
    /// The name has none of the known endings.
    #[error("{path}: cannot tell the format: end it in .png, .exr or .npy", path = .path.display())]
    UnknownFormat { path: PathBuf },
    /// The format is not compiled in.
    #[error(
        "{path}: this build has no .{feature} files: enable glumbra's cargo feature `{feature}`, or write a .png",
        path = .path.display()
    )]
    NotBuilt { path: PathBuf, feature: &'static str },
}

/// A file format, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileFormat {
    /// 8 bits a channel, 16 for depths and distances, which are stretched to be visible.
    Png,
    /// 32-bit float.
    Exr,
    /// NumPy's array, in the pixels' own type.
    Npy,
}

impl FileFormat {
    /// Tests whether the format holds exact 32-bit values.
    pub fn is_exact(self) -> bool {
        self != Self::Png
    }
}

/// The format by the extension of `path`, after a check that a file of that name can be made.
///
/// # Errors
///
/// Another extension, a format that is not compiled in, a folder of that name, or no folder to put it in.
pub fn check_path(path: &Path) -> Result<FileFormat, Error> {
    if path.is_dir() {
        return Err(Error::Folder { path: path.to_owned() });
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let format = match extension.as_deref() {
        Some("png") => FileFormat::Png,
        Some("exr") if cfg!(not(feature = "exr")) => return not_built(path, "exr"),
        Some("exr") => FileFormat::Exr,
        Some("npy") => FileFormat::Npy,
        _ => return Err(Error::UnknownFormat { path: path.to_owned() }),
    };
    match path.parent() {
        Some(folder) if folder != Path::new("") && !folder.is_dir() => {
            Err(Error::NoFolder { path: path.to_owned(), folder: folder.to_owned() })
        }
        _ => Ok(format),
    }
}

fn not_built(path: &Path, feature: &'static str) -> Result<FileFormat, Error> {
    Err(Error::NotBuilt { path: path.to_owned(), feature })
}

/// Tests whether both lead to one file that exists.
#[doc(hidden)]
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| fs::canonicalize(path).ok();
    one == other || place(one).is_some_and(|one| place(other).is_some_and(|other| one == other))
}

/// `a/x.png` and `shade` make `a/x.shade.png`.
#[doc(hidden)]
pub fn beside(path: &Path, name: &str) -> PathBuf {
    let mut file = path.file_stem().unwrap_or_default().to_owned();
    file.push(".");
    file.push(name);
    if let Some(extension) = path.extension() {
        file.push(".");
        file.push(extension);
    }
    path.with_file_name(file)
}

/// A picture with its place and meaning.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// File to write; its ending chooses the format.
    pub path: &'a Path,
    /// The picture's pixels.
    pub pixels: &'a Pixels,
    /// `None`: the main picture.
    pub view: Option<View>,
}

/// Writes all of `outputs`, or none: each beside its name, then all renamed.
///
/// # Errors
///
/// The first file that could not be written; what was written beside is removed.
pub fn write_all(outputs: &[Output<'_>]) -> Result<(), Error> {
    write_described(outputs, &[])
}

/// The same with texts in each PNG: keywords, of at most 79 letters of Latin-1, and what they say. `Software`, glumbra and its
/// version, is in each PNG unless it is one of them.
///
/// # Errors
///
/// As [`write_all`]; a keyword that a PNG cannot have.
pub fn write_described(outputs: &[Output<'_>], texts: &[(&str, String)]) -> Result<(), Error> {
    let paths: Vec<&Path> = outputs.iter().map(|output| output.path).collect();
    atomic_write::write_all(&paths, |index, temporary| write(&outputs[index], texts, temporary))
        .map_err(|(index, error)| failed(paths[index], &error))
}

/// The bytes of a PNG, with texts as by [`write_described`].
///
/// # Errors
///
/// A keyword that a PNG cannot have.
#[doc(hidden)]
pub fn to_png(output: &Output<'_>, texts: &[(&str, String)]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_png(output, texts, &mut bytes)?;
    Ok(bytes)
}

fn failed(path: &Path, error: &io::Error) -> Error {
    Error::Write { path: path.to_owned(), reason: error.to_string() }
}

fn write(output: &Output<'_>, texts: &[(&str, String)], path: &Path) -> io::Result<()> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    match check_path(output.path).map_err(io::Error::other)? {
        FileFormat::Png => write_png(output, texts, &mut file)?,
        #[cfg(feature = "exr")]
        FileFormat::Exr => exact::write_exr(output, &mut file)?,
        #[cfg(not(feature = "exr"))]
        FileFormat::Exr => {} // refused by the check
        FileFormat::Npy => exact::write_npy(output, &mut file)?,
    }
    file.flush()
}

fn write_png(output: &Output<'_>, texts: &[(&str, String)], file: &mut impl Write) -> io::Result<()> {
    let (bytes, (color, is_deep)) = png_bytes(output);
    let picture = PngPicture { size: output.pixels.size(), color, is_deep, bytes: &bytes };
    png_file::write(file, &picture, PngEffort::Fast, texts)
}

/// The picture as RGB; shade as grey and alpha; distances and depths as grey, stretched from their least to their greatest
/// so that they are visible (the other formats have the exact values). With it, the channels, and whether they have 16 bits.
fn png_bytes(output: &Output<'_>) -> (Vec<u8>, (PngColor, bool)) {
    match (output.pixels, output.view) {
        (Pixels::Rgba8 { data, .. }, _) => {
            (data.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect(), (PngColor::Rgb, false))
        }
        (Pixels::Depth { data, .. }, _) => {
            let stretch = Stretch::over(data.iter().copied().filter(|depth| *depth < 1.0));
            let gray = data.iter().flat_map(|depth| to_u16(stretch.apply(*depth)).to_ne_bytes());
            (gray.collect(), (PngColor::Gray, true))
        }
        (Pixels::RgbaF32 { size, data }, Some(View::TexelsPerPixel)) => {
            (density::colored(*size, data, density::ONE).into_bytes(), (PngColor::Rgb, false))
        }
        (Pixels::Stencil { size, data }, Some(View::StencilColors)) => {
            (counts::colored(*size, data).into_bytes(), (PngColor::Rgb, false))
        }
        (Pixels::Stencil { data, .. }, _) => (data.clone(), (PngColor::Gray, false)),
        (Pixels::RgbaF32 { data, .. }, Some(View::Shade)) => {
            (data.chunks_exact(4).flat_map(|p| [to_u8(p[0]), to_u8(p[3])]).collect(), (PngColor::GrayAlpha, false))
        }
        (Pixels::RgbaF32 { data, .. }, Some(View::LightDistance | View::ProjectedMap)) => {
            let pixels = || data.chunks_exact(4);
            let stretch = Stretch::over(pixels().filter(|p| p[3] > 0.0).map(|p| p[0]));
            let gray = pixels().flat_map(|p| [to_u16(stretch.apply(p[0])), to_u16(p[3])]);
            (gray.flat_map(u16::to_ne_bytes).collect(), (PngColor::GrayAlpha, true))
        }
        (Pixels::RgbaF32 { data, .. }, _) => (
            data.chunks_exact(4).flat_map(|p| [to_u8(p[0]), to_u8(p[1]), to_u8(p[2])]).collect(),
            (PngColor::Rgb, false),
        ),
    }
}

/// The picture as its PNG has it; transparent parts are on dark blue.
#[doc(hidden)]
pub fn to_canvas(pixels: &Pixels, view: Option<View>) -> canvas::Canvas {
    const BEHIND: [f32; 3] = [44.0, 50.0, 64.0];
    let (bytes, kind) = png_bytes(&Output { path: Path::new(""), pixels, view });
    let over = |gray: f32, alpha: f32| BEHIND.map(|behind| (behind + alpha * (255.0 * gray - behind)).round() as u8);
    let short = |pair: &[u8]| f32::from(u16::from_ne_bytes([pair[0], pair[1]])) / 65535.0;
    let rgb: Vec<u8> = match kind {
        (PngColor::Gray, false) => bytes.iter().flat_map(|gray| [*gray; 3]).collect(),
        (PngColor::Gray, true) => bytes.chunks_exact(2).flat_map(|pair| over(short(pair), 1.0)).collect(),
        (PngColor::GrayAlpha, false) => {
            bytes.chunks_exact(2).flat_map(|p| over(f32::from(p[0]) / 255.0, f32::from(p[1]) / 255.0)).collect()
        }
        (PngColor::GrayAlpha, true) => {
            bytes.chunks_exact(4).flat_map(|p| over(short(&p[..2]), short(&p[2..]))).collect()
        }
        _ => bytes,
    };
    canvas::Canvas::of_bytes(pixels.size(), rgb)
}

/// A picture without its legend, and the legend.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct Keyed {
    /// The picture.
    pub canvas: canvas::Canvas,
    /// Colours and their words; empty: colours mean nothing special.
    pub legend: Vec<(canvas::Color, String)>,
}

/// The picture as [`to_canvas`] has it, with its legend apart. `one` is what a density of 1 is called; `None`: a texel a pixel.
#[doc(hidden)]
pub fn to_keyed(pixels: &Pixels, view: Option<View>, one: Option<&str>) -> Keyed {
    match (pixels, view) {
        (Pixels::RgbaF32 { size, data }, Some(View::TexelsPerPixel)) => {
            let legend = density::legend(one.unwrap_or(density::ONE));
            let legend = legend.into_iter().map(|(color, name)| (color, name.to_owned())).collect();
            Keyed { canvas: density::plain(*size, data), legend }
        }
        (Pixels::Stencil { size, data }, Some(View::StencilColors)) => {
            Keyed { canvas: counts::plain(*size, data), legend: counts::legend(data) }
        }
        _ => Keyed { canvas: to_canvas(pixels, view), legend: Vec::new() },
    }
}

/// A canvas, its file, and what the file says of it.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct SheetFile {
    /// File to write, a PNG.
    pub path: PathBuf,
    /// The picture.
    pub canvas: canvas::Canvas,
    /// Texts in the file.
    pub texts: PngTexts,
}

/// Writes canvases as PNG, and files of text; all of them, or none.
///
/// # Errors
///
/// As [`write_all`].
#[doc(hidden)]
pub fn write_sheets(sheets: &[SheetFile], files: &[(PathBuf, String)]) -> Result<(), Error> {
    let pictures = sheets.iter().map(|sheet| sheet.path.as_path());
    let paths: Vec<&Path> = pictures.chain(files.iter().map(|(path, _)| path.as_path())).collect();
    let written = atomic_write::write_all(&paths, |index, temporary| match sheets.get(index) {
        Some(SheetFile { canvas, texts, .. }) => {
            let picture =
                PngPicture { size: canvas.size(), color: PngColor::Rgb, is_deep: false, bytes: canvas.bytes() };
            let mut file = BufWriter::new(fs::File::create(temporary)?);
            png_file::write(&mut file, &picture, PngEffort::High, texts.as_slice())?;
            file.flush()
        }
        None => fs::write(temporary, &files[index - sheets.len()].1),
    });
    written.map_err(|(index, error)| failed(paths[index], &error))
}

/// Rounds as GL does (GL 4.6, 2.3.5.2).
fn to_u8(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn to_u16(value: f32) -> u16 {
    (value.clamp(0.0, 1.0) * 65535.0).round() as u16
}

/// Maps the least of some values to 0.1, so that it differs from black, and the greatest to 0.9.
struct Stretch {
    least: f32,
    span: f32,
}

impl Stretch {
    fn over(values: impl Iterator<Item = f32>) -> Self {
        let (least, greatest) =
            values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        Self { least, span: (greatest - least).max(f32::MIN_POSITIVE) }
    }

    fn apply(&self, value: f32) -> f32 {
        if !self.least.is_finite() || value >= 1.0 {
            return 1.0;
        }
        0.1 + 0.8 * (value - self.least) / self.span
    }
}
