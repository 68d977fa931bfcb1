//! GL's rules for shadows and bump mapping as checks of a driver: [`TABLE`] has them, [`run`] runs them on a
//! [`mod@bench`]. Knows no scene and no technique.
//!
//! A verdict comes from a verifier ([`verify`]), which knows what the specification allows; never from another picture.
//! To add a rule: one row in the table, one function in `rules/`.

#[cfg(feature = "check")]
pub mod baseline;
#[cfg_attr(not(feature = "check"), allow(dead_code, reason = "the probe draws on a part of the bench"))]
pub mod bench;
#[cfg(feature = "check")]
pub mod events;
#[doc(hidden)]
#[cfg(feature = "check")]
pub mod faults;
#[cfg(feature = "check")]
mod filter;
#[cfg(feature = "check")]
mod findings;
#[cfg(feature = "check")]
mod frames;
#[cfg(feature = "check")]
pub mod layer;
#[cfg(feature = "check")]
mod model;
#[cfg(feature = "check")]
mod print;
pub mod probe;
#[cfg(feature = "check")]
mod random;
#[cfg(feature = "check")]
pub mod reduce;
#[cfg(feature = "check")]
mod repeats;
#[cfg(feature = "check")]
mod reset;
#[cfg(feature = "check")]
mod rules;
#[cfg(feature = "check")]
mod screen;
#[cfg(feature = "check")]
mod table;
#[cfg(feature = "check")]
pub mod verify;
#[cfg(feature = "check")]
pub mod waivers;
#[cfg(feature = "check")]
mod write;

#[cfg(feature = "check")]
use std::rc::Rc;

#[cfg(feature = "check")]
use serde::Serialize;

#[cfg(feature = "check")]
pub use filter::{UnknownFilter, choose};
#[cfg(feature = "check")]
pub use findings::{Fact, Finding, Findings, RuleVerdict};
#[cfg(feature = "check")]
pub use print::print;
#[cfg(feature = "check")]
pub use repeats::{Flake, join};
#[cfg(feature = "check")]
pub use reset::ResetStatus;
#[cfg(feature = "check")]
pub use screen::{list, screen};
#[cfg(feature = "check")]
pub use table::TABLE;
#[cfg(feature = "check")]
pub use write::junit;

#[cfg(feature = "check")]
use self::bench::fixed_function::FixedBench;
#[cfg(feature = "check")]
use self::bench::{Bench, Mutation};
#[cfg(feature = "check")]
use crate::context::{Context, ContextInfo};

/// One rule of GL, and how it is checked.
#[derive(Clone, Copy, Debug)]
#[cfg(feature = "check")]
pub struct Rule {
    /// Id like `GL-C1`: a letter for the kind.
    pub id: &'static str,
    pub title: &'static str,
    /// Section of the OpenGL 4.6 specification, compatibility profile.
    pub section: &'static str,
    /// Summary of the specification's rule.
    pub says: &'static str,
    /// Tolerance, and its reason.
    pub tolerance: &'static str,
    pub check: fn(&DriverUnderTest, &mut Findings) -> Result<(), bench::Error>,
}

/// A driver, checked by way of one context.
#[cfg(feature = "check")]
pub struct DriverUnderTest {
    pub bench: Bench,
    /// The fixed-function pipeline, or why there is none.
    pub fixed: Result<FixedBench, String>,
    pub info: ContextInfo,
    /// For what draws beside the benches.
    pub context: Rc<dyn Context>,
}

#[cfg(feature = "check")]
impl DriverUnderTest {
    /// The driver of `context`, which is current.
    ///
    /// # Errors
    ///
    /// A driver that has not even a vertex array.
    pub fn new(context: &Rc<dyn Context>, mutation: Option<Mutation>) -> Result<Self, bench::Error> {
        let bench = Bench::of(context.as_ref())?.with_mutation(mutation);
        let fixed = FixedBench::new(context.as_ref(), mutation).map_err(|error| error.to_string());
        Ok(Self { bench, fixed, info: context.describe(), context: context.clone() })
    }
}

