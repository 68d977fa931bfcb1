//! A crate outside of this repository that tests pixels with glumbra's core alone, and the limits of that core. Both build or
//! ask cargo, and the first takes minutes where nothing is built: `ci/test` runs it once.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Its test, which uses nothing else.
const PIXELS: &str = include_str!("pixels.rs");

/// Its test of what the core lacks.
const MISSING: &str = include_str!("missing.rs");

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn cargo(folder: &Path) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(folder).env("CARGO_NET_OFFLINE", "true").env_remove("CARGO_BUILD_TARGET");
    cargo
}

/// Makes the crate: glumbra by its path, the versions of our own lock file.
fn write_crate(folder: &Path) {
    let manifest = format!(
        "[package]\nname = \"outside\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dev-dependencies]\n\
         glumbra = {{ path = {:?}, default-features = false }}\n\n\
         [profile.dev]\nopt-level = 1\ndebug = false\nincremental = false\n\n[workspace]\n",
        root()
    );
    fs::create_dir_all(folder.join("src")).unwrap();
    fs::create_dir_all(folder.join("tests")).unwrap();
    fs::write(folder.join("Cargo.toml"), manifest).unwrap();
    fs::write(folder.join("src/lib.rs"), "").unwrap();
    fs::write(folder.join("tests/pixels.rs"), PIXELS).unwrap();
    fs::write(folder.join("tests/missing.rs"), MISSING).unwrap();
    fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
}

/// Where it is built: kept, so that a second run costs little.
fn target() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |path| root().join(path));
    target.join("outside")
}

fn test_in(folder: &Path, name: &str, bless: bool) -> Output {
    let mut cargo = cargo(folder);
    // Pictures of this run alone, beside the crate.
    cargo.args(["test", "--test", name, "--target-dir"]).arg(target()).env("TMPDIR", folder);
    if bless {
        cargo.env("BLESS", "1");
    }
    cargo.output().unwrap()
}

fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}

#[test]
#[ignore = "builds the library once more, without its features: ci/test runs it"]
fn a_crate_outside_tests_pixels_in_forty_lines() {
    assert!(PIXELS.lines().count() <= 45 && code_lines(PIXELS) < 40, "{} lines", code_lines(PIXELS));
    let folder = tempfile::tempdir().unwrap();
    write_crate(folder.path());
    let blessed = test_in(folder.path(), "pixels", true);
    assert!(blessed.status.success(), "{}", text(&blessed));
    assert!(!text(&blessed).contains("warning"), "{}", text(&blessed));
    let passed = test_in(folder.path(), "pixels", false);
    assert!(text(&passed).contains("1 passed"), "{}", text(&passed));
    let missing = test_in(folder.path(), "missing", false);
    assert!(text(&missing).contains("3 passed"), "{}", text(&missing));
    // Each of its checks can fail.
    for (from, to, expected) in [
        ("[0.5; 3]).color", "[0.4; 3]).color", "Some(0.0), Some(1.0)"),
        ("room(512)?", "room(1024)?", "0 pixels differ"),
        ("(s[0] >= 0.5) !=", "(s[0] < 0.5) !=", "pixels are wrong"),
        ("[0.8, 0.5, 0.3]", "[0.8, 0.5, 0.4]", "the picture has changed"),
    ] {
        assert_eq!(PIXELS.matches(from).count(), 1, "{from}");
        fs::write(folder.path().join("tests/pixels.rs"), PIXELS.replace(from, to)).unwrap();
        let failed = test_in(folder.path(), "pixels", false);
        assert!(!failed.status.success() && text(&failed).contains(expected), "{from}:\n{}", text(&failed));
    }
}

/// Lines that are neither empty nor a comment.
fn code_lines(text: &str) -> usize {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Most crates that the core builds, itself among them: as `cargo tree` lists them, where one that comes twice has two lines.
const MOST_CRATES: usize = 100;

/// Crates of which one compiles C++ or asks for its compiler.
const NO_CPP: [&str; 4] = ["cc", "cmake", "meshopt", "nv-flip-sys"];

#[test]
fn the_core_has_few_crates_and_neither_it_nor_the_command_in_rust_needs_cpp() {
    let crates = |features: &[&str]| {
        let tree = ["tree", "--locked", "--edges", "normal,build", "--prefix", "none"];
        let output = cargo(root()).args(tree).args(features).output().unwrap();
        assert!(output.status.success(), "{}", text(&output));
        let mut lines: Vec<String> = text(&output).lines().map(str::to_owned).collect();
        lines.sort();
        lines.dedup();
        lines
    };
    let compiles_cpp = |lines: &[String]| {
        let name = |line: &String| line.split(' ').next().unwrap_or_default().to_owned();
        lines.iter().map(name).any(|name| NO_CPP.contains(&name.as_str()))
    };
    let core = crates(&["--no-default-features"]);
    assert!(core.len() <= MOST_CRATES, "{} crates:\n{}", core.len(), core.join("\n"));
    assert!(!compiles_cpp(&core) && compiles_cpp(&crates(&[])), "{}", core.join("\n"));
    let command = crates(&["--no-default-features", "--features", "pure-rust"]);
    // A window's library asks for C, which cargo needs to link, too.
    let command: Vec<String> = command.into_iter().filter(|line| !line.starts_with("cc v")).collect();
    assert!(!compiles_cpp(&command) && command.len() > MOST_CRATES, "{}", command.join("\n"));
}
