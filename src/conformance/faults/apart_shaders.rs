//! Faults that were written before any rule had met them: shaders and their look-ups.

use super::lookups::{LOOKUPS, PROJECTED};
use super::{Source, Stage, after_main};

/// Half floats: eleven bits of what a number has.
pub(super) const HALVES: &str = "
float apart_half(float x) {
    float unit = exp2(floor(log2(max(abs(x), 6.2e-5))) - 10.0);
    return floor(x / unit + 0.5) * unit;
}
vec2 apart_half(vec2 v) { return vec2(apart_half(v.x), apart_half(v.y)); }
vec3 apart_half(vec3 v) { return vec3(apart_half(v.xy), apart_half(v.z)); }
vec4 apart_half(vec4 v) { return vec4(apart_half(v.xyz), apart_half(v.w)); }
";

/// A fragment shader with other look-ups: in `functions` the second text stands where the first did.
pub(super) fn lookups(source: &Source, word: &str, functions: &str, [from, to]: [&str; 2]) -> Option<String> {
    let is_meant = source.stage == Stage::Fragment && source.version >= 130 && source.has(word);
    // Arrays of cube maps need a later version than most shaders have.
    if !is_meant || source.has("samplerCubeArray") || source.has("samplerCubeArrayShadow") || !functions.contains(from)
    {
        return None;
    }
    Some(source.with(&format!("{HALVES}{}", functions.replace(from, to))))
}

/// Varyings of a vertex shader that are floats, in their order.
pub(super) fn varyings(source: &Source) -> Vec<String> {
    if source.stage != Stage::Vertex || source.version < 130 {
        return Vec::new();
    }
    let name = |line: &str| {
        let words: Vec<_> = line.trim().trim_end_matches(';').split_whitespace().collect();
        match words[..] {
            ["out" | "smooth", .., kind, name] if kind.starts_with("vec") || kind == "float" => Some(name.to_owned()),
            _ => None,
        }
    };
    source
        .text
        .lines()
        .filter(|line| line.trim_end().ends_with(';'))
        .filter_map(name)
        .filter(|name| !name.contains('['))
        .collect()
}

faults! {
    "comparison-coordinates-of-halves" [texture sampler2DShadow]
    "Coordinates of a comparison have eleven bits."
    { text |source| lookups(source, "texture", LOOKUPS, [
        "sampler2DShadow map, vec3 at) { return texture(map, at)",
        "sampler2DShadow map, vec3 at) { return texture(map, vec3(apart_half(at.xy), at.z))",
    ]) }
    "implicit-level-by-x" [texture GL_LINEAR_MIPMAP_LINEAR]
    "The level of detail of a 2D look-up is found along x alone."
    { text |source| lookups(source, "texture", LOOKUPS, [
        "sampler2D map, vec2 at) { return texture(map, at)",
        "sampler2D map, vec2 at) { return textureGrad(map, at, dFdx(at), vec2(0.0))",
    ]) }
    "projected-level-undivided" [textureProj GL_LINEAR_MIPMAP_LINEAR]
    "The level of detail of a projected look-up is found before the division by q."
    { text |source| lookups(source, "textureProj", PROJECTED, [
        "sampler2D map, vec3 at) { return textureProj(map, at)",
        "sampler2D map, vec3 at) { return textureGrad(map, at.xy / at.z, dFdx(at.xy), dFdy(at.xy))",
    ]) }
    "normalize-of-long-vectors" [normalize]
    "normalize of a vector that is longer than 256 is 0: its square is no half float."
    { text |source| super::anywhere(source, "normalize", "
vec2 apart_normalize(vec2 v) { return dot(v, v) > 65504.0 ? vec2(0.0) : normalize(v); }
vec3 apart_normalize(vec3 v) { return dot(v, v) > 65504.0 ? vec3(0.0) : normalize(v); }
vec4 apart_normalize(vec4 v) { return dot(v, v) > 65504.0 ? vec4(0.0) : normalize(v); }
#define normalize apart_normalize") }
    "clipped-varyings-coarse" [in out gl_Position]
    "Triangles that the near plane clips have varyings that are right to 2^-6."
    { text |source| {
        let scaled = |name: &String| format!("{name} *= behind; ");
        let all: String = varyings(source).iter().map(scaled).collect();
        let statements = format!("float behind = gl_Position.z < -gl_Position.w ? 1.015625 : 1.0; {all}");
        (!all.is_empty()).then(|| after_main(source, Stage::Vertex, &statements)).flatten()
    } }
    "clipped-depth-off" [gl_Position]
    "Triangles that the near plane clips lie 2^-10 deeper at their end before it."
    { text |source| after_main(source, Stage::Vertex,
        "if (gl_Position.z < -gl_Position.w) gl_Position.z += max(abs(gl_Position.z), abs(gl_Position.w)) / 1024.0;") }
    "guard-band-clamps" [gl_Position]
    "Vertices farther away than 64 viewports are moved to there."
    { text |source| after_main(source, Stage::Vertex,
        "if (gl_Position.w > 0.0) gl_Position.xy = clamp(gl_Position.xy, -64.0 * gl_Position.w, 64.0 * gl_Position.w);") }
    "fifth-varying-lost" [in out]
    "Varyings after the fourth are 0."
    { text |source| {
        let lost: String = varyings(source).iter().skip(4).map(|name| format!("{name} *= 0.0; ")).collect();
        (!lost.is_empty()).then(|| after_main(source, Stage::Vertex, &lost)).flatten()
    } }
}
