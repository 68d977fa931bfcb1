//! Faults of GLSL's functions in one range of numbers or one size, and of what programs are made of.

use super::{Source, anywhere};

/// A function of one number in place of `name`: `body` of `x`, for scalars and for each component of vectors.
fn one(source: &Source, name: &str, body: &str) -> Option<String> {
    let of_size = |size: usize| -> String {
        let parts: Vec<String> = (0..size).map(|part| format!("wrong_{name}(v[{part}])")).collect();
        format!("vec{size} wrong_{name}(vec{size} v) {{ return vec{size}({}); }}\n", parts.join(", "))
    };
    let vectors: String = (2..=4).map(of_size).collect();
    let scalar = format!("float wrong_{name}(float x) {{ return {body}; }}\n");
    anywhere(source, name, &format!("{scalar}{vectors}#define {name} wrong_{name}"))
}

/// The same of two numbers, `x` and `y`: the second may be a scalar beside a vector.
fn two(source: &Source, name: &str, body: &str) -> Option<String> {
    let of_size = |size: usize, other: &str, index: fn(usize) -> String| -> String {
        let parts: Vec<String> = (0..size).map(|part| format!("wrong_{name}(v[{part}], w{})", index(part))).collect();
        format!("vec{size} wrong_{name}(vec{size} v, {other} w) {{ return vec{size}({}); }}\n", parts.join(", "))
    };
    let vectors: String = (2..=4)
        .map(|size| {
            of_size(size, &format!("vec{size}"), |part| format!("[{part}]"))
                + &of_size(size, "float", |_| String::new())
        })
        .collect();
    let scalar = format!("float wrong_{name}(float x, float y) {{ return {body}; }}\n");
    anywhere(source, name, &format!("{scalar}{vectors}#define {name} wrong_{name}"))
}

/// A shader in which other text stands.
fn replaced(source: &Source, from: &str, to: &str) -> Option<String> {
    (source.version >= 130 && source.text.contains(from)).then(|| source.text.replace(from, to))
}

faults! {
    "floor-of-large-numbers" [floor] "floor of what is beyond 4096 leaves it as it is."
    { text |source| one(source, "floor", "abs(x) > 4096.0 ? x : floor(x)") }
    "mod-by-negatives" [mod] "mod by a negative number is mod by its magnitude."
    { text |source| two(source, "mod", "mod(x, abs(y))") }
    "pow-of-exponents-to-16" [pow] "Exponents of pow end at 16."
    { text |source| two(source, "pow", "pow(x, min(y, 16.0))") }
    "log2-of-small-numbers" [log2] "log2 of what is below 2^-10 is -10."
    { text |source| one(source, "log2", "log2(max(x, 0.0009765625))") }
    "acos-of-magnitudes" [acos] "acos of a negative number is that of its magnitude."
    { text |source| one(source, "acos", "acos(abs(x))") }
    "sqrt-of-large-numbers-coarse" [sqrt] "sqrt of what is beyond 10000 is right to 2^-10 alone."
    { text |source| one(source, "sqrt", "x > 1e4 ? sqrt(x) * 1.001 : sqrt(x)") }
    "inout-is-in" [inout] "A parameter that is inout is not copied back."
    { text |source| replaced(source, "inout ", "in ") }
    "default-never-taken" [switch] "The default of a switch is never taken."
    { text |source| replaced(source, "default:", "case 99:") }
    "int-rounds" [int] "int() of a float is the nearest integer."
    { text |source| anywhere(source, "int", "
int wrong_int(float x) { return int(floor(x + 0.5)); }
int wrong_int(bool x) { return int(x); }
int wrong_int(int x) { return x; }
int wrong_int(uint x) { return int(x); }
#define int(x) wrong_int(x)") }
}
