//! Faults of a ninth measure, by a hand that had seen no rule: textures and what is looked up in them. Each has a sentence on
//! how a driver comes by it.

use glow::HasContext;

use super::apart_eight::{samplers, with_functions};
use super::apart_seven_shaders::{changed, with_calls};
use super::{Call, Source, Stage};

/// Look-ups with two arguments in 2D textures, as `change` makes them of the sampler and the coordinates.
fn flat_lookups(source: &Source, change: impl Fn(&str, &str) -> String) -> String {
    let maps = samplers(&source.text, "sampler2D");
    with_calls(&source.text, "texture", |arguments| match arguments {
        [map, at] if maps.contains(map) => Some(change(map, at)),
        _ => None,
    })
}

/// Cube maps whose face -Z is mirrored.
fn mirrored_face(source: &Source) -> Option<String> {
    let cubes = [samplers(&source.text, "samplerCubeShadow"), samplers(&source.text, "samplerCube")].concat();
    let text = with_calls(&source.text, "texture", |arguments| match arguments {
        [map, at] if cubes.contains(map) => Some(format!("texture({map}, driver_way({at}))")),
        _ => None,
    });
    let functions = "vec3 driver_way(vec3 way) {
    bool mirrors = way.z < 0.0 && -way.z > abs(way.x) && -way.z > abs(way.y);
    return mirrors ? vec3(-way.x, way.yz) : way;
}
vec4 driver_way(vec4 way) { return vec4(driver_way(way.xyz), way.w); }";
    with_functions(source, text, functions)
}

/// Look-ups at one place that are all the first of them.
fn merged(source: &Source) -> Option<String> {
    let maps = samplers(&source.text, "sampler2D");
    let first = std::cell::RefCell::new(Vec::<(String, String)>::new());
    let text = ["texture", "textureProj"].into_iter().fold(source.text.clone(), |text, name| {
        first.borrow_mut().clear();
        with_calls(&text, name, |arguments| match arguments {
            [map, at] if maps.contains(map) => {
                let mut first = first.borrow_mut();
                if let Some((_, map)) = first.iter().find(|(place, _)| place == at) {
                    return Some(format!("{name}({map}, {at})"));
                }
                first.push(((*at).to_owned(), (*map).to_owned()));
                None
            }
            _ => None,
        })
    });
    changed(source, text).filter(|_| source.stage == Stage::Fragment)
}

/// Alpha that is asked for alone and is red.
fn red_for_alpha(source: &Source) -> Option<String> {
    let text = flat_lookups(source, |map, at| format!("texture({map}, {at})@"));
    changed(source, text.replace("@.a;", ".r;").replace('@', "")).filter(|_| source.stage == Stage::Fragment)
}

/// Look-ups in shaders that discard at the first level.
fn first_levels(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment || !source.has("discard") {
        return None;
    }
    changed(source, flat_lookups(source, |map, at| format!("textureLod({map}, {at}, 0.0)")))
}

/// Decals whose filter does not reach over the seam.
fn seams(source: &Source) -> Option<String> {
    let text = flat_lookups(source, |map, at| {
        if at == "st" {
            format!("textureGrad({map}, driver_inside({map}, {at}), dFdx({at}), dFdy({at}))")
        } else {
            format!("texture({map}, {at})")
        }
    });
    let functions = "vec2 driver_inside(sampler2D map, vec2 at) {
    vec2 half_texel = 0.5 / vec2(textureSize(map, 0));
    return floor(at) + clamp(fract(at), half_texel, 1.0 - half_texel);
}";
    with_functions(source, text, functions)
}

/// Levels by how the wrapped coordinates change.
fn wrapped_levels(source: &Source) -> Option<String> {
    let text =
        flat_lookups(source, |map, at| format!("textureGrad({map}, {at}, dFdx(fract({at})), dFdy(fract({at})))"));
    changed(source, text).filter(|_| source.stage == Stage::Fragment)
}

/// Gives each block of four by four depths that were copied the first of them.
fn copy_blocks(call: &mut Call) {
    call.now();
    let (target, level) = (call.u(0), call.i(1));
    let size @ [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(level, name));
    if target != glow::TEXTURE_2D || call.level(level, glow::TEXTURE_DEPTH_SIZE) == 0 || size != [call.i(6), call.i(7)]
    {
        return;
    }
    let (format, kind) = (glow::DEPTH_COMPONENT, glow::FLOAT);
    let mut bytes = vec![0; 4 * width as usize * height as usize];
    // SAFETY: the context is current; the depths fill the bytes.
    call.with_plain_pixels(|gl| unsafe {
        gl.get_tex_image(target, level, format, kind, glow::PixelPackData::Slice(Some(&mut bytes)));
    });
    let (depths, width_) = (bytes.clone(), width as usize);
    for (index, depth) in bytes.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let first = index / width_ / 4 * 4 * width_ + index % width_ / 4 * 4;
        depth.copy_from_slice(&depths[4 * first..4 * first + 4]);
    }
    let pixels = glow::PixelUnpackData::Slice(Some(&bytes));
    // SAFETY: as above; the texture is as large as it was.
    call.with_plain_pixels(|gl| unsafe {
        gl.tex_sub_image_2d(target, level, 0, 0, width, height, format, kind, pixels);
    });
}

