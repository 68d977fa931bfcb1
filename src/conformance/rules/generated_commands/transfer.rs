//! Clears, uploads, levels that are made, copies and blits in the model.

use crate::conformance::bench::GlFormat;
use crate::conformance::bench::commands::{Clear, Packing, Place};

use super::pixel::{Bounds, Depth, KnownPixel, Way, channels, filled, step, stored};
use super::state::State;

/// A pixel of the client's memory.
pub fn decoded(packing: &Packing, bytes: &[u8], width: u32, at: [usize; 2]) -> KnownPixel {
    let (components, size) = packing.pixel();
    let from = packing.at(width, at[0], at[1]);
    let bytes = &bytes[from..from + size];
    let word = || u32::from_ne_bytes(bytes[..4].try_into().unwrap_or_default());
    let component = |index: usize| match packing.layout[1] {
        glow::UNSIGNED_BYTE => f64::from(bytes[index]) / 255.0,
        glow::UNSIGNED_SHORT => f64::from(u16::from_ne_bytes([bytes[2 * index], bytes[2 * index + 1]])) / 65535.0,
        glow::UNSIGNED_INT => f64::from(word()) / f64::from(u32::MAX),
        _ => f64::from(f32::from_ne_bytes(bytes[4 * index..4 * index + 4].try_into().unwrap_or_default())),
    };
    let mut pixel = KnownPixel::UNKNOWN;
    match packing.layout[0] {
        glow::DEPTH_STENCIL => {
            pixel.depth = Depth { value: f64::from(word() >> 8) / 16_777_215.0, slack: 0.0, way: Way::Other };
            pixel.stencil = Some(word() as u8);
        }
        glow::DEPTH_COMPONENT => {
            pixel.depth = Depth { value: component(0).clamp(0.0, 1.0), slack: 0.0, way: Way::Other };
        }
        layout => {
            let mut color = [Bounds::ZERO, Bounds::ZERO, Bounds::ZERO, Bounds::ONE];
            for (index, channel) in color.iter_mut().enumerate().take(components) {
                *channel = Bounds::of(component(index));
            }
            if layout == glow::BGRA {
                color.swap(0, 2);
            }
            pixel.color = color;
        }
    }
    pixel
}

/// A pixel of an image of a format, after another is put into it.
pub fn put(format: GlFormat, pixel: KnownPixel, before: KnownPixel) -> KnownPixel {
    if !format.is_depth() {
        let color = pixel.color.map(|value| stored(format, value, None));
        return KnownPixel { color: filled(format, color), ..before };
    }
    let depth = Depth { slack: pixel.depth.slack + step(format), way: Way::Other, ..pixel.depth };
    KnownPixel { depth, stencil: if format.has_stencil() { pixel.stencil } else { None }, ..before }
}

