//! Faults of a ninth measure, by a hand that had seen no rule: textures and what is looked up in them. Each has a sentence on
//! how a driver comes by it.

use super::apart_seven_shaders::{changed, with_calls};
use super::{Call, Source, Stage, words};

/// Keeps what a texture that is made had under its name before.
fn name_again(call: &mut Call) {
    call.now();
    for texture in call.integers(1, call.u(0) as usize) {
        let key = texture as u32;
        let was_named = call.kept((90, key));
        call.keep((91, key), was_named);
        call.keep((90, key), 1);
    }
}

/// Gives a texture the last level that its name had before.
fn bind_with_old_level(call: &mut Call) {
    call.now();
    let key = call.u(1);
    if call.u(0) == glow::TEXTURE_2D && call.kept((91, key)) != 0.0 {
        call.keep((91, key), 0);
        let level = call.kept((92, key));
        if level != 0.0 {
            call.other(
                "glTexParameteri",
                &[f64::from(glow::TEXTURE_2D), f64::from(glow::TEXTURE_MAX_LEVEL), level - 1.0],
            );
        }
    }
}

/// Names of a shader's samplers of a type.
fn samplers<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    let declared = text.lines().filter_map(|line| line.trim().strip_prefix("uniform "));
    declared.filter_map(|line| words(line.strip_prefix(kind)?.strip_prefix(' ')?).next()).collect()
}

/// A fragment shader whose calls are changed, with functions of the driver's own before it.
fn with_functions(source: &Source, text: String, functions: &str) -> Option<String> {
    let text = changed(source, text).filter(|_| source.stage == Stage::Fragment)?;
    Some(Source { text, ..*source }.with(functions))
}

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

faults! {
    // The record of a texture outlives it, and what is made under its name next is set up from the record.
    "reused-texture-names-keep-max-level" [glGenTextures GL_TEXTURE_MAX_LEVEL]
    "A texture under the name of a deleted one has that one's last level." {
        glGenTextures => name_again;
        glBindTexture => bind_with_old_level;
        glTexParameteri => |call| if call.u(0) == glow::TEXTURE_2D && call.u(1) == glow::TEXTURE_MAX_LEVEL {
            let key = call.get(glow::TEXTURE_BINDING_2D) as u32;
            call.keep((92, key), call.f(2) + 1.0);
        }
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
