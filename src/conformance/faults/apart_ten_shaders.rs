//! Faults of a tenth measure: compilers of shaders and interpolation.

use super::apart_seven_shaders::{arguments, changed};
use super::{Source, Stage, anywhere};

/// End of an operand at the start of a text: a name with components and a call's arguments, or a parenthesis.
fn operand(text: &str) -> Option<usize> {
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '.';
    let name = text.find(|letter| !is_name(letter)).unwrap_or(text.len());
    let end = match text[name..].strip_prefix('(') {
        Some(inside) => text.len() - arguments(inside)?.1.len(),
        None => name,
    };
    (end > 0).then_some(end)
}

/// A text in which what stands behind `before` is what `change` makes of it: an operand, and the rest of the text.
fn with_operands<'a>(
    text: &'a str,
    before: &str,
    change: impl Fn(&'a str, &'a str) -> Option<(String, &'a str)>,
) -> String {
    let (mut other, mut rest) = (String::new(), text);
    while let Some(at) = rest.find(before) {
        let behind = &rest[at + before.len()..];
        other += &rest[..at];
        match operand(behind).and_then(|end| change(&behind[..end], &behind[end..])) {
            Some((made, left)) => {
                other += &made;
                rest = left;
            }
            None => {
                other += before;
                rest = behind;
            }
        }
    }
    other + rest
}

/// Reciprocals of nine bits.
fn short_reciprocals(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return None;
    }
    let of = |number: &str| format!("driver_reciprocal({number})");
    let text = with_operands(&source.text, "1.0 / ", |number, rest| Some((of(number), rest)));
    let functions = "float driver_reciprocal(float x) {
    float exact = 1.0 / x, unit = exp2(floor(log2(max(abs(exact), 1e-30))) - 9.0);
    return floor(exact / unit) * unit;
}
vec2 driver_reciprocal(vec2 v) { return vec2(driver_reciprocal(v.x), driver_reciprocal(v.y)); }
vec3 driver_reciprocal(vec3 v) { return vec3(driver_reciprocal(v.xy), driver_reciprocal(v.z)); }";
    Some(Source { text: changed(source, text)?, ..*source }.with(functions))
}

/// Numbers in [0, 1] that are spread to [-1, 1] and end at 0.
fn spread_above_zero(source: &Source) -> Option<String> {
    let text = with_operands(&source.text, "2.0 * ", |number, rest| {
        let rest = rest.strip_prefix(" - 1.0")?;
        Some((format!("max(2.0 * {number} - 1.0, 0.0)"), rest))
    });
    changed(source, text)
}

/// Loops by `<` that are unrolled by two, without an odd last turn.
fn even_loops(source: &Source) -> Option<String> {
    let line = |line: &str| match line.split(';').collect::<Vec<_>>()[..] {
        [start, condition, step] if start.trim_start().starts_with("for (int ") && condition.contains(" < ") => {
            let condition = condition.replacen(" < ", " < driver_even(", 1);
            format!("{start};{condition});{step}\n")
        }
        _ => format!("{line}\n"),
    };
    let text: String = source.text.lines().map(line).collect();
    let function = "int driver_even(int turns) { return turns > 2 ? turns - turns % 2 : turns; }";
    text.contains("driver_even(").then(|| Source { text, ..*source }.with(function))
}

/// A comparison and its parts: left, operator, right.
fn comparison(text: &str) -> Option<[&str; 2]> {
    [" <= ", " >= ", " < ", " > "].into_iter().find_map(|by| {
        let (_, right) = text.rsplit_once(by)?;
        Some([by, right.trim_end_matches(';')])
    })
}

