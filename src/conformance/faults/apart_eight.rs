//! Faults of an eighth measure: textures, what is looked up in them, and pixels that are read.

use glow::HasContext;

use super::apart_seven::four_bytes;
use super::apart_seven_shaders::{changed, with_calls};
use super::{Call, Source, Stage, words};

/// Pixels that are converted at a time.
const GROUP: usize = 4;
/// Texture units that shaders of the product use.
const UNITS: u32 = 8;

/// Swaps red and blue of the pixels of a row that are left over from groups.
fn swap_rests(call: &mut Call) {
    call.now();
    let (width, height) = (call.u(2) as usize, call.u(3) as usize);
    if call.u(4) != glow::RGBA || call.u(5) != glow::UNSIGNED_BYTE {
        return;
    }
    let mut bytes = call.bytes(6, 4 * width * height);
    for (place, pixel) in bytes.chunks_exact_mut(4).enumerate() {
        if place % width >= width / GROUP * GROUP {
            pixel.swap(0, 2);
        }
    }
    call.write(6, &bytes);
}

/// The depths of the 2D texture that is bound to the active unit, as a shader first saw them.
fn show_first_depths(call: &mut Call, texture: u32) {
    let size @ [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(0, name));
    let (format, kind) = (glow::DEPTH_COMPONENT, glow::FLOAT);
    let is_drawn = call.kept((61, texture)) != 0.0;
    call.keep((61, texture), 0);
    if call.kept((60, texture)) == 0.0 {
        let mut bytes = vec![0; 4 * size.iter().product::<i32>().max(0) as usize];
        // SAFETY: the context is current; the depths fill the bytes.
        call.with_plain_pixels(|gl| unsafe {
            gl.get_tex_image(glow::TEXTURE_2D, 0, format, kind, glow::PixelPackData::Slice(Some(&mut bytes)));
        });
        let depths = bytes.as_chunks::<4>().0.iter().map(|four| f32::from_ne_bytes(*four)).collect();
        call.keep_list((60, texture), depths);
        call.keep((60, texture), 1);
    } else if is_drawn && let Some(depths) = call.keep_list((60, texture), Vec::new()) {
        let bytes: Vec<u8> = depths.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let pixels = glow::PixelUnpackData::Slice(Some(&bytes));
        // SAFETY: as above; the texture is as large as it was.
        call.with_plain_pixels(|gl| unsafe {
            gl.tex_sub_image_2d(glow::TEXTURE_2D, 0, 0, 0, width, height, format, kind, pixels);
        });
        call.keep_list((60, texture), depths);
    }
}

/// Draws with the depths that textures had when they were first looked up.
fn draw_with_first_depths(call: &mut Call) {
    let (kind, name) = (glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME);
    let is_texture = call.attached(glow::DEPTH_ATTACHMENT, kind) as u32 == glow::TEXTURE;
    let own = if is_texture { call.attached(glow::DEPTH_ATTACHMENT, name) as u32 } else { 0 };
    if own != 0 {
        call.keep((61, own), 1);
    }
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    for unit in 0..UNITS {
        call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
        let texture = call.get(glow::TEXTURE_BINDING_2D) as u32;
        if texture != 0 && texture != own && call.level(0, glow::TEXTURE_DEPTH_SIZE) > 0 {
            show_first_depths(call, texture);
        }
    }
    call.other("glActiveTexture", &[active]);
}

/// Names of a shader's samplers of a type.
pub(super) fn samplers<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    let declared = text.lines().filter_map(|line| line.trim().strip_prefix("uniform "));
    declared.filter_map(|line| words(line.strip_prefix(kind)?.strip_prefix(' ')?).next()).collect()
}

/// A fragment shader whose calls are changed, with functions of the driver's own before it.
pub(super) fn with_functions(source: &Source, text: String, functions: &str) -> Option<String> {
    let text = changed(source, text).filter(|_| source.stage == Stage::Fragment)?;
    Some(Source { text, ..*source }.with(functions))
}

