//! Results of a run, as its files have them.

use std::path::PathBuf;

use serde::Serialize;

use crate::cases::{CaseOutcome, CaseVerdict};

/// Results of a run, as --json writes them.
#[derive(Debug, Serialize)]
pub struct TestResults {
    /// GL_RENDERER and GL_VERSION; none where glumbra has drawn nothing.
    pub driver: Option<String>,
    folders: Vec<PathBuf>,
    /// Time of the whole run.
    pub seconds: f64,
    /// By name.
    pub cases: Vec<CaseOutcome>,
    /// Names of cases that an interrupt has left.
    pub not_run: Vec<String>,
}

impl TestResults {
    /// Results of no case yet.
    pub fn new(folders: &[PathBuf]) -> Self {
        Self { driver: None, folders: folders.to_vec(), seconds: 0.0, cases: Vec::new(), not_run: Vec::new() }
    }

    /// Tests whether a case does not pass, or did not run.
    pub fn fails(&self) -> bool {
        !self.not_run.is_empty() || self.cases.iter().any(|case| case.verdict != CaseVerdict::Pass)
    }
}
