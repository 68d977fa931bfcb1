//! Faults of a third measure: shaders, primitives, the fixed-function pipeline.

use super::apart_shaders::HALVES;
use super::lookups::{LOOKUPS, PROJECTED};
use super::{Call, Source, Stage, after_main, anywhere, define};
use crate::context::compatibility::raw;

/// `textureGrad` with the shorter derivative for both.
const SHORTER: &str = "
vec4 third_grad(sampler1D map, float at, float dx, float dy) { return textureGrad(map, at, dx, dy); }
vec4 third_grad(sampler2D map, vec2 at, vec2 dx, vec2 dy) {
    vec2 size = vec2(textureSize(map, 0));
    vec2 shorter = length(size * dx) < length(size * dy) ? dx : dy;
    return textureGrad(map, at, shorter, shorter);
}
vec4 third_grad(sampler3D map, vec3 at, vec3 dx, vec3 dy) { return textureGrad(map, at, dx, dy); }
vec4 third_grad(samplerCube map, vec3 at, vec3 dx, vec3 dy) { return textureGrad(map, at, dx, dy); }
vec4 third_grad(sampler2DArray map, vec3 at, vec2 dx, vec2 dy) { return textureGrad(map, at, dx, dy); }
float third_grad(sampler2DShadow map, vec3 at, vec2 dx, vec2 dy) { return textureGrad(map, at, dx, dy); }
#define textureGrad third_grad";

/// `pow` by a logarithm of eleven bits.
const POWERS: &str = "
float third_pow(float x, float y) { return x > 0.0 ? exp2(y * apart_half(log2(x))) : pow(x, y); }
vec2 third_pow(vec2 x, vec2 y) { return vec2(third_pow(x.x, y.x), third_pow(x.y, y.y)); }
vec3 third_pow(vec3 x, vec3 y) { return vec3(third_pow(x.xy, y.xy), third_pow(x.z, y.z)); }
vec4 third_pow(vec4 x, vec4 y) { return vec4(third_pow(x.xyz, y.xyz), third_pow(x.w, y.w)); }
#define pow third_pow";

/// A shader with comparisons that do not clamp their reference to 1.
fn unclamped(source: &Source) -> Option<String> {
    let is_meant = source.stage == Stage::Fragment && source.version >= 130 && source.has("sampler2DShadow");
    if !is_meant || source.has("samplerCubeArray") || source.has("samplerCubeArrayShadow") {
        return None;
    }
    let plain = LOOKUPS.replace(
        "sampler2DShadow map, vec3 at) { return texture(map, at);",
        "sampler2DShadow map, vec3 at) {
    float found = texture(map, at);
    // 1 where the function is LESS or LEQUAL.
    float least = texture(map, vec3(at.xy, 0.0));
    return at.z > 1.0 && least == 1.0 ? 0.0 : found;",
    );
    let projected = PROJECTED.replace(
        "sampler2DShadow map, vec4 at) { return textureProj(map, at);",
        "sampler2DShadow map, vec4 at) {
    float found = textureProj(map, at);
    float least = textureProj(map, vec4(at.xy, 0.0, at.w));
    return at.z > at.w && at.w > 0.0 && least == 1.0 ? 0.0 : found;",
    );
    let lines = [("texture", plain), ("textureProj", projected)].into_iter().filter(|(word, _)| source.has(word));
    let lines: String = lines.map(|(_, lines)| lines).collect();
    (!lines.is_empty()).then(|| source.with(&lines))
}

/// A shader whose loops by `while` are left after four turns.
fn short_loops(source: &Source) -> Option<String> {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let (mut text, mut rest, mut found) = (String::new(), source.text.as_str(), 0);
    while let Some(at) = rest.find("while") {
        let (before, after) = (&rest[..at], &rest[at + 5..]);
        text += before;
        rest = after;
        let condition = after.trim_start().strip_prefix('(').filter(|_| !before.ends_with(is_letter)).and_then(closed);
        match condition {
            Some((condition, behind)) if !behind.trim_start().starts_with(';') => {
                text += &format!("for (int turns_{found} = 0; turns_{found} < 4 && ({condition}); ++turns_{found})");
                (rest, found) = (behind, found + 1);
            }
            _ => text += "while",
        }
    }
    (found > 0 && source.version >= 130).then(|| text + rest)
}

/// Text before the parenthesis that closes one, and text behind it.
fn closed(text: &str) -> Option<(&str, &str)> {
    let mut depth = 1;
    for (index, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some((&text[..index], &text[index + 1..]));
        }
    }
    None
}

