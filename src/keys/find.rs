//! Keys by a part of their path.

use super::Key;

/// A pattern that no key has.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("no key of a scene file is called `{pattern}`: {hint} `glumbra keys` lists all")]
pub struct NoSuchKey {
    pattern: String,
    hint: String,
}

/// The key of the path `pattern`; or the keys of that table; or those that end with it; or those that have it in their path.
/// Numbers of lights and objects, as `--set` has them, are passed over.
///
/// # Errors
///
/// None has it.
pub fn find<'a>(table: &'a [Key], pattern: &str) -> Result<Vec<&'a Key>, NoSuchKey> {
    let path: Vec<&str> = pattern.split('.').filter(|part| part.parse::<u32>().is_err() && !part.is_empty()).collect();
    let path = path.join(".").replace('-', "_");
    let (end, start) = (format!(".{path}"), format!("{path}."));
    let tests: [&dyn Fn(&Key) -> bool; 3] = [
        &|key| key.key == path || key.key.starts_with(&start),
        &|key| key.key.ends_with(&end) || key.key.contains(&format!("{end}.")),
        &|key| key.key.contains(&path),
    ];
    let mut found = tests.iter().map(|test| table.iter().filter(|key| test(key)).collect::<Vec<_>>());
    let found = found.find(|keys| !keys.is_empty() && !path.is_empty());
    found.ok_or_else(|| NoSuchKey { pattern: pattern.to_owned(), hint: nearest(table, &path) })
}

/// Names that are nearest to the last part of `path`, three at most.
fn nearest(table: &[Key], path: &str) -> String {
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let wrong = last(path);
    let mut names: Vec<(usize, String)> = table
        .iter()
        .map(|key| last(&key.key))
        .map(|name| (strsim::damerau_levenshtein(&wrong, &name), name))
        .filter(|(distance, name)| *distance <= 1 + name.len() / 3)
        .collect();
    names.sort_unstable();
    names.dedup();
    let near: Vec<String> = names.into_iter().take(3).map(|(_, name)| format!("`{name}`")).collect();
    if near.is_empty() { String::from("none is like it.") } else { format!("did you mean {}?", near.join(", ")) }
}
