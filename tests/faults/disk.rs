//! Disks that are full or read-only, limits on files, and what a killed process leaves.

use std::fs;
use std::os::unix::process::CommandExt;
use std::process::Stdio;
use std::time::Duration;

use super::*;

const OLD: &str = "an older picture";

#[test]
fn a_full_disk_keeps_the_older_picture() {
    let folder = work();
    let Some(mount) = Mount::new(folder.path(), "size=16k") else {
        println!("skipped: this test cannot mount");
        return;
    };
    fs::write(mount.0.join("x.png"), OLD).unwrap();
    let output = run(folder.path(), "glumbra render scene.toml -o mounted/x.png --aov shade");
    assert_eq!(refusal(&output, 1, "cannot be written: No space left on device"), None);
    assert_eq!(names(&mount.0), ["x.png"]);
    assert_eq!(fs::read_to_string(mount.0.join("x.png")).unwrap(), OLD);
}

/// Room for the journal and not for the page: the sweep is kept, and --resume ends it without measuring again.
#[test]
fn a_disk_that_is_full_at_the_last_write_loses_no_row() {
    let folder = work();
    fs::write(folder.path().join("grid.toml"), "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [64, 128]\n").unwrap();
    let Some(mount) = Mount::new(folder.path(), "size=32k") else {
        println!("skipped: this test cannot mount");
        return;
    };
    let report = "glumbra report scene.toml --grid grid.toml --runs 1 -o mounted";
    let output = run(folder.path(), report);
    assert_eq!(refusal(&output, 1, "cannot be written: No space left on device"), None);
    let journal = fs::read_to_string(mount.0.join("report.journal.jsonl")).unwrap();
    assert!(journal.lines().count() >= 2, "{journal}");
    mount.options("remount,size=16m");
    let output = run(folder.path(), &format!("{report} --resume"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(names(&mount.0).iter().filter(|name| name.starts_with("report")).count(), 3, "{:?}", names(&mount.0));
    let json = fs::read_to_string(mount.0.join("report.json")).unwrap();
    for line in journal.lines() {
        // The very times of the first run.
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        let report: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert!(report["scenes"][0]["rows"].as_array().unwrap().contains(&row["row"]), "{line}");
    }
}

#[test]
fn a_disk_that_is_read_only_is_told() {
    let folder = work();
    let Some(mount) = Mount::new(folder.path(), "size=64k") else {
        println!("skipped: this test cannot mount");
        return;
    };
    fs::write(mount.0.join("x.png"), OLD).unwrap();
    mount.options("remount,ro");
    for script in ["glumbra render scene.toml -o mounted/x.png", "glumbra check --filter D1 --json mounted/x.png"] {
        let output = run(folder.path(), script);
        let code = if script.contains("check") { 2 } else { 1 };
        assert_eq!(refusal(&output, code, "x.png: cannot be written: Read-only file system"), None);
    }
    let output = run(folder.path(), "glumbra report scene.toml --quick -o mounted/report");
    assert_eq!(refusal(&output, 1, "mounted/report: the folder cannot be made: Read-only file system"), None);
}

#[test]
fn limits_and_devices_are_told() {
    refused(&[
        (
            "a limit on files",
            "ulimit -f 1; glumbra render scene.toml -o x.png",
            1,
            "x.png: cannot be written: File too large",
        ),
        ("a full device", "ln -s /dev/full x.png; glumbra render scene.toml -o x.png", 1, "No space left on device"),
        ("no folder", "glumbra render scene.toml -o absent/x.png", 1, "the folder absent does not exist"),
        ("no scene", "glumbra render absent.toml", 1, "absent.toml: cannot be read: No such file or directory"),
        (
            "a folder of the name",
            "mkdir x.json; glumbra check --filter D1 --json x.json",
            2,
            "x.json: cannot be written",
        ),
        (
            "a file for a folder",
            "touch out; glumbra report scene.toml --quick -o out",
            1,
            "out: the folder cannot be made",
        ),
    ]);
}

/// Ended while it writes: by SIGKILL what is beside stays, and the next run removes it; other signals leave nothing.
#[test]
fn what_a_killed_process_leaves_is_removed() {
    for (signal, leaves) in [("KILL", true), ("TERM", false), ("INT", false), ("HUP", false)] {
        let folder = work();
        fs::write(folder.path().join("x.png"), OLD).unwrap();
        // A pipe that nobody reads holds the process at its last write, with that file unfinished.
        let script =
            "export TMPDIR=.; mkfifo x.shade.png; exec \"$0\" render scene.toml -o x.png --aov depth --aov shade";
        let mut command = Command::new("sh");
        command.args(["-c", script, GLUMBRA]).current_dir(folder.path()).stderr(Stdio::null());
        // Who runs the tests by nohup has SIGHUP ignored, and what they start inherits that.
        // SAFETY: signal may be called between fork and exec.
        unsafe {
            command.pre_exec(|| {
                libc::signal(libc::SIGHUP, libc::SIG_DFL);
                Ok(())
            });
        }
        let mut child = command.spawn().unwrap();
        let is_beside = |name: &String| name.contains(".glumbra-");
        let deadline = std::time::Instant::now() + Duration::from_secs(60);
        // All renames but the pipe's are done when the process waits for a reader.
        while fs::read_to_string(folder.path().join("x.png")).is_ok_and(|text| text == OLD) {
            assert!(std::time::Instant::now() < deadline, "x.png is never written");
            std::thread::sleep(Duration::from_millis(5));
        }
        let kill = format!("kill -{signal} {}", child.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        child.wait().unwrap();
        assert_eq!(names(folder.path()).iter().any(is_beside), leaves, "{signal}: {:?}", names(folder.path()));
        fs::remove_file(folder.path().join("x.shade.png")).unwrap();
        let output = run(folder.path(), "glumbra render scene.toml -o x.png");
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert!(!names(folder.path()).iter().any(is_beside), "{signal}: {:?}", names(folder.path()));
    }
}

/// Two processes write the same pictures at once, again and again.
#[test]
fn two_writers_leave_one_whole_picture() {
    let folder = work();
    let script = "for i in 1 2 3 4; do glumbra render scene.toml -o x.png --aov shade || exit 1; done";
    let children: Vec<_> =
        (0..2).map(|_| shell(folder.path(), script).stderr(Stdio::piped()).spawn().unwrap()).collect();
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    }
    assert_eq!(names(folder.path()), ["scene.toml", "x.png", "x.shade.png"]);
    for name in ["x.png", "x.shade.png"] {
        let picture = image::open(folder.path().join(name)).unwrap();
        assert_eq!((picture.width(), picture.height()), (96, 96));
    }
}
