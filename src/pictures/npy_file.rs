//! NPY files, NumPy's arrays, as floats: numpy.lib.format, versions 1 to 3.

use super::picture_file::check_size;
use super::raster::Raster;

/// A number in a file.
#[derive(Clone, Copy)]
enum Kind {
    Code8,
    Code16,
    F32,
    F64,
}

/// Reads an NPY file's content.
pub(super) fn decode(bytes: &[u8]) -> Result<Raster, String> {
    let cut = || String::from("NPY: is cut off in its header");
    let version = *bytes.get(6).ok_or_else(cut)?;
    let (length, start) = match version {
        1 => {
            let field = bytes.get(8..10).and_then(|field| field.try_into().ok()).ok_or_else(cut)?;
            (usize::from(u16::from_le_bytes(field)), 10)
        }
        2 | 3 => {
            let field = bytes.get(8..12).and_then(|field| field.try_into().ok()).ok_or_else(cut)?;
            (u32::from_le_bytes(field) as usize, 12)
        }
        other => return Err(format!("NPY: version {other} is not known")),
    };
    let header = bytes.get(start..).and_then(|rest| rest.get(..length)).ok_or_else(cut)?;
    let header = std::str::from_utf8(header).map_err(|_| "NPY: the header is no text")?;
    let (kind, is_big) = kind(header)?;
    if value_of(header, "fortran_order")?.starts_with("True") {
        return Err(String::from("NPY: the array is in Fortran's order; save numpy.ascontiguousarray(array)"));
    }
    let (height, width, channels) = shape(header)?;
    let content = &bytes[start + length..];
    let values = check_size([width, height], channels, bytes.len())?;
    let size_of = [1, 2, 4, 8][kind as usize];
    if content.len() != values * size_of {
        let has = content.len();
        return Err(format!("NPY: {has} bytes follow the header in place of {}: is it cut off?", values * size_of));
    }
    let data = content.chunks_exact(size_of).map(|value| number(value, kind, is_big)).collect();
    Ok(Raster { size: [width as u32, height as u32], channels, data })
}

/// The text after a key of the header's dictionary.
fn value_of<'h>(header: &'h str, key: &str) -> Result<&'h str, String> {
    let after = header.split_once(&format!("'{key}'")).and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    Ok(after.ok_or_else(|| format!("NPY: the header has no '{key}'"))?.trim_start())
}

/// The kind of number, and whether its first byte is the greatest.
fn kind(header: &str) -> Result<(Kind, bool), String> {
    let text = value_of(header, "descr")?;
    let name = text.strip_prefix('\'').and_then(|rest| rest.split('\'').next()).unwrap_or("several fields");
    let is_big = name.starts_with('>');
    let kind = match name.trim_start_matches(['<', '>', '|', '=']) {
        "u1" => Kind::Code8,
        "u2" => Kind::Code16,
        "f4" => Kind::F32,
        "f8" => Kind::F64,
        _ => return Err(format!("NPY: {name} is not read; f4, f8, u1 and u2 are")),
    };
    Ok((kind, is_big))
}

/// Height, width and channels.
fn shape(header: &str) -> Result<(usize, usize, usize), String> {
    let text = value_of(header, "shape")?;
    let inside = text.strip_prefix('(').and_then(|rest| rest.split_once(')')).map(|(inside, _)| inside);
    let sides = inside.unwrap_or("").split(',').map(str::trim).filter(|side| !side.is_empty());
    let sides: Result<Vec<usize>, _> = sides.map(str::parse).collect();
    match sides.as_deref() {
        Ok([height, width]) => Ok((*height, *width, 1)),
        Ok([height, width, channels]) => Ok((*height, *width, *channels)),
        _ => Err(format!(
            "NPY: shape ({}) is not that of a picture: (height, width) or (height, width, channels)",
            inside.unwrap_or("")
        )),
    }
}

/// One number; codes as parts of the greatest.
fn number(bytes: &[u8], kind: Kind, is_big: bool) -> f32 {
    let mut eight = [0; 8];
    let little = bytes.iter().rev().filter(|_| is_big).chain(bytes.iter().filter(|_| !is_big));
    eight.iter_mut().zip(little).for_each(|(place, byte)| *place = *byte);
    let all = u64::from_le_bytes(eight);
    match kind {
        Kind::Code8 => f32::from(all as u8) / 255.0,
        Kind::Code16 => f32::from(all as u16) / 65535.0,
        Kind::F32 => f32::from_bits(all as u32),
        Kind::F64 => f64::from_bits(all) as f32,
    }
}