/// Draws a strip as triangles of their own, each with its vertices in the strip's order.
fn draw_in_order(call: &mut Call) {
    if call.u(0) != glow::TRIANGLE_STRIP {
        return;
    }
    call.skip();
    call.set(0, glow::TRIANGLES);
    let by_index = call.name == "glDrawElements";
    let size = match call.u(2) {
        glow::UNSIGNED_INT => 4,
        glow::UNSIGNED_SHORT => 2,
        _ => 1,
    };
    let triangles = call.i(if by_index { 1 } else { 2 }) - 2;
    call.set(if by_index { 1 } else { 2 }, 3);
    for _ in 0..triangles {
        call.again();
        if by_index {
            call.set_pointer(3, call.pointer(3).wrapping_byte_add(size));
        } else {
            call.add(1, 1.0);
        }
    }
}

faults! {
    "pow-by-halves" [pow] "pow takes a logarithm of eleven bits."
    { text |source| anywhere(source, "pow", &format!("{HALVES}{POWERS}")) }
    "texturegrad-by-shorter" [textureGrad] "The level of detail of textureGrad is that of the shorter derivative."
    { text |source| define(source, Stage::Fragment, "textureGrad", SHORTER) }
    "derivatives-of-halves" [dFdx dFdy fwidth] "Derivatives are those of numbers of eleven bits."
    { text |source| {
        let lines = "\n#define dFdx(x) dFdx(apart_half(x))\n#define dFdy(x) dFdy(apart_half(x))\n#define fwidth(x) fwidth(apart_half(x))";
        let word = ["dFdx", "dFdy", "fwidth"].into_iter().find(|word| source.has(word))?;
        define(source, Stage::Fragment, word, &format!("{HALVES}{lines}"))
    } }
    "fwidth-without-signs" [fwidth] "fwidth is the magnitude of the sum, not the sum of magnitudes."
    { text |source| define(source, Stage::Fragment, "fwidth", "#define fwidth(x) abs(dFdx(x) + dFdy(x))") }
    "interpolation-by-w-of-1024" [smooth gl_Position] "Varyings are interpolated as if no w were beyond 1024."
    { text |source| after_main(source, Stage::Vertex,
        "if (gl_Position.w > 1024.0) gl_Position *= 1024.0 / gl_Position.w;") }
    "while-loops-of-four-turns" [while] "Loops by while are left after four turns." { text short_loops }
    "dot-of-halves" [dot] "dot takes numbers of eleven bits."
    { text |source| define(source, Stage::Fragment, "dot",
        &format!("{HALVES}\n#define dot(a, b) dot(apart_half(a), apart_half(b))")) }
    "references-beyond-one-fail" [texture textureProj sampler2DShadow GL_DEPTH_COMPONENT24]
    "A comparison does not clamp its reference to 1: beyond it nothing is lit." { text unclamped }
    "strips-turn-every-second" [GL_TRIANGLE_STRIP glDrawArrays glDrawElements]
    "Every second triangle of a strip has the other winding." { glDrawArrays glDrawElements => draw_in_order }
    "outlines-of-culled-faces" [glPolygonMode GL_LINE GL_CULL_FACE]
    "Faces that are drawn as outlines are not culled." {
        draw => |call| if call.get4(glow::POLYGON_MODE)[0] as u32 != glow::FILL { call.with(glow::CULL_FACE, false) }
    }
    "far-plane-clamps" [gl_Position GL_DEPTH_CLAMP]
    "A vertex beyond the far plane is moved onto it, and what it belongs to is not clipped there."
    { text |source| after_main(source, Stage::Vertex,
        "if (gl_Position.w > 0.0) gl_Position.z = min(gl_Position.z, gl_Position.w);") }
    "alpha-gequal-is-greater" [glAlphaFunc GL_GEQUAL]
    "The alpha function GEQUAL is GREATER." { glAlphaFunc => |call| { call.replace(0, glow::GEQUAL, glow::GREATER); } }
    "scale-of-four-is-two" [GL_RGB_SCALE glTexEnvf]
    "RGB_SCALE of 4 is 2." { glTexEnvf => |call| if call.u(1) == raw::RGB_SCALE && call.f(2) == 4.0 { call.set(2, 2.0) } }
    // What follows takes the place of one that proves to do nothing.
    "depth-range-of-nothing-is-whole" [glDepthRangef glDepthRange]
    "A depth range whose near is its far is taken for [0, 1]." {
        glDepthRange glDepthRangef => |call| if call.f(0) == call.f(1) {
            call.set(0, 0.0);
            call.set(1, 1.0);
        }
    }
}
