//! `glumbra test` that is ended before its cases are, or whose files cannot be written: what is known is kept.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;

use super::{FAILS, PASSES, glumbra, text, write};
use crate::support::processes::{await_end, children_of};

/// Cases of which the third never ends.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "all/a-passes", PASSES);
    write(folder.path(), "all/b-fails", FAILS);
    write(folder.path(), "all/c-waits", &format!("render = [\"sh\", \"-c\", \"sleep 60\", \"{{out}}\"]\n{PASSES}"));
    write(folder.path(), "all/d-passes", PASSES);
    folder
}

fn start(folder: &Path) -> Child {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    command.args(["test", "all", "--jobs", "1", "--json", "x.json", "--junit", "x.xml", "--html", "page"]);
    command.spawn().unwrap()
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_default()
}

/// Waits until both files have the case that fails.
fn await_results(folder: &Path) {
    let begin = Instant::now();
    while !(read(folder, "x.json").contains("\"name\": \"b-fails\"")
        && read(folder, "x.xml").contains("behind the box"))
    {
        assert!(begin.elapsed() < Duration::from_secs(20), "nothing is written: {}", read(folder, "x.json"));
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_run_that_is_ended_leaves_its_results_and_no_process() {
    for signal in [libc::SIGINT, libc::SIGKILL] {
        let folder = folder();
        fs::write(folder.path().join("x.json"), "of an earlier run").unwrap();
        let mut run = start(folder.path());
        await_results(folder.path());
        let children = children_of(run.id());
        assert_eq!(children.len(), 1);
        // SAFETY: the process is this test's own.
        unsafe { libc::kill(run.id() as i32, signal) };
        let status = run.wait().unwrap();

        let json: serde_json::Value = serde_json::from_str(&read(folder.path(), "x.json")).unwrap();
        assert_eq!(json["unfinished"], serde_json::json!(["c-waits", "d-passes"]));
        let names: Vec<_> = json["cases"].as_array().unwrap().iter().map(|case| &case["name"]).collect();
        assert_eq!(names, ["a-passes", "b-fails"]);
        assert!(json["seconds"].as_f64().unwrap() > 0.0);
        let junit = read(folder.path(), "x.xml");
        let report = quick_junit::Report::deserialize_from_str(&junit).unwrap();
        assert_eq!((report.tests, report.failures, report.errors), (4, 1, 2), "{junit}");
        assert_eq!(junit.matches("type=\"unfinished\"").count(), 2, "{junit}");
        assert_eq!(report.test_suites.len(), 1, "finished or not, a folder is one suite");
        let page = read(folder.path(), "page/index.html");
        match signal {
            libc::SIGINT => {
                assert_eq!(status.code(), Some(130));
                assert!(page.contains("<h1>1 case fails</h1>") && page.contains("<h2>Unfinished</h2>"), "{page}");
            }
            _ => {
                assert_eq!(status.signal(), Some(signal));
                assert_eq!(page, "", "the page is written at the end");
            }
        }
        await_end(&children);
    }
}

/// The page cannot be written at the end: its folder is gone. What was found is on the screen and in the other files.
#[test]
fn a_file_that_cannot_be_written_at_the_end_loses_no_result() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "all/a-fails", FAILS);
    write(folder.path(), "all/b-removes", &format!("render = [\"rm\", \"-r\", \"../../page\", \"{{out}}\"]\n{PASSES}"));
    let output = glumbra(folder.path(), &["all", "--jobs", "1", "--json", "x.json", "--html", "page"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("page/index.html: cannot be written"), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).lines().last(), Some("FAIL: a-fails, b-removes"));
    assert!(read(folder.path(), "x.json").contains("\"name\": \"a-fails\""));
}
