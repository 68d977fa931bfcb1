//! The command in a shell, in a folder with a small scene: under limits, on full disks, with drivers chosen by Mesa's
//! variables.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output};

use super::lit_box::SCENE;

pub const GLUMBRA: &str = env!("CARGO_BIN_EXE_glumbra");

/// A folder with `scene.toml` in it.
pub fn work() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

/// `script` by the shell in `folder`; in it `glumbra` is the command. No display, no variables of a driver.
pub fn shell(folder: &Path, script: &str) -> Command {
    let mut command = Command::new("sh");
    command.arg("-c").arg(format!("ulimit -c 0; glumbra() {{ \"{GLUMBRA}\" \"$@\"; }}\n{script}"));
    command.current_dir(folder);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "GALLIUM_DRIVER"] {
        command.env_remove(name);
    }
    command
}

pub fn run(folder: &Path, script: &str) -> Output {
    shell(folder, script).output().unwrap()
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The exit status as a shell counts it: 128 and the signal's number for a process that was ended by one.
pub fn code(output: &Output) -> i32 {
    output.status.code().or_else(|| output.status.signal().map(|signal| 128 + signal)).unwrap()
}

/// The names in a folder, hidden ones too, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// Checks a failure: one error that says `expected`, and the exit code. Returns what is wrong.
pub fn refusal(output: &Output, expected_code: i32, expected: &str) -> Option<String> {
    let error = text(&output.stderr);
    let errors = error.lines().filter(|line| line.starts_with("error: ")).count();
    if code(output) == expected_code && errors == 1 && error.contains(expected) && !error.contains("panicked") {
        return None;
    }
    Some(format!("exit {}, {errors} errors, not {expected_code} and \"{expected}\": {error}", code(output)))
}

/// Runs a table of scripts, each with a name, in a folder of its own, and what each must say.
pub fn refused(table: &[(&str, &str, i32, &str)]) {
    let mut wrong = Vec::new();
    for (name, script, code, expected) in table {
        let folder = work();
        let output = run(folder.path(), script);
        wrong.extend(refusal(&output, *code, expected).map(|how| format!("{name}: {how}")));
        let left: Vec<String> = names(folder.path()).into_iter().filter(|name| name.contains(".tmp")).collect();
        if !left.is_empty() {
            wrong.push(format!("{name}: leaves {left:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
