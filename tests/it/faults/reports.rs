//! Reports that are killed, and two at once.

use std::fs;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use glumbra::report::store::merge::{self, equal_but_for_times};

use super::*;

const GRID: &str = "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [64, 128, 256]\nfilter = [\"nearest\", \"linear\"]\n\
                    offset = [{ factor = 0.0, units = 0.0 }, { factor = 2.0, units = 4.0 }]\n";

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(GLUMBRA);
    command.current_dir(folder).args(["report", "scene.toml", "--grid", "grid.toml", "--runs", "1"]).args(arguments);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn files(folder: &Path) -> Vec<String> {
    let mut files = names(folder);
    for inner in ["plots", "pictures"] {
        files.extend(names(&folder.join(inner)).into_iter().map(|name| format!("{inner}/{name}")));
    }
    files
}

#[test]
fn a_report_that_is_killed_at_any_moment_is_gone_on_with() {
    let folder = work();
    fs::write(folder.path().join("grid.toml"), GRID).unwrap();
    let begin = Instant::now();
    let output = start(folder.path(), &["-o", "whole"]).wait_with_output().unwrap();
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let whole_time = begin.elapsed();
    let whole = merge::load(&folder.path().join("whole")).unwrap();
    for moment in 0..10 {
        let place = format!("killed{moment}");
        let mut child = start(folder.path(), &["-o", &place]);
        std::thread::sleep(whole_time.mul_f64((f64::from(moment) + 0.5) / 10.0));
        // SIGKILL; a process that has ended already is as good.
        let _ = child.kill();
        child.wait().unwrap();
        let path = folder.path().join(&place);
        if path.join("report.json").exists() {
            // Whole or not there.
            merge::load(&path).unwrap();
        }
        let output = start(folder.path(), &["-o", &place, "--resume"]).wait_with_output().unwrap();
        assert_eq!(code(&output), 0, "moment {moment}: {}", text(&output.stderr));
        let report = merge::load(&path).unwrap();
        assert!(report.complete, "moment {moment}");
        assert_eq!(report.scenes[0].rows.len(), whole.scenes[0].rows.len());
        for (row, expected) in report.scenes[0].rows.iter().zip(&whole.scenes[0].rows) {
            assert!(equal_but_for_times(row, expected), "moment {moment}: {row:?} {expected:?}");
        }
        let left = files(&path);
        assert!(
            !left.iter().any(|name| name.contains(".tmp") || name.contains("journal")),
            "moment {moment}: {left:?}"
        );
    }
}

#[test]
fn a_second_report_into_one_folder_is_refused() {
    let folder = work();
    fs::write(folder.path().join("grid.toml"), GRID).unwrap();
    let journal = folder.path().join("out/report.journal.jsonl");
    let first = start(folder.path(), &["-o", "out", "--size", "256x256"]);
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::read_to_string(&journal).map_or(true, |text| text.is_empty()) {
        assert!(Instant::now() < deadline, "no journal");
        std::thread::sleep(Duration::from_millis(2));
    }
    let second = start(folder.path(), &["-o", "out"]).wait_with_output().unwrap();
    let first = first.wait_with_output().unwrap();
    assert_eq!(code(&first), 0, "{}", text(&first.stderr));
    assert_eq!(refusal(&second, 1, "another report is being written into this folder"), None);
    let report = merge::load(&folder.path().join("out")).unwrap();
    assert!(report.complete && report.scenes[0].size == [256, 256]);
}
