//! Known deviations: a failing check that a waiver names, of its driver and range of versions, does not fail a run; a
//! waiver that no longer applies does.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{RuleOutcome, RuleVerdict};
use crate::context::ContextInfo;

/// The built-in file.
const SHIPPED: &str = include_str!("../../data/waivers.toml");

/// One known deviation.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waiver {
    /// A part of GL_RENDERER.
    pub renderer: String,
    /// A part of GL_VERSION. `from` and `until` are compared with the number that follows it.
    pub version: String,
    /// The first version that deviates: "22.3" is 22.3.0 too.
    pub from: Option<Number>,
    /// The first version after it that does not.
    pub until: Option<Number>,
    /// The rule's id.
    pub rule: String,
    /// Name of the check, to the letter; any measurement there is waived.
    pub finding: String,
    /// Reason for the waiver.
    pub reason: String,
}

/// A version's number, by its parts: 22.3.6.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(try_from = "String")]
pub struct Number(Vec<u32>);

impl TryFrom<String> for Number {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let parts: Result<Vec<u32>, _> = text.split('.').map(str::parse).collect();
        parts.map(Self).map_err(|_| format!("\"{text}\" is no version: write numbers with dots between, like 22.3"))
    }
}

impl Number {
    /// The number that `text` starts with, if it does.
    fn leading(text: &str) -> Option<Self> {
        let text = text.trim_start();
        let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
        Self::try_from(text[..end].trim_end_matches('.').to_owned()).ok()
    }
}

impl Waiver {
    /// Tests whether it names this driver and one of its versions.
    fn is_of(&self, context: &ContextInfo) -> bool {
        let Some((_, after)) = context.version.split_once(&self.version) else { return false };
        let number = Number::leading(after);
        let since = self.from.as_ref().is_none_or(|from| number.as_ref().is_some_and(|number| number >= from));
        let still = self.until.as_ref().is_none_or(|until| number.as_ref().is_some_and(|number| number < until));
        context.renderer.contains(&self.renderer) && since && still
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    waiver: Vec<Waiver>,
}

/// Reason why a waiver file is refused.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("{}: {error}", .path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}:{line}: {message}", .path.display())]
    Parse { path: PathBuf, line: usize, message: String },
    #[error("{}: there is no rule {rule}", .path.display())]
    UnknownRule { path: PathBuf, rule: String },
}

/// The waivers of `path`, or those that are shipped.
///
/// # Errors
///
/// A file that cannot be read, does not parse, or names a rule that is not there.
pub fn load(path: Option<&Path>) -> Result<Vec<Waiver>, Error> {
    match path {
        None => parse(Path::new("data/waivers.toml"), SHIPPED),
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|error| Error::Read { path: path.to_owned(), error })?;
            parse(path, &text)
        }
    }
}

fn parse(path: &Path, text: &str) -> Result<Vec<Waiver>, Error> {
    let file: File = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start).min(text.len());
        let line = text.as_bytes()[..start].iter().filter(|byte| **byte == b'\n').count() + 1;
        Error::Parse { path: path.to_owned(), line, message: error.message().to_owned() }
    })?;
    let unknown = file.waiver.iter().find(|waiver| super::TABLE.iter().all(|rule| rule.id != waiver.rule));
    match unknown {
        Some(waiver) => Err(Error::UnknownRule { path: path.to_owned(), rule: waiver.rule.clone() }),
        None => Ok(file.waiver),
    }
}

/// Marks waived failures, and returns what is wrong with waivers for this driver that nothing needed.
pub fn apply(waivers: &[Waiver], context: &ContextInfo, outcomes: &mut [RuleOutcome]) -> Vec<String> {
    let mut stale = Vec::new();
    for waiver in waivers.iter().filter(|waiver| waiver.is_of(context)) {
        let Some(outcome) = outcomes.iter_mut().find(|outcome| outcome.id == waiver.rule) else { continue };
        let mut used = false;
        for finding in &mut outcome.findings {
            if finding.verdict == RuleVerdict::Fail && finding.what == waiver.finding {
                finding.verdict = RuleVerdict::Waived;
                used = true;
            }
        }
        outcome.verdict = outcome.findings.iter().map(|finding| finding.verdict).max().unwrap_or(outcome.verdict);
        if !used && !may_be_untested(outcome, waiver) {
            stale.push(format!(
                "a waiver of {} no longer applies to {} {}: remove it, or end it with `until`: \"{}\"",
                waiver.rule, context.renderer, context.version, waiver.finding
            ));
        }
    }
    stale
}

/// Tests whether this context could not test what the waiver names.
fn may_be_untested(outcome: &RuleOutcome, waiver: &Waiver) -> bool {
    let untestable = || outcome.findings.iter().filter(|finding| finding.verdict == RuleVerdict::Untestable);
    let mut asked = outcome.findings.iter().filter(|finding| finding.verdict != RuleVerdict::Untestable);
    !asked.any(|finding| finding.what == waiver.finding) && untestable().next().is_some()
}

#[cfg(test)]
#[path = "waivers_tests.rs"]
mod tests;
