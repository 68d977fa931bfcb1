//! What a plan says of itself: what it leaves out, what it chose, what it warns of.

/// What was left out and why, and what the reader of a plan should know besides.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    pub left_out: Vec<LeftOut>,
    /// What a technique chose by itself, and why.
    pub chosen: Vec<Chosen>,
    pub warnings: Vec<String>,
}

/// Something that this frame does not draw.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LeftOut {
    pub what: String,
    pub why: String,
}

/// A choice among several ways.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Chosen {
    pub of: String,
    pub choice: String,
    pub why: String,
}

impl Notes {
    pub fn left_out(&mut self, what: impl Into<String>, why: impl Into<String>) {
        self.left_out.push(LeftOut { what: what.into(), why: why.into() });
    }

    pub fn chosen(&mut self, of: impl Into<String>, choice: impl Into<String>, why: impl Into<String>) {
        self.chosen.push(Chosen { of: of.into(), choice: choice.into(), why: why.into() });
    }
}
