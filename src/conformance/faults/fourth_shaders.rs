//! Faults of a fourth measure: shaders, and state that reaches them.

use glow::HasContext;

use super::apart_shaders::lookups;
use super::lookups::{LOOKUPS, PROJECTED};
use super::{Source, Stage, after_main, anywhere, text};

/// Attribute by which a broken driver's vertex shaders see its state: no array feeds it.
const STATE: u32 = 15;

/// A shader that sees state of the driver as `driver_state`: `vertex` after main() of the vertex stage, `fragment` before a
/// fragment shader that has `word`.
pub(super) fn with_state(source: &Source, vertex: &str, word: &str, fragment: &str) -> Option<String> {
    match source.stage {
        Stage::Vertex if source.version >= 330 => {
            let text = after_main(source, Stage::Vertex, &format!("driver_state = driver_attribute; {vertex}"))?;
            let lines = format!("layout(location = {STATE}) in vec4 driver_attribute;\nflat out vec4 driver_state;");
            Some(Source { text, ..*source }.with(&lines))
        }
        Stage::Fragment if source.version >= 330 && source.has(word) => {
            Some(source.with(&format!("flat in vec4 driver_state;\n{fragment}")))
        }
        _ => None,
    }
}

/// Sets what shaders see.
pub(super) fn set_state(call: &super::Call, [x, y, z, w]: [f32; 4]) {
    // SAFETY: the context is current.
    unsafe { call.gl().vertex_attrib_4_f32(STATE, x, y, z, w) };
}

/// Vertices on a grid of a sixteenth of a pixel, where the driver says how large the viewport is.
fn on_coarse_grid(source: &Source) -> Option<String> {
    let statements = "if (driver_state.x > 0.0 && gl_Position.w > 0.0)
        gl_Position.xy = floor(gl_Position.xy / gl_Position.w * driver_state.xy + 0.5) / driver_state.xy * gl_Position.w;";
    if source.stage == Stage::Vertex { with_state(source, statements, "", "") } else { None }
}

/// `discard` does nothing where the driver says so.
fn discards_with_color(source: &Source) -> Option<String> {
    with_state(source, "", "discard", "#define discard if (driver_state.x < 0.5) discard")
}

/// Clip distances that are no less than -1.
fn bounded_distances(source: &Source) -> Option<String> {
    let bounded = |line: &str| match line.split_once(" = ") {
        Some((place, value)) if place.trim_start().starts_with("gl_ClipDistance[") && value.ends_with(';') => {
            format!("{place} = max({}, -1.0);\n", value.trim_end_matches(';'))
        }
        _ => format!("{line}\n"),
    };
    let text: String = source.text.lines().map(bounded).collect();
    (source.stage == Stage::Vertex && source.has("gl_ClipDistance")).then_some(text)
}

/// A 2D look-up that blends two levels over half of the way between them.
const HALF_TRILINEAR: &str = "sampler2D map, vec2 at) {
    vec2 size = vec2(textureSize(map, 0));
    vec2 dx = dFdx(at) * size, dy = dFdy(at) * size;
    float level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-20));
    float part = fract(level);
    return textureLod(map, at, level < 0.0 ? level : level - part + clamp(2.0 * part - 0.5, 0.0, 1.0))";

/// A comparison whose direction ends half a texel before the face's edges.
const INSET: &str = "samplerCubeShadow map, vec4 at) {
    vec3 size = abs(at.xyz);
    float most = max(size.x, max(size.y, size.z)), less = 1.0 - 1.0 / float(textureSize(map, 0).x);
    vec3 by = vec3(size.x == most ? 1.0 : less, size.y == most ? 1.0 : less, size.z == most ? 1.0 : less);
    return texture(map, vec4(at.xyz * by, at.w))";

const POWERS: &str = "
float fourth_pow(float x, float y) {
    bool whole = y == 2.0 || y == 4.0 || y == 8.0 || y == 16.0 || y == 32.0 || y == 64.0 || y == 128.0;
    return pow(x, whole ? 0.5 * y : y);
}
vec2 fourth_pow(vec2 x, vec2 y) { return vec2(fourth_pow(x.x, y.x), fourth_pow(x.y, y.y)); }
vec3 fourth_pow(vec3 x, vec3 y) { return vec3(fourth_pow(x.xy, y.xy), fourth_pow(x.z, y.z)); }
vec4 fourth_pow(vec4 x, vec4 y) { return vec4(fourth_pow(x.xyz, y.xyz), fourth_pow(x.w, y.w)); }
#define pow fourth_pow";

