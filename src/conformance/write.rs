//! Machine-readable results: JSON, and JUnit's XML for continuous integration.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::{Checked, RuleOutcome, RuleVerdict};

/// All of it, pretty.
///
/// # Errors
///
/// Those of serde.
pub fn json(checked: &Checked) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(checked).map(|text| text + "\n")
}

/// A test case each rule, and one each waiver that is out of date.
///
/// # Errors
///
/// Those of the XML writer.
pub fn junit(checked: &Checked) -> Result<String, quick_junit::SerializeError> {
    let mut suite = TestSuite::new(format!("{}, {}", checked.context.renderer, checked.context.version));
    for outcome in &checked.outcomes {
        suite.add_test_case(test_case(outcome));
    }
    for stale in &checked.stale_waivers {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message(stale.clone());
        suite.add_test_case(TestCase::new("waivers", status));
    }
    let mut report = Report::new("glumbra check");
    report.add_test_suite(suite);
    report.to_string()
}

fn test_case(outcome: &RuleOutcome) -> TestCase {
    let told = |verdict: RuleVerdict| {
        let findings = outcome.findings.iter().filter(|finding| finding.verdict == verdict);
        findings.map(|finding| finding.message()).collect::<Vec<_>>().join("\n")
    };
    let mut status = match outcome.verdict {
        RuleVerdict::Fail => TestCaseStatus::non_success(NonSuccessKind::Failure),
        RuleVerdict::Untestable => TestCaseStatus::skipped(),
        RuleVerdict::Pass | RuleVerdict::Warning | RuleVerdict::Waived => TestCaseStatus::success(),
    };
    if matches!(outcome.verdict, RuleVerdict::Fail | RuleVerdict::Untestable) {
        status.set_message(told(outcome.verdict));
        status.set_description(format!("GL 4.6, {}: {}", outcome.section, outcome.says));
    }
    let mut case = TestCase::new(format!("{} {}", outcome.id, outcome.title), status);
    case.set_classname("glumbra.check").set_time(std::time::Duration::from_secs_f64(outcome.seconds));
    let rest: Vec<String> = [(RuleVerdict::Warning, "quality warning"), (RuleVerdict::Waived, "waived")]
        .into_iter()
        .map(|(verdict, name)| (told(verdict), name))
        .filter(|(text, _)| !text.is_empty())
        .map(|(text, name)| format!("{name}:\n{text}"))
        .collect();
    if !rest.is_empty() {
        case.set_system_out(rest.join("\n"));
    }
    case
}
