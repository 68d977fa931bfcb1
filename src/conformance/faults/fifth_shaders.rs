//! Faults of a fifth measure: shaders.

use super::apart_shaders::{lookups, varyings};
use super::fourth_shaders::{set_state, with_state};
use super::lookups::LOOKUPS;
use super::{Source, Stage, after_main, anywhere, define, text};

fn is_letter(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// Another text of a shader from version 130, if it is another.
fn changed(source: &Source, text: String) -> Option<String> {
    (source.version >= 130 && text != source.text).then_some(text)
}

/// A row and a column of a matrix exchanged where it stands behind a vector.
fn with_vectors_behind(source: &Source) -> Option<String> {
    let is_name = |word: &&str| word.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_');
    let mut names = Vec::new();
    for kind in ["mat3 ", "mat4 "] {
        for (at, _) in source.text.match_indices(kind) {
            names.extend(text::words(&source.text[at + kind.len()..]).next().filter(is_name).map(str::to_owned));
        }
    }
    let mut other = source.text.clone();
    for name in names {
        let (mut text, mut rest) = (String::new(), other.as_str());
        let sought = format!(" * {name}");
        while let Some(at) = rest.find(&sought) {
            let (before, after) = (&rest[..at], &rest[at + sought.len()..]);
            text += before;
            let whole = !after.starts_with(|letter: char| is_letter(letter) || "([.".contains(letter));
            text += &if whole { format!(" * transpose({name})") } else { sought.clone() };
            rest = after;
        }
        other = text + rest;
    }
    changed(source, other)
}

/// Loops within loops whose counter is not set again: it is set before the outer loop.
fn stale_counters(source: &Source) -> Option<String> {
    let lines: Vec<_> = source.text.lines().map(str::to_owned).collect();
    let mut text = String::new();
    let mut hoisted = String::new();
    for (number, line) in lines.iter().enumerate() {
        let is_loop = |line: &str| line.trim_start().starts_with("for (int ");
        let first = |line: &str| {
            line.split_once("for (").and_then(|(_, rest)| rest.split_once(';')).map(|(first, _)| first.to_owned())
        };
        if !hoisted.is_empty() && is_loop(line) {
            text += &line.replacen(&hoisted, "", 1);
            text += "\n";
            hoisted.clear();
            continue;
        }
        let bare = is_loop(line) && line.trim_end().ends_with(')');
        if let Some(inner) = lines.get(number + 1).filter(|inner| bare && is_loop(inner)).and_then(|inner| first(inner))
        {
            text += &format!("{inner}; ");
            hoisted = inner;
        }
        text += line;
        text += "\n";
    }
    if source.stage == Stage::Fragment { changed(source, text) } else { None }
}

/// Varyings of two components in steps of 1/256.
fn fixed_pairs(source: &Source) -> Option<String> {
    let is_pair = |name: &&String| source.text.contains(&format!("out vec2 {name};"));
    let rounded = |name: &String| format!("{name} = floor({name} * 256.0 + 0.5) / 256.0; ");
    let all: String = varyings(source).iter().filter(is_pair).map(rounded).collect();
    (!all.is_empty()).then(|| after_main(source, Stage::Vertex, &all)).flatten()
}

/// A fragment's place from above, where the driver says how high the window is.
fn places_from_above(source: &Source) -> Option<String> {
    with_state(
        source,
        "",
        "gl_FragCoord",
        "#define gl_FragCoord vec4(gl_FragCoord.x, \
        driver_state.y > 0.0 ? driver_state.y - gl_FragCoord.y : gl_FragCoord.y, gl_FragCoord.zw)",
    )
}

/// `sin` by a parabola within half a turn.
const PARABOLAS: &str = "
float fifth_sin(float x) {
    float turn = x * 0.15915494 - floor(x * 0.15915494 + 0.5);
    return turn * (8.0 - 16.0 * abs(turn));
}
vec2 fifth_sin(vec2 x) { return vec2(fifth_sin(x.x), fifth_sin(x.y)); }
vec3 fifth_sin(vec3 x) { return vec3(fifth_sin(x.xy), fifth_sin(x.z)); }
vec4 fifth_sin(vec4 x) { return vec4(fifth_sin(x.xyz), fifth_sin(x.w)); }
#define sin fifth_sin";

const SIZES: &str = "
int fifth_size(int side) { int power = 1; for (int k = 0; k < 16; ++k) power = power < side ? 2 * power : power; return power; }
ivec2 fifth_size(ivec2 sides) { return ivec2(fifth_size(sides.x), fifth_size(sides.y)); }
ivec3 fifth_size(ivec3 sides) { return ivec3(fifth_size(sides.xy), sides.z); }
#define textureSize(map, level) fifth_size(textureSize(map, level))";

const CROSS: &str = "
vec3 fifth_cross(vec3 a, vec3 b) {
    a.x = a.y * b.z - a.z * b.y;
    a.y = a.z * b.x - a.x * b.z;
    a.z = a.x * b.y - a.y * b.x;
    return a;
}
#define cross fifth_cross";

/// Derivatives without the last of four components.
const DERIVATIVES: &str = "
float fifth_three(float v) { return v; }
vec2 fifth_three(vec2 v) { return v; }
vec3 fifth_three(vec3 v) { return v; }
vec4 fifth_three(vec4 v) { return vec4(v.xyz, 0.0); }
#define dFdx(x) fifth_three(dFdx(x))
#define dFdy(x) fifth_three(dFdy(x))";

faults! {
    // Functions are inlined without the jump for a return that stands in a branch.
    "returns-in-branches-ignored" [return]
    "A function without a value goes on behind a return." { text |source| changed(source, source.text.replace("return;", ";")) }
    // A product is lowered by the matrix's kind, whichever side it stands on.
    "vector-times-matrix-turned" [glUniformMatrix3fv]
    "A vector times a matrix is the matrix times the vector." { text with_vectors_behind }
    // The first value of a counter is taken for invariant, and is moved before the loop around it.
    "inner-counters-not-set-again" [for]
    "The counter of a loop within a loop is set once." { text stale_counters }
    // A short polynomial for sin is used where precision was not asked for.
    "sin-by-parabola" [sin] "sin is a parabola through its zeros and extremes."
    { text |source| anywhere(source, "sin", PARABOLAS) }
    // Whole numbers are found by adding a large number, in a unit that has eight bits behind the point.
    "floor-a-256th-early" [floor] "floor of what is less than 1/256 below a whole number is that number."
    { text |source| anywhere(source, "floor", "#define floor(x) floor((x) + 1.0 / 256.0)") }
    // The descriptor has the size of the memory, which is in powers of two.
    "texturesize-of-memory" [textureSize] "textureSize is rounded up to powers of two."
    { text |source| anywhere(source, "textureSize", SIZES) }
    // The register of a result may be that of the first operand, and is written before all is read.
    "cross-overwrites-its-operand" [cross] "cross reads components of its first operand that it has replaced already."
    { text |source| anywhere(source, "cross", CROSS) }
    // Derivatives are computed for three components at once, and the fourth is not scheduled.
    "derivatives-of-four-lose-last" [dFdx dFdy] "The last component of the derivative of a vec4 is 0."
    { text |source| {
        let word = ["dFdx", "dFdy"].into_iter().find(|word| source.has(word))?;
        define(source, Stage::Fragment, word, DERIVATIVES)
    } }
    // Windows count rows from above, and the test for a window asks whether there is no colour texture.
    "places-from-above-without-color" [gl_FragCoord GL_DEPTH_ATTACHMENT]
    "gl_FragCoord.y is counted from above where no colour is attached." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, places_from_above);
        draw => |call| {
            let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
            let bare = call.get(glow::DRAW_FRAMEBUFFER_BINDING) != 0 && call.attached(glow::COLOR_ATTACHMENT0, kind) == 0;
            let height = if bare { call.get4(glow::VIEWPORT)[3] as f32 } else { 0.0 };
            set_state(call, [0.0, height, 0.0, 0.0]);
        }
    }
    // Texture coordinates are interpolated by a unit for fixed-point numbers.
    "pairs-in-fixed-point" [out in] "Varyings of two components are multiples of 1/256 at the vertices." { text fixed_pairs }
    // Weights of a comparison's four texels have two bits, as those of the smallest formats.
    "comparisons-in-quarters" [texture sampler2DShadow GL_LINEAR]
    "A comparison under LINEAR is a multiple of a quarter."
    { text |source| lookups(source, "texture", LOOKUPS, [
        "sampler2DShadow map, vec3 at) { return texture(map, at)",
        "sampler2DShadow map, vec3 at) { return floor(4.0 * texture(map, at) + 0.5) / 4.0",
    ]) }
}
