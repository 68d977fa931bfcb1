//! Pictures from files, as textures: RGBA8, rows from the bottom up. Knows nothing of materials.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use image::{DynamicImage, ImageReader, Limits};

use super::{Error, text};

/// The most texels a side; what every GL 3 driver of today takes.
const LIMIT: u32 = 16384;

/// A decoded image, RGBA8, rows from the bottom up as GL wants them.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The file's path, or a built-in's name.
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// `4 * width * height` bytes.
    pub rgba: Vec<u8>,
    /// True if any texel's alpha is below 255.
    pub has_alpha: bool,
}

impl Texture {
    /// The channel of a map_d that the alpha test reads: alpha, or red where all is opaque.
    pub fn alpha_channel(&self) -> usize {
        if self.has_alpha { 3 } else { 0 }
    }

    /// The colour at (s, t) by GL's linear filter in f64: weights between the centres of the four nearest texels, the edge's
    /// own beyond it [GL 4.6, 8.14.2]. RGB, each in [0, 1].
    pub fn bilinear(&self, st: DVec2) -> DVec3 {
        let at = st * DVec2::new(f64::from(self.width), f64::from(self.height)) - 0.5;
        let first = at.floor();
        let part = at - first;
        let texel = |x: f64, y: f64| {
            let x = x.clamp(0.0, f64::from(self.width - 1)) as usize;
            let y = y.clamp(0.0, f64::from(self.height - 1)) as usize;
            let place = 4 * (y * self.width as usize + x);
            DVec3::from_array([0, 1, 2].map(|k| f64::from(self.rgba[place + k]) / 255.0))
        };
        let row = |y: f64| texel(first.x, y).lerp(texel(first.x + 1.0, y), part.x);
        row(first.y).lerp(row(first.y + 1.0), part.y)
    }

    /// The greatest value of a channel, in [0, 1].
    pub(super) fn most(&self, channel: usize) -> f32 {
        let most = self.rgba.iter().skip(channel).step_by(4).copied().max();
        most.map_or(1.0, |most| f32::from(most) / 255.0)
    }
}

/// Reads a PNG, JPEG, BMP or TGA, recognised by its first bytes, else by its name's extension.
pub fn load_texture(path: &Path) -> Result<Texture, Error> {
    decode_texture(path, &text::read(path)?)
}

/// [`load_texture`] of a file that is in memory; `path` is its name.
pub fn decode_texture(path: &Path, bytes: &[u8]) -> Result<Texture, Error> {
    let picture = decode(path, bytes)?.flipv();
    let (width, height) = (picture.width(), picture.height());
    let rgba = picture.into_rgba8().into_raw();
    let has_alpha = rgba.chunks_exact(4).any(|texel| texel[3] != 255);
    Ok(Texture { name: path.display().to_string(), width, height, rgba, has_alpha })
}

/// A picture as its file has it, rows from the top down.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<DynamicImage, Error> {
    let picture_error = |source| Error::Picture { path: path.to_owned(), source };
    let mut reader = ImageReader::new(std::io::Cursor::new(bytes));
    if let Ok(format) = image::ImageFormat::from_path(path) {
        reader.set_format(format);
    }
    let reader = reader.with_guessed_format().map_err(|source| Error::Read { path: path.to_owned(), source })?;
    let format = reader.format();
    // The size is read first: a small file may claim a picture that no memory holds.
    let (width, height) = reader.into_dimensions().map_err(picture_error)?;
    if !(1..=LIMIT).contains(&width) || !(1..=LIMIT).contains(&height) {
        return Err(Error::PictureSize { path: path.to_owned(), width, height, limit: LIMIT });
    }
    let mut reader = ImageReader::new(std::io::Cursor::new(bytes));
    if let Some(format) = format {
        reader.set_format(format);
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(16 * u64::from(width) * u64::from(height) + (64 << 20));
    reader.limits(limits);
    reader.decode().map_err(picture_error)
}

/// Finds the file `written` in a material library or model in `folder`. If it does not exist as written, backslashes count as
/// slashes, and case is ignored; then the bare file name is tried in `folder`. `None`: not found.
pub(crate) fn find_file(folder: &Path, written: &str) -> Option<PathBuf> {
    let slashed = written.replace('\\', "/");
    let bare = slashed.rsplit('/').next().unwrap_or_default();
    let as_written = folder.join(written);
    let with_slashes = folder.join(&slashed);
    [as_written, with_slashes]
        .into_iter()
        .find(|path| path.is_file())
        .or_else(|| find_in_any_case(folder, &slashed))
        .or_else(|| {
            let beside = folder.join(bare);
            if beside.is_file() { Some(beside) } else { find_in_any_case(folder, bare) }
        })
}

/// Walks `relative` down from `folder`, each step ignoring case.
fn find_in_any_case(folder: &Path, relative: &str) -> Option<PathBuf> {
    let mut found = folder.to_owned();
    for step in relative.split('/').filter(|step| !step.is_empty() && *step != ".") {
        let exact = found.join(step);
        if exact.exists() {
            found = exact;
            continue;
        }
        let listed = if found.as_os_str().is_empty() { Path::new(".") } else { &found };
        let mut names: Vec<_> =
            std::fs::read_dir(listed).ok()?.filter_map(|entry| Some(entry.ok()?.file_name())).collect();
        names.sort();
        let wanted = step.to_lowercase();
        let name = names.into_iter().find(|name| name.to_string_lossy().to_lowercase() == wanted)?;
        found = found.join(name);
    }
    found.is_file().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_from_the_bottom_up() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.png");
        let mut picture = image::RgbaImage::new(1, 2);
        picture.put_pixel(0, 0, image::Rgba([10, 0, 0, 255]));
        picture.put_pixel(0, 1, image::Rgba([20, 0, 0, 200]));
        picture.save(&path).unwrap();
        let texture = load_texture(&path).unwrap();
        assert_eq!((texture.width, texture.height, texture.has_alpha), (1, 2, true));
        assert_eq!(texture.rgba, [20, 0, 0, 200, 10, 0, 0, 255]);
    }

    #[test]
    fn names_are_found_with_backslashes_and_in_any_case() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("Maps")).unwrap();
        std::fs::write(folder.path().join("Maps/Wood.PNG"), []).unwrap();
        std::fs::write(folder.path().join("Bare.png"), []).unwrap();
        let find = |written| find_file(folder.path(), written);
        let wood = Some(folder.path().join("Maps/Wood.PNG"));
        assert_eq!(find("Maps/Wood.PNG"), wood);
        assert_eq!(find(r".\maps\wood.png"), wood);
        assert_eq!(find(r"C:\work\textures\bare.png"), Some(folder.path().join("Bare.png")));
        assert_eq!(find("stone.png"), None);
    }
}
