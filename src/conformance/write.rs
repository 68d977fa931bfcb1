//! JUnit's XML of the results, for continuous integration.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Property, Report, TestCase, TestCaseStatus, TestSuite};

use super::{Checked, Finding, RuleOutcome, RuleVerdict};

/// A suite each rule, and in it a test case each finding. The driver's numbers are the suites' properties. One suite more
/// has the waivers that are out of date, and one the rules that were not run when a run was ended.
///
/// # Errors
///
/// Those of the XML writer.
pub fn junit(checked: &Checked) -> Result<String, quick_junit::SerializeError> {
    let mut report = Report::new("glumbra check");
    for outcome in &checked.outcomes {
        report.add_test_suite(suite(checked, outcome));
    }
    if !checked.stale_waivers.is_empty() {
        let mut waivers = TestSuite::new("waivers");
        for stale in &checked.stale_waivers {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message("a waiver no longer applies").set_description(stale.clone());
            waivers.add_test_case(case("waivers", stale, status));
        }
        report.add_test_suite(waivers);
    }
    if !checked.unfinished.is_empty() {
        let mut unfinished = TestSuite::new("unfinished");
        for id in &checked.unfinished {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message("not run").set_description("The run has not come to this rule, or was ended before it.");
            unfinished.add_test_case(case("unfinished", id, status));
        }
        report.add_test_suite(unfinished);
    }
    report.to_string()
}

fn case(class: &str, name: &str, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new(name, status);
    case.set_classname(format!("glumbra.check.{class}"));
    case
}

fn suite(checked: &Checked, outcome: &RuleOutcome) -> TestSuite {
    let mut suite = TestSuite::new(format!("{} {}", outcome.id, outcome.title));
    suite.set_time(Duration::from_secs_f64(outcome.seconds));
    let context = &checked.context;
    let driver = [
        ("GL_VENDOR", &context.vendor),
        ("GL_RENDERER", &context.renderer),
        ("GL_VERSION", &context.version),
        ("context", &context.backend),
        ("profile", &context.profile),
    ];
    suite.add_properties(driver.map(|(name, value)| Property::new(name, value.as_str())));
    suite.add_properties(outcome.facts.iter().map(|fact| Property::new(fact.name.as_str(), fact.value.as_str())));
    for finding in &outcome.findings {
        suite.add_test_case(test_case(outcome, finding));
    }
    suite
}

/// The case of a finding. A failure's text has the rule, what is due and what was measured: readers of reports show the text
/// and not always the message.
fn test_case(outcome: &RuleOutcome, finding: &Finding) -> TestCase {
    let status = match finding.verdict {
        RuleVerdict::Pass | RuleVerdict::Warning => TestCaseStatus::success(),
        RuleVerdict::Untestable => {
            let mut status = TestCaseStatus::skipped();
            status.set_message(format!("cannot be tested here: {}", finding.measured));
            status
        }
        RuleVerdict::Waived => {
            let mut status = TestCaseStatus::skipped();
            let reason = finding.waiver.as_deref().unwrap_or_default();
            status.set_message(format!("waived: {}: {reason}", finding.measured));
            status
        }
        RuleVerdict::Fail => failure(outcome, finding, NonSuccessKind::Failure),
        RuleVerdict::OutOfMemory | RuleVerdict::ContextLost | RuleVerdict::Hang | RuleVerdict::Crash => {
            failure(outcome, finding, NonSuccessKind::Error)
        }
    };
    let mut case = case(outcome.id, &finding.what, status);
    match finding.verdict {
        RuleVerdict::Warning => case.set_system_out(format!("quality warning: {}", finding.measured)),
        RuleVerdict::Pass => case.set_system_out(finding.measured.clone()),
        _ => &mut case,
    };
    case
}

fn failure(outcome: &RuleOutcome, finding: &Finding, kind: NonSuccessKind) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(finding.verdict.to_string().to_lowercase()).set_message(finding.measured.clone());
    status.set_description(format!(
        "{id} {title}\n{message}\nGL 4.6, {section}: {says}\nTolerance: {tolerance}\nAgain: glumbra check --filter {id}",
        id = outcome.id,
        title = outcome.title,
        message = finding.message(),
        section = outcome.section,
        says = outcome.says,
        tolerance = outcome.tolerance,
    ));
    status
}
