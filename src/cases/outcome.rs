//! Outcome of a case: its verdict, the check that failed, and the pictures that show it.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::read::PixelCase;

/// Result of a case, or of its first check that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CaseVerdict {
    /// Every check holds.
    Pass,
    /// A check does not hold, or could not be made.
    Fail,
    /// A golden was written, which fails on purpose: nobody has looked at it.
    Blessed,
    /// The driver or the case's command crashed.
    Crash,
    /// The case did not end within its time.
    Hang,
    /// There was not enough memory.
    OutOfMemory,
}

impl CaseVerdict {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Pass, Self::Fail, Self::Blessed, Self::Crash, Self::Hang, Self::OutOfMemory];

    /// The verdict as a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "FAIL",
            Self::Blessed => "BLESSED",
            Self::Crash => "CRASH",
            Self::Hang => "HANG",
            Self::OutOfMemory => "OUT OF MEMORY",
        }
    }
}

/// Reason why a check does not hold.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}{}", .files.in_words())]
pub struct Failure {
    /// Any but a pass.
    pub verdict: CaseVerdict,
    /// Expected and found, in words, with the check's `why`.
    pub message: String,
    /// The check's key in the file and its number from 0; `gl` for a GL error; none where no check was come to.
    pub check: Option<(&'static str, usize)>,
    /// Pictures that show it.
    pub files: Box<FailureFiles>,
}

impl Failure {
    /// A failure of a kind, in words.
    pub fn new(verdict: CaseVerdict, message: impl Into<String>) -> Self {
        Self { verdict, message: message.into(), check: None, files: Box::default() }
    }

    /// A GL error, whichever check drew.
    pub(super) fn of_gl(message: String) -> Self {
        Self { check: Some(("gl", 0)), ..Self::new(CaseVerdict::Fail, message) }
    }

    /// The failure of a check, unless it is known which.
    pub(super) fn at(self, kind: &'static str, index: usize) -> Self {
        Self { check: self.check.or(Some((kind, index))), ..self }
    }

    /// The failure with words before its own.
    pub(super) fn under(self, words: &str) -> Self {
        Self { message: format!("{words}: {}", self.message), ..self }
    }
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self::new(CaseVerdict::Fail, message)
    }
}

impl From<&str> for Failure {
    fn from(message: &str) -> Self {
        Self::new(CaseVerdict::Fail, message)
    }
}

/// Pictures of a failure, as PNG files. Absent: there is none, or it could not be written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureFiles {
    /// The picture that was judged.
    pub actual: Option<PathBuf>,
    /// The picture that was expected, where one was.
    pub expected: Option<PathBuf>,
    /// Their difference, from black to white at 16/255; against truth, a class each pixel.
    pub difference: Option<PathBuf>,
    /// Errors of pictures that could not be written.
    pub errors: Vec<String>,
}

impl FailureFiles {
    /// The pictures with their names.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let all = [("actual", &self.actual), ("expected", &self.expected), ("difference", &self.difference)];
        all.into_iter().filter_map(|(name, path)| path.as_ref().map(|path| (name, path)))
    }

    fn in_words(&self) -> String {
        let files = self.named().map(|(_, path)| path.display().to_string());
        let lines: Vec<String> = files.chain(self.errors.iter().cloned()).collect();
        if lines.is_empty() { String::new() } else { format!("\n  see {}", lines.join("\n      ")) }
    }
}

/// A case that was run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseOutcome {
    /// The folder's path below the one that was searched.
    pub name: String,
    /// The question that the case asks.
    pub asks: String,
    /// The whole case's.
    pub verdict: CaseVerdict,
    /// The time that it took.
    pub seconds: f64,
    /// Expected and found in words; none where it passes.
    pub message: Option<String>,
    /// The check that failed: its key in the file, and `gl` for a GL error.
    pub check: Option<String>,
    /// The check's file and line, as `PATH:LINE`.
    pub at: Option<String>,
    /// Pictures of the failure.
    pub files: FailureFiles,
    /// Measurements of checks that hold.
    pub measured: Vec<String>,
}

impl CaseOutcome {
    /// A case whose process ended before it did.
    pub fn ended(case: &PixelCase, verdict: CaseVerdict, seconds: f64, message: String) -> Self {
        let refused = Self::refused(&case.name, message);
        Self { asks: case.checks.asks.clone(), verdict, seconds, ..refused }
    }

    /// A case that could not be run.
    pub fn refused(name: &str, message: String) -> Self {
        Self {
            name: name.to_owned(),
            asks: String::new(),
            verdict: CaseVerdict::Fail,
            seconds: 0.0,
            message: Some(message),
            check: None,
            at: None,
            files: FailureFiles::default(),
            measured: Vec::new(),
        }
    }

    /// The failure in lines: the question, the place with what was found, the pictures. `None`: the case passes.
    pub fn failure(&self) -> Option<String> {
        let message = self.message.as_ref()?;
        let at = self.at.as_ref().map(|at| format!("{at}: ")).unwrap_or_default();
        let check = self.check.as_ref().map(|check| format!("[{check}] ")).unwrap_or_default();
        Some(format!("{}\n  {at}{check}{message}{}", self.asks, self.files.in_words()))
    }
}