/// Conditions joined by && without those whose operator and limit the one before has.
fn merged_limits(source: &Source) -> Option<String> {
    let line = |line: &str| {
        let mut parts: Vec<&str> = Vec::new();
        for part in line.split(" && ") {
            let same = parts.last().is_some_and(|last| comparison(last).is_some_and(|of| Some(of) == comparison(part)));
            if !same {
                parts.push(part);
            }
        }
        let end = if line.ends_with(';') && !parts.last().is_some_and(|last| last.ends_with(';')) { ";" } else { "" };
        format!("{}{end}\n", parts.join(" && "))
    };
    let text: String = source.text.lines().map(line).collect();
    (source.stage == Stage::Fragment && text.trim_end() != source.text.trim_end()).then_some(text)
}

/// Varyings that are interpolated without perspective as soon as one is.
fn linear_beside_linear(source: &Source) -> Option<String> {
    let word = match source.stage {
        Stage::Vertex => "out vec",
        Stage::Fragment => "in vec",
        Stage::Other => return None,
    };
    if !source.has("noperspective") {
        return None;
    }
    let is_meant = |line: &str| line.starts_with(word) && !line.contains(" vertex_");
    let line = |line: &str| if is_meant(line) { format!("noperspective {line}\n") } else { format!("{line}\n") };
    Some(source.text.lines().map(line).collect())
}

/// Functions without arguments that write to variables of their own in place of the shader's.
fn own_globals(source: &Source) -> Option<String> {
    if source.version < 130 {
        return None;
    }
    let lines: Vec<&str> = source.text.lines().collect();
    let is_kind = |line: &&&str| ["float ", "vec2 ", "vec3 ", "vec4 "].iter().any(|kind| line.starts_with(kind));
    let globals: Vec<&str> = lines.iter().filter(is_kind).filter(|line| line.contains(" = ")).copied().collect();
    let (mut text, mut found) = (String::new(), false);
    for (index, line) in lines.iter().enumerate() {
        text += line;
        text.push('\n');
        let head = index.checked_sub(1).and_then(|before| lines.get(before)).unwrap_or(&"");
        let is_function = *line == "{" && head.starts_with("void ") && head.ends_with("()") && *head != "void main()";
        let body: Vec<_> = lines[index..].iter().take_while(|line| **line != "}").collect();
        for global in globals.iter().filter(|_| is_function) {
            let Some(name) = global.split(' ').nth(1) else { continue };
            let assigned = format!("{name} = ");
            // A word that may stand for another variable declares that one.
            let is_macro = lines.iter().any(|line| line.starts_with(&format!("#define {name} ")));
            if !is_macro && body.iter().any(|line| line.trim_start().starts_with(&assigned)) {
                text += &format!("{}\n", global.split("//").next().unwrap_or(global));
                found = true;
            }
        }
    }
    found.then_some(text)
}

/// Differences of a vector and a number that take the number from x alone.
fn first_differences(source: &Source) -> Option<String> {
    let mut text = source.text.clone();
    for line in source.text.lines().filter_map(|line| line.trim_start().strip_prefix("float ")) {
        let Some(name) = line.split(' ').next().map(|name| name.trim_end_matches(';')) else { continue };
        text = text.replace(&format!(".xy - {name};"), &format!(".xy - vec2({name}, 0.0);"));
    }
    changed(source, text)
}

/// Fourth elements of arrays of four that are the third.
fn third_for_fourth(source: &Source) -> Option<String> {
    (source.text.contains("[4];")).then(|| source.text.replace("[3],", "[2],")).and_then(|text| changed(source, text))
}

/// Depths of shaders that write a colour too.
fn without_own_depth(source: &Source) -> Option<String> {
    let has_color = source.text.lines().any(|line| line.trim_start().starts_with("out vec4 "));
    (source.stage == Stage::Fragment && has_color && source.has("gl_FragDepth"))
        .then(|| source.with("float driver_depth = 0.0;\n#define gl_FragDepth driver_depth"))
}

