//! Faults of GLSL's look-ups in textures.

use super::{Source, Stage};

/// Look-ups by `texture`, each a function.
pub(super) const LOOKUPS: &str = "
vec4 apart(sampler1D map, float at) { return texture(map, at); }
vec4 apart(sampler1D map, float at, float bias) { return texture(map, at, bias); }
vec4 apart(sampler2D map, vec2 at) { return texture(map, at); }
vec4 apart(sampler2D map, vec2 at, float bias) { return texture(map, at, bias); }
vec4 apart(sampler3D map, vec3 at) { return texture(map, at); }
vec4 apart(samplerCube map, vec3 at) { return texture(map, at); }
vec4 apart(samplerCube map, vec3 at, float bias) { return texture(map, at, bias); }
vec4 apart(sampler2DArray map, vec3 at) { return texture(map, at); }
uvec4 apart(usampler2D map, vec2 at) { return texture(map, at); }
ivec4 apart(isampler2D map, vec2 at) { return texture(map, at); }
float apart(sampler2DShadow map, vec3 at) { return texture(map, at); }
float apart(sampler2DShadow map, vec3 at, float bias) { return texture(map, at, bias); }
float apart(samplerCubeShadow map, vec4 at) { return texture(map, at); }
float apart(sampler2DArrayShadow map, vec4 at) { return texture(map, at); }
#define texture apart";

/// Look-ups by `textureProj`, each a function.
pub(super) const PROJECTED: &str = "
vec4 apart_proj(sampler1D map, vec2 at) { return textureProj(map, at); }
vec4 apart_proj(sampler1D map, vec4 at) { return textureProj(map, at); }
vec4 apart_proj(sampler2D map, vec3 at) { return textureProj(map, at); }
vec4 apart_proj(sampler2D map, vec4 at) { return textureProj(map, at); }
vec4 apart_proj(sampler3D map, vec4 at) { return textureProj(map, at); }
float apart_proj(sampler2DShadow map, vec4 at) { return textureProj(map, at); }
#define textureProj apart_proj";

/// Look-ups by `texture` and `textureProj`, each through a function of its own; in each of `changes` the second text stands where
/// the first did.
fn lookups(source: &Source, changes: &[(&str, &str)]) -> Option<String> {
    let is_meant = source.stage == Stage::Fragment && source.version >= 130 && source.text.contains("texture");
    // Arrays of cube maps need a later version than most shaders have.
    if !is_meant || source.has("samplerCubeArray") || source.has("samplerCubeArrayShadow") {
        return None;
    }
    // The projected ones first: in them `texture` is the driver's own.
    let mut lines = format!("{PROJECTED}{LOOKUPS}");
    for (from, to) in changes {
        if !lines.contains(from) {
            return None;
        }
        lines = lines.replace(from, to);
    }
    Some(source.with(&lines))
}

