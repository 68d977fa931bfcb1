//! Faults of a seventh measure, by a hand that had seen no rule: textures, samplers and copies into them. Each has a sentence
//! on how a driver comes by it.

use glow::HasContext;

use super::Call;

/// GL_CLAMP: half of what is filtered at an edge is the border.
const CLAMP: u32 = 0x2900;
/// Rows of a tile of texels.
const TILE: usize = 32;
/// Texels of a side that one group of a compute shader writes.
const GROUP: usize = 4;
/// Pixels of a side of a block that is cleared by one bit.
const BLOCK: usize = 8;
/// Texels that a table in the texture unit holds.
const TABLE: usize = 256;

/// Width, height and bytes of texels of four bytes that are uploaded; `None`: there are none.
pub(super) fn four_bytes(call: &Call, internal: u32) -> Option<(usize, usize, Vec<u8>)> {
    let (width, height) = (call.u(3) as usize, call.u(4) as usize);
    let is_meant = call.u(0) == glow::TEXTURE_2D && call.u(2) == internal && call.u(6) == glow::RGBA;
    let is_bytes = [glow::BYTE, glow::UNSIGNED_BYTE].contains(&call.u(7));
    let bytes = if is_meant && is_bytes { call.bytes(8, 4 * width * height) } else { Vec::new() };
    (!bytes.is_empty()).then_some((width, height, bytes))
}

/// Fills the last tile with the rows of the one before, where it is not whole.
fn repeat_whole_tiles(call: &mut Call) {
    let Some((width, height, mut bytes)) = four_bytes(call, glow::RGBA8) else { return };
    let whole = height / TILE * TILE;
    if whole == 0 || whole == height {
        return;
    }
    for row in whole..height {
        let from = 4 * width * (row - TILE);
        bytes.copy_within(from..from + 4 * width, 4 * width * row);
    }
    call.set_bytes(8, &bytes);
}

/// Takes signed bytes of later levels for unsigned ones.
fn unsigned_levels(call: &mut Call) {
    let Some((_, _, bytes)) = four_bytes(call, glow::RGBA8_SNORM).filter(|_| call.i(1) > 0) else { return };
    let bytes: Vec<u8> = bytes.iter().map(|byte| (u32::from(*byte) * 127 / 255) as u8).collect();
    call.set_bytes(8, &bytes);
}

/// Blackens what lies beyond whole groups in the levels that were made.
fn blacken_rests(call: &Call) {
    for level in 1.. {
        let [width, height] =
            [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(level, name).max(0) as usize);
        if width == 0 {
            return;
        }
        let [across, up] = [width, height].map(|side| side / GROUP * GROUP);
        if [across, up] == [width, height] {
            continue;
        }
        let mut texels = vec![0; 4 * width * height];
        let pixels = glow::PixelPackData::Slice(Some(&mut texels));
        // SAFETY: the context is current; the level's texels fill the bytes.
        call.with_plain_pixels(|gl| unsafe {
            gl.get_tex_image(glow::TEXTURE_2D, level, glow::RGBA, glow::UNSIGNED_BYTE, pixels)
        });
        for (place, texel) in texels.chunks_exact_mut(4).enumerate() {
            if place % width >= across || place / width >= up {
                texel.fill(0);
            }
        }
        call.upload(level, [width as i32, height as i32], &texels);
    }
}

/// Keeps every second, fourth and so on of the texels of a line, so that they fit into a table.
fn shorten_line(call: &mut Call) {
    let count = call.u(3) as usize;
    if call.u(6) != glow::FLOAT || call.pointer(7).is_null() || count <= TABLE {
        return;
    }
    let numbers = call.floats(7, count);
    let by = count.div_ceil(TABLE);
    let repeated = (0..count).map(|index| numbers[index / by * by]).collect();
    call.set_floats(7, repeated);
}

