//! Faults of a fifth measure, by hands that had seen no rule: calls. Each has a sentence on how a driver comes by it.

use glow::HasContext;

use super::Call;
use super::fourth::texels;
use crate::context::compatibility::raw;

/// Texture units that are looked at.
const UNITS: u32 = 8;
/// Entries of the cache of transformed vertices, and the bits of an index that it keeps.
const ENTRIES: usize = 32;
const TAG: u32 = 0xFF;

/// Draws with other indices of 32 bits.
fn draw_with(call: &mut Call, indices: &[u32]) {
    let (gl, bytes) = (call.gl(), indices.iter().flat_map(|index| index.to_ne_bytes()).collect::<Vec<u8>>());
    let old = std::num::NonZeroU32::new(call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) as u32).map(glow::NativeBuffer);
    // SAFETY: the context is current; the buffer holds the indices that are drawn.
    let Ok(buffer) = (unsafe { gl.create_buffer() }) else { return };
    unsafe {
        gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(buffer));
        gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &bytes, glow::STREAM_DRAW);
    }
    let offset = call.pointer(3);
    call.set_pointer(3, std::ptr::null());
    call.now();
    call.set_pointer(3, offset);
    // SAFETY: as above.
    unsafe {
        call.gl().bind_buffer(glow::ELEMENT_ARRAY_BUFFER, old);
        call.gl().delete_buffer(buffer);
    }
}

/// The indices of 32 bits that a draw reads from a buffer; none for another draw.
fn indices(call: &Call) -> Vec<u32> {
    if call.u(2) != glow::UNSIGNED_INT || call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) == 0 {
        return Vec::new();
    }
    let mut bytes = vec![0; 4 * call.i(1).max(0) as usize];
    // SAFETY: the context is current; the buffer holds what is drawn.
    unsafe { call.gl().get_buffer_sub_data(glow::ELEMENT_ARRAY_BUFFER, call.pointer(3) as usize as i32, &mut bytes) };
    bytes.chunks_exact(4).map(|four| u32::from_ne_bytes([four[0], four[1], four[2], four[3]])).collect()
}

/// Draws through a cache of vertices that takes two for one whose indices agree in their low bits.
fn draw_cached(call: &mut Call) {
    let found = indices(call);
    let mut cache: std::collections::VecDeque<u32> = std::collections::VecDeque::new();
    let mut fetch = |index: &u32| {
        if let Some(hit) = cache.iter().find(|entry| (**entry ^ index) & TAG == 0) {
            return *hit;
        }
        cache.push_front(*index);
        cache.truncate(ENTRIES);
        *index
    };
    let fetched: Vec<_> = found.iter().map(&mut fetch).collect();
    if fetched != found {
        draw_with(call, &fetched);
    }
}

/// Draws with the indices that lie beyond the first range of their buffer moved to its end.
fn draw_bounded(call: &mut Call) {
    let found = indices(call);
    let Some(most) = found.iter().max() else { return };
    let key = (10, call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) as u32);
    let bound = call.kept(key);
    if bound == 0.0 {
        call.keep(key, f64::from(*most) + 1.0);
    } else if f64::from(*most) >= bound {
        let bounded: Vec<_> = found.iter().map(|index| (*index).min(bound as u32 - 1)).collect();
        draw_with(call, &bounded);
    }
}

