//! Files of exact 32-bit values, each kind with its cargo feature: EXR and NumPy's NPY.

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

/// An array of shape (height, width), or (height, width, channels) for several.
#[cfg(feature = "npy")]
pub fn write_npy(output: &Output<'_>, file: &mut impl Write) -> io::Result<()> {
    use npyz::WriterBuilder;
    let [width, height] = output.pixels.size().map(u64::from);
    let planes = planes(output);
    let mut shape = vec![height, width];
    if planes.len() > 1 {
        shape.push(planes.len() as u64);
    }
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
    for pixel in 0..(width * height) as usize {
        for (_, plane) in &planes {
            writer.push(&plane[pixel])?;
        }
    }
    writer.finish()
}
