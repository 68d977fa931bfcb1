//! JUnit's XML: a suite each folder, a test case each case.

use std::collections::BTreeMap;
use std::time::Duration;

use quick_junit::{NonSuccessKind, Property, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};

use super::results::TestResults;
use crate::cases::{CaseOutcome, CaseVerdict};

/// The report.
///
/// # Errors
///
/// Those of the XML writer.
pub fn to_junit(results: &TestResults) -> Result<String, SerializeError> {
    let mut report = Report::new("glumbra test");
    report.set_time(Duration::from_secs_f64(results.seconds));
    let mut suites: BTreeMap<String, TestSuite> = BTreeMap::new();
    let mut add = |folder: &str, case: TestCase| {
        let new = || {
            let mut suite = TestSuite::new(folder);
            suite.add_properties(results.driver.iter().map(|driver| Property::new("driver", driver.as_str())));
            suite
        };
        suites.entry(folder.to_owned()).or_insert_with(new).add_test_case(case);
    };
    for outcome in &results.cases {
        let (folder, name) = parts(&outcome.name);
        let mut case = TestCase::new(name, status(outcome));
        case.set_classname(folder.replace('/', ".")).set_time(Duration::from_secs_f64(outcome.seconds));
        if !outcome.measured.is_empty() {
            case.set_system_out(outcome.measured.join("\n"));
        }
        add(folder, case);
    }
    for name in &results.unfinished {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status
            .set_type("unfinished")
            .set_message("the run has not come to the end of this case, or was ended before it");
        let (folder, name) = parts(name);
        let mut case = TestCase::new(name, status);
        case.set_classname(folder.replace('/', "."));
        add(folder, case);
    }
    for suite in suites.values_mut() {
        suite.set_time(suite.test_cases.iter().filter_map(|case| case.time).sum());
    }
    report.add_test_suites(suites.into_values());
    report.to_string()
}

/// The folder of a case, and the rest of its name.
fn parts(name: &str) -> (&str, &str) {
    name.rsplit_once('/').unwrap_or(("cases", name))
}

/// A failure's text has all: readers of reports show the text and not always the message.
fn status(outcome: &CaseOutcome) -> TestCaseStatus {
    let kind = match outcome.verdict {
        CaseVerdict::Pass => return TestCaseStatus::success(),
        CaseVerdict::Fail | CaseVerdict::Blessed => NonSuccessKind::Failure,
        CaseVerdict::Crash | CaseVerdict::Hang | CaseVerdict::OutOfMemory => NonSuccessKind::Error,
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(outcome.verdict.name().to_lowercase());
    status.set_message(outcome.message.clone().unwrap_or_default());
    let again = format!("\nAgain: glumbra test DIR --exact --filter {}", outcome.name);
    status.set_description(outcome.failure().unwrap_or_default() + &again);
    status
}