/// Tests whether an image that is drawn into is bound to a texture unit.
fn is_bound(call: &Call) -> bool {
    let named = |point| {
        let read = |name| call.attached(point, name);
        (read(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32 == glow::TEXTURE)
            .then(|| read(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME))
    };
    let attached: Vec<_> = [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT].into_iter().filter_map(named).collect();
    !attached.is_empty()
        && on_units(call, |call| attached.contains(&call.get(glow::TEXTURE_BINDING_2D))).contains(&true)
}

/// Texture state that is found with each unit active.
fn on_units<T>(call: &Call, find: impl Fn(&Call) -> T) -> Vec<T> {
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    let found = (0..UNITS).map(|unit| {
        call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
        find(call)
    });
    let found = found.collect();
    call.other("glActiveTexture", &[active]);
    found
}

/// Tests whether a cube map of depths is bound.
fn has_cube_of_depths(call: &Call) -> bool {
    let depths = |call: &Call| {
        let (face, name) = (glow::TEXTURE_CUBE_MAP_POSITIVE_X, glow::TEXTURE_DEPTH_SIZE);
        // SAFETY: the context is current; a cube map is bound.
        call.get(glow::TEXTURE_BINDING_CUBE_MAP) != 0
            && unsafe { call.gl().get_tex_level_parameter_i32(face, 0, name) } > 0
    };
    on_units(call, depths).contains(&true)
}

/// Draws with the 2D textures taken off units that have a cube map too.
fn draw_cubes_alone(call: &mut Call) {
    let names = [glow::TEXTURE_BINDING_CUBE_MAP, glow::TEXTURE_BINDING_2D];
    let bound = on_units(call, |call| names.map(|name| f64::from(call.get(name))));
    let both: Vec<_> = (0..).zip(bound).filter(|(_, [cube, plane])| *cube != 0.0 && *plane != 0.0).collect();
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    let bind = |call: &Call, unit: u32, texture: f64| {
        call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
        call.other("glBindTexture", &[f64::from(glow::TEXTURE_2D), texture]);
    };
    both.iter().for_each(|(unit, _)| bind(call, *unit, 0.0));
    call.now();
    both.iter().for_each(|(unit, [_, plane])| bind(call, *unit, *plane));
    call.other("glActiveTexture", &[active]);
}

/// Clears whole tiles of eight pixels alone.
fn clear_whole_tiles(call: &mut Call) {
    let [_, _, width, height] = call.get4(glow::VIEWPORT);
    if !call.enabled(glow::SCISSOR_TEST) && width >= 8 && height >= 8 && width % 8 + height % 8 > 0 {
        let scissor = call.get4(glow::SCISSOR_BOX).map(f64::from);
        call.other("glScissor", &[0.0, 0.0, f64::from(width / 8 * 8), f64::from(height / 8 * 8)]);
        call.with(glow::SCISSOR_TEST, true);
        call.other("glScissor", &scissor);
    }
}

/// Draws as if the stored alpha were 1 where it has just been written alone.
fn blend_by_stale_alpha(call: &mut Call) {
    let mask = call.get4(glow::COLOR_WRITEMASK).map(|on| on != 0);
    if mask == [false, false, false, true] {
        call.keep((10, 0), 1);
    } else if call.kept((10, 0)) != 0.0 && call.enabled(glow::BLEND) {
        let names = [glow::BLEND_SRC_RGB, glow::BLEND_DST_RGB, glow::BLEND_SRC_ALPHA, glow::BLEND_DST_ALPHA];
        let factors = names.map(|name| call.get(name) as u32);
        if factors[0] == glow::DST_ALPHA {
            call.keep((10, 0), 0);
            let [_, rgb, alpha, stored] = factors.map(f64::from);
            call.other("glBlendFuncSeparate", &[f64::from(glow::ONE), rgb, alpha, stored]);
            call.now();
            call.other("glBlendFuncSeparate", &factors.map(f64::from));
        }
    }
}

/// Rejects the first draw under GEQUAL or GREATER after a clear of depth.
fn reject_first(call: &mut Call) {
    let framebuffer = call.get(glow::DRAW_FRAMEBUFFER_BINDING) as u32;
    let farther = [glow::GEQUAL, glow::GREATER].contains(&(call.get(glow::DEPTH_FUNC) as u32));
    if call.kept((10, framebuffer)) != 0.0 && call.enabled(glow::DEPTH_TEST) {
        call.keep((10, framebuffer), 0);
        if farther {
            call.skip()
        }
    }
}

/// The mean of four texels as if they were encoded as sRGB.
fn mean_of_light(texels: [u8; 4]) -> u8 {
    let light: f32 = texels.iter().map(|texel| (f32::from(*texel) / 255.0).powf(2.2)).sum();
    ((light / 4.0).powf(1.0 / 2.2) * 255.0).round() as u8
}

/// An image of half the size; the last column or row of an odd side is left out.
fn halved(width: usize, height: usize, texels: &[u8], mean: impl Fn([u8; 4]) -> u8) -> Vec<u8> {
    let at = |x: usize, y: usize, channel| texels[4 * (y.min(height - 1) * width + x.min(width - 1)) + channel];
    let places = (0..(height / 2).max(1)).flat_map(|y| (0..(width / 2).max(1)).map(move |x| (2 * x, 2 * y)));
    let four =
        |(x, y), channel| [at(x, y, channel), at(x + 1, y, channel), at(x, y + 1, channel), at(x + 1, y + 1, channel)];
    places.flat_map(|place| [0, 1, 2, 3].map(|channel| mean(four(place, channel)))).collect()
}

/// Makes levels by means of light.
fn brighten_levels(call: &Call) {
    let [mut width, mut height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(0, name) as usize);
    let mut bytes = vec![0; 4 * width * height];
    let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
    // SAFETY: the context is current; the texels fill the bytes.
    call.with_plain_pixels(|gl| unsafe {
        gl.get_tex_image(glow::TEXTURE_2D, 0, glow::RGBA, glow::UNSIGNED_BYTE, pixels)
    });
    let mut level = 0;
    while width.max(height) > 1 {
        level += 1;
        bytes = halved(width, height, &bytes, mean_of_light);
        [width, height] = [width, height].map(|side| (side / 2).max(1));
        call.upload(level, [width as i32, height as i32], &bytes);
    }
}

/// An image in the corner of one whose sides are powers of two.
fn padded(width: usize, height: usize, texels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for row in texels.chunks_exact(4 * width) {
        bytes.extend_from_slice(row);
        bytes.resize(bytes.len() + 4 * (width.next_power_of_two() - width), 0);
    }
    bytes.resize(4 * width.next_power_of_two() * height.next_power_of_two(), 0);
    bytes
}

faults! {
    // The cache of transformed vertices keeps too few bits of the index.
    "vertex-cache-tags-of-8-bits" [glDrawElements GL_UNSIGNED_INT]
    "Of two vertices nearby in a draw whose indices agree in eight bits the first stands for both." {
        glDrawElements => draw_cached
    }
    // The largest index is kept with the buffer, though it belongs to the range that was drawn first.
    "index-bounds-of-first-range" [glDrawElements GL_ELEMENT_ARRAY_BUFFER]
    "Indices beyond those of the first range that was drawn of a buffer are that range's largest." {
        glBufferData => |call| if call.u(0) == glow::ELEMENT_ARRAY_BUFFER {
            call.keep((10, call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) as u32), 0);
        };
        glDrawElements => draw_bounded
    }
    // The filter of redundant uniforms compares eight bytes whatever the type.
    "vectors-compared-by-two" [glUniform3f glUniform4f]
    "A vector is not sent where its first two components are those that it had." {
        glLinkProgram => |call| call.keep((10, call.u(0)), call.kept((10, call.u(0))) + 1.0);
        glUniform3f glUniform4f => |call| {
            let program = call.get(glow::CURRENT_PROGRAM) as u32;
            let key = (1 << 31 | program | (call.kept((10, program)) as u32) << 16, call.u(0));
            let two = vec![call.f(1) as f32, call.f(2) as f32];
            if call.keep_list(key, two.clone()) == Some(two) { call.skip() }
        }
    }
    // The test whether there is an offset at all looks at the factor.
    "offset-lost-with-factor-0" [glPolygonOffset]
    "The units of an offset whose factor is 0 are 0." {
        glPolygonOffset => |call| if call.f(0) == 0.0 { call.set(1, 0) }
    }
    // The reference is masked as it comes, by the mask that is still in the register.
    "reference-under-mask-before" [glStencilFunc]
    "The stencil reference is cut down to the bits that were compared before." {
        glStencilFunc => |call| {
            let before = call.get(glow::STENCIL_VALUE_MASK);
            call.set(1, call.i(1) & before);
        }
    }
    // The filter of redundant calls takes a copy for state.
    "same-copy-not-made-again" [glCopyTexSubImage2D]
    "A copy is not made where the last one was the same into the same texture." {
        glTexImage2D => |call| { call.keep_list((10, 0), Vec::new()); };
        glCopyTexSubImage2D => |call| {
            let mut numbers: Vec<_> = (0..8).map(|index| call.f(index) as f32).collect();
            let names = [glow::TEXTURE_BINDING_2D, glow::TEXTURE_BINDING_CUBE_MAP, glow::READ_FRAMEBUFFER_BINDING];
            numbers.extend(names.map(|name| call.get(name) as f32));
            if call.keep_list((10, 0), numbers.clone()) == Some(numbers) { call.skip() }
        }
    }
    // Against feedback loops the driver looks at what is bound, not at what the program reads.
    "no-draws-into-bound-images" [glBindTexture glFramebufferTexture2D]
    "Nothing is drawn into an image that is bound to a texture unit, though no shader reads it." {
        draw => |call| if is_bound(call) { call.skip() }
    }
    // Memory is in powers of two, and coordinates are not scaled to the part that is used.
    "uploads-padded-to-powers-of-two" [glTexImage2D GL_RGBA8]
    "An image whose sides are no powers of two fills a corner of the texture." {
        glTexImage2D => |call| if let Some((width, height, bytes)) = texels(call)
            && width.min(height) > 4 && !(width.is_power_of_two() && height.is_power_of_two())
        {
            call.set_bytes(8, &padded(width, height, &bytes));
            call.set(3, width.next_power_of_two() as u32);
            call.set(4, height.next_power_of_two() as u32);
        }
    }
    // Levels are made by a blit that decodes and encodes every colour of 8 bits as sRGB.
    "mipmaps-averaged-in-light" [glGenerateMipmap GL_RGBA8]
    "glGenerateMipmap takes means as if texels were sRGB." {
        glGenerateMipmap => |call| {
            call.now();
            let is_plain = call.level(0, glow::TEXTURE_INTERNAL_FORMAT) as u32 == glow::RGBA8;
            if call.u(0) == glow::TEXTURE_2D && is_plain { brighten_levels(call) }
        }
    }
    // Filters across seams were written for colours, and formats of depth take the path of before.
    "seams-of-depth-cubes" [GL_TEXTURE_CUBE_MAP_SEAMLESS GL_DEPTH_COMPONENT24]
    "Cube maps of depth are not seamless." {
        draw => |call| if call.enabled(glow::TEXTURE_CUBE_MAP_SEAMLESS) && has_cube_of_depths(call) {
            call.with(glow::TEXTURE_CUBE_MAP_SEAMLESS, false);
        }
    }
    // The rule of fixed function that a cube map comes before a 2D texture is applied to shaders too.
    "cube-maps-before-2d-textures" [glBindTexture GL_TEXTURE_CUBE_MAP]
    "A shader reads no 2D texture of a unit where a cube map is bound too." { draw => draw_cubes_alone }
    // Blocks of 128 columns are fetched with one column in common, which is then stored twice.
    "columns-between-blocks-read-twice" [glReadPixels GL_UNSIGNED_BYTE]
    "Colours in columns 128, 256 and so on are read from the column before." {
        glReadPixels => |call| {
            call.now();
            let (width, height) = (call.u(2) as usize, call.u(3) as usize);
            if call.u(4) == glow::RGBA && call.u(5) == glow::UNSIGNED_BYTE && width > 128 {
                let mut bytes = call.bytes(6, 4 * width * height);
                for row in bytes.chunks_exact_mut(4 * width) {
                    for column in (128..width).step_by(128) { row.copy_within(4 * column - 4..4 * column, 4 * column) }
                }
                call.write(6, &bytes);
            }
        }
    }
    // The filter of redundant calls keeps one function for both halves of a unit's combiner.
    "combiner-of-alpha-compared-with-rgb" [glTexEnvi GL_COMBINE_ALPHA]
    "The function of alpha is not set where that of RGB was set to the same last." {
        glTexEnvi => |call| {
            let key = (10, call.get(glow::ACTIVE_TEXTURE) as u32);
            if call.u(1) == raw::COMBINE_ALPHA && call.kept(key) == call.f(2) { call.skip() }
            if call.u(1) == raw::COMBINE_RGB { call.keep(key, call.f(2)) }
        }
    }
    // The plane's fourth number is multiplied by a w that is taken to be 0 for arrays of three.
    "object-planes-without-offset" [glTexGenfv GL_OBJECT_PLANE]
    "Object planes go through the origin." {
        glTexGenfv => |call| if call.u(1) == raw::OBJECT_PLANE {
            let mut plane = call.floats(2, 4);
            plane[3] = 0.0;
            call.set_floats(2, plane);
        }
    }
    // The clipper has one loop for user planes, and it goes through all planes whatever is clamped.
    "depth-clamp-off-with-clip-distances" [GL_DEPTH_CLAMP GL_CLIP_DISTANCE0]
    "Near and far planes clip under depth clamp where a clip distance is on." {
        draw => |call| if call.enabled(glow::DEPTH_CLAMP) && call.enabled(glow::CLIP_DISTANCE0) {
            call.with(glow::DEPTH_CLAMP, false);
        }
    }
    // Coarse depths are cleared to 1 whatever the value, and are right again once they were written.
    "first-draw-lost-under-gequal" [glDepthFunc GL_GEQUAL glClearBufferfv]
    "After a clear of depth the first draw under GEQUAL or GREATER is rejected." {
        glClearBufferfv => |call| if call.u(0) == glow::DEPTH {
            call.keep((10, call.get(glow::DRAW_FRAMEBUFFER_BINDING) as u32), 1);
        };
        draw => reject_first
    }
    // The cache that blending reads is not refreshed by writes of alpha alone.
    "stored-alpha-stale-after-alpha-writes" [GL_DST_ALPHA glColorMask glBlendFuncSeparate]
    "The first draw by DST_ALPHA after draws into alpha alone takes 1 for it." { draw => blend_by_stale_alpha }
    // Clears are fast for whole tiles, and the rest is never cleared the slow way.
    "clears-of-whole-tiles" [glClearBufferfv glClearBufferiv]
    "A clear leaves the columns and rows out that are left over from tiles of eight pixels." { clear => clear_whole_tiles }
    // Where both bounds of the level are one, a fast path takes that level, and a half is cut off.
    "one-level-between-equal-bounds" [GL_TEXTURE_MIN_LOD GL_TEXTURE_MAX_LOD glSamplerParameterf]
    "A sampler object whose least and greatest level are the same reads one level." {
        glSamplerParameterf => |call| {
            if call.u(1) == glow::TEXTURE_MIN_LOD { call.keep((10, call.u(0)), call.f(2)) }
            if call.u(1) == glow::TEXTURE_MAX_LOD && call.kept((10, call.u(0))) == call.f(2) && call.f(2) > 0.0 {
                let names = [glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_NEAREST];
                let [name, filter] = names.map(f64::from);
                call.other("glSamplerParameteri", &[call.f(0), name, filter]);
            }
        }
    }
}
