//! `glumbra report` and `glumbra tune` as a user runs them: files, shards, GNU parallel, merging, Ctrl-C, going on.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use glumbra::report::merge::{self, equal_but_for_times};
use glumbra::report::results::{Report, Row, SceneReport};

const GLUMBRA: &str = env!("CARGO_BIN_EXE_glumbra");

const SCENE: &str = r#"
[image]
size = [96, 96]
[camera]
eye = [3.0, 2.5, 4.0]
target = [0.0, 0.6, 0.0]
[[light]]
kind = "spot"
position = [2.0, 4.0, 3.0]
target = [0.0, 0.5, 0.0]
cone = 60.0
near = 0.5
far = 20.0
[light.shadow]
technique = "shadow-map"
size = 256
[[object]]
mesh = "quad"
scale = [4.0, 1.0, 4.0]
[[object]]
mesh = "box"
scale = 0.5
translate = [0.0, 0.7, 0.0]
"#;

const GRID: &str = r#"
[[sweep]]
technique = "none"
[[sweep]]
technique = "shadow-map"
size = [64, 128, 256]
filter = ["nearest", "linear"]
offset = [{ factor = 0.0, units = 0.0 }, { factor = 2.0, units = 4.0 }]
"#;

/// A folder with a scene and a grid.
struct Work {
    folder: tempfile::TempDir,
}

impl Work {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        std::fs::write(folder.path().join("grid.toml"), GRID).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn report(&self, more: &[&str]) -> Command {
        let mut command = Command::new(GLUMBRA);
        command.current_dir(self.folder.path());
        command.args(["report", "scene.toml", "--grid", "grid.toml", "--runs", "1"]).args(more);
        command
    }

    fn load(&self, name: &str) -> Report {
        merge::load(&self.path(name)).unwrap()
    }
}

fn succeed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn only_scene(report: &Report) -> &SceneReport {
    assert_eq!(report.scenes.len(), 1);
    &report.scenes[0]
}

