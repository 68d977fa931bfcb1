//! Findings of a rule: verdicts with measurements, and facts without a verdict.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::bench::{Error, GlFormat};
use super::verify::{Grade, GradeTally};
use super::{Rule, RuleOutcome};

/// Verdicts, in order of severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RuleVerdict {
    /// This context cannot be tested.
    Untestable,
    Pass,
    /// Allowed, but not as good as could be.
    Warning,
    /// Fails, as a waiver says it does.
    Waived,
    Fail,
    /// The driver reports that memory has run out, or the system ended the process for want of it.
    OutOfMemory,
    /// The context was lost: the GPU was reset.
    ContextLost,
    /// The rule did not end in time.
    Hang,
    /// The process that checked the rule was ended by a signal, or ended itself.
    Crash,
}

impl RuleVerdict {
    /// Tests whether a run with this verdict fails.
    pub fn fails(self) -> bool {
        self >= Self::Fail
    }
}

impl fmt::Display for RuleVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Untestable => "cannot be tested here",
            Self::Pass => "pass",
            Self::Warning => "quality warning",
            Self::Waived => "waived",
            Self::Fail => "FAIL",
            Self::OutOfMemory => "OUT OF MEMORY",
            Self::ContextLost => "CONTEXT LOST",
            Self::Hang => "HANG",
            Self::Crash => "CRASH",
        })
    }
}

/// One check of a rule, and its result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    pub what: String,
    pub verdict: RuleVerdict,
    /// The measurement, or the reason why there is none.
    pub measured: String,
    /// The reason why it is waived.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waiver: Option<String>,
    /// The first of its values that is wrong: how many came before it, and the bits of its distance.
    #[serde(skip)]
    pub first_wrong: Option<(usize, u64)>,
}

impl Finding {
    /// A finding that nothing waives.
    pub fn new(what: impl Into<String>, verdict: RuleVerdict, measured: impl Into<String>) -> Self {
        Self { what: what.into(), verdict, measured: measured.into(), waiver: None, first_wrong: None }
    }

    /// The check and its measurement, as one line.
    pub fn message(&self) -> String {
        format!("{}: {}", self.what, self.measured)
    }
}

/// A number that a user of the driver wants to know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fact {
    pub name: String,
    pub value: String,
}

/// Findings of a rule so far.
#[derive(Debug, Default)]
pub struct Findings {
    list: Vec<Finding>,
    facts: Vec<Fact>,
}

impl Findings {
    pub fn add(&mut self, what: impl Into<String>, verdict: RuleVerdict, measured: impl Into<String>) {
        self.list.push(Finding::new(what, verdict, measured));
    }

    /// Fails unless `holds`; `measured` says what was seen.
    pub fn must_hold(&mut self, what: impl Into<String>, holds: bool, measured: impl Into<String>) {
        self.add(what, if holds { RuleVerdict::Pass } else { RuleVerdict::Fail }, measured);
    }

    /// Fails if `wrong` of `count` is not 0, or if nothing was counted.
    pub fn none_wrong(&mut self, what: impl Into<String>, wrong: usize, count: usize) {
        let measured = match wrong {
            0 => format!("all {count} right"),
            _ => format!("{wrong} of {count} wrong"),
        };
        self.must_hold(what, wrong == 0 && count > 0, measured);
    }

    /// By the tally's worst grade; `unit` names what its worst distance is counted in.
    pub fn tally(&mut self, what: impl Into<String>, tally: GradeTally, unit: &str) {
        let GradeTally { good, allowed, wrong, worst, first_wrong } = tally;
        let count = tally.count();
        let off =
            if worst > 0.0 && !unit.is_empty() { format!(", at most {worst:.3} {unit} off") } else { String::new() };
        let (verdict, measured) = match () {
            () if wrong > 0 => (RuleVerdict::Fail, format!("{wrong} of {count} wrong{off}")),
            () if count == 0 => (RuleVerdict::Fail, "nothing was drawn".to_owned()),
            () if allowed > 0 => (RuleVerdict::Warning, format!("{allowed} of {count} only just allowed{off}")),
            () => (RuleVerdict::Pass, format!("all {good} good{off}")),
        };
        self.add(what, verdict, measured);
        if let Some(finding) = self.list.last_mut() {
            finding.first_wrong = first_wrong.map(|(before, distance)| (before, distance.to_bits()));
        }
    }

    /// By one grade.
    pub fn grade(&mut self, what: impl Into<String>, grade: Grade, measured: impl Into<String>) {
        let verdict = match grade {
            Grade::Good => RuleVerdict::Pass,
            Grade::Allowed => RuleVerdict::Warning,
            Grade::Wrong => RuleVerdict::Fail,
        };
        self.add(what, verdict, measured);
    }

    /// Adds to the measurement of the last finding, as which case was the first that failed.
    pub fn note(&mut self, text: &str) {
        if let Some(finding) = self.list.last_mut() {
            finding.measured = format!("{}; {text}", finding.measured);
        }
    }

    pub fn untestable(&mut self, what: impl Into<String>, why: impl Into<String>) {
        self.add(what, RuleVerdict::Untestable, why);
    }

    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push(Fact { name: name.into(), value: value.into() });
    }

    /// A format that no driver needs to have cannot be tested without; any other error is a failure.
    pub fn error(&mut self, error: &Error) {
        match error {
            Error::Refused { format, reason } if !GlFormat::is_required(format) => {
                self.untestable(*format, format!("refused: {reason}"));
            }
            error => {
                let verdict = match error {
                    Error::Gl { codes, .. } if codes.contains("GL_CONTEXT_LOST") => RuleVerdict::ContextLost,
                    Error::Gl { codes: told, .. } | Error::Refused { reason: told, .. }
                        if told.contains("GL_OUT_OF_MEMORY") =>
                    {
                        RuleVerdict::OutOfMemory
                    }
                    _ => RuleVerdict::Fail,
                };
                self.add("draws", verdict, error.to_string());
            }
        }
    }

    /// Runs a part of a rule, whose error is a finding and does not end the rule.
    pub fn part(&mut self, part: impl FnOnce(&mut Self) -> Result<(), Error>) {
        if let Err(error) = part(self) {
            self.error(&error);
        }
    }

    pub(super) fn outcome(self, rule: &Rule, seconds: f64) -> RuleOutcome {
        RuleOutcome::new(rule, self.list, self.facts, seconds)
    }
}
