//! Faults of an eighth measure: compilers of shaders.

use super::apart_seven_shaders::{arguments, changed, with_calls};
use super::{Source, Stage, after_main, words};

/// A text whose lines are changed.
fn with_lines(source: &Source, change: impl Fn(&str) -> String) -> Option<String> {
    changed(source, source.text.lines().map(|line| change(line) + "\n").collect())
}

/// Tests whether a text is one identifier.
fn is_name(text: &str) -> bool {
    words(text).next() == Some(text) && !text.starts_with(|letter: char| letter.is_ascii_digit())
}

/// Clip distances whose number is a variable are all the first.
fn first_distance(source: &Source) -> Option<String> {
    const PLACE: &str = "gl_ClipDistance[";
    with_lines(source, |line| {
        let assigned = line.trim_start().strip_prefix(PLACE).and_then(|rest| rest.split_once("] = "));
        match assigned {
            Some((index, value)) if is_name(index) => format!("{{ {PLACE}{index}] = 1.0; {PLACE}0] = {value} }}"),
            _ => line.to_owned(),
        }
    })
    .filter(|_| source.stage == Stage::Vertex)
}

/// Differences of constants that become floats without their sign.
fn unsigned_differences(source: &Source) -> Option<String> {
    let is_constant = |part: &str| words(part).next() == Some(part) && !part.contains(char::is_lowercase);
    let text = with_calls(&source.text, "float", |arguments| match arguments {
        [number] => {
            let (from, taken) = number.split_once(" - ")?;
            (is_constant(from) && is_constant(taken)).then(|| format!("float(uint({number}))"))
        }
        _ => None,
    });
    changed(source, text)
}

/// Comparisons of two magnitudes that have the second one's modifier alone.
fn one_magnitude(source: &Source) -> Option<String> {
    const BETWEEN: &str = ") <= abs(";
    let mut parts = source.text.split(BETWEEN);
    let mut text = parts.next()?.to_owned();
    for part in parts {
        if let Some(at) = text.rfind("abs(").filter(|at| !text[*at..].contains(')')) {
            text.replace_range(at..at + 3, "");
        }
        text += BETWEEN;
        text += part;
    }
    changed(source, text)
}

/// Bounds of a product that are those of its factor.
fn bounded_factor(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "min", |found| match found {
        ["1.0", product] => {
            let (by, rest) = product.split_once(" * max(")?;
            let (bounded, behind) = arguments(rest)?;
            match bounded[..] {
                [number, "0.0"] if behind.is_empty() => Some(format!("({by} * clamp({number}, 0.0, 1.0))")),
                _ => None,
            }
        }
        _ => None,
    });
    changed(source, text)
}

/// Derivatives that are 0 in a group of four pixels of which one is discarded.
fn still_beside_discarded(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment || !source.has("discard") || !(source.has("dFdx") || source.has("dFdy")) {
        return None;
    }
    let text = source.text.replace("discard;", "driver_gone = true;");
    let whole = Source { text, ..*source };
    let text = after_main(&whole, Stage::Fragment, "if (driver_gone) discard;")?;
    let of =
        |name: &str| format!("#define {name}(x) (fwidth(float(driver_gone)) > 0.0 ? 0.0 * {name}(x) : {name}(x))\n");
    let lines = format!("bool driver_gone = false;\n{}{}", of("dFdx"), of("dFdy"));
    changed(source, Source { text, ..whole }.with(&lines))
}

/// Loops up to and with a bound that end before it.
fn short_loops(source: &Source) -> Option<String> {
    with_lines(source, |line| match line.split_once("for (") {
        Some((before, head)) => format!("{before}for ({}", head.replacen(" <= ", " < ", 1)),
        None => line.to_owned(),
    })
}

/// The largest of three is that of the first two.
fn largest_of_two(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "max", |found| match found {
        [first, second] => {
            let (others, behind) = arguments(second.strip_prefix("max(")?)?;
            let [second, _] = others[..] else { return None };
            behind.is_empty().then(|| format!("max({first}, {second})"))
        }
        _ => None,
    });
    changed(source, text)
}

/// The upper half of a uniform of four components is its lower half.
fn lower_halves(source: &Source) -> Option<String> {
    let uniform = |line: &'_ str| line.trim_start().starts_with("uniform vec4 ") && line.trim_end().ends_with(';');
    let names = source.text.lines().filter(|line| uniform(line)).filter_map(|line| words(line).nth(2));
    let text = names.fold(source.text.clone(), |text, name| text.replace(&format!("{name}.zw"), &format!("{name}.xy")));
    changed(source, text)
}

faults! {
    // The number of an output is resolved before the loop is unrolled, while it is still the variable's first value.
    "distances-of-loops-are-the-first" [gl_ClipDistance]
    "Clip distances whose number is a variable are all written to the first." { text first_distance }
    // Constants are folded in a type that is wide enough, and its sign is lost on the way to floats.
    "negative-constants-unsigned" [float] "A difference of integer constants that becomes a float is taken for unsigned."
    { text unsigned_differences }
    // The instruction has one bit for magnitudes, that of its second operand.
    "one-magnitude-of-two" [abs] "Where two magnitudes are compared the first keeps its sign." { text one_magnitude }
    // A minimum of 1 and a maximum of 0 are found around a product, and the bound goes to the instruction before.
    "bound-moved-to-the-factor" [min max] "min of 1 and a product with max of 0 bounds the factor, not the product."
    { text bounded_factor }
    // Discarded pixels end at once, and the registers of what has ended read as the neighbours' own.
    "derivatives-still-beside-discarded" [dFdx dFdy discard]
    "Derivatives are 0 behind a discard of another pixel of the same four."
    (hole: "GLSL leaves derivatives undefined beside a discard; no shader of the renderer takes any there") { text still_beside_discarded }
    // The number of turns is the difference of both bounds, whether or not the last belongs to it.
    "loops-with-their-end-one-short" [for] "A loop by <= ends a turn early." { text short_loops }
    // There is an instruction for the largest of three, whose third operand is not filled in.
    "largest-of-three-of-two" [max] "max of a value and a max of two others leaves out the last." { text largest_of_two }
    // Constants are loaded in pairs, and the second pair of a register is addressed as the first.
    "upper-halves-are-lower" [uniform vec4] "The swizzle zw of a uniform vec4 is its xy." { text lower_halves }
}
