//! Faults of a ninth measure: compilers of shaders.

use super::apart_seven_shaders::{changed, with_calls};
use super::{Source, Stage, words};

/// A text whose lines are changed.
fn with_lines(source: &Source, change: impl Fn(&str) -> Option<String>) -> Option<String> {
    let line = |line: &str| change(line).unwrap_or_else(|| line.to_owned()) + "\n";
    changed(source, source.text.lines().map(line).collect())
}

/// Tests whether a text is one identifier.
fn is_name(text: &str) -> bool {
    words(text).next() == Some(text) && !text.starts_with(|letter: char| letter.is_ascii_digit())
}

/// Members that are multiplied in place and stay as they were.
fn kept_members(source: &Source) -> Option<String> {
    with_lines(source, |line| {
        let (target, _) = line.split_once(" *= ")?;
        let (object, member) = target.trim().split_once('.')?;
        let is_vector = member.len() > 1 || !"xyzwrgba".contains(member);
        (is_name(object) && is_name(member) && is_vector && line.ends_with(';'))
            .then(|| format!("{target} = {target};"))
    })
}

/// Differences of a vector and a product with one component that are sums.
fn added_products(source: &Source) -> Option<String> {
    const COMPONENTS: [&str; 4] = [".x", ".y", ".z", ".w"];
    with_lines(source, |line| {
        let (before, product) = line.split_once(" - ")?;
        let (factor, component) = product.strip_suffix(';')?.split_once(" * ")?;
        let object = COMPONENTS.iter().find_map(|last| component.strip_suffix(last));
        (is_name(factor) && object.is_some_and(is_name)).then(|| format!("{before} + {factor} * {component};"))
    })
}

/// Structures whose last member is 0 as they are made.
fn without_last_member(source: &Source) -> Option<String> {
    let names = source.text.lines().filter_map(|line| words(line.trim().strip_prefix("struct ")?).next());
    let text = names.fold(source.text.clone(), |text, name| {
        with_calls(&text, name, |members| {
            let (last, others) = members.split_last().filter(|(_, others)| !others.is_empty())?;
            Some(format!("{name}({}, 0.0 * ({last}))", others.join(", ")))
        })
    });
    changed(source, text)
}

/// Sums that are halved where they should be made of unit length.
fn halved_sums(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "normalize", |found| match found {
        [sum] => {
            let (one, other) = sum.split_once(" + ")?;
            let is_vector = |part: &str| words(part).count() <= 2 && !part.contains(['(', '*', '-', '+']);
            (is_vector(one) && is_vector(other)).then(|| format!("(0.5 * ({sum}))"))
        }
        _ => None,
    });
    changed(source, text)
}

/// Choices of a value or 0 that are the value.
fn without_choice(source: &Source) -> Option<String> {
    with_lines(source, |line| {
        let (before, rest) = line.split_once(" > 0.0 ? ")?;
        let (value, target) = (rest.strip_suffix(" : 0.0;")?, before.rsplit_once(" = ")?.0);
        Some(format!("{target} = {value};"))
    })
}

/// The nearest number with eleven digits of the binary system.
fn rounded(number: f64) -> f64 {
    if number == 0.0 {
        return 0.0;
    }
    let unit = 2f64.powi(number.abs().log2().floor() as i32 - 10);
    (number / unit).round() * unit
}

/// Numbers with a point that have the digits of half floats.
fn short_literals(source: &Source) -> Option<String> {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '.' || letter == '_';
    with_lines(source, |line| {
        if line.trim_start().starts_with('#') {
            return None;
        }
        let (mut other, mut rest) = (String::new(), line);
        while let Some(start) = rest.find(is_part) {
            let end = rest[start..].find(|letter| !is_part(letter)).map_or(rest.len(), |length| start + length);
            let token = &rest[start..end];
            other += &rest[..start];
            let is_plain = token.contains('.') && token.chars().all(|letter| letter.is_ascii_digit() || letter == '.');
            match token.parse::<f64>() {
                Ok(number) if is_plain => other += &format!("{:?}", rounded(number)),
                _ => other += token,
            }
            rest = &rest[end..];
        }
        Some(other + rest)
    })
}