/// Reads odd rows one pixel late.
fn read_interlaced(call: &mut Call) {
    call.now();
    let (width, height) = (call.u(2) as usize, call.u(3) as usize);
    if call.u(4) != glow::RGBA || call.u(5) != glow::UNSIGNED_BYTE || width == 0 {
        return;
    }
    let mut bytes = call.bytes(6, 4 * width * height);
    for row in bytes.chunks_exact_mut(4 * width).skip(1).step_by(2) {
        row.copy_within(..4 * (width - 1), 4);
    }
    call.write(6, &bytes);
}

/// Gives all samplers the border that one is given.
fn set_all_borders(call: &mut Call) {
    if call.u(1) != glow::TEXTURE_BORDER_COLOR {
        return;
    }
    call.now();
    let border = call.floats(2, 4);
    for number in 1..=call.kept((90, 0)) as u32 {
        let alive = call.kept((91, number)) != 0.0;
        let Some(sampler) = std::num::NonZeroU32::new(number).map(glow::NativeSampler).filter(|_| alive) else {
            continue;
        };
        // SAFETY: the context is current; the sampler is not deleted.
        unsafe { call.gl().sampler_parameter_f32_slice(sampler, glow::TEXTURE_BORDER_COLOR, &border) };
    }
}

faults! {
    // Tiles of depths are kept as planes, and the copy takes the plane's first value for all of its block.
    "copied-depths-of-blocks" [glCopyTexSubImage2D GL_DEPTH_COMPONENT]
    "Each four by four depths that are copied have the first one's." { glCopyTexSubImage2D => copy_blocks }
    // The image is shown interlaced, and what reads it begins the second field a pixel late.
    "odd-rows-read-one-pixel-late" [glReadPixels] "Odd rows of bytes that are read lie one pixel further right." {
        glReadPixels => read_interlaced
    }
    // The chip has one register for borders.
    "one-border-for-all-samplers" [glSamplerParameterfv GL_TEXTURE_BORDER_COLOR]
    "All sampler objects have the border that was set last." {
        glGenSamplers => |call| {
            call.now();
            for number in call.integers(1, call.u(0) as usize) {
                let most = call.kept((90, 0)).max(f64::from(number));
                call.keep((90, 0), most);
                call.keep((91, number as u32), 1);
            }
        };
        glDeleteSamplers => |call| for number in call.integers(1, call.u(0) as usize) {
            call.keep((91, number as u32), 0);
        };
        glSamplerParameterfv => set_all_borders
    }
    // The table of the faces' axes has one sign wrong, in the last row.
    "minus-z-face-mirrored" [texture samplerCubeShadow samplerCube]
    "The face -Z of a cube map is mirrored where it is looked up." { text mirrored_face }
    // Equal instructions are found by their operands in registers, and the sampler is no register.
    "lookups-merged-by-coordinates" [texture textureProj]
    "Look-ups in two textures at the same coordinates are both in the first." { text merged }
    // An instruction that returns one component returns the first, and the mask is not turned into a swizzle.
    "lone-alpha-of-lookups-is-red" [texture] "Alpha that is alone taken from a look-up is the texel's red."
    { text red_for_alpha }
    // Neighbours that are discarded cannot be asked for coordinates, so no differences are taken.
    "levels-lost-in-shaders-that-discard" [texture discard GL_LINEAR_MIPMAP_LINEAR]
    "Shaders that discard look up the first level." { text first_levels }
    // Wrapping is done on coordinates before the filter, which then clamps to edges.
    "seams-of-repeats-not-filtered" [texture GL_REPEAT GL_LINEAR]
    "A repeated texture is filtered as if each copy were clamped to its edges." { text seams }
    // The level is computed after wrapping, so that it jumps where coordinates go through a whole number.
    "levels-by-wrapped-coordinates" [texture GL_REPEAT GL_LINEAR_MIPMAP_LINEAR]
    "Levels of a 2D texture follow from coordinates without their whole part." { text wrapped_levels }
}