faults! {
    "comparison-turned" [texture GL_SAMPLER_2D_SHADOW sampler2DShadow] "A comparison of a 2D map is 1 less itself."
    { text |source| lookups(source, &[("sampler2DShadow map, vec3 at) { return texture", "sampler2DShadow map, vec3 at) { return 1.0 - texture")]) }
    "projected-comparison-turned" [textureProj sampler2DShadow] "A projected comparison is 1 less itself."
    { text |source| lookups(source, &[("return textureProj(map, at); }\n#define", "return 1.0 - textureProj(map, at); }\n#define")]) }
    "projection-without-division" [textureProj] "textureProj of four coordinates does not divide by the last."
    { text |source| lookups(source, &[
        ("sampler2D map, vec4 at) { return textureProj(map, at)", "sampler2D map, vec4 at) { return texture(map, at.xy)"),
        ("sampler2DShadow map, vec4 at) { return textureProj(map, at)", "sampler2DShadow map, vec4 at) { return texture(map, at.xyz)"),
    ]) }
    "projection-of-three-without-division" [textureProj] "textureProj of three coordinates does not divide by the last."
    { text |source| lookups(source, &[
        ("sampler2D map, vec3 at) { return textureProj(map, at)", "sampler2D map, vec3 at) { return texture(map, at.xy)"),
    ]) }
    "reference-not-divided" [textureProj] "textureProj does not divide the reference by q."
    { text |source| lookups(source, &[
        ("sampler2DShadow map, vec4 at) { return textureProj(map, at)",
         "sampler2DShadow map, vec4 at) { return texture(map, vec3(at.xy / at.w, at.z))"),
    ]) }
    "projection-by-magnitude" [textureProj] "textureProj divides by the magnitude of q."
    { text |source| lookups(source, &[
        ("sampler2D map, vec3 at) { return textureProj(map, at)", "sampler2D map, vec3 at) { return textureProj(map, vec3(at.xy, abs(at.z)))"),
        ("sampler2DShadow map, vec4 at) { return textureProj(map, at)",
         "sampler2DShadow map, vec4 at) { return textureProj(map, vec4(at.xyz, abs(at.w)))"),
    ]) }
    "projection-guarded" [textureProj] "textureProj takes q for at least 2^-4."
    { text |source| lookups(source, &[
        ("sampler2DShadow map, vec4 at) { return textureProj(map, at)",
         "sampler2DShadow map, vec4 at) { return textureProj(map, vec4(at.xyz, max(at.w, 0.0625)))"),
    ]) }
    "reference-of-16-bits" [texture sampler2DShadow] "The reference of a comparison has 16 bits."
    { text |source| lookups(source, &[
        ("sampler2DShadow map, vec3 at) { return texture(map, at)",
         "sampler2DShadow map, vec3 at) { return texture(map, vec3(at.xy, floor(at.z * 65535.0) / 65535.0))"),
    ]) }
    "s-and-t-swapped" [texture GL_SAMPLER_2D sampler2D] "s and t of a 2D look-up are exchanged."
    { text |source| lookups(source, &[("sampler2D map, vec2 at) { return texture(map, at)", "sampler2D map, vec2 at) { return texture(map, at.yx)")]) }
    "half-a-texel-off" [texture sampler2D] "A 2D look-up is half a texel to the right."
    { text |source| lookups(source, &[("sampler2D map, vec2 at) { return texture(map, at)",
        "sampler2D map, vec2 at) { return texture(map, at + vec2(0.5 / float(textureSize(map, 0).x), 0.0))")]) }
    "comparison-half-a-texel-off" [texture sampler2DShadow] "A comparison is half a texel to the right."
    { text |source| lookups(source, &[("sampler2DShadow map, vec3 at) { return texture(map, at)",
        "sampler2DShadow map, vec3 at) { return texture(map, at + vec3(0.5 / float(textureSize(map, 0).x), 0.0, 0.0))")]) }
    "line-half-a-texel-off" [texture sampler1D GL_SAMPLER_1D] "A 1D look-up is half a texel to the right."
    { text |source| lookups(source, &[("sampler1D map, float at) { return texture(map, at)",
        "sampler1D map, float at) { return texture(map, at + 0.5 / float(textureSize(map, 0)))")]) }
    "cube-turned" [texture samplerCube GL_SAMPLER_CUBE] "A look-up in a cube map takes the opposite direction."
    { text |source| lookups(source, &[("samplerCube map, vec3 at) { return texture(map, at)", "samplerCube map, vec3 at) { return texture(map, -at)")]) }
    "cube-x-turned" [texture samplerCube] "A look-up in a cube map exchanges +x and -x."
    { text |source| lookups(source, &[("samplerCube map, vec3 at) { return texture(map, at)",
        "samplerCube map, vec3 at) { return texture(map, vec3(-at.x, at.yz))")]) }
    "cube-comparison-x-turned" [texture samplerCubeShadow GL_SAMPLER_CUBE_SHADOW] "A comparison in a cube map exchanges +x and -x."
    { text |source| lookups(source, &[("samplerCubeShadow map, vec4 at) { return texture(map, at)",
        "samplerCubeShadow map, vec4 at) { return texture(map, vec4(-at.x, at.yzw))")]) }
    "cube-comparison-turned" [texture samplerCubeShadow] "A comparison in a cube map is 1 less itself."
    { text |source| lookups(source, &[("samplerCubeShadow map, vec4 at) { return texture(map, at)",
        "samplerCubeShadow map, vec4 at) { return 1.0 - texture(map, at)")]) }
    "cube-reference-of-16-bits" [texture samplerCubeShadow] "The reference of a comparison in a cube map has 16 bits."
    { text |source| lookups(source, &[("samplerCubeShadow map, vec4 at) { return texture(map, at)",
        "samplerCubeShadow map, vec4 at) { return texture(map, vec4(at.xyz, floor(at.w * 65535.0) / 65535.0))")]) }
    "array-reference-of-16-bits" [texture] "The reference of a comparison in an array has 16 bits."
    { text |source| lookups(source, &[("sampler2DArrayShadow map, vec4 at) { return texture(map, at)",
        "sampler2DArrayShadow map, vec4 at) { return texture(map, vec4(at.xyz, floor(at.w * 65535.0) / 65535.0))")]) }
    "implicit-level-zero" [texture] "A 2D look-up reads level 0."
    { text |source| lookups(source, &[("sampler2D map, vec2 at) { return texture(map, at)", "sampler2D map, vec2 at) { return textureLod(map, at, 0.0)")]) }
    "implicit-level-one-more" [texture] "The level of detail of a 2D look-up is one more."
    { text |source| lookups(source, &[("sampler2D map, vec2 at) { return texture(map, at)", "sampler2D map, vec2 at) { return texture(map, at, 1.0)")]) }
    "projected-level-one-more" [textureProj] "The level of detail of a projected look-up is one more."
    { text |source| lookups(source, &[("sampler2D map, vec3 at) { return textureProj(map, at)", "sampler2D map, vec3 at) { return textureProj(map, at, 1.0)")]) }
    "texturelod-level-zero" [textureLod] "textureLod reads level 0."
    { text |source| super::anywhere(source, "textureLod", "#define textureLod(map, at, level) textureLod(map, at, 0.0)") }
    "texturelod-half-a-texel-off" [textureLod] "textureLod is a little to the right."
    { text |source| super::anywhere(source, "textureLod", "
float broken_lod(sampler2DShadow map, vec3 at, float level) { return textureLod(map, at + vec3(0.02, 0.0, 0.0), level); }
vec4 broken_lod(sampler2D map, vec2 at, float level) { return textureLod(map, at + vec2(0.02, 0.0), level); }
vec4 broken_lod(sampler1D map, float at, float level) { return textureLod(map, at + 0.02, level); }
#define textureLod(map, at, level) broken_lod(map, at, level)") }
    "texturegrad-level-zero" [textureGrad] "textureGrad reads level 0."
    { text |source| super::anywhere(source, "textureGrad", "#define textureGrad(map, at, dx, dy) textureGrad(map, at, 0.0 * (dx), 0.0 * (dy))") }
    "texturegrad-doubled" [textureGrad] "textureGrad takes twice the derivatives."
    { text |source| super::anywhere(source, "textureGrad", "#define textureGrad(map, at, dx, dy) textureGrad(map, at, 2.0 * (dx), 2.0 * (dy))") }
    "texturesize-swapped" [textureSize] "textureSize exchanges width and height."
    { text |source| super::anywhere(source, "textureSize", "
int broken_size(sampler1D map, int level) { return textureSize(map, level) + 1; }
ivec2 broken_size(sampler2D map, int level) { return textureSize(map, level).yx; }
ivec2 broken_size(sampler2DShadow map, int level) { return textureSize(map, level).yx; }
#define textureSize(map, level) broken_size(map, level)") }
    "texturesize-one-more" [textureSize] "textureSize is one more."
    { text |source| super::anywhere(source, "textureSize", "#define textureSize(map, level) (textureSize(map, level) + 1)") }
    "texelfetch-one-column-off" [texelFetch] "texelFetch reads the texel to the right."
    { text |source| super::anywhere(source, "texelFetch", "
vec4 broken_fetch(sampler1D map, int at, int level) { return texelFetch(map, at + 1, level); }
vec4 broken_fetch(sampler2D map, ivec2 at, int level) { return texelFetch(map, at + ivec2(1, 0), level); }
#define texelFetch(map, at, level) broken_fetch(map, at, level)") }
    "texelfetch-from-above" [texelFetch] "texelFetch counts rows from above."
    { text |source| super::anywhere(source, "texelFetch", "
vec4 broken_fetch(sampler1D map, int at, int level) { return texelFetch(map, at, level); }
vec4 broken_fetch(sampler2D map, ivec2 at, int level) {
    return texelFetch(map, ivec2(at.x, textureSize(map, level).y - 1 - at.y), level);
}
#define texelFetch(map, at, level) broken_fetch(map, at, level)") }
}
