//! Files of exact 32-bit values: EXR, with the cargo feature of that name, and NumPy's NPY.

use std::io::{self, Write};

use super::Output;
use crate::device::Pixels;
use crate::views::View;

/// The channels that a view has, by EXR's names, and the number of floats between pixels.
fn channels(output: &Output<'_>) -> (&'static [(&'static str, usize)], usize) {
    match (output.pixels, output.view) {
        (Pixels::Depth { .. }, _) => (&[("Z", 0)], 1),
        (Pixels::Stencil { .. }, _) => (&[("Y", 0)], 1),
        (_, Some(View::Shade | View::TexelsPerPixel)) => (&[("Y", 0), ("A", 3)], 4),
        (_, Some(View::LightDistance | View::ProjectedMap)) => (&[("Z", 0), ("A", 3)], 4),
        _ => (&[("R", 0), ("G", 1), ("B", 2)], 4),
    }
}

/// One plane of floats a channel.
fn planes(output: &Output<'_>) -> Vec<(&'static str, Vec<f32>)> {
    let (channels, stride) = channels(output);
    let plane = |offset: usize| match output.pixels {
        Pixels::Rgba8 { data, .. } => data[offset..].iter().step_by(stride).map(|v| f32::from(*v) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } | Pixels::Depth { data, .. } => {
            data[offset..].iter().step_by(stride).copied().collect()
        }
        Pixels::Stencil { data, .. } => data.iter().map(|value| f32::from(*value)).collect(),
    };
    channels.iter().map(|(name, offset)| (*name, plane(*offset))).collect()
}

/// One layer with a channel for each plane.
#[cfg(feature = "exr")]
pub fn write_exr(output: &Output<'_>, file: &mut (impl Write + io::Seek)) -> io::Result<()> {
    use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
    let [width, height] = output.pixels.size();
    let channels = planes(output).into_iter().map(|(name, plane)| AnyChannel::new(name, FlatSamples::F32(plane)));
    let layer = Layer::new(
        (width as usize, height as usize),
        LayerAttributes::named(output.view.map_or("picture", View::name)),
        Encoding::SMALL_FAST_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    );
    Image::from_layer(layer).write().non_parallel().to_buffered(file).map_err(io::Error::other)
}

/// An array of shape (height, width), or (height, width, channels) for several, in the format of NumPy's `numpy.lib.format`,
/// version 1.0: little-endian 32-bit floats, in rows.
pub fn write_npy(output: &Output<'_>, file: &mut impl Write) -> io::Result<()> {
    /// Bytes before the header's text: a magic string, the version, the text's length.
    const START: usize = 10;
    /// The array begins at a multiple of so many bytes.
    const ALIGNMENT: usize = 64;
    let [width, height] = output.pixels.size();
    let planes = planes(output);
    let shape = match planes.len() {
        1 => format!("({height}, {width})"),
        channels => format!("({height}, {width}, {channels})"),
    };
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    let end = (START + header.len() + 1).next_multiple_of(ALIGNMENT);
    header += &" ".repeat(end - START - header.len() - 1);
    header.push('\n');
    file.write_all(b"\x93NUMPY\x01\x00")?;
    file.write_all(&u16::try_from(header.len()).map_err(io::Error::other)?.to_le_bytes())?;
    file.write_all(header.as_bytes())?;
    for pixel in 0..(width as usize) * (height as usize) {
        for (_, plane) in &planes {
            file.write_all(&plane[pixel].to_le_bytes())?;
        }
    }
    Ok(())
}