/// Result of one rule.
#[derive(Clone, Debug, Serialize)]
#[cfg(feature = "check")]
pub struct RuleOutcome {
    pub id: &'static str,
    pub title: &'static str,
    pub section: &'static str,
    pub says: &'static str,
    pub tolerance: &'static str,
    /// The worst verdict of the findings.
    pub verdict: RuleVerdict,
    pub findings: Vec<Finding>,
    pub facts: Vec<Fact>,
    pub seconds: f64,
}

#[cfg(feature = "check")]
impl RuleOutcome {
    /// The outcome of a rule with these findings.
    pub fn new(rule: &Rule, findings: Vec<Finding>, facts: Vec<Fact>, seconds: f64) -> Self {
        let Rule { id, title, section, says, tolerance, .. } = *rule;
        let verdict = RuleVerdict::Untestable;
        let mut outcome = Self { id, title, section, says, tolerance, verdict, findings, facts, seconds };
        outcome.judge();
        outcome
    }

    /// Finds the verdict again, after its findings have changed.
    pub(crate) fn judge(&mut self) {
        let worst = self.findings.iter().map(|finding| finding.verdict).max();
        self.verdict = worst.unwrap_or(RuleVerdict::Untestable);
    }
}

/// Results of a run.
#[derive(Clone, Debug, Serialize)]
#[cfg(feature = "check")]
pub struct Checked {
    pub context: ContextInfo,
    pub outcomes: Vec<RuleOutcome>,
    /// Time of the run. Rules that ran at once took longer together.
    pub seconds: f64,
    /// Waivers for this driver that nothing needed: each is a failure.
    pub stale_waivers: Vec<String>,
    /// Rules that have not been run yet: the run goes on, or was ended.
    pub unfinished: Vec<&'static str>,
    /// Findings that differ from repeat to repeat.
    pub flakes: Vec<Flake>,
    /// Changes since the run that is the baseline.
    pub since: Option<baseline::Changes>,
}

#[cfg(feature = "check")]
impl Checked {
    /// Number of rules with this verdict.
    pub fn count(&self, verdict: RuleVerdict) -> usize {
        self.outcomes.iter().filter(|outcome| outcome.verdict == verdict).count()
    }

    /// Tests whether the run fails. Without a baseline: a rule failed that is not waived, or a waiver is out of date. With
    /// one: something fails that did not fail there.
    pub fn fails(&self) -> bool {
        match &self.since {
            Some(changes) => !changes.new_failures.is_empty(),
            None => self.failing().next().is_some() || !self.stale_waivers.is_empty(),
        }
    }

    /// The rules that fail.
    pub fn failing(&self) -> impl Iterator<Item = &RuleOutcome> {
        self.outcomes.iter().filter(|outcome| outcome.verdict.fails())
    }

    /// Tests whether nothing could be tested.
    pub fn is_empty(&self) -> bool {
        self.count(RuleVerdict::Untestable) == self.outcomes.len()
    }
}

/// Runs `rules` and gives `seen` each outcome.
#[cfg(feature = "check")]
pub fn run(subject: &DriverUnderTest, rules: &[&'static Rule], mut seen: impl FnMut(&RuleOutcome)) -> Vec<RuleOutcome> {
    let outcomes = rules.iter().map(|rule| run_rule(subject, rule));
    outcomes.inspect(|outcome| seen(outcome)).collect()
}

/// Runs one rule.
#[cfg(feature = "check")]
pub fn run_rule(subject: &DriverUnderTest, rule: &Rule) -> RuleOutcome {
    let start = std::time::Instant::now();
    let _doing = crate::process::doing(format!("checking {}, {}", rule.id, rule.title));
    let mut findings = Findings::default();
    if let Err(error) = (rule.check)(subject, &mut findings) {
        findings.error(&error);
    }
    findings.outcome(rule, start.elapsed().as_secs_f64())
}
