//! Choice of rules: `--filter`.

use super::{Rule, TABLE};

/// A pattern that matches no rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no rule is called `{pattern}`: did you mean {}? The rules are {}", nearest.join(" or "), ids.join(", "))]
pub struct UnknownFilter {
    pub pattern: String,
    pub nearest: Vec<&'static str>,
    pub ids: Vec<&'static str>,
}

/// The rules that `patterns` name, in the table's order: each pattern is an id (`GL-C1` or `C1`), the letter of
/// a kind, or a part of a title, in capitals or not. All of them without a pattern.
///
/// # Errors
///
/// A pattern that matches nothing, with the nearest ids.
pub fn choose(patterns: &[String]) -> Result<Vec<&'static Rule>, UnknownFilter> {
    for pattern in patterns {
        if !TABLE.iter().any(|rule| matches(rule, pattern)) {
            return Err(unknown(pattern));
        }
    }
    let wanted = |rule: &&Rule| patterns.is_empty() || patterns.iter().any(|pattern| matches(rule, pattern));
    Ok(TABLE.iter().filter(wanted).collect())
}

fn matches(rule: &Rule, pattern: &str) -> bool {
    let pattern = pattern.trim().to_lowercase();
    let (id, title) = (short_id(rule), rule.title.to_lowercase());
    // An id is compared whole: one may begin with another.
    !pattern.is_empty()
        && (id == pattern.strip_prefix("gl-").unwrap_or(&pattern)
            || (pattern.len() == 1 && id.starts_with(&pattern))
            || (pattern.len() > 2 && title.contains(&pattern)))
}

/// The id without its prefix, in small letters: `c1` for `GL-C1`.
fn short_id(rule: &Rule) -> String {
    rule.id.trim_start_matches("GL-").to_lowercase()
}

fn unknown(pattern: &str) -> UnknownFilter {
    let far = |rule: &Rule| {
        let pattern = pattern.trim().to_lowercase();
        let words = rule.title.to_lowercase();
        let words = words.split_whitespace().map(str::to_owned).chain([short_id(rule), rule.id.to_lowercase()]);
        words.map(|word| strsim::damerau_levenshtein(&word, &pattern)).min().unwrap_or(usize::MAX)
    };
    let mut rules: Vec<&Rule> = TABLE.iter().collect();
    rules.sort_by_key(|rule| far(rule));
    UnknownFilter {
        pattern: pattern.to_owned(),
        nearest: rules.iter().take(2).map(|rule| rule.id).collect(),
        ids: TABLE.iter().map(|rule| rule.id).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::choose;

    fn ids(patterns: &[&str]) -> Vec<&'static str> {
        let patterns: Vec<String> = patterns.iter().map(|pattern| (*pattern).to_owned()).collect();
        choose(&patterns).unwrap().iter().map(|rule| rule.id).collect()
    }

    #[test]
    fn patterns_name_ids_kinds_and_words() {
        assert_eq!(ids(&["c1"]), ["GL-C1"]);
        assert_eq!(ids(&["gl-c1"]), ["GL-C1"]);
        assert_eq!(ids(&["S3", "C1"]), ["GL-C1", "GL-S3"]);
        let of_kind_s: Vec<_> = ids(&[]).into_iter().filter(|id| id.starts_with("GL-S")).collect();
        assert!(of_kind_s.len() > 1);
        assert_eq!(ids(&["s"]), of_kind_s);
        assert!(ids(&["stencil"]).contains(&"GL-S1"));
        assert_eq!(ids(&[]).len(), super::TABLE.len());
    }

    #[test]
    fn a_pattern_without_a_rule_names_the_nearest() {
        let error = choose(&["C99".to_owned()]).unwrap_err();
        assert!(error.nearest.iter().all(|id| id.starts_with("GL-C")), "{error}");
        assert!(error.to_string().starts_with("no rule is called `C99`: did you mean GL-C"), "{error}");
        let error = choose(&["stensil".to_owned()]).unwrap_err();
        assert!(error.nearest[0].starts_with("GL-S"), "{error}");
    }
}
