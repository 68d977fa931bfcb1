//! `ci/demo` and `ci/setup` on machines that are not like the author's: another target folder, a read-only checkout, no
//! root, no HOME. Commands that would act on the machine are stand-ins that note their arguments.
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A folder with a copy of `ci`, and one of stand-ins, `bin`.
struct Machine {
    folder: tempfile::TempDir,
}

impl Machine {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        for name in ["ci", "bin"] {
            fs::create_dir(folder.path().join(name)).unwrap();
        }
        for name in ["demo", "setup", "cargo-path"] {
            fs::copy(Path::new(ROOT).join("ci").join(name), folder.path().join("ci").join(name)).unwrap();
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn stand_in(&self, path: &str, script: &str) {
        let path = self.path(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// The machine's own tools by name, and nothing else but the stand-ins.
    fn tools(&self, names: &[&str]) {
        for name in names {
            let found = Command::new("sh").args(["-c", &format!("command -v {name}")]).output().unwrap();
            let found = String::from_utf8(found.stdout).unwrap();
            std::os::unix::fs::symlink(found.trim(), self.path("bin").join(name)).unwrap();
        }
    }

    fn setup(&self) -> Command {
        let mut command = Command::new(self.path("ci/setup"));
        command.env("PATH", self.path("bin")).env("CARGO_HOME", self.path("cargo"));
        command
    }
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// cargo is asked to run what it built, wherever that is.
#[test]
fn demo_runs_what_cargo_built() {
    let machine = Machine::new();
    machine.stand_in("ci/setup", "exit 0");
    machine.stand_in("cargo/bin/cargo", "echo \"$@\" >>log");
    let output = Command::new(machine.path("ci/demo"))
        .arg("x.png")
        .current_dir(machine.folder.path())
        .env("CARGO_HOME", machine.path("cargo"))
        .env("CARGO_TARGET_DIR", machine.path("elsewhere"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output));
    let log = fs::read_to_string(machine.path("log")).unwrap();
    let picture = fs::canonicalize(machine.folder.path()).unwrap().join("x.png");
    assert!(log.starts_with("run --release --locked --bin glumbra -- render data/scenes/main.toml -o "), "{log}");
    assert!(log.trim().ends_with("x.png") && text(&output).contains("x.png"), "{log} {}", picture.display());
}

/// A file named `out` is as much in the way as a file system that is read-only, and is so for root too.
#[test]
fn demo_draws_into_the_target_folder_of_a_read_only_checkout() {
    let machine = Machine::new();
    fs::write(machine.path("out"), "").unwrap();
    machine.stand_in("ci/setup", "exit 0");
    machine.stand_in(
        "cargo/bin/cargo",
        "echo \"$@\" >>log; [ \"$1\" != metadata ] || echo '{\"packages\":[],\"target_directory\":\"/some/where\",\"v\":1}'",
    );
    let mut command = Command::new(machine.path("ci/demo"));
    let output = command.env("CARGO_HOME", machine.path("cargo")).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    assert!(text(&output).contains("rendered /some/where/main.png"), "{}", text(&output));
}

const TOOLS: [&str; 6] = ["bash", "sh", "env", "dirname", "mkdir", "cat"];

#[test]
fn setup_without_root_names_the_packages() {
    let machine = Machine::new();
    machine.tools(&TOOLS);
    machine.stand_in("bin/id", "echo 1000");
    machine.stand_in("bin/apt-get", "echo called >>\"$0.log\"");
    let output = machine.setup().output().unwrap();
    let said = text(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("this needs root") && said.contains("apt-get install gcc g++ libc6-dev"), "{said}");
    assert!(!machine.path("bin/apt-get.log").exists(), "{said}");
}

/// A distribution without OSMesa: apt-get is not asked to install what it does not have.
#[test]
fn setup_does_without_osmesa_where_there_is_none() {
    let machine = Machine::new();
    machine.tools(&TOOLS);
    machine.stand_in("bin/id", "echo 0");
    machine.stand_in("bin/apt-cache", "exit 100");
    machine.stand_in("bin/apt-get", "echo \"$@\" >>\"$0.log\"");
    machine.stand_in("cargo/bin/cargo", "exit 0");
    // ldconfig tells what libraries there are; setup looks into /usr/lib besides.
    let script = fs::read_to_string(machine.path("ci/setup")).unwrap();
    fs::write(machine.path("ci/setup"), script.replace("/usr/lib", "/nonexistent")).unwrap();
    machine.stand_in("bin/ldconfig", "echo libEGL.so.1 libEGL_mesa.so.0 libgallium-24");
    let output = machine.setup().env("XDG_CACHE_HOME", machine.path("cache")).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    let log = fs::read_to_string(machine.path("bin/apt-get.log")).unwrap();
    assert!(log.contains("g++") && !log.contains("libosmesa6"), "{log}");
    assert!(text(&output).contains("there is no libosmesa6 here"), "{}", text(&output));
}

#[test]
fn cargo_is_found_without_home() {
    let run = |script: &str| {
        let mut command = Command::new("bash");
        command.args(["-c", script]).env_remove("HOME").env_remove("CARGO_HOME").current_dir(ROOT);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", text(&output));
        text(&output).trim().to_owned()
    };
    let home = run("echo ~");
    let path = run("set -euo pipefail; . ci/cargo-path; echo \"$PATH\"");
    assert!(path.starts_with(&format!("{home}/.cargo/bin:")), "{path}");
}

/// Nothing in `ci` takes the target folder for granted.
#[test]
fn no_script_names_the_target_folder() {
    for entry in fs::read_dir(Path::new(ROOT).join("ci")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            let script = fs::read_to_string(&path).unwrap();
            assert!(!script.contains("target/release") && !script.contains("target/debug"), "{}", path.display());
        }
    }
}
