//! Standard output and standard error that are closed, full, or read by somebody who has seen enough.

use super::*;

/// Each prints on standard output and succeeds.
const COMMANDS: &[&str] = &[
    "--help",
    "render --help",
    "--version",
    "info",
    "info --json -",
    "plan scene.toml",
    "plan scene.toml --json -",
    "plan scene.toml --print-scene",
    "render scene.toml -o x.png --json -",
    "check --filter D1 --verbose",
    "figures --list",
    "stress --list --case near",
    "test --list cases",
    "test cases",
    "tune scene.toml --sizes 64 --spare 100000",
    "tune scene.toml --sizes 64 --spare 100000 --json -",
    "report scene.toml --grid grid.toml --runs 1 -o out",
];

fn try_all(redirection: &str, expected: impl Fn(&str, &Output) -> Result<(), String>) {
    let mut wrong = Vec::new();
    for command in COMMANDS {
        let folder = work();
        std::fs::write(folder.path().join("grid.toml"), "[[sweep]]\ntechnique = \"none\"\n").unwrap();
        std::fs::create_dir_all(folder.path().join("cases/drawn")).unwrap();
        let case = "asks = \"\"\nscene = \"../../scene.toml\"\n[[count]]\nclass = \"lit\"\nleast = 0.001\nwhy = \"\"\n";
        std::fs::write(folder.path().join("cases/drawn/case.toml"), case).unwrap();
        // A warning on standard error: the model has no material library.
        let output = run(folder.path(), &format!("glumbra {command} {redirection}"));
        let error = text(&output.stderr);
        if code(&output) == 101 || code(&output) > 128 || error.contains("panicked") {
            wrong.push(format!("{command} {redirection}: exit {}: {error}", code(&output)));
        }
        wrong.extend(expected(command, &output).err().map(|how| format!("{command} {redirection}: {how}: {error}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn succeeds(_: &str, output: &Output) -> Result<(), String> {
    if output.status.success() { Ok(()) } else { Err(format!("exit {}", code(output))) }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    // The file keeps the status, which a pipe would lose.
    try_all("| head -c 1 >/dev/null", |_, _| Ok(()));
    try_all("2>error >/dev/null; code=$?; cat error >&2; exit $code", succeeds);
    let folder = work();
    for command in ["info --json -", "plan scene.toml --json -", "render scene.toml -o x.png --json -"] {
        let output = run(folder.path(), &format!("{{ glumbra {command} --quiet; echo $? >code; }} | true; cat code"));
        assert_eq!((text(&output.stdout).trim(), text(&output.stderr).as_str()), ("0", ""), "{command}");
    }
}

#[test]
fn a_full_standard_output_is_told() {
    try_all(">/dev/full", |command, output| {
        let is_two = ["check", "stress", "test"].iter().any(|name| command.starts_with(name));
        let code = if is_two { 2 } else { 1 };
        match refusal(output, code, "error: standard output: No space left on device") {
            None => Ok(()),
            Some(how) => Err(how),
        }
    });
}

#[test]
fn closed_streams_are_no_panic() {
    try_all(">&-", succeeds);
    try_all("2>&-", succeeds);
    try_all("2>/dev/full", succeeds);
    try_all(">&- 2>&- <&-", succeeds);
}

/// Warnings and errors are lost then, and the exit status is not.
#[test]
fn messages_for_a_closed_standard_error_are_no_panic() {
    let folder = work();
    std::fs::write(folder.path().join("m.obj"), "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    for stream in ["2>&-", "2>/dev/full"] {
        for (command, expected) in [
            ("render m.obj -o x.png", 0),
            ("render absent.toml", 1),
            ("render --nonsense", 2),
            ("check --filter nonsense", 2),
        ] {
            let output = run(folder.path(), &format!("glumbra {command} {stream}"));
            assert_eq!(code(&output), expected, "{command} {stream}");
        }
    }
}
