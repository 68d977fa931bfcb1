//! `glumbra check` as a command: its screen, lists, results on standard output, baselines, repeats, and runs that are ended.

use super::*;

/// One rule of each kind that ends quickly.
const QUICK: [&str; 4] = ["--filter", "GL-C1", "--filter", "GL-S2"];

fn with_quick(folder: &Path, arguments: &[&str]) -> Output {
    check(folder, &[&QUICK[..], arguments].concat())
}

#[test]
fn rules_are_listed_a_line_each() {
    let folder = tempfile::tempdir().unwrap();
    let listed = text(&check(folder.path(), &["--list"]).stdout);
    assert_eq!(listed.lines().count(), conformance::TABLE.len());
    assert!(listed.lines().zip(conformance::TABLE.iter()).all(|(line, rule)| line.starts_with(rule.id)), "{listed}");
    assert_eq!(text(&with_quick(folder.path(), &["--list"]).stdout).lines().count(), 2);
}

#[test]
fn the_screen_is_plain_in_a_pipe_and_its_last_line_names_what_fails() {
    let folder = tempfile::tempdir().unwrap();
    let output = with_quick(folder.path(), &[]);
    let screen = text(&output.stdout);
    assert!(!screen.contains('\u{1b}') && screen.lines().all(|line| line.chars().count() <= 80), "{screen}");
    assert_eq!(screen.lines().last(), Some("No rule fails."));
    std::fs::write(folder.path().join("empty.toml"), "").unwrap();
    let output = check(folder.path(), &["--filter", "O1", "--filter", "R2", "--waivers", "empty.toml"]);
    let screen = text(&output.stdout);
    if screen.contains("llvmpipe") {
        assert_eq!(screen.lines().last(), Some("FAIL: GL-O1, GL-R2"), "{screen}");
    }
    let mut command = Command::cargo_bin("glumbra").unwrap();
    let colored = command.args(["check", "--filter", "C1"]).env("CLICOLOR_FORCE", "1").env_remove("NO_COLOR").output();
    assert!(text(&colored.unwrap().stdout).contains("\u{1b}[32mNo rule fails."));
}

#[test]
fn results_go_to_standard_output_and_the_screen_to_standard_error() {
    let folder = tempfile::tempdir().unwrap();
    let output = with_quick(folder.path(), &["--json", "-"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["outcomes"].as_array().unwrap().len(), 2);
    assert!(text(&output.stderr).contains("No rule fails."));
    let output = with_quick(folder.path(), &["--junit", "-"]);
    assert!(text(&output.stdout).starts_with("<?xml"), "{}", text(&output.stdout));
    let output = with_quick(folder.path(), &["--junit", "-", "--json", "-"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--json and --junit name the same file"), "{}", text(&output.stderr));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn folders_are_made_and_an_earlier_run_is_a_baseline() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("empty.toml"), "").unwrap();
    let rules = ["--filter", "GL-R2", "--waivers", "empty.toml"];
    let before = check(folder.path(), &[&rules[..], &["--json", "out/deep/before.json"]].concat());
    let again = ["--baseline", "out/deep/before.json", "--write-waivers", "out/mine.toml"];
    let output = check(folder.path(), &[&rules[..], &again].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(words(&output.stdout).contains("no change;"), "{}", text(&output.stdout));
    // What was written waives what fails.
    let waived = check(folder.path(), &["--filter", "GL-R2", "--waivers", "out/mine.toml"]);
    assert_eq!(waived.status.code(), Some(0), "{}", text(&waived.stdout));
    if before.status.code() == Some(1) {
        let path = folder.path().join("out/deep/before.json");
        let sound = std::fs::read_to_string(&path).unwrap().replace("\"verdict\": \"fail\"", "\"verdict\": \"pass\"");
        std::fs::write(&path, sound).unwrap();
        let output = check(folder.path(), &[&rules[..], &again[..2]].concat());
        assert_eq!(output.status.code(), Some(1));
        assert!(words(&output.stdout).contains("new failure: GL-R2"), "{}", text(&output.stdout));
    }
    let output = check(folder.path(), &["--baseline", "empty.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("empty.toml: this is no result of `glumbra check --json`"));
}

#[test]
fn repeats_processes_of_their_own_and_none_answer_alike() {
    let folder = tempfile::tempdir().unwrap();
    let findings = |arguments: &[&str]| {
        let output = with_quick(folder.path(), &[arguments, &["--json", "-"]].concat());
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["flakes"].as_array().unwrap().len(), 0);
        json["outcomes"].as_array().unwrap().iter().map(|outcome| outcome["findings"].clone()).collect::<Vec<_>>()
    };
    let once = findings(&[]);
    for arguments in [&["--repeat", "3"][..], &["--isolate"], &["--here"]] {
        assert_eq!(findings(arguments), once, "{arguments:?}");
    }
}