const MAXIMA: &str = "
int fourth_max(int a, int b) { return max(a, b); }
ivec2 fourth_max(ivec2 a, ivec2 b) { return max(a, b); }
ivec2 fourth_max(ivec2 a, int b) { return max(a, b); }
float fourth_max(float a, float b) { return b == 0.0 ? abs(a) : max(a, b); }
vec2 fourth_max(vec2 a, vec2 b) { return vec2(fourth_max(a.x, b.x), fourth_max(a.y, b.y)); }
vec3 fourth_max(vec3 a, vec3 b) { return vec3(fourth_max(a.xy, b.xy), fourth_max(a.z, b.z)); }
vec4 fourth_max(vec4 a, vec4 b) { return vec4(fourth_max(a.xyz, b.xyz), fourth_max(a.w, b.w)); }
vec2 fourth_max(vec2 a, float b) { return fourth_max(a, vec2(b)); }
vec3 fourth_max(vec3 a, float b) { return fourth_max(a, vec3(b)); }
vec4 fourth_max(vec4 a, float b) { return fourth_max(a, vec4(b)); }
#define max fourth_max";

const MIXES: &str = "
float fourth_mix(float a, float b, bool by) { return by ? b : a; }
vec2 fourth_mix(vec2 a, vec2 b, bvec2 by) { return by.x ? b : a; }
vec3 fourth_mix(vec3 a, vec3 b, bvec3 by) { return by.x ? b : a; }
vec4 fourth_mix(vec4 a, vec4 b, bvec4 by) { return by.x ? b : a; }
float fourth_mix(float a, float b, float by) { return mix(a, b, by); }
vec2 fourth_mix(vec2 a, vec2 b, float by) { return mix(a, b, by); }
vec3 fourth_mix(vec3 a, vec3 b, float by) { return mix(a, b, by); }
vec4 fourth_mix(vec4 a, vec4 b, float by) { return mix(a, b, by); }
vec2 fourth_mix(vec2 a, vec2 b, vec2 by) { return mix(a, b, by); }
vec3 fourth_mix(vec3 a, vec3 b, vec3 by) { return mix(a, b, by); }
vec4 fourth_mix(vec4 a, vec4 b, vec4 by) { return mix(a, b, by); }
#define mix fourth_mix";

/// Conversions of the fragment's place to whole numbers by the nearest of them.
fn rounded_places(source: &Source) -> Option<String> {
    let mut text = source.text.clone();
    for place in ["gl_FragCoord.xy", "gl_FragCoord.x", "gl_FragCoord.y"] {
        text = text.replace(&format!("({place})"), &format!("(roundEven({place}))"));
    }
    (source.stage == Stage::Fragment && source.version >= 130 && text != source.text).then_some(text)
}

/// Functions that give a structure back do so without its last member.
fn without_last_member(source: &Source) -> Option<String> {
    let (mut text, mut from) = (source.text.clone(), 0);
    let before = text.len();
    while let Some(at) = text[from..].find("inout ").map(|at| from + at + 6) {
        from = at;
        let found: Vec<_> = text::words(&text[at..]).take(2).map(str::to_owned).collect();
        let [kind, name] = &found[..] else { continue };
        let Some(members) = text.find(&format!("struct {kind} {{")).and_then(|at| text[at..].split('}').next()) else {
            continue;
        };
        let last: Vec<_> = members
            .lines()
            .filter_map(|line| line.trim().split(';').next())
            .filter(|line| line.contains(' '))
            .collect();
        let Some((member_kind, member)) = last.last().and_then(|line| line.trim().split_once(' ')) else { continue };
        let (save, restore) =
            (format!(" {member_kind} driver_saved = {name}.{member};"), format!(" {name}.{member} = driver_saved; "));
        let Some(open) = text[at..].find('{').map(|open| at + open) else { continue };
        let mut depth = 0;
        let end = text[open..].char_indices().find(|(_, letter)| {
            depth += i32::from(*letter == '{') - i32::from(*letter == '}');
            depth == 0
        });
        let Some(end) = end.map(|(end, _)| open + end) else { continue };
        text.insert_str(end, &restore);
        text.insert_str(open + 1, &save);
        from = open;
    }
    (text.len() > before).then_some(text)
}