#[test]
fn a_report_says_how_wrong_and_for_what_price() {
    let work = Work::new();
    succeed(&mut work.report(&["-o", "out", "--error", "2", "--time", "1000"]));
    let report = work.load("out");
    let scene = only_scene(&report);
    assert!(report.complete && scene.rows.len() == 1 + 1 + 12, "{} rows", scene.rows.len());
    let wrong = |index: usize| scene.rows[index].measured().unwrap().wrong_percent();
    // Row 1: no shadow at all; its leak is all of the true shadow. Row 2: no offset, acne. Row 13: 256, linear, offset.
    let unshadowed = scene.rows[1].measured().unwrap();
    assert!(unshadowed.metrics.all.leak_percent > 1.5 && unshadowed.metrics.all.false_shadow_percent == 0.0);
    assert!(wrong(2) > 20.0 && wrong(13) < 1.0, "{} {}", wrong(2), wrong(13));
    for row in &scene.rows {
        let measured = row.measured().unwrap();
        assert!(measured.frame_redrawn.median > 0.0 && measured.frame_redrawn.runs == 1);
        assert!(measured.passes.iter().all(|pass| pass.wall.median > 0.0 && pass.fragments.is_some()));
    }
    let saved = scene.saved.as_ref().unwrap();
    assert!(saved.same_pixels && !saved.left_out.is_empty() && saved.whole.image_bytes > saved.pruned.image_bytes);
    let html = std::fs::read_to_string(work.path("out/report.html")).unwrap();
    for part in ["data:image/png;base64,", "<svg", "[light.shadow]", "scene.toml"] {
        assert!(html.contains(part), "report.html has no {part}");
    }
    let csv = std::fs::read_to_string(work.path("out/report.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + scene.rows.len());
    assert!(!work.path("out/report.journal.jsonl").exists());
}

/// Without a grid of one's own: every technique has a row that was drawn, and its documents' claims their numbers.
#[test]
fn a_report_tells_what_the_documents_claim() {
    let work = Work::new();
    let mut command = Command::new(GLUMBRA);
    command.current_dir(work.folder.path());
    let told = succeed(command.args(["report", "scene.toml", "--quick", "--runs", "1", "-o", "out"]));
    assert!(
        told.contains("What the documents claim, on scene.toml:") && told.contains("second-depth: moves the error")
    );
    let report = work.load("out");
    let scene = only_scene(&report);
    for technique in ["none", "shadow-map", "midpoint", "second-depth", "shadow-volume"] {
        let drawn = |row: &&Row| row.technique == technique && row.measured().is_some();
        assert!(scene.rows.iter().any(|row| drawn(&row)), "{technique}");
    }
    // Each has both its numbers, or says why not: of the box nothing is seen that is turned away from the light.
    let sides = || scene.claims.iter().flat_map(|claim| [&claim.first, &claim.second]);
    assert!(sides().all(|side| side.value.is_some() != side.why.is_some()), "{told}");
    assert!(sides().filter(|side| side.value.is_some()).count() >= 18, "{told}");
    let page = std::fs::read_to_string(work.path("out/report.html")).unwrap();
    assert!(page.contains("What the documents claim, on this scene"));
}

#[test]
fn shards_run_by_gnu_parallel_merge_to_the_whole() {
    let work = Work::new();
    succeed(&mut work.report(&["-o", "whole"]));
    let parallel = Command::new("parallel")
        .current_dir(work.folder.path())
        .args(["--will-cite", "-j2"])
        .arg(format!("{GLUMBRA} report scene.toml --grid grid.toml --runs 1 -o part{{}} --shard {{}}/3"))
        .args([":::", "1", "2", "3"])
        .output();
    let parallel = parallel.expect("GNU parallel is missing: ci/setup --test installs it");
    assert!(parallel.status.success(), "{}", String::from_utf8_lossy(&parallel.stderr));
    assert!(!work.load("part2").complete);
    let mut merge = Command::new(GLUMBRA);
    merge.current_dir(work.folder.path()).args(["report", "merge", "part1", "part2", "part3", "-o", "merged"]);
    succeed(&mut merge);
    // The scene, the truth, and at least the row as written and the most wrong: of all the rows that the page names.
    let page = std::fs::read_to_string(work.path("merged/report.html")).unwrap();
    assert!(page.matches("data:image/png;base64,").count() >= 4 && !page.contains("no part has a picture"));
    let (whole, merged) = (work.load("whole"), work.load("merged"));
    assert!(merged.complete);
    let (whole, merged) = (only_scene(&whole), only_scene(&merged));
    assert_eq!(whole.rows.len(), merged.rows.len());
    for (a, b) in whole.rows.iter().zip(&merged.rows) {
        assert!(equal_but_for_times(a, b), "{a:#?}\n{b:#?}");
    }
    // Two thirds are not the whole, and a part is not merged with itself as if it were another.
    let mut some = Command::new(GLUMBRA);
    some.current_dir(work.folder.path()).args(["report", "merge", "part1", "part3", "-o", "some"]);
    succeed(&mut some);
    assert!(!work.load("some").complete);
}

/// Interrupts a long sweep after its first rows, and goes on.
#[test]
fn an_interrupted_report_is_valid_and_goes_on() {
    let work = Work::new();
    let long = GRID.replace("[64, 128, 256]", "[64, 96, 128, 160, 192, 224, 256, 288, 320, 352, 384, 416, 448, 480]");
    std::fs::write(work.path("grid.toml"), long).unwrap();
    let mut running = work.report(&["-o", "out"]).stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
    let journal = work.path("out/report.journal.jsonl");
    let lines = |path: &Path| std::fs::read_to_string(path).map_or(0, |text| text.lines().count());
    let start = Instant::now();
    while lines(&journal) < 3 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    succeed(Command::new("kill").args(["-INT", &running.id().to_string()]));
    assert_eq!(running.wait().unwrap().code(), Some(1));
    let cut = work.load("out");
    let rows = only_scene(&cut).rows.len();
    assert!(!cut.complete && rows >= 3 && rows < only_scene(&cut).grid_rows, "{rows} rows");
    succeed(&mut work.report(&["-o", "out", "--resume"]));
    let whole = work.load("out");
    assert!(whole.complete);
    // What was measured before was not measured again: its times are the same.
    for row in &only_scene(&cut).rows {
        assert_eq!(row, &only_scene(&whole).rows[row.index]);
    }
}

#[test]
fn bad_arguments_say_what_is_wrong() {
    let work = Work::new();
    std::fs::write(work.path("empty.toml"), "").unwrap();
    std::fs::write(work.path("typo.toml"), "[[sweep]]\ntechnique = \"shadow-mop\"\n").unwrap();
    std::fs::write(work.path("key.toml"), "[[sweep]]\ntechnique = \"shadow-map\"\nsise = [1, 2]\n").unwrap();
    for (arguments, code, message) in [
        (&["--grid", "empty.toml"][..], 1, "has no [[sweep]]"),
        (&["--grid", "typo.toml"], 1, "did you mean `shadow-map`?"),
        (&["--grid", "absent.toml"], 1, "absent.toml: cannot be read"),
        (&["--grid", "grid.toml", "--light", "3"], 1, "there is no light 3"),
        (&["--grid", "grid.toml", "--shard", "3/2"], 2, "1 <= I <= N"),
        (&["--grid", "grid.toml", "--jobs", "0"], 2, "--jobs"),
    ] {
        let mut command = Command::new(GLUMBRA);
        command.current_dir(work.folder.path()).args(["report", "scene.toml", "-o", "out"]).args(arguments);
        let output = command.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
        assert!(error.contains(message) && !error.contains("panicked"), "{arguments:?}: {error}");
        assert!(!work.path("out").exists(), "{arguments:?} left a folder");
    }
    // A key that the technique does not know fails its rows, not the report.
    let mut command = Command::new(GLUMBRA);
    command.current_dir(work.folder.path()).args(["report", "scene.toml", "-o", "out", "--grid", "key.toml"]);
    succeed(&mut command);
    let text = std::fs::read_to_string(work.path("out/report.json")).unwrap();
    assert!(text.contains("did you mean `size`?"));
}

/// From a thousandth to a thousand units of size, without being told: the same offset, to the same errors.
#[test]
fn tune_finds_an_offset_at_any_size() {
    let work = Work::new();
    let tuned = [1e-3, 1.0, 1e3].map(|scale| {
        let object = format!("mesh = \"box\"\nscale = {:?}\ntranslate = [0.0, {:?}, 0.0]", 0.5 * scale, 0.7 * scale);
        let floor = format!("mesh = \"quad\"\nscale = [{0:?}, 1.0, {0:?}]", 4.0 * scale);
        let place = |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", x * scale, y * scale, z * scale);
        let scene = format!(
            "[image]\nsize = [96, 96]\n[camera]\neye = {}\ntarget = {}\n[[light]]\nkind = \"spot\"\nposition = {}\n\
             target = {}\ncone = 60.0\nnear = {:?}\nfar = {:?}\n[light.shadow]\ntechnique = \"shadow-map\"\n[[object]]\n{floor}\n[[object]]\n{object}\n",
            place(3.0, 2.5, 4.0),
            place(0.0, 0.6, 0.0),
            place(2.0, 4.0, 3.0),
            place(0.0, 0.5, 0.0),
            0.5 * scale,
            20.0 * scale
        );
        std::fs::write(work.path("sized.toml"), scene).unwrap();
        let mut command = Command::new(GLUMBRA);
        command.current_dir(work.folder.path()).args(["tune", "sized.toml", "--sizes", "128,256", "--json"]);
        let tuned: serde_json::Value = serde_json::from_str(&succeed(&mut command)).unwrap();
        let chosen = tuned["chosen"].clone();
        assert!(chosen["false_shadow_percent"].as_f64().unwrap() < 0.05, "{chosen}");
        assert!(chosen["leak_percent"].as_f64().unwrap() < 0.5, "{chosen}");
        assert!(tuned["curve"].as_array().unwrap().iter().any(|point| point["clean"] == false));
        [chosen["size"].clone(), chosen["factor"].clone(), chosen["units"].clone()]
    });
    assert!(tuned[0] == tuned[1] && tuned[1] == tuned[2], "{tuned:?}");
}
