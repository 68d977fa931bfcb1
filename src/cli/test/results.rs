//! Results of a run, as its files have them.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use serde::Serialize;

use crate::cases::{CaseOutcome, CaseVerdict};

/// Results of a run, as --json writes them.
#[derive(Debug, Serialize)]
pub struct TestResults {
    /// GL_RENDERER and GL_VERSION; none where glumbra has drawn nothing.
    pub driver: Option<String>,
    folders: Vec<PathBuf>,
    /// Time of the run so far.
    pub seconds: f64,
    /// By name.
    pub cases: Vec<CaseOutcome>,
    /// Names of the cases that have not ended.
    pub unfinished: BTreeSet<String>,
    #[serde(skip)]
    begin: Instant,
}

impl TestResults {
    /// Results of a run that begins now, of cases with these names.
    pub fn new<'a>(folders: &[PathBuf], names: impl Iterator<Item = &'a str>) -> Self {
        Self {
            driver: None,
            folders: folders.to_vec(),
            seconds: 0.0,
            cases: Vec::new(),
            unfinished: names.map(str::to_owned).collect(),
            begin: Instant::now(),
        }
    }

    /// Adds a case that has ended.
    pub fn add(&mut self, outcome: CaseOutcome) {
        self.unfinished.remove(&outcome.name);
        let place = self.cases.partition_point(|case| case.name <= outcome.name);
        self.cases.insert(place, outcome);
    }

    /// Brings the run's time up to date.
    pub fn take_time(&mut self) {
        self.seconds = self.begin.elapsed().as_secs_f64();
    }

    /// Tests whether a case does not pass, or has not ended.
    pub fn fails(&self) -> bool {
        !self.unfinished.is_empty() || self.cases.iter().any(|case| case.verdict != CaseVerdict::Pass)
    }
}
