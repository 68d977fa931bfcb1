//! Faults of GLSL's functions on numbers and vectors.

use super::anywhere;

faults! {
    "abs-ignored" [abs] "abs leaves the sign."
    { text |source| anywhere(source, "abs", "#define abs(x) (x)") }
    "clamp-without-low" [clamp] "clamp has no lower bound."
    { text |source| anywhere(source, "clamp", "#define clamp(x, a, b) min(x, b)") }
    "clamp-without-high" [clamp] "clamp has no upper bound."
    { text |source| anywhere(source, "clamp", "#define clamp(x, a, b) max(x, a)") }
    "cos-is-sin" [cos] "cos is sin."
    { text |source| anywhere(source, "cos", "#define cos(x) sin(x)") }
    "sin-is-cos" [sin] "sin is cos."
    { text |source| anywhere(source, "sin", "#define sin(x) cos(x)") }
    "sin-in-first-turn-only" [sin] "sin of angles beyond one turn is 0."
    { text |source| anywhere(source, "sin", "#define sin(x) (abs(x) > 6.3 ? 0.0 : sin(x))") }
    "cross-turned" [cross] "cross has the other sign."
    { text |source| anywhere(source, "cross", "#define cross(a, b) cross(b, a)") }
    "dot-without-last" [dot] "dot of three components leaves out the last."
    { text |source| anywhere(source, "dot", "
float broken_dot(vec2 a, vec2 b) { return dot(a, b); }
float broken_dot(vec3 a, vec3 b) { return dot(a.xy, b.xy); }
float broken_dot(vec4 a, vec4 b) { return dot(a, b); }
#define dot(a, b) broken_dot(a, b)") }
    "dot-of-four-without-last" [dot] "dot of four components leaves out the last."
    { text |source| anywhere(source, "dot", "
float broken_dot(vec2 a, vec2 b) { return dot(a, b); }
float broken_dot(vec3 a, vec3 b) { return dot(a, b); }
float broken_dot(vec4 a, vec4 b) { return dot(a.xyz, b.xyz); }
#define dot(a, b) broken_dot(a, b)") }
    "exp-of-two" [exp] "exp has the base 2."
    { text |source| anywhere(source, "exp", "#define exp(x) exp2(x)") }
    "log2-natural" [log2] "log2 has the base e."
    { text |source| anywhere(source, "log2", "#define log2(x) log(x)") }
    "log2-coarse" [log2] "log2 is right to 2^-6 alone."
    { text |source| anywhere(source, "log2", "#define log2(x) (floor(64.0 * log2(x)) / 64.0)") }
    "pow-one-more" [pow] "pow multiplies once too often."
    { text |source| anywhere(source, "pow", "#define pow(x, y) pow(x, (y) + 1.0)") }
    "pow-of-zero-is-one" [pow] "pow of 0 is 1."
    { text |source| anywhere(source, "pow", "#define pow(x, y) ((x) == 0.0 ? 1.0 : pow(x, y))") }
    "floor-towards-zero" [floor] "floor of what is negative is one more."
    { text |source| anywhere(source, "floor", "#define floor(x) trunc(x)") }
    "floor-is-round" [floor] "floor gives the nearest whole number."
    { text |source| anywhere(source, "floor", "#define floor(x) roundEven(x)") }
    "fract-of-magnitude" [fract] "fract of what is negative is negative."
    { text |source| anywhere(source, "fract", "#define fract(x) ((x) - trunc(x))") }
    "fract-is-complement" [fract] "fract is 1 less itself."
    { text |source| anywhere(source, "fract", "#define fract(x) (1.0 - fract(x))") }
    "greater-than-is-strict" [greaterThanEqual] "greaterThanEqual is false for equals."
    { text |source| anywhere(source, "greaterThanEqual", "#define greaterThanEqual(a, b) greaterThan(a, b)") }
    "greater-than-is-less" [greaterThanEqual] "greaterThanEqual has its operands exchanged."
    { text |source| anywhere(source, "greaterThanEqual", "#define greaterThanEqual(a, b) greaterThanEqual(b, a)") }
    "inversesqrt-coarse" [inversesqrt] "inversesqrt is right to 2^-6 alone."
    { text |source| anywhere(source, "inversesqrt", "#define inversesqrt(x) (inversesqrt(x) * 1.015)") }
    "sqrt-coarse" [sqrt] "sqrt is right to 2^-6 alone."
    { text |source| anywhere(source, "sqrt", "#define sqrt(x) (sqrt(x) * 1.015)") }
    "sqrt-ignored" [sqrt] "sqrt gives its argument."
    { text |source| anywhere(source, "sqrt", "#define sqrt(x) (x)") }
    "length-of-two" [length] "length of three components leaves out the last."
    { text |source| anywhere(source, "length", "
float broken_length(vec2 v) { return length(v); }
float broken_length(vec3 v) { return length(v.xy); }
float broken_length(vec4 v) { return length(v); }
#define length(v) broken_length(v)") }
    "length-squared" [length] "length is not rooted."
    { text |source| anywhere(source, "length", "#define length(v) dot(v, v)") }
    "distance-squared" [distance] "distance is not rooted."
    { text |source| anywhere(source, "distance", "#define distance(a, b) dot((a) - (b), (a) - (b))") }
    "max-is-first" [max] "max gives its first argument."
    { text |source| anywhere(source, "max", "#define max(a, b) (a)") }
    "max-is-min" [max min] "max and min are exchanged."
    { text |source| anywhere(source, "max", "
#define max(a, b) min(a, b)") }
    "min-is-first" [min] "min gives its first argument."
    { text |source| anywhere(source, "min", "#define min(a, b) (a)") }
    "mix-turned" [mix] "mix takes the other share."
    { text |source| anywhere(source, "mix", "#define mix(a, b, t) mix(b, a, t)") }
    "normalize-ignored" [normalize] "normalize leaves the length."
    { text |source| anywhere(source, "normalize", "#define normalize(v) (v)") }
    "normalize-of-two" [normalize] "normalize takes the length of the first two components."
    { text |source| anywhere(source, "normalize", "
vec2 broken_normalize(vec2 v) { return normalize(v); }
vec3 broken_normalize(vec3 v) { return v / max(length(v.xy), 0.1); }
vec4 broken_normalize(vec4 v) { return normalize(v); }
#define normalize(v) broken_normalize(v)") }
}
