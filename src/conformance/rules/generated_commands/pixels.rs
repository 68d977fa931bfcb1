//! Layouts of pixels in memory, and random content.

use crate::conformance::bench::GlFormat;
use crate::conformance::bench::commands::Packing;
use crate::conformance::random::Random;

/// Rows one after another, in the client's memory.
pub const fn tight(layout: [u32; 2]) -> Packing {
    Packing { layout, alignment: 1, row: 0, skip: [0; 2], buffer: None }
}

/// The layouts by which all of an image is read.
pub fn plain(format: GlFormat) -> Vec<Packing> {
    if !format.is_depth() {
        return vec![tight([glow::RGBA, glow::FLOAT]), tight([glow::RGBA, glow::UNSIGNED_BYTE])];
    }
    let mut all = vec![tight([glow::DEPTH_COMPONENT, glow::FLOAT])];
    if format.has_stencil() {
        all.push(tight([glow::STENCIL_INDEX, glow::UNSIGNED_BYTE]));
    }
    all
}

/// A layout that a format can be given or read in.
pub fn packing(random: &mut Random, format: GlFormat, area: [i32; 4], upload: bool) -> Packing {
    let layout = match format {
        GlFormat::Depth24Stencil8 if upload => [glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8],
        GlFormat::Depth24Stencil8 | GlFormat::Depth32FStencil8 if random.below(2) == 0 => {
            [glow::STENCIL_INDEX, glow::UNSIGNED_BYTE]
        }
        GlFormat::Depth24Stencil8 if random.below(2) == 0 => [glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8],
        _ if format.is_depth() => {
            [glow::DEPTH_COMPONENT, random.pick(&[glow::FLOAT, glow::UNSIGNED_INT, glow::UNSIGNED_SHORT])]
        }
        _ => random.pick(&[
            [glow::RGBA, glow::UNSIGNED_BYTE],
            [glow::RGBA, glow::UNSIGNED_BYTE],
            [glow::RGBA, glow::FLOAT],
            [glow::BGRA, glow::UNSIGNED_BYTE],
            [glow::RGB, glow::UNSIGNED_BYTE],
            [glow::RED, glow::FLOAT],
            [glow::RED, glow::UNSIGNED_BYTE],
        ]),
    };
    let width = area[2] as u32;
    let mut packing = tight(layout);
    packing.alignment = random.pick(&[1, 2, 4, 8]);
    if random.below(3) == 0 {
        packing.row = width + random.below(5) as u32;
        packing.skip = [random.below((packing.row - width + 1) as usize) as u32, random.below(3) as u32];
    }
    if random.below(3) == 0 {
        packing.buffer = Some(16 * random.below(4) as u32);
    }
    packing
}

/// Content for a packing: whole numbers of its type, or floats in steps of 1/16.
pub fn bytes(random: &mut Random, packing: &Packing, size: [u32; 2]) -> Vec<u8> {
    let count = packing.bytes(size);
    if packing.layout[1] == glow::FLOAT {
        let depth = packing.layout[0] == glow::DEPTH_COMPONENT;
        let range = if depth { [0.0, 16.0] } else { [-8.0, 32.0] };
        let floats = (0..count.div_ceil(4)).map(|_| random.between(range[0], range[1]).round() / 16.0);
        let mut bytes: Vec<u8> = floats.flat_map(f32::to_ne_bytes).collect();
        bytes.truncate(count);
        return bytes;
    }
    (0..count).map(|_| random.below(256) as u8).collect()
}
