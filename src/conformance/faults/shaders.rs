//! Faults of shaders: derivatives, GLSL's variables, qualifiers, `discard`.

use super::{Stage, after_main, anywhere, define, loops_once};

const FRAGMENT: Stage = Stage::Fragment;
const VERTEX: Stage = Stage::Vertex;

faults! {
    "dfdx-zero" [dFdx] "dFdx is 0."
    { text |source| define(source, FRAGMENT, "dFdx", "#define dFdx(x) (0.0 * dFdx(x))") }
    "dfdy-zero" [dFdy] "dFdy is 0."
    { text |source| define(source, FRAGMENT, "dFdy", "#define dFdy(x) (0.0 * dFdy(x))") }
    "dfdy-turned" [dFdy] "dFdy goes down the window."
    { text |source| define(source, FRAGMENT, "dFdy", "#define dFdy(x) (-dFdy(x))") }
    "dfdx-turned" [dFdx] "dFdx goes to the left."
    { text |source| define(source, FRAGMENT, "dFdx", "#define dFdx(x) (-dFdx(x))") }
    "dfdx-halved" [dFdx] "dFdx is half as large."
    { text |source| define(source, FRAGMENT, "dFdx", "#define dFdx(x) (0.5 * dFdx(x))") }
    "dfdx-is-dfdy" [dFdx] "dFdx is dFdy."
    { text |source| define(source, FRAGMENT, "dFdx", "#define dFdx(x) dFdy(x)") }
    "fwidth-of-x" [fwidth] "fwidth leaves out y."
    { text |source| define(source, FRAGMENT, "fwidth", "#define fwidth(x) abs(dFdx(x))") }
    "fwidth-is-larger" [fwidth] "fwidth is the larger of both derivatives."
    { text |source| define(source, FRAGMENT, "fwidth", "#define fwidth(x) max(abs(dFdx(x)), abs(dFdy(x)))") }
    "discard-ignored" [discard] "A fragment that is discarded is drawn."
    { text |source| define(source, FRAGMENT, "discard", "#define discard 0") }
    "discard-keeps-depth" [discard] "A fragment that is discarded writes its depth."
    { text |source| define(source, FRAGMENT, "discard", "#define discard { gl_FragDepth = gl_FragCoord.z; return; }") }
    "fragcoord-at-corners" [gl_FragCoord] "gl_FragCoord has the pixel's lower left corner."
    { text |source| define(source, FRAGMENT, "gl_FragCoord",
        "#define gl_FragCoord (gl_FragCoord - vec4(0.5, 0.5, 0.0, 0.0))") }
    "fragcoord-one-row-off" [gl_FragCoord] "gl_FragCoord.y is one more."
    { text |source| define(source, FRAGMENT, "gl_FragCoord", "#define gl_FragCoord (gl_FragCoord + vec4(0.0, 1.0, 0.0, 0.0))") }
    "fragcoord-z-clip" [gl_FragCoord] "gl_FragCoord.z goes from -1 to 1."
    { text |source| define(source, FRAGMENT, "gl_FragCoord",
        "#define gl_FragCoord vec4(gl_FragCoord.xy, 2.0 * gl_FragCoord.z - 1.0, gl_FragCoord.w)") }
    "fragcoord-z-of-16-bits" [gl_FragCoord] "gl_FragCoord.z has 16 bits."
    { text |source| define(source, FRAGMENT, "gl_FragCoord",
        "#define gl_FragCoord vec4(gl_FragCoord.xy, floor(65535.0 * gl_FragCoord.z) / 65535.0, gl_FragCoord.w)") }
    "fragcoord-w-not-inverted" [gl_FragCoord] "gl_FragCoord.w is the clip position's w."
    { text |source| define(source, FRAGMENT, "gl_FragCoord",
        "#define gl_FragCoord vec4(gl_FragCoord.xyz, 1.0 / gl_FragCoord.w)") }
    "fragdepth-ignored" [gl_FragDepth] "The depth that a shader writes is not used."
    { text |source| define(source, FRAGMENT, "gl_FragDepth", "float unused_depth;\n#define gl_FragDepth unused_depth") }
    "fragdepth-of-16-bits" [gl_FragDepth] "The depth that a shader writes has 16 bits."
    { text |source| source.has("gl_FragDepth").then(|| after_main(source, FRAGMENT,
        "gl_FragDepth = floor(65535.0 * gl_FragDepth) / 65535.0;")).flatten() }
    "fragdepth-clamped-by-own" [gl_FragDepth] "The depth that a shader writes is never nearer than the fragment's own."
    { text |source| source.has("gl_FragDepth").then(|| after_main(source, FRAGMENT,
        "gl_FragDepth = max(gl_FragDepth, gl_FragCoord.z);")).flatten() }
    "position-one-pixel-off" [gl_Position] "Vertices lie a little to the right."
    { text |source| after_main(source, VERTEX, "gl_Position.x += 0.02 * gl_Position.w;") }
    "position-of-12-bits" [gl_Position] "Positions have 12 bits."
    { text |source| after_main(source, VERTEX, "gl_Position.xy = floor(gl_Position.xy * 4096.0 + 0.5) / 4096.0;") }
    "position-too-deep" [gl_Position] "Vertices lie 2^-12 deeper."
    { text |source| after_main(source, VERTEX, "gl_Position.z += gl_Position.w / 4096.0;") }
    "position-w-never-negative" [gl_Position] "Vertices behind the eye are drawn in front of it."
    { text |source| after_main(source, VERTEX, "gl_Position.w = abs(gl_Position.w);") }
    "position-not-invariant" [invariant gl_Position] "Every second vertex shader computes positions 2^-20 deeper."
    { text |source| if source.number % 4 >= 2 {
        after_main(source, VERTEX, "gl_Position.z += gl_Position.w / 1048576.0;")
    } else {
        None
    } }
    "clip-distances-turned" [gl_ClipDistance] "What a clip distance keeps is clipped."
    { text |source| if source.has("gl_ClipDistance") {
        after_main(source, VERTEX, "gl_ClipDistance[0] = -gl_ClipDistance[0];")
    } else {
        None
    } }
    "clip-distance-without-sign" [gl_ClipDistance] "Clip distances keep everything."
    { text |source| if source.has("gl_ClipDistance") {
        after_main(source, VERTEX, "gl_ClipDistance[0] = abs(gl_ClipDistance[0]);")
    } else {
        None
    } }
    "flat-is-smooth" [flat] "flat is interpolated."
    { text |source| anywhere(source, "flat", "#define flat") }
    "noperspective-is-smooth" [noperspective] "noperspective is interpolated with perspective."
    { text |source| anywhere(source, "noperspective", "#define noperspective") }
    "smooth-is-noperspective" [in out] "Varyings are interpolated without perspective."
    { text |source| {
        let other = source.text.replace("\nout vec4 ", "\nnoperspective out vec4 ").replace("\nin vec4 ", "\nnoperspective in vec4 ");
        let varyings = match source.stage {
            Stage::Vertex => other.replace("\nnoperspective in vec4 ", "\nin vec4 "),
            _ => other.replace("\nnoperspective out vec4 ", "\nout vec4 "),
        };
        (source.version >= 130 && varyings != source.text).then_some(varyings)
    } }
    "layout-ignored" [layout location] "A location of an attribute is not kept."
    { text |source| if source.has("location") && source.stage == VERTEX {
        Some(source.text.replace("location = 1", "location = 9").replace("location = 2", "location = 1").replace("location = 9", "location = 2"))
    } else {
        None
    } }
    "loops-once" [for] "A loop is gone through once."
    { text |source| loops_once(source, FRAGMENT) }
    "divisions-coarse" [gl_Position] "w of positions is right to 2^-8 alone."
    { text |source| after_main(source, VERTEX, "gl_Position.w *= 1.0 + 1.0 / 256.0;") }
}
