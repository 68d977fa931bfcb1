//! `glumbra test`: exit codes, files and the page of a run with cases that pass, fail and crash; the choice of cases; and
//! the page of keys.

mod format;
#[cfg(unix)]
mod interrupted;
mod other_renderer;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    for name in ["CARGO_TARGET_DIR", "DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.current_dir(folder).arg("test").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn write(folder: &Path, name: &str, keys: &str) {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes/box.toml");
    fs::create_dir_all(folder.join(name)).unwrap();
    let text = format!("asks = \"Is it {name}, or <b>not</b>?\"\nscene = {scene:?}\n{keys}");
    fs::write(folder.join(name).join("case.toml"), text).unwrap();
}

const PASSES: &str = "[[pick]]\nat = [0, 1, 0]\nclass = \"lit\"\nwhy = \"the box's top\"\n";
const FAILS: &str = "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"lit\"\nwhy = \"behind the box\"\n";
const GOLDEN: &str = "[golden]\nmax = 2\nmean = 0.05\nwhy = \"now\"\n";

/// A folder of cases that pass, fail and, where there is a shell, crash.
fn cases() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "all/passes", PASSES);
    write(folder.path(), "all/deep/fails", FAILS);
    write(folder.path(), "all/crashes", &format!("render = [\"sh\", \"-c\", \"kill -9 $$\", \"{{out}}\"]\n{PASSES}"));
    folder
}

#[test]
#[cfg(unix)]
fn a_run_survives_what_crashes_and_says_what_fails() {
    let folder = cases();
    let files = ["--json", "out/a.json", "--junit", "out/a.xml", "--html", "out/page", "--failures", "out/failures"];
    let output = glumbra(folder.path(), &[&["all"], &files[..]].concat());
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{screen}{}", text(&output.stderr));
    for line in ["pass passes (", "FAIL deep/fails (", "CRASH crashes ("] {
        assert!(screen.lines().any(|found| found.starts_with(line)), "{line}: {screen}");
    }
    assert!(screen.contains("3 cases: 1 pass, 1 FAIL, 1 CRASH; "), "{screen}");
    assert_eq!(screen.lines().last(), Some("FAIL: crashes, deep/fails"));
    assert!(
        screen.contains("all/deep/fails/case.toml:3: [pick] pixel [") && screen.contains(": behind the box"),
        "{screen}"
    );
    assert!(!screen.contains('\u{1b}'), "no colours in a pipe");

    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.path().join("out/a.json")).unwrap()).unwrap();
    assert_eq!((&json["schema"], &json["schema_version"]), (&"glumbra-test".into(), &1.into()));
    let found: Vec<_> =
        json["cases"].as_array().unwrap().iter().map(|case| (&case["name"], &case["verdict"])).collect();
    assert_eq!(
        format!("{found:?}").replace("String", ""),
        r#"[(("crashes"), ("crash")), (("deep/fails"), ("fail")), (("passes"), ("pass"))]"#
    );
    let fails = &json["cases"][1];
    assert_eq!((&fails["check"], &fails["at"]), (&"pick".into(), &"all/deep/fails/case.toml:3".into()));
    let actual = fails["files"]["actual"].as_str().unwrap();
    assert_eq!(actual, "out/failures/deep/fails/actual.png");
    assert_eq!(image::image_dimensions(folder.path().join(actual)).unwrap(), (192, 192));

    let junit = fs::read_to_string(folder.path().join("out/a.xml")).unwrap();
    let report = quick_junit::Report::deserialize_from_str(&junit);
    assert_eq!(report.map(|report| (report.tests, report.failures, report.errors)).unwrap(), (3, 1, 1), "{junit}");
    let page = fs::read_to_string(folder.path().join("out/page/index.html")).unwrap();
    assert!(page.contains("<h1>2 cases fail</h1>") && page.contains("data-picture=\"actual\""), "{page}");
    assert!(page.contains("Is it all/deep/fails, or &lt;b&gt;not&lt;/b&gt;?"), "escaped");
    let place = |words: &str| page.find(words).unwrap();
    assert!(place("id=\"deep/fails\"") < place("<h2>Pass</h2>"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
}

/// The page compares two pictures where there are two, each in it once.
#[test]
fn a_golden_that_differs_has_three_pictures_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "golden", GOLDEN);
    let blessed = glumbra(folder.path(), &["golden", "--bless"]);
    let screen = text(&blessed.stdout);
    assert_eq!(blessed.status.code(), Some(1), "{screen}");
    assert!(screen.contains("BLESSED golden (") && screen.contains("Look at each picture, then run again"), "{screen}");
    let same = glumbra(folder.path(), &["golden", "--verbose"]);
    assert_eq!(same.status.code(), Some(0), "{}", text(&same.stdout));
    assert!(
        text(&same.stdout).contains("    golden: compared with the golden of this driver"),
        "{}",
        text(&same.stdout)
    );
    write(folder.path(), "golden", &format!("set = [\"light.shadow.technique=none\"]\n{GOLDEN}"));
    let differs = glumbra(folder.path(), &["golden", "--html", "page"]);
    assert_eq!(differs.status.code(), Some(1));
    let page = fs::read_to_string(folder.path().join("page/index.html")).unwrap();
    for name in ["actual", "expected", "difference"] {
        assert_eq!(page.matches(&format!("<figure data-picture=\"{name}\"><img")).count(), 1, "{name}");
        assert!(folder.path().join("case-failures/golden").join(name).with_extension("png").is_file());
    }
    assert_eq!(page.matches("data:image/png;base64,").count(), 3);
}

