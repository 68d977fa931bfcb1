//! Texels of a level, whole or in pieces: what the client hands over, and what the model keeps of it.

use std::rc::Rc;

use super::formats::{Numbers, TexelFormat};
use super::layouts;
use super::model::Level;
use crate::conformance::bench::GlTexels;
use crate::conformance::random::Random;

/// Random texels of a block, and what is stored of them with its slack.
pub struct Block {
    pub texels: GlTexels,
    pub stored: Vec<[f64; 4]>,
    pub slack: f64,
}

impl Block {
    /// A block of columns, rows and slices; `volume`: glTexImage3D reads it.
    pub fn random(random: &mut Random, format: &TexelFormat, size: [usize; 3], scale: i32, volume: bool) -> Self {
        // As pictures of files come: bytes of four channels, row by row.
        let is_picture = !volume && matches!(format.numbers, Numbers::Unorm | Numbers::Srgb) && random.chance(0.8);
        let layout = if is_picture { [glow::RGBA, glow::UNSIGNED_BYTE] } else { layouts::layout(random, format) };
        let count = size[0] * size[1] * size[2];
        let (mut bytes, mut stored, mut slack) = (Vec::new(), Vec::with_capacity(count), 0.0_f64);
        for _ in 0..count {
            let value = layouts::value(random, format, scale);
            let given = layouts::encode(&mut bytes, layout, value);
            let (kept, off) = format.store(given);
            stored.push(kept);
            slack = slack.max(off);
        }
        let each = bytes.len() / count.max(1);
        if is_picture {
            let texels = GlTexels { layout, store: [4, 0, 0, 0, 0, 0], bytes, in_buffer: None };
            return Self { texels, stored, slack };
        }
        let (bytes, store) = spread(random, &bytes, each, size, volume);
        let in_buffer = random.chance(0.25).then(|| 16 * random.below(9) as u32);
        Self { texels: GlTexels { layout, store, bytes, in_buffer }, stored, slack }
    }
}

/// Lays texels of `each` bytes out by a random pixel store.
fn spread(random: &mut Random, texels: &[u8], each: usize, size: [usize; 3], volume: bool) -> (Vec<u8>, [u32; 6]) {
    let [width, height, depth] = size;
    let alignment = random.pick(&[4, 4, 1, 2, 8]);
    let mut some = |share: f32, most: usize| if random.chance(share) { 1 + random.below(most) } else { 0 };
    let (longer, skip_rows, skip_pixels) = (some(0.4, 7), some(0.25, 4), some(0.25, 5));
    let row = if longer + skip_pixels > 0 { width + longer + skip_pixels } else { 0 };
    let (higher, skip_images) = if volume { (some(0.3, 3), some(0.2, 2)) } else { (0, 0) };
    let image = if higher > 0 { height + skip_rows + higher } else { 0 };
    let stride = (if row > 0 { row } else { width } * each).next_multiple_of(alignment);
    let rows = if image > 0 { image } else { height };
    let mut bytes = vec![0xA5; stride * (rows * (skip_images + depth) + skip_rows)];
    for slice in 0..depth {
        for line in 0..height {
            let from = (slice * height + line) * width * each;
            let to = ((skip_images + slice) * rows + skip_rows + line) * stride + skip_pixels * each;
            bytes[to..to + width * each].copy_from_slice(&texels[from..from + width * each]);
        }
    }
    let store = [alignment, row, skip_rows, skip_pixels, image, skip_images].map(|number| number as u32);
    (bytes, store)
}

impl Level {
    /// A level of these texels.
    pub fn of(size: [usize; 3], texels: Vec<[f64; 4]>, slack: f64) -> Self {
        Self { size, texels: Rc::new(texels), slack, known: true }
    }

    /// Replaces a block.
    pub fn replace(&mut self, at: [usize; 3], size: [usize; 3], slack: f64, texel: impl Fn([usize; 3]) -> [f64; 4]) {
        let [width, height, _] = self.size;
        let texels = Rc::make_mut(&mut self.texels);
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    texels[((at[2] + z) * height + at[1] + y) * width + at[0] + x] = texel([x, y, z]);
                }
            }
        }
        self.slack = self.slack.max(slack);
    }

    /// The next level by a box of two along each axis that is halved: known where sides are powers of two.
    pub fn halved(&self, axes: usize, format: &TexelFormat) -> Self {
        let half = |axis: usize| if axis < axes { (self.size[axis] / 2).max(1) } else { self.size[axis] };
        let size = [half(0), half(1), half(2)];
        let known = self.known && (0..axes).all(|axis| self.size[axis].is_power_of_two());
        let mut texels = vec![[0.0; 4]; size[0] * size[1] * size[2]];
        for (index, texel) in texels.iter_mut().enumerate() {
            let at = [index % size[0], index / size[0] % size[1], index / size[0] / size[1]];
            let mut count = 0.0;
            let step = [0, 1, 2].map(|axis| self.size[axis] / size[axis]);
            for part in 0..step[0] * step[1] * step[2] {
                let by = [part % step[0], part / step[0] % step[1], part / step[0] / step[1]];
                let from = [0, 1, 2].map(|axis| ((at[axis] * step[axis] + by[axis]).min(self.size[axis] - 1)) as i64);
                let there = self.at(from);
                for channel in 0..4 {
                    texel[channel] += there[channel];
                }
                count += 1.0;
            }
            for channel in texel.iter_mut() {
                *channel /= count;
            }
        }
        let most = self.texels.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        // A code of its own bits a level, or what a small float keeps.
        Self { size, texels: Rc::new(texels), slack: self.slack + format.step(most) * 1.5, known }
    }
}
