//! Notes of a plan: what it leaves out, its choices, and its warnings.

/// Notes of a plan: what was left out and why, choices, and warnings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    pub left_out: Vec<LeftOut>,
    /// Choices that a technique made, and why.
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
