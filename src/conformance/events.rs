//! Lines by which a process that checks rules tells another how far it is: one JSON value a line.

use serde::{Deserialize, Serialize};

use super::{Fact, Finding, Rule, RuleOutcome, TABLE};
use crate::context::ContextInfo;

/// One step of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Event {
    /// There is no context to check: the error.
    Refused(String),
    /// The driver at hand.
    Context(Box<ContextInfo>),
    /// The rule of this id begins.
    Begins(String),
    /// A rule has ended. `lost`: the context is of no more use, and the process ends.
    Ends { id: String, findings: Vec<Finding>, facts: Vec<Fact>, seconds: f64, lost: bool },
}

impl Event {
    /// The end of a rule.
    pub fn ends(outcome: RuleOutcome, lost: bool) -> Self {
        let RuleOutcome { id, findings, facts, seconds, .. } = outcome;
        Self::Ends { id: id.to_owned(), findings, facts, seconds, lost }
    }
}

/// The rule of an id.
pub fn rule(id: &str) -> Option<&'static Rule> {
    TABLE.iter().find(|rule| rule.id == id)
}
