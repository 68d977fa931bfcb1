//! Several runs of the same rules as one: the worst of each check, and which checks do not answer alike.

use serde::Serialize;

use super::{Finding, RuleOutcome};

/// A check that does not answer alike in every repeat.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Flake {
    /// The rule's id.
    pub rule: &'static str,
    /// Name of the check.
    pub what: String,
    /// Its answers in the order of the repeats: verdict and measurement, or that it is missing.
    pub answers: Vec<String>,
}

/// Joins the repeats of a run. Every repeat has the same rules in the same order. Of each check the worst finding is kept.
pub fn join(repeats: Vec<Vec<RuleOutcome>>) -> (Vec<RuleOutcome>, Vec<Flake>) {
    let mut flakes = Vec::new();
    let mut rest = repeats.clone().into_iter();
    let mut joined = rest.next().unwrap_or_default();
    for (index, outcome) in joined.iter_mut().enumerate() {
        let runs: Vec<&RuleOutcome> = repeats.iter().filter_map(|run| run.get(index)).collect();
        let mut names: Vec<&str> = Vec::new();
        for finding in runs.iter().flat_map(|run| &run.findings) {
            if !names.contains(&finding.what.as_str()) {
                names.push(&finding.what);
            }
        }
        let mut kept = Vec::new();
        for name in names {
            let found = |run: &&RuleOutcome| run.findings.iter().find(|finding| finding.what == name).cloned();
            let answers: Vec<Option<Finding>> = runs.iter().map(found).collect();
            if answers.iter().any(|answer| answer != &answers[0]) {
                let answers = answers.iter().map(text).collect();
                flakes.push(Flake { rule: outcome.id, what: name.to_owned(), answers });
            }
            kept.extend(
                answers
                    .into_iter()
                    .flatten()
                    .reduce(|worst, next| if next.verdict > worst.verdict { next } else { worst }),
            );
        }
        outcome.findings = kept;
        outcome.seconds = runs.iter().map(|run| run.seconds).sum();
        outcome.judge();
    }
    (joined, flakes)
}

fn text(answer: &Option<Finding>) -> String {
    answer.as_ref().map_or("missing".to_owned(), |finding| format!("{}: {}", finding.verdict, finding.measured))
}
