//! Claims of documents as a report holds them: plain values, written as JSON and read back.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::report::numbers::plain;

/// A claim of a document, and its result on this scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Claimed {
    /// Technique that the claim is about.
    pub technique: String,
    /// Document and section.
    pub source: String,
    /// The claim in a sentence.
    pub says: String,
    /// Compared quantity, with its unit.
    pub quantity: String,
    /// Measurement on the relation's left.
    pub first: Measurement,
    /// Relation between both, in words: "at most 0.5 ×", "more than".
    pub relation: String,
    /// Measurement on the relation's right.
    pub second: Measurement,
    /// Range that holds the ratio of two times with a confidence of at least 95 %; `None`: the quantity is no time.
    pub ratio_range: Option<[f64; 2]>,
    /// Result.
    pub verdict: ClaimVerdict,
}

/// A number of a claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Settings in TOML.
    pub settings: String,
    /// Measured value, in the unit of [`Claimed::quantity`].
    pub value: Option<f64>,
    /// Reason why there is no value.
    pub why: Option<String>,
}

/// Result of a claim on one scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClaimVerdict {
    /// The measured numbers stand in the claimed relation.
    Holds,
    /// They do not.
    Fails,
    /// Times do not, on this machine.
    FailsHere,
    /// One of the numbers is missing, or their spread is too wide.
    Unknown,
    /// The scene, or how it is measured, has nothing that shows it.
    NotMeasured,
}

impl ClaimVerdict {
    /// The verdict in words, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "does not hold",
            Self::FailsHere => "not on this machine",
            Self::Unknown => "not known",
            Self::NotMeasured => "not measured here",
        }
    }
}

impl Claimed {
    /// The first number over the second, if that is meaningful.
    pub fn ratio(&self) -> Option<f64> {
        let (first, second) = (self.first.value?, self.second.value?);
        (second > 0.0).then_some(first / second)
    }
}

/// One line: the claim, both numbers, the verdict.
impl fmt::Display for Claimed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = |side: &Measurement| match (side.value, &side.why) {
            (Some(value), _) => plain(value),
            (None, why) => why.clone().unwrap_or_default(),
        };
        let range = self.ratio_range.map_or_else(String::new, |range| {
            let [least, greatest] = range.map(plain);
            format!(", 95 % range {least} to {greatest} ×")
        });
        let ratio = self.ratio().map_or_else(String::new, |ratio| format!(" ({} ×{range})", plain(ratio)));
        write!(f, "{}: {}: {}: ", self.technique, self.says, self.verdict.name())?;
        write!(f, "{} against {}{ratio}, {}", text(&self.first), text(&self.second), self.quantity)
    }
}