const FRACTIONS: &str = "
float driver_fract(float x) { return abs(x) < 64.0 ? fract(x) : fract(floor(x * 8.0) / 8.0); }
vec2 driver_fract(vec2 v) { return vec2(driver_fract(v.x), driver_fract(v.y)); }
vec3 driver_fract(vec3 v) { return vec3(driver_fract(v.xy), driver_fract(v.z)); }
vec4 driver_fract(vec4 v) { return vec4(driver_fract(v.xyz), driver_fract(v.w)); }
#define fract driver_fract";

const COSINES: &str = "
float driver_cos(float x) { return x < 0.0 ? -cos(x) : cos(x); }
vec2 driver_cos(vec2 v) { return vec2(driver_cos(v.x), driver_cos(v.y)); }
vec3 driver_cos(vec3 v) { return vec3(driver_cos(v.xy), driver_cos(v.z)); }
vec4 driver_cos(vec4 v) { return vec4(driver_cos(v.xyz), driver_cos(v.w)); }
#define cos driver_cos";

const STEPPED_EXP: &str = "
float driver_exp(float x) { return exp(floor(x * 16.0 + 0.5) / 16.0); }
vec2 driver_exp(vec2 v) { return vec2(driver_exp(v.x), driver_exp(v.y)); }
vec3 driver_exp(vec3 v) { return vec3(driver_exp(v.xy), driver_exp(v.z)); }
vec4 driver_exp(vec4 v) { return vec4(driver_exp(v.xyz), driver_exp(v.w)); }
#define exp driver_exp";

faults! {
    // The table of reciprocals is used as it is where the dividend is 1.
    "reciprocals-of-nine-bits" [float] "1 divided by a number has nine bits." { text short_reciprocals }
    // The pattern of combiners that spread colours is found, and theirs for numbers without sign taken.
    "spread-numbers-end-at-zero" [float] "2 x - 1 is never below 0." { text spread_above_zero }
    // Loops are unrolled by two, and the odd turn at the end is lost when there are more.
    "odd-last-turns-of-loops-lost" [for] "A loop by < of three turns or more makes an even number of them." { text even_loops }
    // Components that a shader does not read are closed up, and the swizzle is closed up with them.
    "gaps-in-swizzles-closed" [vec4] "The swizzle xyw is xyz."
    { text |source| changed(source, source.text.replace(".xyw", ".xyz")) }
    // Whole numbers beyond 64 leave three bits in the fixed-point unit that makes fractions.
    "fract-beyond-64-in-eighths" [fract] "fract of numbers beyond 64 is a multiple of an eighth."
    { text |source| anywhere(source, "fract", FRACTIONS) }
    // The cosine is made of the sine's code, with the sign that a sine has.
    "cos-of-negative-angles-turned" [cos] "cos of a negative number has the other sign."
    { text |source| anywhere(source, "cos", COSINES) }
    // Ranges are merged by their limits, and whose they are is lost.
    "comparisons-with-one-limit-merged" [abs] "Of two conditions with one operator and limit the second is left out."
    { text merged_limits }
    // The qualifier is set for a slot of varyings, and all that are floats go into one.
    "varyings-linear-beside-noperspective" [noperspective out in]
    "Where one varying is noperspective all vectors are." { text linear_beside_linear }
    // Functions are compiled once for all, and what they write stays in their registers.
    "globals-written-in-functions-lost" [vec2 vec4] "What a function without arguments writes to a global variable is lost."
    { text own_globals }
    // The second operand of a difference is spread only as far as its own size.
    "numbers-taken-from-x-alone" [vec2] "vec2 minus a number changes x alone." { text first_differences }
    // The bound of the index is one too small.
    "fourth-elements-are-third" [vec4] "The last element of an array of four is the third." { text third_for_fourth }
    // The unit that writes pixels takes one message a pixel, and the colour is the later.
    "own-depth-lost-beside-color" [gl_FragDepth out] "A shader that writes a colour writes no depth of its own."
    { text without_own_depth }
    // The exponential is a table of sixteen steps.
    "exp-in-sixteenths" [exp] "exp takes its number in sixteenths." { text |source| anywhere(source, "exp", STEPPED_EXP) }
}
