//! The process that runs cases: each line of its standard input names one, and each that has ended is told by a line.

use std::path::PathBuf;
use std::sync::mpsc::channel;

use serde::{Deserialize, Serialize};

use crate::cases::{CaseOutcome, CaseRunner, CaseVerdict, PixelCase, Settings};
use crate::cli::{Error, child_process};

/// A case to run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Job {
    /// The folder of its case.toml.
    pub folder: PathBuf,
    /// The case's name.
    pub name: String,
}

/// News of a case.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseEvent {
    /// There is no context to draw on: the error.
    Refused(String),
    /// It has ended. The driver, if a picture has been drawn in this process.
    Ended { outcome: Box<CaseOutcome>, driver: Option<String> },
}

/// Runs the cases that standard input names, until it ends, and this process with it.
///
/// # Errors
///
/// Standard output that is closed.
pub fn run(settings: Settings) -> Result<(), Error> {
    let (send, jobs) = channel();
    child_process::end_with_parent(move |line| {
        if let Ok(job) = serde_json::from_str::<Job>(&line) {
            let _ = send.send(job);
        }
    });
    let mut runner = CaseRunner::new(settings);
    for job in jobs {
        let outcome = match PixelCase::read(&job.folder, &job.name) {
            Ok(case) => runner.run(&case),
            // It was another file a moment ago.
            Err(error) => CaseOutcome::refused(&job.name, error.to_string()),
        };
        let event = match runner.drawer().no_context() {
            Some(error) if outcome.verdict == CaseVerdict::Fail => CaseEvent::Refused(error.to_owned()),
            _ => {
                let driver = runner.drawer().used_driver().map(str::to_owned);
                CaseEvent::Ended { outcome: Box::new(outcome), driver }
            }
        };
        child_process::tell(&event)?;
    }
    Ok(())
}