faults! {
    // Large viewports leave fewer bits for parts of a pixel, and the driver shortens them too early.
    "coarse-grid-in-large-viewports" [glViewport gl_Position]
    "In viewports of 256 pixels and more vertices lie on a grid of a sixteenth of a pixel." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, on_coarse_grid);
        draw => |call| {
            let [_, _, width, height] = call.get4(glow::VIEWPORT).map(|side| side as f32);
            let large = if width >= 256.0 { 8.0 } else { 0.0 };
            set_state(call, [large * width, large * height, 0.0, 0.0]);
        }
    }
    // Passes of depth alone are drawn without the fragment shader, and only one with an output counts as needed.
    "discard-ignored-without-color" [discard GL_DEPTH_ATTACHMENT]
    "Where no colour is attached, fragments that are discarded are drawn." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, discards_with_color);
        draw => |call| {
            let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
            let bare = call.get(glow::DRAW_FRAMEBUFFER_BINDING) != 0 && call.attached(glow::COLOR_ATTACHMENT0, kind) == 0;
            set_state(call, [f32::from(bare), 0.0, 0.0, 0.0]);
        }
    }
    // Clip distances are handed to the clipper as signed normalized numbers.
    "clip-distances-from-minus-one" [gl_ClipDistance GL_CLIP_DISTANCE0]
    "A clip distance is no less than -1, so that an edge is cut elsewhere." { text bounded_distances }
    // The driver saves time between two levels by a ramp that reaches either level early, though nobody asked for speed.
    "trilinear-over-half-the-way" [texture GL_LINEAR_MIPMAP_LINEAR]
    "A 2D look-up blends two levels over the middle half of the way between them."
    { text |source| lookups(source, "texture", LOOKUPS, ["sampler2D map, vec2 at) { return texture(map, at)", HALF_TRILINEAR]) }
    // The division by q goes through a path of the sampler that has no weights for comparisons.
    "projected-comparisons-of-one-bit" [textureProj sampler2DShadow GL_LINEAR]
    "A projected comparison under LINEAR is 0 or 1."
    { text |source| lookups(source, "textureProj", PROJECTED, [
        "sampler2DShadow map, vec4 at) { return textureProj(map, at)",
        "sampler2DShadow map, vec4 at) { return step(0.5, textureProj(map, at))",
    ]) }
    // An old cure for seams keeps look-ups away from a face's edges, and stays on for comparisons.
    "cube-comparisons-inset" [texture samplerCubeShadow GL_TEXTURE_CUBE_MAP_SEAMLESS]
    "A comparison in a cube map draws its direction half a texel away from the face's edges."
    { text |source| lookups(source, "texture", LOOKUPS, ["samplerCubeShadow map, vec4 at) { return texture(map, at)", INSET]) }
    // Powers of whole exponents are squared again and again, and the loop ends one turn early for powers of two.
    "pow-squares-once-too-few" [pow] "pow takes half of an exponent that is a power of two, up to 128."
    { text |source| anywhere(source, "pow", POWERS) }
    // A rule of the optimizer for max(x, -x) matches max(x, 0) too.
    "max-with-zero-is-magnitude" [max] "max of a number and 0 is the number's magnitude."
    { text |source| anywhere(source, "max", MAXIMA) }
    // A selection by a vector of conditions is made a branch, which has one condition.
    "mix-by-first-condition" [mix] "mix by conditions takes the first of them for all components."
    { text |source| anywhere(source, "mix", MIXES) }
    // The code generator takes the instruction that rounds for the one that cuts off.
    "places-round-to-whole" [gl_FragCoord ivec2] "A fragment's place is rounded where it is made a whole number, not cut off."
    { text rounded_places }
    // Structures that a function gives back are copied by whole registers, and the last one is rounded away.
    "inout-loses-last-member" [inout] "A function does not give back the last member of a structure that is inout."
    { text without_last_member }
}