impl State {
    pub fn upload(&mut self, slot: usize, [level, layer]: [u32; 2], area: [u32; 4], packing: &Packing, bytes: &[u8]) {
        self.bind_texture(slot);
        let [x, y, width, height] = area;
        let place = Place::Texture { slot, level, layer };
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let at = [x + column, y + row];
            let Some((before, format)) = self.pixel(place, at) else { return };
            let given = decoded(packing, bytes, width, [column as usize, row as usize]);
            self.set_pixel(place, at, put(format, given, before));
        }
    }

    /// Each level is the mean of two by two texels of the one before [GL 4.6, 8.14.4 recommends the box filter]; sizes are
    /// powers of two.
    pub fn make_levels(&mut self, slot: usize) {
        self.bind_texture(slot);
        let Some(image) = &mut self.textures[slot] else { return };
        let (format, levels, layers) = (image.format, image.levels, image.layers);
        for (level, layer) in (1..levels).flat_map(|level| (0..layers).map(move |layer| (level, layer))) {
            let ([width, height], above) = (image.size_of(level), image.size_of(level - 1));
            let from = image.plane(level - 1, layer).to_vec();
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let index = |dx: u32, dy: u32| {
                    let at = [(2 * x + dx).min(above[0] - 1), (2 * y + dy).min(above[1] - 1)];
                    (at[1] * above[0] + at[0]) as usize
                };
                let four = [index(0, 0), index(1, 0), index(0, 1), index(1, 1)].map(|index| from[index].color);
                let color = std::array::from_fn(|channel| {
                    let sum = four.iter().map(|color| color[channel]).fold(Bounds::ZERO, Bounds::plus);
                    if sum.is_known() {
                        stored(format, sum.times(Bounds::of(0.25)), Some(1.0))
                    } else {
                        Bounds::UNKNOWN
                    }
                });
                image.plane_mut(level, layer)[(y * width + x) as usize].color = filled(format, color);
            }
        }
    }

    pub fn clear(&mut self, clear: Clear) {
        let Some(framebuffer) = self.framebuffer(false).copied() else { return };
        let Some((size, _)) = self.complete(&framebuffer) else { return };
        let (color, depth, stencil) = match clear {
            Clear::Bits([color, depth, stencil]) => (
                color.then_some((None, self.clear_color)),
                depth.then_some(self.clear_depth),
                stencil.then_some(self.clear_stencil),
            ),
            Clear::Color(output, color) => (Some((Some(output as usize), color)), None, None),
            Clear::Depth(depth) => (None, Some(f64::from(depth)), None),
            Clear::Stencil(value) => (None, None, Some(value)),
            Clear::Both(depth, value) => (None, Some(f64::from(depth)), Some(value)),
        };
        for at in (0..size[1])
            .flat_map(|y| (0..size[0]).map(move |x| [x, y]))
            .filter(|at| self.in_scissor(*at))
            .collect::<Vec<_>>()
        {
            if let Some((only, color)) = color {
                for (output, attachment) in framebuffer.outputs.into_iter().enumerate() {
                    let Some(attached) = attachment.and_then(|index| framebuffer.color[index as usize]) else {
                        continue;
                    };
                    if only.is_none_or(|only| only == output) {
                        self.clear_color(attached.place, at, color, self.masks[output]);
                    }
                }
            }
            let Some(attached) = framebuffer.depth else { continue };
            let Some((mut pixel, format)) = self.pixel(attached.place, at) else { continue };
            if let Some(value) = depth.filter(|_| self.depth_mask) {
                pixel.depth = Depth { value: value.clamp(0.0, 1.0), slack: step(format), way: Way::Other };
            }
            if let Some(value) = stencil.filter(|_| attached.stencil) {
                // Clears go through the mask of front faces [GL 4.6, 17.4.3].
                let mask = self.stencil[0].write_mask as u8;
                pixel.stencil = match (pixel.stencil, mask) {
                    (_, 0xFF) => Some(value as u8),
                    (before, _) => before.map(|before| before & !mask | value as u8 & mask),
                };
            }
            self.set_pixel(attached.place, at, pixel);
        }
    }

    fn clear_color(&mut self, place: Place, at: [u32; 2], color: [f32; 4], mask: [bool; 4]) {
        let Some((mut pixel, format)) = self.pixel(place, at) else { return };
        for channel in (0..channels(format)).filter(|channel| mask[*channel]) {
            pixel.color[channel] = stored(format, Bounds::of(f64::from(color[channel])), None);
        }
        pixel.color = filled(format, pixel.color);
        self.set_pixel(place, at, pixel);
    }

    /// The image that is read of a framebuffer: its read buffer, or its depth.
    pub fn read_place(&self, color: bool) -> Option<Place> {
        let framebuffer = self.framebuffer(true)?;
        if color {
            framebuffer.color[framebuffer.read? as usize].map(|of| of.place)
        } else {
            framebuffer.depth.map(|of| of.place)
        }
    }

    pub fn copy(&mut self, [x, y, width, height]: [i32; 4], slot: usize, [level, layer]: [u32; 2], to: [i32; 2]) {
        self.bind_texture(slot);
        let place = Place::Texture { slot, level, layer };
        let Some(color) = self.textures[slot].as_ref().map(|image| !image.format.is_depth()) else { return };
        let Some(from) = self.read_place(color) else { return };
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let at = [(to[0] + column) as u32, (to[1] + row) as u32];
            let Some((given, given_format)) = self.pixel(from, [(x + column) as u32, (y + row) as u32]) else { return };
            let Some((before, format)) = self.pixel(place, at) else { return };
            self.set_pixel(place, at, moved(given, given_format, before, format));
        }
    }

    /// Blits by whole multiples: nothing but the scissor touches a blit [GL 4.6, 18.3.1].
    pub fn blit(&mut self, from: [i32; 4], to: [i32; 4], bits: [bool; 3]) {
        let (Some(reading), Some(drawing)) = (self.framebuffer(true).copied(), self.framebuffer(false).copied()) else {
            return;
        };
        let Some((size, _)) = self.complete(&drawing) else { return };
        let sources = (self.read_place(true).filter(|_| bits[0]), reading.depth);
        let side = |ends: [i32; 4], axis: usize| f64::from(ends[axis + 2] - ends[axis]);
        for at in (0..size[1])
            .flat_map(|y| (0..size[0]).map(move |x| [x, y]))
            .filter(|at| self.in_scissor(*at))
            .collect::<Vec<_>>()
        {
            let place: [f64; 2] = std::array::from_fn(|axis| {
                let share = (f64::from(at[axis]) + 0.5 - f64::from(to[axis])) / side(to, axis);
                if (0.0..1.0).contains(&share) { f64::from(from[axis]) + share * side(from, axis) } else { -1.0 }
            });
            if place.iter().any(|at| *at < 0.0) {
                continue;
            }
            let source = place.map(|at| at.floor() as u32);
            if let Some(place) = sources.0 {
                let Some((given, given_format)) = self.pixel(place, source) else { continue };
                for attached in drawing.outputs.into_iter().flatten().filter_map(|index| drawing.color[index as usize])
                {
                    let Some((before, format)) = self.pixel(attached.place, at) else { continue };
                    self.set_pixel(attached.place, at, moved(given, given_format, before, format));
                }
            }
            if let (Some(from), Some(to)) = (sources.1, drawing.depth) {
                let Some((given, _)) = self.pixel(from.place, source) else { continue };
                let Some((mut pixel, _)) = self.pixel(to.place, at) else { continue };
                if bits[1] {
                    pixel.depth = given.depth;
                }
                if bits[2] && to.stencil {
                    pixel.stencil = given.stencil;
                }
                self.set_pixel(to.place, at, pixel);
            }
        }
    }
}

/// A pixel that is copied into an image of another format, or of the same: then to the bit.
fn moved(given: KnownPixel, from: GlFormat, before: KnownPixel, to: GlFormat) -> KnownPixel {
    if from == to {
        return if to.is_depth() {
            KnownPixel { color: before.color, ..given }
        } else {
            KnownPixel { color: given.color, ..before }
        };
    }
    put(to, KnownPixel { color: filled(from, given.color), ..given }, before)
}
