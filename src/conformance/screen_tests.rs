//! The screen's text, the baseline, repeats and JUnit, on outcomes that are made up.

use super::super::{Fact, baseline, join, junit, waivers};
use super::*;
use crate::conformance::events::rule;

fn outcome(id: &str, findings: &[(&str, RuleVerdict, &str)]) -> RuleOutcome {
    let findings = findings.iter().map(|(what, verdict, measured)| Finding::new(*what, *verdict, *measured)).collect();
    let facts = vec![Fact { name: "a number".to_owned(), value: "7".to_owned() }];
    RuleOutcome::new(rule(id).unwrap(), findings, facts, 0.5)
}

fn checked(outcomes: Vec<RuleOutcome>) -> Checked {
    let context = serde_json::json!({
        "backend": "EGL", "vendor": "Mesa", "renderer": "llvmpipe (LLVM 15)", "profile": "compatibility",
        "version": "4.5 (Compatibility Profile) Mesa 22.3.6", "shading_language": "4.50", "khr_debug": true,
        "debug_output": false, "timer_bits": 64, "limits": {
            "texture_size": 1, "cube_map_size": 1, "array_layers": 1, "texture_units": 1, "renderbuffer_size": 1,
            "viewport": [1, 1], "color_attachments": 1, "draw_buffers": 1, "samples": 1, "subpixel_bits": 8,
            "anisotropy": 1.0, "clip_distances": 8, "vertex_attributes": 16, "vertex_uniforms": 1,
            "fragment_uniforms": 1, "uniform_block_bytes": 1
        }
    });
    Checked {
        context: serde_json::from_value(context).unwrap(),
        seconds: outcomes.iter().map(|outcome| outcome.seconds).sum(),
        outcomes,
        stale_waivers: Vec::new(),
        unfinished: Vec::new(),
        flakes: Vec::new(),
        since: None,
    }
}

fn three() -> Checked {
    let long =
        "a measurement of many words that has to be put into several lines as it is longer than the screen is wide";
    checked(vec![
        outcome("GL-C1", &[("a", RuleVerdict::Pass, "all right")]),
        outcome(
            "GL-S1",
            &[("b", RuleVerdict::Fail, long), ("c", RuleVerdict::Pass, "right"), ("w", RuleVerdict::Warning, "so")],
        ),
        outcome("GL-R1", &[("d", RuleVerdict::Crash, "SIGSEGV"), ("e", RuleVerdict::Untestable, "no")]),
    ])
}

/// The text as a screen without colours shows it.
fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

#[test]
fn the_screen_has_what_does_not_pass_in_80_columns_and_last_the_rules_that_fail() {
    let text = screen(&three(), 80);
    assert!(text.contains("\u{1b}[1m\u{1b}[31mCRASH:"), "{text:?}");
    let text = plain(&text);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(!text.contains("GL-C1") && !text.contains("c: right"), "{text}");
    for part in ["GL says: ", "FAIL: b: a measurement", "warning: w: so", "CRASH: d: SIGSEGV", "not here: e: no"] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
    assert_eq!(text.lines().last(), Some("FAIL: GL-S1, GL-R1"));
    let sound = checked(vec![outcome("GL-C1", &[("a", RuleVerdict::Pass, "all right")])]);
    assert_eq!(plain(&screen(&sound, 80)).lines().last(), Some("No rule fails."));
}

#[test]
fn junit_has_a_case_a_finding_with_the_failure_in_its_text() {
    let mut run = three();
    let waiver = waivers::parse_for_test("GL-S1", "b");
    waivers::apply(&waiver, &run.context.clone(), &mut run.outcomes);
    run.unfinished = vec!["GL-F1"];
    let xml = junit(&run).unwrap();
    for part in [
        "tests=\"7\" skipped=\"2\" failures=\"0\" errors=\"2\"",
        "<testcase name=\"d\" classname=\"glumbra.check.GL-R1\">",
        "<error message=\"SIGSEGV\" type=\"crash\">GL-R1 ",
        "<skipped message=\"waived: a measurement",
        "<skipped message=\"cannot be tested here: no\"/>",
        "<property name=\"a number\" value=\"7\"/>",
        "<testcase name=\"GL-F1\" classname=\"glumbra.check.unfinished\">",
    ] {
        assert!(xml.contains(part), "no `{part}` in {xml}");
    }
}

#[test]
fn a_run_is_compared_with_an_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("before.json");
    std::fs::write(&path, serde_json::to_string_pretty(&three()).unwrap()).unwrap();
    let before = baseline::load(&path).unwrap();
    let same = baseline::compare(&before, &three());
    assert_eq!((same.known_failures.len(), same.new_failures.len(), same.fixed.len()), (2, 0, 0));
    let mut now = checked(vec![outcome(
        "GL-S1",
        &[("b", RuleVerdict::Pass, "right"), ("c", RuleVerdict::Fail, "wrong"), ("n", RuleVerdict::Pass, "")],
    )]);
    let changes = baseline::compare(&before, &now);
    assert_eq!(changes.new_failures, ["GL-S1 c: wrong"]);
    assert_eq!(changes.fixed, ["GL-S1 b: right"]);
    assert_eq!(changes.new, ["GL-S1 n: "]);
    assert_eq!(changes.gone, ["GL-S1 w: so"]);
    now.since = Some(changes);
    assert!(now.fails());
    let mut again = three();
    again.since = Some(same);
    assert!(!again.fails(), "known failures do not fail a run with a baseline");
    std::fs::write(&path, "{}").unwrap();
    assert!(baseline::load(&path).unwrap_err().to_string().contains("no result of `glumbra check --json`"));
}

#[test]
fn what_differs_between_repeats_is_named_and_the_worst_kept() {
    let run =
        |verdict, measured| vec![outcome("GL-S1", &[("b", verdict, measured), ("c", RuleVerdict::Pass, "right")])];
    let (joined, flakes) =
        join(vec![run(RuleVerdict::Pass, "0"), run(RuleVerdict::Fail, "3"), run(RuleVerdict::Pass, "0")]);
    assert_eq!(joined[0].verdict, RuleVerdict::Fail);
    assert_eq!(joined[0].findings.len(), 2);
    assert_eq!(flakes.len(), 1);
    assert_eq!(flakes[0].answers, ["pass: 0", "FAIL: 3", "pass: 0"]);
}

#[test]
fn waivers_that_are_written_waive_what_fails() {
    let mut run = three();
    let text = waivers::write(&run, &[]).unwrap();
    for part in ["renderer = \"llvmpipe\"", "version = \"Mesa \"", "from = \"22.3.6\"", "finding = \"d\""] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("waivers.toml");
    std::fs::write(&path, &text).unwrap();
    let written = waivers::load(Some(&path)).unwrap();
    assert!(waivers::apply(&written, &run.context.clone(), &mut run.outcomes).is_empty());
    assert!(!run.fails());
    // Written again, they are the same.
    assert_eq!(waivers::write(&run, &written).unwrap(), text);
}