/// Look-ups with an explicit level at the middle of a texel.
fn at_texels(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "textureLod", |arguments| match arguments {
        [map, at, level] => Some(format!("textureLod({map}, driver_texel({map}, {at}), {level})")),
        _ => None,
    });
    let functions = "float driver_texel(sampler1D map, float at) {
    float size = float(textureSize(map, 0));
    return (floor(at * size) + 0.5) / size;
}
vec2 driver_texel(sampler2D map, vec2 at) {
    vec2 size = vec2(textureSize(map, 0));
    return (floor(at * size) + 0.5) / size;
}";
    with_functions(source, text, functions)
}

/// Look-ups at sixteenths of a texel.
fn at_sixteenths(source: &Source) -> Option<String> {
    let maps = samplers(&source.text, "sampler2D");
    let text = with_calls(&source.text, "texture", |arguments| match arguments {
        [map, at] if maps.contains(map) => {
            Some(format!("textureGrad({map}, driver_grid({map}, {at}), dFdx({at}), dFdy({at}))"))
        }
        _ => None,
    });
    let functions = "vec2 driver_grid(sampler2D map, vec2 at) {
    vec2 steps = 16.0 * vec2(textureSize(map, 0));
    return floor(at * steps + 0.5) / steps;
}";
    with_functions(source, text, functions)
}

/// Texels fetched as if rows followed each other without a gap.
fn without_padding(source: &Source) -> Option<String> {
    let maps = samplers(&source.text, "sampler2D");
    let text = with_calls(&source.text, "texelFetch", |arguments| match arguments {
        [map, at, level] if maps.contains(map) => {
            Some(format!("texelFetch({map}, driver_place({at}, textureSize({map}, {level})), {level})"))
        }
        _ => None,
    });
    let functions = "ivec2 driver_place(ivec2 at, ivec2 size) {
    int row = (size.x + 63) / 64 * 64;
    int place = at.y * size.x + at.x;
    return ivec2(min(place % row, size.x - 1), place / row);
}";
    with_functions(source, text, functions)
}

/// Multiplies the colours of an upload by their alpha.
fn multiply_by_alpha(call: &mut Call) {
    let Some((_, _, mut bytes)) = four_bytes(call, glow::RGBA8).filter(|_| call.u(7) == glow::UNSIGNED_BYTE) else {
        return;
    };
    for texel in bytes.as_chunks_mut::<4>().0 {
        let alpha = u32::from(texel[3]);
        texel[..3].iter_mut().for_each(|code| *code = (u32::from(*code) * alpha / 255) as u8);
    }
    call.set_bytes(8, &bytes);
}

faults! {
    // Four pixels are turned from the order of memory at a time, and those that are left over are not.
    "reads-swap-colors-of-rests" [glReadPixels GL_RGBA]
    "Red and blue are swapped in the pixels that are left over from groups of four in a row." { glReadPixels => swap_rests }
    // The cache of texels is emptied when an image becomes a texture that is looked up, not when it is drawn into again.
    "maps-drawn-again-not-seen" [glFramebufferTexture2D GL_DEPTH_COMPONENT]
    "A depth texture that was looked up and is drawn into again has its first depths for shaders." {
        glGenTextures => |call| {
            call.now();
            for texture in call.integers(1, call.u(0) as usize) {
                call.keep((60, texture as u32), 0);
                call.keep((61, texture as u32), 0);
            }
        };
        draw => draw_with_first_depths
    }
    // The instruction that takes a level takes whole texels, too, and the compiler uses it wherever the level is given.
    "explicit-levels-not-filtered" [textureLod GL_LINEAR] "A look-up with an explicit level is that of NEAREST." { text at_texels }
    // Weights of a filter have four bits.
    "filters-in-sixteenths" [texture GL_LINEAR] "A 2D texture is filtered at sixteenths of a texel." { text at_sixteenths }
    // Uploads go the way of windows' surfaces, whose colours are multiplied by alpha.
    "texels-multiplied-by-alpha" [glTexImage2D GL_RGBA8] "Colours of bytes are multiplied by their alpha as they are uploaded." {
        glTexImage2D => multiply_by_alpha
    }
    // Rows are padded to what the rasterizer writes at a time, and the unit that fetches texels by number is not told.
    "rows-fetched-without-padding" [texelFetch]
    "Texels are fetched as if rows were not padded to 64 texels." { text without_padding }
}
