//! Copies out of the framebuffer that is bound for reading.

use crate::conformance::bench::commands::{Command, Place, TEXTURES};
use crate::conformance::bench::{GlImageDesc, GlShape};

use super::generate::Generator;
use super::state::State;

impl Generator {
    /// A copy of a part, or of all.
    pub fn copy(&mut self, state: &State) {
        if self.random.chance(0.5) {
            return self.copy_all(state);
        }
        let Some((slot, level, layer, size)) = self.place(state) else { return };
        let from = self.area(size);
        let [_, _, width, height] = from;
        let at = [(size[0] as i32, width), (size[1] as i32, height)]
            .map(|(side, part)| self.random.below((side - part + 1) as usize) as i32);
        self.queue.push_back(Command::Copy { from, slot, level, layer, at });
    }

    /// Fills an image of the same size and format, as a shadow map is filled that is drawn in the window's depth buffer. It is
    /// made where there is none.
    fn copy_all(&mut self, state: &State) {
        let Some((size, 0)) = state.framebuffer(true).and_then(|framebuffer| state.complete(framebuffer)) else {
            return;
        };
        let is_depth = self.random.chance(0.6);
        let Some(source) = state.read_place(!is_depth) else { return };
        let Some(format) = state.image(source).map(|image| image.format) else { return };
        let is_source = |slot: usize| matches!(source, Place::Texture { slot: other, .. } if other == slot);
        let mut fitting = Vec::new();
        for slot in (0..TEXTURES).filter(|slot| !is_source(*slot)) {
            let Some(image) = state.textures[slot].as_ref().filter(|image| image.format == format) else { continue };
            let levels = (0..image.levels).filter(|level| image.size_of(*level) == size);
            fitting.extend(levels.flat_map(|level| (0..image.layers).map(move |layer| (slot, level, layer))));
        }
        let copied = |(slot, level, layer): (usize, u32, u32)| {
            let from = [0, 0, size[0] as i32, size[1] as i32];
            Command::Copy { from, slot, level, layer, at: [0; 2] }
        };
        if !fitting.is_empty() {
            let place = self.random.pick(&fitting);
            return self.queue.push_back(copied(place));
        }
        // Textures of odd slots have depths.
        let slots: Vec<usize> = (0..TEXTURES).filter(|slot| (slot % 2 == 1) == is_depth && !is_source(*slot)).collect();
        let (Some(read), false) = (state.bound[1], slots.is_empty()) else { return };
        let slot = self.random.pick(&slots);
        let desc = GlImageDesc { shape: GlShape::Flat, format, size, layers: 1, levels: 1 };
        let fresh = self.random.chance(0.5);
        self.make(Command::Texture { slot, desc, fresh });
        self.queue.push_back(Command::Bind { draw: false, read: true, slot: read });
        self.queue.push_back(copied((slot, 0, 0)));
    }
}