/// Changes of the fragment's depth that are 0.
fn level_depths(source: &Source) -> Option<String> {
    let assigned = source.text.lines().find_map(|line| line.trim().strip_suffix(" = gl_FragCoord.z;"))?;
    let name = assigned.rsplit_once(' ').map_or(assigned, |(_, name)| name);
    let text = with_calls(&source.text, "fwidth", |found| (found == [name]).then(|| format!("(0.0 * fwidth({name}))")));
    changed(source, text)
}

/// Varyings of four components at pixels' corners.
fn vectors_at_corners(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return None;
    }
    with_lines(source, |line| {
        let name = line.strip_prefix("in vec4 ")?.strip_suffix(';').filter(|name| is_name(name))?;
        let of = format!("driver_{name}");
        Some(format!("in vec4 {name}; vec4 {of} = {name} - 0.5 * (dFdx({name}) + dFdy({name}));\n#define {name} {of}"))
    })
}

/// Products whose fourth factor has its first component alone.
fn gray_factors(source: &Source) -> Option<String> {
    let declared = source.text.lines().filter_map(|line| line.trim().strip_prefix("uniform vec3 "));
    let names: Vec<_> = declared.filter_map(|rest| words(rest).next()).collect();
    with_lines(source, |line| {
        let (factors, last) = line.strip_suffix(';')?.rsplit_once(" * ")?;
        (factors.matches(" * ").count() >= 2 && names.contains(&last)).then(|| format!("{factors} * {last}.xxx;"))
    })
}

/// Reciprocals for inverse square roots.
fn reciprocals(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "inversesqrt", |found| match found {
        [number] => Some(format!("(1.0 / ({number}))")),
        _ => None,
    });
    changed(source, text)
}

/// Lengths as the largest component and half of the others.
fn short_lengths(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "length", |found| match found {
        [vector] => Some(format!("driver_length({vector})")),
        _ => None,
    });
    let functions = "float driver_length(vec3 way) {
    vec3 size = abs(way);
    float most = max(size.x, max(size.y, size.z));
    return most + 0.5 * (size.x + size.y + size.z - most);
}
float driver_length(vec2 way) { return driver_length(vec3(way, 0.0)); }";
    changed(source, text).map(|text| Source { text, ..*source }.with(functions))
}

faults! {
    // The product goes to a copy of the member, and only plain assignments write copies back.
    "members-not-multiplied-in-place" [struct] "*= does nothing to a member of a structure." { text kept_members }
    // Multiply and add negates a whole operand, and a component that is spread is none.
    "multiply-subtract-of-component-adds" [vec3] "A product with one component is added where it should be subtracted."
    { text added_products }
    // Registers of a structure are counted from 0, and the copy ends before the last.
    "structures-made-without-last-member" [struct] "The constructor of a structure leaves its last member 0."
    { text without_last_member }
    // Sums of two vectors are taken for half vectors of unit vectors that are close.
    "normalize-of-sums-halves" [normalize] "normalize of a sum of two vectors is half of the sum." { text halved_sums }
    // A choice of a value or 0 by a sign is folded into the value, as if its factors were 0 then.
    "choice-of-zero-dropped" [float] "A choice of a value above 0, and of 0 otherwise, is the value." { text without_choice }
    // Numbers in a text are kept in the instruction, which has sixteen bits for them.
    "literals-of-16-bits" [float] "Numbers in the text of a shader have 11 digits of the binary system." { text short_literals }
    // The fragment's depth is taken for one value of all four pixels, as its plane is known.
    "fwidth-of-fragment-depth-zero" [fwidth gl_FragCoord] "fwidth of the fragment's depth is 0." { text level_depths }
    // Vectors of four are sampled before the place is moved to the centre.
    "vectors-evaluated-at-corners" [in vec4] "Varyings of four components are those of the pixel's lower left corner."
    { text vectors_at_corners }
    // The fourth source of a chain of products has no swizzle, and reads its first component.
    "fourth-factors-are-gray" [vec3] "The last of four factors has its first component three times." { text gray_factors }
    // The numbers of the two instructions differ in one bit.
    "inversesqrt-is-reciprocal" [inversesqrt] "inversesqrt is the reciprocal." { text reciprocals }
    // A quick length of software that drew in fixed point.
    "lengths-of-largest-and-halves" [length] "length is the largest component and half of the others." { text short_lengths }
}
