//! Runs cases one after the other on one context.

use std::cell::RefCell;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::bench::{CaseBench, Shared, remove_pictures};
use super::check;
use super::draw::Drawer;
use super::outcome::{CaseOutcome, CaseVerdict, Failure, FailureFiles};
use super::read::{FILE, PixelCase};
use crate::context::ContextRequest;

/// Settings of a run.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Context to draw on.
    pub context: ContextRequest,
    /// Folder for pictures of failures: each case's in a folder of its name.
    pub failures: PathBuf,
    /// Goldens are written, and their cases fail.
    pub bless: bool,
    /// Time that the commands of a case may take together.
    pub limit: Duration,
}

impl Default for Settings {
    /// The first context that works, pictures in `case-failures`, no blessing, two minutes.
    fn default() -> Self {
        Self {
            context: ContextRequest::default(),
            failures: PathBuf::from("case-failures"),
            bless: false,
            limit: Duration::from_secs(120),
        }
    }
}

/// Runs cases. It keeps its renderer and context from case to case.
pub struct CaseRunner {
    settings: Settings,
    drawer: Drawer,
}

impl CaseRunner {
    /// A runner; its context is opened when the first picture is wanted.
    pub fn new(settings: Settings) -> Self {
        let drawer = Drawer::new(settings.context);
        Self { settings, drawer }
    }

    /// The renderer with its context.
    pub fn drawer(&mut self) -> &mut Drawer {
        &mut self.drawer
    }

    /// Makes every check of `case`, up to the first that fails.
    pub fn run(&mut self, case: &PixelCase) -> CaseOutcome {
        let begin = Instant::now();
        remove_pictures(&self.settings.failures, case);
        let shared = Shared {
            drawer: RefCell::new(&mut self.drawer),
            measured: RefCell::default(),
            deadline: begin + self.settings.limit,
            failures: &self.settings.failures,
            bless: self.settings.bless,
        };
        let variants = case.variants();
        let result = variants.iter().try_for_each(|variant| {
            check::run(&CaseBench::new(variant, &shared)).map_err(|failure| match &variant.variant {
                Some(set) => failure.under(&format!("for_each {set:?}")),
                None => failure,
            })
        });
        let measured = shared.measured.take();
        outcome(case, result.err(), measured, begin.elapsed())
    }
}

fn outcome(case: &PixelCase, failure: Option<Failure>, measured: Vec<String>, took: Duration) -> CaseOutcome {
    let mut outcome = CaseOutcome {
        name: case.name.clone(),
        asks: case.checks.asks.clone(),
        verdict: CaseVerdict::Pass,
        seconds: took.as_secs_f64(),
        message: None,
        check: None,
        at: None,
        files: FailureFiles::default(),
        measured,
    };
    if let Some(failure) = failure {
        let line = failure.check.and_then(|(kind, index)| case.line(kind, index));
        outcome.at = line.map(|line| format!("{}:{line}", case.folder.join(FILE).display()));
        outcome.check = failure.check.map(|(kind, _)| kind.to_owned());
        outcome.verdict = failure.verdict;
        outcome.message = Some(failure.message);
        outcome.files = *failure.files;
    }
    outcome
}
