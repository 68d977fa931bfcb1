//! Known deviations: a failing check that a waiver names, of its driver and range of versions, does not fail a run; a
//! waiver that no longer applies does.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Checked, RuleOutcome, RuleVerdict};
use crate::context::ContextInfo;

/// The built-in file.
const SHIPPED: &str = include_str!("../../data/waivers.toml");

/// One known deviation.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Waiver {
    /// The beginning of GL_RENDERER.
    pub renderer: String,
    /// A part of GL_VERSION. `from` and `until` are compared with the number that follows it.
    pub version: String,
    /// The first version that deviates: "22.3" is 22.3.0 too.
    pub from: Option<Number>,
    /// The first version after it that does not.
    pub until: Option<Number>,
    /// The rule's id.
    pub rule: String,
    /// Name of the check, to the letter; any measurement there is waived. Absent: every check of the rule.
    pub finding: Option<String>,
    /// Machines that deviate, in words, where GL's strings do not tell: on others the check passes, and the waiver is not
    /// called stale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// Reason for the waiver.
    pub reason: String,
}

/// A version's number, by its parts: 22.3.6.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
pub struct Number(Vec<u32>);

impl TryFrom<String> for Number {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let parts: Result<Vec<u32>, _> = text.split('.').map(str::parse).collect();
        parts.map(Self).map_err(|_| format!("\"{text}\" is no version: write numbers with dots between, like 22.3"))
    }
}

impl From<Number> for String {
    fn from(number: Number) -> Self {
        number.0.iter().map(u32::to_string).collect::<Vec<_>>().join(".")
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
    /// Tests whether it waives the check of this name.
    fn names(&self, what: &str) -> bool {
        self.finding.as_deref().is_none_or(|finding| finding == what)
    }

    /// Tests whether it names this driver and one of its versions.
    fn is_of(&self, context: &ContextInfo) -> bool {
        let Some((_, after)) = context.version.split_once(&self.version) else { return false };
        let number = Number::leading(after);
        let since = self.from.as_ref().is_none_or(|from| number.as_ref().is_some_and(|number| number >= from));
        let still = self.until.as_ref().is_none_or(|until| number.as_ref().is_some_and(|number| number < until));
        context.renderer.starts_with(&self.renderer) && since && still
    }
}

#[derive(Debug, Deserialize, Serialize)]
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
            if finding.verdict.fails() && waiver.names(&finding.what) {
                finding.verdict = RuleVerdict::Waived;
                finding.waiver = Some(waiver.reason.clone());
                used = true;
            }
        }
        outcome.judge();
        if !used && waiver.on.is_none() && !may_be_untested(outcome, waiver) {
            stale.push(format!(
                "a waiver of {} no longer applies to {} {}: remove it, or end it with `until`: \"{}\"",
                waiver.rule,
                context.renderer,
                context.version,
                waiver.finding.as_deref().unwrap_or("every check")
            ));
        }
    }
    stale
}

/// A waiver file for what fails on this driver and for what is waived already, to be read in place of the file at hand.
///
/// # Errors
///
/// Those of the TOML writer.
pub fn write(checked: &Checked, waivers: &[Waiver]) -> Result<String, toml::ser::Error> {
    let context = &checked.context;
    let (version, from) = version_of(&context.version);
    let renderer = context.renderer.split(" (").next().unwrap_or_default().to_owned();
    let mut waiver: Vec<Waiver> = Vec::new();
    for (outcome, finding) in
        checked.outcomes.iter().flat_map(|outcome| outcome.findings.iter().map(move |f| (outcome, f)))
    {
        let known =
            |waiver: &&Waiver| waiver.is_of(context) && waiver.rule == outcome.id && waiver.names(&finding.what);
        if finding.verdict == RuleVerdict::Waived {
            let known = waivers.iter().find(known).filter(|known| !waiver.contains(known));
            waiver.extend(known.cloned());
        } else if finding.verdict.fails() {
            waiver.push(Waiver {
                renderer: renderer.clone(),
                version: version.clone(),
                from: from.clone(),
                until: None,
                rule: outcome.id.to_owned(),
                finding: Some(finding.what.clone()),
                on: None,
                reason: format!("{} (GL 4.6, {})", finding.measured, outcome.section),
            });
        }
    }
    let head = format!(
        "# What fails on {}, {}: `glumbra check --waivers FILE` calls it no failure.\n\
         # `renderer` begins GL_RENDERER, `version` is a part of GL_VERSION; versions from `from` up to, but not at, `until`.\n\
         # Say in `reason` where the bug is reported.\n\n",
        context.renderer, context.version
    );
    Ok(head + &toml::to_string(&File { waiver })?)
}

/// The words of GL_VERSION before the driver's own number, and that number: `Mesa ` and 22.3.6. GL's number comes first,
/// so that a driver's is the last one with a dot.
fn version_of(text: &str) -> (String, Option<Number>) {
    let mut words = text.split_whitespace().collect::<Vec<_>>();
    while let (Some(word), true) = (words.pop(), !words.is_empty()) {
        let name = words[words.len() - 1];
        if word.contains('.')
            && !name.contains('.')
            && let Some(number) = Number::leading(word)
        {
            return (format!("{name} "), Some(number));
        }
    }
    (String::new(), Number::leading(text))
}

/// Tests whether this context could not test what the waiver names.
fn may_be_untested(outcome: &RuleOutcome, waiver: &Waiver) -> bool {
    let untestable = || outcome.findings.iter().filter(|finding| finding.verdict == RuleVerdict::Untestable);
    let mut asked = outcome.findings.iter().filter(|finding| finding.verdict != RuleVerdict::Untestable);
    !asked.any(|finding| waiver.names(&finding.what)) && untestable().next().is_some()
}

/// A waiver of every driver.
#[cfg(test)]
pub(super) fn parse_for_test(rule: &str, finding: &str) -> Vec<Waiver> {
    let text = ["renderer", "version", "rule", "finding", "reason"].into_iter().zip(["", "", rule, finding, "known"]);
    let text: String = text.map(|(key, value)| format!("{key} = \"{value}\"\n")).collect();
    parse(Path::new("test"), &format!("[[waiver]]\n{text}")).expect("a waiver")
}

#[cfg(test)]
#[path = "waivers_tests.rs"]
mod tests;
