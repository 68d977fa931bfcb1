//! Known deviations: a failure of one driver and version, quoted to the letter, does not fail a run; a waiver that no
//! longer applies does.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{Outcome, Verdict};
use crate::context::ContextInfo;

/// The file that is shipped.
const SHIPPED: &str = include_str!("../../../data/waivers.toml");

/// One known deviation.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waiver {
    /// A part of GL_RENDERER.
    pub renderer: String,
    /// A part of GL_VERSION.
    pub version: String,
    /// The rule's id.
    pub rule: String,
    /// The finding, to the letter: `what: measured`.
    pub message: String,
    /// Why it is let pass.
    pub reason: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    waiver: Vec<Waiver>,
}

/// Why a waiver file is refused.
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
pub fn apply(waivers: &[Waiver], context: &ContextInfo, outcomes: &mut [Outcome]) -> Vec<String> {
    let mut stale = Vec::new();
    let here =
        |waiver: &&Waiver| context.renderer.contains(&waiver.renderer) && context.version.contains(&waiver.version);
    for waiver in waivers.iter().filter(here) {
        let Some(outcome) = outcomes.iter_mut().find(|outcome| outcome.id == waiver.rule) else { continue };
        let matching = |verdict: Verdict, message: &str| verdict == Verdict::Fail && message == waiver.message;
        let mut used = false;
        for finding in &mut outcome.findings {
            if matching(finding.verdict, &finding.message()) {
                finding.verdict = Verdict::Waived;
                used = true;
            }
        }
        outcome.verdict = outcome.findings.iter().map(|finding| finding.verdict).max().unwrap_or(outcome.verdict);
        if !used && !may_be_untested(outcome, waiver) {
            stale.push(format!(
                "the waiver of {} for {} {} no longer applies, remove it: \"{}\"",
                waiver.rule, waiver.renderer, waiver.version, waiver.message
            ));
        }
    }
    stale
}

/// Whether this context could not ask what the waiver is about.
fn may_be_untested(outcome: &Outcome, waiver: &Waiver) -> bool {
    let about = |what: &str| waiver.message.strip_prefix(what).is_some_and(|rest| rest.starts_with(':'));
    let untestable = || outcome.findings.iter().filter(|finding| finding.verdict == Verdict::Untestable);
    let asked = outcome.findings.iter().any(|finding| finding.verdict != Verdict::Untestable && about(&finding.what));
    !asked && untestable().next().is_some()
}

#[cfg(test)]
#[path = "waivers_tests.rs"]
mod tests;
