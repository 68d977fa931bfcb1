//! Disks that are full or read-only: file systems of a few kilobytes, which not every user may mount.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Completion;

use crate::shell::{code, names, refusal, run, text, work};
use crate::{Done, Test, tests};

pub const TESTS: &[Test] = tests![
    a_full_disk_keeps_the_older_picture,
    a_full_disk_is_an_error_and_leaves_nothing,
    a_disk_that_is_full_at_the_last_write_loses_no_row,
    a_disk_that_is_read_only_is_told,
];

const OLD: &str = "an older picture";
const CANNOT_MOUNT: &str = "this user cannot mount";

/// A file system of its own below `folder`, of `options`; `None` where this machine does not let tests mount.
struct Mount(PathBuf);

impl Mount {
    fn new(folder: &Path, options: &str) -> Option<Self> {
        let place = folder.join("mounted");
        fs::create_dir(&place).unwrap();
        let mut command = Command::new("mount");
        let mounted = command.args(["-t", "tmpfs", "-o", options, "none"]).arg(&place).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(Self(place))
    }

    fn options(&self, options: &str) {
        assert!(Command::new("mount").args(["-o", options]).arg(&self.0).status().unwrap().success());
    }
}

impl Drop for Mount {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

fn a_full_disk_keeps_the_older_picture() -> Done {
    let folder = work();
    let Some(mount) = Mount::new(folder.path(), "size=16k") else {
        return Ok(Completion::ignored_with(CANNOT_MOUNT));
    };
    fs::write(mount.0.join("x.png"), OLD).unwrap();
    let output = run(folder.path(), "glumbra render scene.toml -o mounted/x.png --aov shade");
    assert_eq!(refusal(&output, 1, "cannot be written: No space left on device"), None);
    assert_eq!(names(&mount.0), ["x.png"]);
    assert_eq!(fs::read_to_string(mount.0.join("x.png")).unwrap(), OLD);
    Ok(Completion::Completed)
}

fn a_full_disk_is_an_error_and_leaves_nothing() -> Done {
    let folder = work();
    let Some(mount) = Mount::new(folder.path(), "size=64k") else {
        return Ok(Completion::ignored_with(CANNOT_MOUNT));
    };
    for name in ["x.png", "x.exr", "x.npy"] {
        let output =
            run(folder.path(), &format!("glumbra render scene.toml -o mounted/{name} --size 600x600 --aov depth"));
        assert_eq!(refusal(&output, 1, "cannot be written: No space left on device"), None);
        assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
        assert_eq!(names(&mount.0), [""; 0], "{name}");
    }
    Ok(Completion::Completed)
}

/// Room for the journal and not for the page: the sweep is kept, and --resume ends it without measuring again.
fn a_disk_that_is_full_at_the_last_write_loses_no_row() -> Done {
    let folder = work();
    fs::write(folder.path().join("grid.toml"), "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [64, 128]\n").unwrap();
    let Some(mount) = Mount::new(folder.path(), "size=32k") else {
        return Ok(Completion::ignored_with(CANNOT_MOUNT));
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
    Ok(Completion::Completed)
}

fn a_disk_that_is_read_only_is_told() -> Done {
    let folder = work();
    let Some(mount) = Mount::new(folder.path(), "size=64k") else {
        return Ok(Completion::ignored_with(CANNOT_MOUNT));
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
    Ok(Completion::Completed)
}
