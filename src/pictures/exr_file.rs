//! EXR files as floats: the first layer, at full resolution. Channels are ordered as colours where their names are those of
//! colours (R, G, B, A; Y, A), and else by name.

use std::io::Cursor;

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, read};

use super::picture_file::check_size;
use super::raster::Raster;

/// Names of colours' channels in their order.
const ORDER: [&str; 5] = ["Y", "R", "G", "B", "A"];

/// Reads an EXR file's content.
pub(super) fn decode(bytes: &[u8]) -> Result<Raster, String> {
    let said = |error: exr::error::Error| format!("EXR: {error}");
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(said)?;
    for header in &meta.headers {
        check(header, bytes.len())?;
    }
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.non_parallel().from_buffered(Cursor::new(bytes)).map_err(said)?;
    let layer = image.layer_data;
    let size = [layer.size.width(), layer.size.height()];
    let mut channels: Vec<_> = layer.channel_data.list.iter().collect();
    let place = |name: &str| ORDER.iter().position(|known| *known == name).unwrap_or(ORDER.len());
    channels.sort_by_key(|channel| place(&channel.name.to_string()));
    let values = check_size(size, channels.len(), bytes.len())?;
    let mut data = vec![0.0; values];
    for (offset, channel) in channels.iter().enumerate() {
        let places = data.iter_mut().skip(offset).step_by(channels.len());
        places.zip(channel.sample_data.values_as_f32()).for_each(|(place, value)| *place = value);
    }
    Ok(Raster { size: size.map(|side| side as u32), channels: channels.len(), data })
}

fn check(header: &Header, bytes: usize) -> Result<(), String> {
    let size = [header.layer_size.width(), header.layer_size.height()];
    check_size(size, header.channels.list.len(), bytes)?;
    if header.channels.list.iter().any(|channel| channel.sampling.width() != 1 || channel.sampling.height() != 1) {
        return Err(String::from(
            "EXR: a channel has fewer values than the picture has pixels, which is not supported",
        ));
    }
    let window = header.shared_attributes.display_window;
    let whole = [window.size.width(), window.size.height()];
    if whole != size {
        return Err(format!(
            "EXR: the data window, {}x{}, is not the display window, {}x{}: write the whole picture",
            size[0], size[1], whole[0], whole[1]
        ));
    }
    Ok(())
}