/// Zeroes the blocks of a copy in which nothing was drawn since the clear.
fn zero_cleared_blocks(call: &mut Call) {
    call.now();
    let (target, level, cleared) = (call.u(0), call.i(1), call.kept((60, 0)) as f32);
    let gl = call.gl();
    // SAFETY: the context is current; a texture of this target is bound.
    let read = |name| unsafe { gl.get_tex_level_parameter_i32(target, level, name) };
    let size @ [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(read);
    if cleared == 0.0 || read(glow::TEXTURE_DEPTH_SIZE) == 0 || size != [call.i(6), call.i(7)] {
        return;
    }
    let (format, kind, row) = (glow::DEPTH_COMPONENT, glow::FLOAT, width as usize);
    let mut bytes = vec![0; 4 * row * height as usize];
    // SAFETY: as above; the depths fill the bytes.
    call.with_plain_pixels(|gl| unsafe {
        gl.get_tex_image(target, level, format, kind, glow::PixelPackData::Slice(Some(&mut bytes)))
    });
    let mut depths: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|four| f32::from_ne_bytes(*four)).collect();
    for top in (0..height as usize).step_by(BLOCK) {
        for left in (0..row).step_by(BLOCK) {
            let rows = top..(top + BLOCK).min(height as usize);
            let columns = left..(left + BLOCK).min(row);
            let places = || rows.clone().flat_map(|y| columns.clone().map(move |x| y * row + x));
            if places().all(|place| (depths[place] - cleared).abs() < 1e-6) {
                places().for_each(|place| depths[place] = 0.0);
            }
        }
    }
    let bytes: Vec<u8> = depths.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
    let pixels = glow::PixelUnpackData::Slice(Some(&bytes));
    // SAFETY: as above.
    call.with_plain_pixels(|gl| unsafe {
        gl.tex_sub_image_2d(target, level, 0, 0, width, height, format, kind, pixels)
    });
}

faults! {
    // One code of the hardware stands for both ways of clamping, and the bit between them is set for NEAREST alone.
    "edges-filtered-with-border" [GL_CLAMP_TO_EDGE GL_LINEAR glSamplerParameteri]
    "CLAMP_TO_EDGE of a sampler object under LINEAR filters the last texels with the border's colour." {
        glSamplerParameteri => |call| match call.u(1) {
            glow::TEXTURE_MIN_FILTER => call.keep((60, call.u(0)), u32::from(call.u(2) == glow::LINEAR)),
            glow::TEXTURE_WRAP_S | glow::TEXTURE_WRAP_T if call.kept((60, call.u(0))) != 0.0 => {
                call.replace(2, glow::CLAMP_TO_EDGE, CLAMP);
            }
            _ => {}
        }
    }
    // The engine copies whole tiles, and the tile that is left over is still in its buffer from the one before.
    "tiles-in-part-hold-the-one-before" [glTexImage2D GL_RGBA8]
    "Of an image whose rows do not fill the last tile of 32 rows, those in it are those 32 rows before." {
        glTexImage2D => repeat_whole_tiles
    }
    // The descriptor says for each level how it is decoded, and the sign is filled in for the first.
    "levels-beyond-first-unsigned" [glTexImage2D GL_RGBA8_SNORM]
    "Signed bytes of levels beyond the first are read as unsigned." { glTexImage2D => unsigned_levels }
    // A compute shader makes levels in groups of four by four, and the number of groups is rounded down.
    "levels-made-in-whole-groups" [glGenerateMipmap]
    "Made levels are black in the columns and rows that are left over from groups of four." {
        glGenerateMipmap => |call| {
            call.now();
            let is_plain = call.level(0, glow::TEXTURE_INTERNAL_FORMAT) as u32 == glow::RGBA8;
            if call.u(0) == glow::TEXTURE_2D && is_plain { blacken_rests(call) }
        }
    }
    // The blits that make levels leave their own state, and the driver takes it for the program's.
    "depth-test-off-after-levels" [glGenerateMipmap GL_DEPTH_TEST]
    "After glGenerateMipmap the depth test is off until it is switched on again." {
        glGenerateMipmap => |call| {
            call.now();
            call.other("glDisable", &[f64::from(glow::DEPTH_TEST)]);
        }
    }
    // Lines are kept in a table of the texture unit, which was made for palettes.
    "lines-of-256-texels" [glTexImage1D]
    "A 1D texture of more than 256 floats is kept with as few of them as fit." { glTexImage1D => shorten_line }
    // Blocks that a clear left untouched have one bit in place of depths, and the copy reads the depths.
    "cleared-blocks-not-resolved-by-copies" [glCopyTexSubImage2D glClearBufferfv GL_DEPTH_COMPONENT]
    "A copy of depths is 0 in blocks of eight pixels where nothing was drawn since the clear." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            let depth = call.floats(2, 1)[0];
            call.keep((60, 0), depth);
        };
        glCopyTexSubImage2D => zero_cleared_blocks
    }
    // The filter fetches four texels of one tile, and images smaller than a tile take the path for NEAREST.
    "small-images-not-filtered" [GL_LINEAR glTexParameteri]
    "LINEAR of a 2D texture's own parameters is NEAREST where the texture has less than four columns." {
        glTexParameteri => |call| if [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER].contains(&call.u(1))
            && call.u(0) == glow::TEXTURE_2D && (1..4).contains(&call.level(0, glow::TEXTURE_WIDTH))
        {
            call.replace(2, glow::LINEAR, glow::NEAREST);
        }
    }
}
