//! Disks that are full or read-only, limits on files, and what a killed process leaves.

use std::fs;
use std::os::unix::process::CommandExt;
use std::process::Stdio;
use std::time::Duration;

use super::*;

const OLD: &str = "an older picture";

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
        // Tests that are run by nohup or in the background of a shell have signals ignored, and what they start inherits that.
        // SAFETY: signal may be called between fork and exec.
        unsafe {
            command.pre_exec(|| {
                for signal in [libc::SIGHUP, libc::SIGINT, libc::SIGTERM] {
                    libc::signal(signal, libc::SIG_DFL);
                }
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
    let script = "for i in 1 2 3 4; do glumbra render scene.toml -o x.png --aov shade --quiet || exit 1; done";
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
