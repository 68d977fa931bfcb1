//! Names that are nearly those which exist, for errors.

/// "did you mean …" for a near miss, and the whole list where it is short.
pub fn suggest<'n>(wrong: &str, names: impl Iterator<Item = &'n str>) -> String {
    let mut names: Vec<&str> = names.collect();
    names.sort_unstable();
    names.dedup();
    // A name cut short, or one with too much, is nearer than any misspelling.
    let begins = |name: &str| wrong.len() > 1 && (name.starts_with(wrong) || wrong.starts_with(name));
    let nearest = names
        .iter()
        .map(|name| (if begins(name) { 0 } else { strsim::damerau_levenshtein(wrong, name) }, *name))
        .min()
        .filter(|(distance, name)| *distance <= 1 + name.len() / 3);
    let all = names.join(", ");
    match nearest {
        Some((_, name)) => format!("did you mean `{name}`? (known: {all})"),
        None => format!("known: {all}"),
    }
}
