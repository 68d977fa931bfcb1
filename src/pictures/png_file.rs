//! PNG files as floats, with their text chunks. Palettes, transparent colours and fewer than 8 bits are expanded; colour
//! profiles and gamma chunks are not applied. Of an animation, the first frame.

use std::io::Cursor;

use png::{BitDepth, Transformations};

use super::picture_file::{MOST_VALUES, PictureFile, check_size};
use super::raster::Raster;

/// Reads a PNG file's content.
pub(super) fn decode(bytes: &[u8]) -> Result<PictureFile, String> {
    let said = |error: png::DecodingError| format!("PNG: {error}");
    let limits = png::Limits { bytes: 2 * MOST_VALUES };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(said)?;
    let info = reader.info();
    let (size, is_interlaced) = ([info.width, info.height], info.interlaced);
    let (color, depth) = reader.output_color_type();
    let channels = color.samples();
    let values = check_size(size.map(|side| side as usize), channels, bytes.len())?;
    let mut data: Vec<f32> = Vec::new();
    if is_interlaced {
        let mut whole = vec![0; reader.output_buffer_size().ok_or("PNG: too large")?];
        reader.next_frame(&mut whole).map_err(said)?;
        extend(&mut data, &whole, depth);
    } else {
        while let Some(row) = reader.next_row().map_err(said)? {
            extend(&mut data, row.data(), depth);
        }
    }
    if data.len() != values {
        return Err(format!("PNG: {} values in place of {values}", data.len()));
    }
    reader.finish().map_err(said)?;
    Ok(PictureFile { raster: Raster { size, channels, data }, texts: texts(reader.info()) })
}

/// Adds codes of 8 or 16 bits as parts of the greatest.
fn extend(data: &mut Vec<f32>, bytes: &[u8], depth: BitDepth) {
    match depth {
        BitDepth::Sixteen => {
            let codes = bytes.as_chunks::<2>().0.iter().map(|pair| u16::from_be_bytes(*pair));
            data.extend(codes.map(|code| f32::from(code) / 65535.0));
        }
        _ => data.extend(bytes.iter().map(|code| f32::from(*code) / 255.0)),
    }
}

fn texts(info: &png::Info<'_>) -> Vec<(String, String)> {
    let plain = info.uncompressed_latin1_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.text.clone()));
    let packed = info.compressed_latin1_text.iter().filter_map(|c| Some((c.keyword.clone(), c.get_text().ok()?)));
    let wide = info.utf8_text.iter().filter_map(|c| Some((c.keyword.clone(), c.get_text().ok()?)));
    plain.chain(packed).chain(wide).collect()
}
