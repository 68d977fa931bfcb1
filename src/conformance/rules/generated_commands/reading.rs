//! Commands that read every image, by a framebuffer of their own.

use crate::conformance::bench::commands::{Command, Place, Point, Setting};

use super::generate::READER;
use super::image::Image;
use super::pixels;
use super::state::State;

/// Reads one level of one layer.
fn one(place: Place, image: &Image) -> Vec<Command> {
    let depth = image.format.is_depth();
    let point = if depth { Point::Depth } else { Point::Color(0) };
    let mut commands = vec![
        Command::Framebuffer(READER),
        Command::Attach { slot: READER, point, place: Some(place) },
        Command::Bind { draw: true, read: true, slot: READER },
    ];
    if depth {
        commands.push(Command::DrawBuffers([None; 2]));
        commands.push(Command::ReadBuffer(None));
    }
    let [width, height] = image.size_of(State::part(place)[0]).map(|side| side as i32);
    let area = [0, 0, width, height];
    commands.extend(pixels::plain(image.format).into_iter().map(|packing| Command::Read { area, packing }));
    commands
}

/// Parts of images that can be read: those of textures that sampling can reach, and renderbuffers of one sample.
fn parts(state: &State) -> Vec<(Place, &Image)> {
    let mut places = Vec::new();
    for (slot, image) in state.textures.iter().enumerate() {
        let Some(image) = image else { continue };
        for level in image.range[0]..=image.range[1] {
            places.extend((0..image.layers).map(|layer| (Place::Texture { slot, level, layer }, image)));
        }
    }
    for (slot, image) in state.renderbuffers.iter().enumerate() {
        places
            .extend(image.as_ref().filter(|image| image.samples == 0).map(|image| (Place::Renderbuffer(slot), image)));
    }
    places
}

/// Makes all levels of all textures ones that sampling can reach.
pub fn opening(state: &State) -> Vec<Command> {
    let slots = state.textures.iter().enumerate().filter_map(|(slot, image)| Some((slot, image.as_ref()?.levels)));
    slots.map(|(slot, levels)| Command::Set(Setting::Levels(slot, [0, levels - 1]))).collect()
}

/// Reads all that can be read, and binds the framebuffers that were bound before.
pub fn all(state: &State) -> Vec<Command> {
    let mut commands: Vec<_> = parts(state).into_iter().flat_map(|(place, image)| one(place, image)).collect();
    for (reading, bound) in state.bound.into_iter().enumerate() {
        if let Some(slot) = bound.filter(|slot| *slot != READER) {
            commands.push(Command::Bind { draw: reading == 0, read: reading == 1, slot });
        }
    }
    commands
}
