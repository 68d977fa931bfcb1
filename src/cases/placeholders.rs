//! Words of `render`, the command that draws in place of glumbra: what stands in braces, and what a command must be told.
//!
//! | placeholder | becomes |
//! |---|---|
//! | `{scene}` | the scene's file, an absolute path |
//! | `{out}` | the picture's file to write, a PNG; with `{out.exr}` an EXR file, with `{out.npy}` a NumPy array |
//! | `{kind}` | `picture`: the colours; or `shade`: how much of `{light}` arrives, gray: 1 lit, 0 shadowed |
//! | `{light}` | the light of a shade, from 0; 0 for a picture |
//! | `{width}`, `{height}` | the picture's size in pixels, by the scene |

use super::file::Checks;

/// Kinds of files that a command may write, by the placeholder.
pub(super) const OUTPUTS: [(&str, &str); 4] =
    [("out", "png"), ("out.png", "png"), ("out.exr", "exr"), ("out.npy", "npy")];
/// Other placeholders.
const INPUTS: [&str; 5] = ["scene", "light", "width", "height", "kind"];

/// Refuses words that are no command which can draw what `checks` need.
///
/// # Errors
///
/// No program, an unknown placeholder, no file to write, no kind where the checks need both.
pub(super) fn check(words: &[String], checks: &Checks) -> Result<(), String> {
    if words.first().is_none_or(String::is_empty) {
        return Err(String::from("`render` names no program"));
    }
    let names: Vec<&str> = words.iter().flat_map(|word| placeholders(word)).collect();
    let known = || OUTPUTS.iter().map(|(name, _)| *name).chain(INPUTS);
    if let Some(name) = names.iter().find(|name| !known().any(|known| known == **name)) {
        let all = known().map(|name| format!("{{{name}}}")).collect::<Vec<_>>().join(", ");
        return Err(format!("`render` has {{{name}}}, which stands for nothing; there are {all}"));
    }
    if !names.iter().any(|name| extension(name).is_some()) {
        return Err(String::from("`render` has no {out}: the command must be told which file to write"));
    }
    let colours =
        checks.golden.is_some() || checks.pick.iter().any(|pick| pick.color.is_some() || pick.formula.is_some());
    let shades = checks.edge.len() + checks.cone.len() + checks.count.len() + checks.truth.len() > 0
        || checks.pick.iter().any(|pick| pick.class.is_some() || pick.shade.is_some());
    if colours && shades && !names.contains(&"kind") {
        return Err(String::from(
            "`render` has no {kind}: some checks need the picture, others the shade, and the command must be told which",
        ));
    }
    Ok(())
}

/// Names in braces.
pub(super) fn placeholders(word: &str) -> impl Iterator<Item = &str> {
    let parts = word.split('{').skip(1);
    parts.filter_map(|part| part.split_once('}')).map(|(name, _)| name).filter(|name| is_name(name))
}

/// Tests whether text in braces is meant as a placeholder: shells and JSON have braces, too.
fn is_name(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'.')
}

/// Extension of the file that a placeholder stands for; none for another placeholder.
pub(super) fn extension(name: &str) -> Option<&'static str> {
    OUTPUTS.iter().find(|(known, _)| *known == name).map(|(_, extension)| *extension)
}

/// Fills placeholders from left to right; what is filled in is not read again.
pub(super) fn fill_word(word: &str, values: &[(&str, String)]) -> String {
    let mut filled = String::new();
    let mut rest = word;
    while let Some(at) = rest.find('{') {
        filled += &rest[..at];
        rest = &rest[at..];
        let found = values.iter().find_map(|(name, value)| {
            let length = name.len() + 2;
            (rest.get(..length) == Some(&format!("{{{name}}}"))).then_some((length, value))
        });
        let (length, value) = found.map_or((1, "{"), |(length, value)| (length, value.as_str()));
        filled += value;
        rest = &rest[length..];
    }
    filled + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placeholders_are_filled_once() {
        let values = [("scene", "{out}".to_owned()), ("out", "a b".to_owned())];
        assert_eq!(fill_word("x{scene}{out}-{kind}{", &values), "x{out}a b-{kind}{");
        assert_eq!(placeholders("{out.exr} ${HOME} {} {a").collect::<Vec<_>>(), ["out.exr"]);
    }
}