#[test]
#[cfg(unix)]
fn a_case_that_hangs_is_ended_and_the_next_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let render = "render = [\"sh\", \"-c\", \"sleep 60 & sleep 60\", \"{out}\"]\n";
    write(folder.path(), "all/hangs", &format!("{render}{PASSES}"));
    write(folder.path(), "all/passes", PASSES);
    let begin = std::time::Instant::now();
    let output = glumbra(folder.path(), &["all", "--timeout", "3", "--jobs", "1"]);
    let screen = text(&output.stdout);
    assert!(screen.contains("HANG hangs (3.0") && screen.contains("1 pass, 1 HANG"), "{screen}");
    assert!(begin.elapsed().as_secs() < 50, "what the command started does not go on");
}

/// A driver that crashes ends the child, and the case has the verdict.
#[test]
#[cfg(unix)]
fn a_child_that_dies_is_a_verdict() {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        "all/a-kills",
        &format!("render = [\"sh\", \"-c\", \"kill -ABRT $PPID; sleep 9\", \"{{out}}\"]\n{PASSES}"),
    );
    write(folder.path(), "all/b-passes", PASSES);
    let output = glumbra(folder.path(), &["all", "--jobs", "1"]);
    let screen = text(&output.stdout);
    assert!(screen.contains("CRASH a-kills (") && screen.contains("the case crashed (SIGABRT)"), "{screen}");
    assert!(screen.contains("pass b-passes ("), "{screen}");
}

fn listed(folder: &Path, arguments: &[&str]) -> Vec<String> {
    let output = glumbra(folder, &[&["all", "--list"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout).lines().map(str::to_owned).collect()
}

#[test]
fn cases_are_chosen_by_name_and_by_shard() {
    let folder = cases();
    let list = |arguments: &[&str]| listed(folder.path(), arguments);
    assert_eq!(list(&[]), ["crashes", "deep/fails", "passes"]);
    assert_eq!(list(&["--filter", "a", "--filter", "crash"]), ["crashes", "deep/fails", "passes"]);
    assert_eq!(list(&["--filter", "deep/"]), ["deep/fails"]);
    assert_eq!(list(&["--exact", "--filter", "passes"]), ["passes"]);
    let shards: Vec<String> = (1..=2).flat_map(|part| list(&["--shard", &format!("{part}/2")])).collect();
    assert_eq!(shards.len(), 3);
    assert_eq!(shards.into_iter().collect::<BTreeSet<_>>(), list(&[]).into_iter().collect());
    let own = glumbra(&folder.path().join("all/passes"), &[".", "--list"]);
    assert_eq!(text(&own.stdout), "passes\n", "the folder itself may be a case");
}

#[test]
fn wrong_use_is_refused() {
    let folder = cases();
    fs::create_dir(folder.path().join("empty")).unwrap();
    write(folder.path(), "bad/key", "picks = []\n");
    write(folder.path(), "bad/grammar", "pick = [\n");
    write(
        folder.path(),
        "bad/empty",
        "\n[[count]]\nclass = \"lit\"\nwhy = \"\"\n[[pick]]\nat = [0, 0, 0]\nclass = \"lit\"\nwhy = \"\"\n",
    );
    let refused = |arguments: &[&str], words: &[&str]| {
        let output = glumbra(folder.path(), arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(
            words.iter().all(|words| error.contains(words)) && !error.contains("panicked"),
            "{arguments:?}: {error}"
        );
        assert!(output.stdout.is_empty());
    };
    refused(&[], &["<DIR>..."]);
    refused(&["absent"], &["absent: cannot be searched for cases"]);
    refused(&["empty"], &["no case.toml at or below empty"]);
    refused(&["all", "--filter", "no such"], &["no case of 3 has \"no such\" in its name"]);
    refused(&["all", "--exact"], &["--filter"]);
    refused(&["all/passes", "--context", "window"], &["no OpenGL context can be had"]);
    refused(&["all", "--shard", "3/2"], &["1 <= I <= N"]);
    refused(&["all", "--jobs", "0"], &["0 is not in 1..=256"]);
    refused(&["all", "bad", "--json", "x", "--junit", "x"], &["bad/key/case.toml:3: unknown field `picks`"]);
    refused(&["all", "--json", "x", "--junit", "x"], &["--json and --junit name the same file"]);
    refused(&["all", "--json", "empty"], &["empty: cannot be written"]);
    // All of them are named.
    refused(
        &["bad"],
        &["bad/key/case.toml:3: ", "bad/grammar/case.toml:", "bad/empty/case.toml:4: a count needs `least`"],
    );
    assert!(!folder.path().join("x").exists());
}

#[test]
fn results_go_to_standard_output_and_the_screen_to_standard_error() {
    let folder = cases();
    let output = glumbra(folder.path(), &["all", "--filter", "passes", "--json", "-"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["cases"][0]["name"], "passes");
    assert!(text(&output.stderr).contains("No case fails."));
    assert_eq!(output.status.code(), Some(0));
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.current_dir(folder.path()).args(["test", "all/passes"]).env("CLICOLOR_FORCE", "1").env_remove("NO_COLOR");
    assert!(text(&command.output().unwrap().stdout).contains("\u{1b}[32mNo case fails."));
}

/// Standard output that is closed loses the screen, and neither the run nor its files.
#[test]
#[cfg(unix)]
fn a_reader_that_has_seen_enough_costs_no_result() {
    let folder = cases();
    let script = "{ \"$0\" test all --junit out.xml --jobs 1; echo $? >code; } | true; cat code";
    let output = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_glumbra")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(text(&output.stdout).trim(), "1", "{}", text(&output.stderr));
    assert!(fs::read_to_string(folder.path().join("out.xml")).unwrap().contains("tests=\"3\""));
}
