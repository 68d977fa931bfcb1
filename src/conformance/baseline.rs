//! Comparison with an earlier run: what fails now and did not, what is mended, what is new or gone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Checked, Finding, RuleVerdict};

/// An earlier run, as `--json` wrote it. Keys that it does not need are passed over, so that files of other versions can be
/// read.
#[derive(Clone, Debug, Deserialize)]
pub struct Baseline {
    context: Driver,
    outcomes: Vec<Outcome>,
    #[serde(default)]
    stale_waivers: Vec<String>,
}

#[derive(Clone, Debug, Deserialize)]
struct Driver {
    renderer: String,
    version: String,
}

#[derive(Clone, Debug, Deserialize)]
struct Outcome {
    id: String,
    findings: Vec<Finding>,
}

/// Reason why a baseline is refused.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("{}: {error}", .path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("{}: this is no result of `glumbra check --json`: {error}", .path.display())]
    Parse { path: PathBuf, error: serde_json::Error },
}

/// Differences of a run from its baseline. Each line has the rule, the check, and what was measured.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Changes {
    /// The driver of the baseline.
    pub driver: String,
    /// Fails now, and did not fail then or was not there.
    pub new_failures: Vec<String>,
    /// Failed then, and does not now.
    pub fixed: Vec<String>,
    /// Fails now as then.
    pub known_failures: Vec<String>,
    /// Is checked now, and was not then.
    pub new: Vec<String>,
    /// Was checked then by a rule that is run now, and is not now.
    pub gone: Vec<String>,
}

/// Reads an earlier run.
///
/// # Errors
///
/// A file that cannot be read, or is none that `--json` wrote.
pub fn load(path: &Path) -> Result<Baseline, Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::Read { path: path.to_owned(), error })?;
    serde_json::from_str(&text).map_err(|error| Error::Parse { path: path.to_owned(), error })
}

/// Compares a run with an earlier one.
pub fn compare(before: &Baseline, checked: &Checked) -> Changes {
    let mut then: BTreeMap<(&str, &str), &Finding> = BTreeMap::new();
    for outcome in &before.outcomes {
        then.extend(outcome.findings.iter().map(|finding| ((outcome.id.as_str(), finding.what.as_str()), finding)));
    }
    let mut changes =
        Changes { driver: format!("{}, {}", before.context.renderer, before.context.version), ..Changes::default() };
    for outcome in &checked.outcomes {
        for finding in &outcome.findings {
            let before = then.remove(&(outcome.id, finding.what.as_str()));
            let line = format!("{} {}", outcome.id, finding.message());
            let failed = before.is_some_and(|before| before.verdict.fails());
            match (finding.verdict.fails(), failed) {
                (true, true) => changes.known_failures.push(line),
                (true, false) => changes.new_failures.push(line),
                // What cannot be tested any more is not mended.
                (false, true) if finding.verdict != RuleVerdict::Untestable => changes.fixed.push(line),
                (false, true) => changes.gone.push(line),
                (false, false) if before.is_none() => changes.new.push(line),
                (false, false) => {}
            }
        }
    }
    let run = |id: &str| checked.outcomes.iter().any(|outcome| outcome.id == id);
    let gone = then.into_iter().filter(|((id, _), _)| run(id));
    changes.gone.extend(gone.map(|((id, _), finding)| format!("{id} {}", finding.message())));
    let stale = checked.stale_waivers.iter().filter(|stale| !before.stale_waivers.contains(stale));
    changes.new_failures.extend(stale.cloned());
    changes
}
