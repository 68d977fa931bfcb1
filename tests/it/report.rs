//! `glumbra report` and `glumbra tune` as a user runs them: files, shards, GNU parallel, merging, Ctrl-C, going on.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::difference::{NOT_COMPARED, OUTSIDE_CONE, difference_picture};
use glumbra::judge::metrics::{Band, compare};
use glumbra::report::measure::grid::{self, Grid};
use glumbra::report::measure::run::{self, MeasureOptions};
use glumbra::report::store::fingerprint;
use glumbra::report::store::merge::{self, equal_but_for_times};
use glumbra::report::store::results::{Report, Row, SceneReport};
use glumbra::scene;
use glumbra::truth::Answer;

use crate::support::lit_box::SCENE;

const GLUMBRA: &str = env!("CARGO_BIN_EXE_glumbra");

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

/// Without a grid of one's own: every technique has a row that was drawn, and published claims of it have their numbers.
#[test]
fn a_report_measures_published_claims() {
    let work = Work::new();
    let mut command = Command::new(GLUMBRA);
    command.current_dir(work.folder.path());
    let told = succeed(command.args(["report", "scene.toml", "--quick", "--runs", "1", "-o", "out"]));
    assert!(told.contains("Published claims, on scene.toml:") && told.contains("second-depth: moves the error"));
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
    assert!(page.contains("Published claims, on this scene"));
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

/// Interrupts a long sweep into `out` after its first rows.
fn interrupt(work: &Work) {
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
}

#[test]
fn an_interrupted_report_is_valid_and_goes_on() {
    let work = Work::new();
    interrupt(&work);
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
    std::fs::write(
        work.path("value.toml"),
        "[[sweep]]\ntechnique = \"shadow-map\"\nfilter = [\"linear\", \"linaer\"]\n",
    )
    .unwrap();
    let many: String = (0..8).map(|key| format!("k{key} = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n")).collect();
    std::fs::write(work.path("many.toml"), format!("[[sweep]]\ntechnique = \"shadow-map\"\n{many}")).unwrap();
    for (arguments, code, message) in [
        (&["--grid", "empty.toml"][..], 1, "has no [[sweep]]"),
        (&["--grid", "typo.toml"], 1, "did you mean `shadow-map`?"),
        (&["--grid", "key.toml"], 1, "key.toml:3: unknown key `sise` in [sweep]: did you mean `size`?"),
        (
            &["--grid", "value.toml"],
            1,
            "value.toml:3: `light.shadow.filter` cannot be \"linaer\": did you mean `linear`?",
        ),
        (&["--grid", "many.toml"], 1, "many.toml:3: unknown key `k0`"),
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
}

/// Second depth needs closed casters, which is seen only when the row is planned with its objects.
#[test]
fn rows_that_fail_while_they_are_drawn_are_counted() {
    let work = Work::with_files();
    std::fs::write(work.path("grid.toml"), "[[sweep]]\ntechnique = \"second-depth\"\n").unwrap();
    let output = work.report(&["-o", "out"]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(error.contains("error: 1 of 2 settings could not be measured, row 1 for example: "), "{error}");
    assert!(work.load("out").complete && work.path("out/report.html").exists());
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
        command.current_dir(work.folder.path()).args(["tune", "sized.toml", "--sizes", "128,256", "--json", "-"]);
        let tuned: serde_json::Value = serde_json::from_str(&succeed(&mut command)).unwrap();
        let chosen = tuned["chosen"].clone();
        assert!(chosen["false_shadow_percent"].as_f64().unwrap() < 0.05, "{chosen}");
        assert!(chosen["leak_percent"].as_f64().unwrap() < 0.5, "{chosen}");
        assert!(tuned["curve"].as_array().unwrap().iter().any(|point| point["clean"] == false));
        [chosen["size"].clone(), chosen["factor"].clone(), chosen["units"].clone()]
    });
    assert!(tuned[0] == tuned[1] && tuned[1] == tuned[2], "{tuned:?}");
}

/// A scene whose `[light.shadow]` has keys that a grid does not vary.
fn with_keys() -> String {
    let keys = "technique = \"shadow-map\"\nformat = \"depth16\"\nfilter = \"nearest\"\ndimming = 0.25\n\
                offset = { factor = 3.0, units = 40.0 }";
    SCENE.replace("technique = \"shadow-map\"", keys)
}

fn options() -> MeasureOptions {
    let context = ContextRequest::default();
    MeasureOptions { light: 0, runs: 1, jobs: 1, shard: (1, 1), band_texels: 2.0, context }
}

/// The table `[light.shadow]` of a scene's text.
fn shadow_table(text: &str) -> &str {
    let rest = &text[text.find("[light.shadow]").unwrap()..];
    &rest[..rest.find("[[object]]").unwrap()]
}

/// Pasted in place of the scene's table, and by `--set` over it: both draw the row, to the bit.
#[test]
fn a_row_is_what_render_draws_from_its_toml() {
    let work = Work::new();
    let text = with_keys();
    std::fs::write(work.path("scene.toml"), &text).unwrap();
    let more =
        format!("{GRID}[[sweep]]\ntechnique = \"shadow-volume\"\n[[sweep]]\ntechnique = \"midpoint\"\nsize = 128\n");
    std::fs::write(work.path("grid.toml"), more).unwrap();
    let settings = grid::load(&work.path("grid.toml")).unwrap();
    let sweep = run::prepare(&work.path("scene.toml"), &[], &Grid::Own(settings.clone()), &options()).unwrap();
    let rows: Vec<Row> = (0..=settings.len()).map(|index| sweep.row_of(index).clone()).collect();
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for row in rows {
        let mut draw = |text: &str, overrides: &[String]| {
            std::fs::write(work.path("pasted.toml"), text).unwrap();
            let scene = glumbra::load(&work.path("pasted.toml"), overrides).unwrap().scene;
            draw_shade(&scene, 0, &mut renderer).unwrap()
        };
        let pasted = draw(&text.replace(shadow_table(&text), &row.to_toml()), &[]);
        let set = |(key, entry): &(String, scene::Entry)| format!("light.shadow.{key}={}", entry.value.to_toml());
        let overrides = match row.index {
            0 => Vec::new(),
            index => settings[index - 1].entries.iter().map(set).collect(),
        };
        let overridden = draw(&text, &overrides);
        let swept = draw_shade(&sweep.scene_of(row.index).unwrap(), 0, &mut renderer).unwrap();
        assert!(swept == pasted, "{}", row.to_toml());
        assert!(swept == overridden, "{overrides:?}");
    }
    // Of the scene's keys a row has those that its technique reads.
    let volume = sweep.row_of(settings.len() - 1);
    assert_eq!((volume.technique.as_str(), volume.settings_text().as_str()), ("shadow-volume", "dimming = 0.25"));
}

/// Outside a spotlight's cone a shade is transparent: that is no difference.
#[test]
fn nothing_outside_the_cone_counts_as_missing() {
    let work = Work::new();
    let sweep =
        run::prepare(&work.path("scene.toml"), &[String::from("light.cone=25")], &Grid::Own(Vec::new()), &options())
            .unwrap();
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let shade = draw_shade(&sweep.scene, 0, &mut renderer).unwrap();
    let outside = sweep.truth.count(|answer| answer == Answer::OutsideCone);
    assert!(outside > 500, "{outside}");
    let metrics = compare(&sweep.truth, &shade, &Band { texels: 2.0, map_size: [256; 2] }).unwrap();
    assert_eq!((metrics.left_out.outside_cone, metrics.left_out.not_drawn), (outside, 0));
    let picture = difference_picture(&sweep.truth, &shade).unwrap();
    let count = |color: [u8; 3]| picture.pixels().filter(|pixel| pixel.0 == color).count();
    assert_eq!((count(OUTSIDE_CONE), count(NOT_COMPARED)), (outside, 0));
}

/// The answer is on standard output as TOML, one of two.
#[test]
fn the_answer_is_on_the_terminal() {
    let work = Work::new();
    std::fs::write(work.path("scene.toml"), with_keys()).unwrap();
    let told = succeed(&mut work.report(&["-o", "out", "--error", "5", "--time", "10000"]));
    assert!(
        told.contains("# Cheapest with at most 5 % wrong: row ") && told.contains("# Most exact within 10000 ms: row ")
    );
    assert_eq!(told.matches("\n[light.shadow]\n").count(), 2, "{told}");
    assert!(told.trim_end().ends_with("report.html"), "{told}");
    for part in told.split("[light.shadow]").skip(1) {
        part.parse::<toml::Table>().unwrap();
    }
    let merged =
        succeed(Command::new(GLUMBRA).current_dir(work.folder.path()).args(["report", "merge", "out", "-o", "m"]));
    assert_eq!(merged.matches("\n[light.shadow]\n").count(), 2, "{merged}");
}

const MODEL: &str =
    "mtllib m.mtl\nv -1 0.2 -1\nv 1 0.2 -1\nv 0 0.9 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n";

impl Work {
    /// With a mesh that has a material that has a picture.
    fn with_files() -> Self {
        let work = Self::new();
        let object = SCENE.replace("mesh = \"box\"\nscale = 0.5", "mesh = \"m.obj\"\nscale = 0.9");
        std::fs::write(work.path("scene.toml"), object).unwrap();
        std::fs::write(work.path("m.obj"), MODEL).unwrap();
        std::fs::write(work.path("m.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd m.png\n").unwrap();
        image::RgbImage::from_pixel(2, 2, image::Rgb([9, 9, 9])).save(work.path("m.png")).unwrap();
        work
    }

    /// Changes the `which`-th file that a row depends on; whether there is one.
    fn change(&self, which: usize) -> bool {
        let replace = |name: &str, from: &str, to: &str| {
            let text = std::fs::read_to_string(self.path(name)).unwrap();
            assert!(text.contains(from));
            std::fs::write(self.path(name), text.replace(from, to)).unwrap();
        };
        match which {
            0 => replace("m.obj", "0.9 1", "1.1 1"),
            1 => replace("m.mtl", "Kd 1 0 0", "Kd 1 0 0\nd 0.1"),
            2 => image::RgbImage::from_pixel(2, 2, image::Rgb([9, 9, 8])).save(self.path("m.png")).unwrap(),
            3 => replace("scene.toml", "size = 256", "size = 255"),
            4 => replace("grid.toml", "64, ", "65, "),
            _ => return false,
        }
        true
    }

    fn fingerprint(&self) -> String {
        let settings = grid::load(&self.path("grid.toml")).unwrap();
        let sweep = run::prepare(&self.path("scene.toml"), &[], &Grid::Own(settings), &options()).unwrap();
        sweep.report.fingerprint
    }
}

#[test]
fn a_fingerprint_is_of_every_file_that_a_row_depends_on() {
    let (work, elsewhere) = (Work::with_files(), Work::with_files());
    let mut seen = vec![work.fingerprint()];
    assert_eq!(elsewhere.fingerprint(), seen[0], "another folder is no other scene");
    let mut which = 0;
    while work.change(which) {
        let fingerprint = work.fingerprint();
        assert!(!seen.contains(&fingerprint), "file {which} is not in it");
        seen.push(fingerprint);
        which += 1;
    }
    assert!(which > 4);
}

#[test]
fn a_stamp_is_of_the_driver_and_the_machine() {
    let machine = run::machine(&options()).unwrap();
    let stamp = |renderer: &str, jobs, runs| {
        let machine =
            glumbra::report::store::results::Machine { renderer: renderer.to_owned(), jobs, ..machine.clone() };
        fingerprint::stamp(&machine, &MeasureOptions { runs, ..options() })
    };
    assert_eq!(stamp("a", 1, 1), stamp("a", 1, 1));
    for other in [stamp("b", 1, 1), stamp("a", 2, 1), stamp("a", 1, 2)] {
        assert_ne!(stamp("a", 1, 1), other);
    }
}

/// A mesh that changed between two runs: its rows are measured again, and it is said.
#[test]
fn a_report_that_goes_on_does_not_mix_old_and_new() {
    let work = Work::with_files();
    interrupt(&work);
    assert!(work.change(0));
    let output = work.report(&["-o", "out", "--resume"]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && error.contains("rows are not taken up"), "{error}");
    succeed(&mut work.report(&["-o", "anew"]));
    let (resumed, anew) = (work.load("out"), work.load("anew"));
    let (resumed, anew) = (only_scene(&resumed), only_scene(&anew));
    assert_eq!(resumed.rows.len(), anew.rows.len());
    assert!(resumed.rows.iter().zip(&anew.rows).all(|(a, b)| equal_but_for_times(a, b)));
}

/// A byte that is no text costs one row; a row of an index that the grid has not is not believed.
#[test]
fn a_damaged_journal_costs_what_is_damaged() {
    let work = Work::new();
    interrupt(&work);
    let path = work.path("out/report.journal.jsonl");
    let mut bytes = std::fs::read(&path).unwrap();
    let line: Vec<u8> = bytes.split(|byte| *byte == b'\n').next().unwrap().to_vec();
    let strange = String::from_utf8(line).unwrap().replacen("\"index\":0", "\"index\":9999", 1);
    bytes[40] = 0xff;
    bytes.extend_from_slice(strange.as_bytes());
    std::fs::write(&path, bytes).unwrap();
    let output = work.report(&["-o", "out", "--resume"]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{error}");
    assert!(error.contains("report.journal.jsonl:1: this row is damaged"), "{error}");
    assert!(error.contains("1 rows are not taken up: the grid has no such rows"), "{error}");
    let report = work.load("out");
    assert!(report.complete && only_scene(&report).rows.len() == only_scene(&report).grid_rows);
}

#[cfg(unix)]
#[test]
fn a_path_that_is_no_utf_8_loses_no_report() {
    use std::os::unix::ffi::OsStrExt;
    let work = Work::new();
    let name = std::ffi::OsStr::from_bytes(b"caf\xe9.toml");
    std::fs::write(work.folder.path().join(name), SCENE).unwrap();
    let mut command = Command::new(GLUMBRA);
    command.current_dir(work.folder.path()).arg("report").arg(name).args([
        "--grid",
        "grid.toml",
        "--runs",
        "1",
        "-o",
        "out",
    ]);
    succeed(&mut command);
    let report = work.load("out");
    let scene = only_scene(&report);
    assert_eq!(scene.path, Path::new("caf\u{fffd}.toml"));
    assert_eq!(scene.path_bytes.as_deref(), Some("636166e92e746f6d6c"));
    assert!(report.complete && work.path("out/report.html").exists());
}

/// From nothing nothing follows: the light looks away from all that is seen.
#[test]
fn tune_refuses_to_conclude_from_nothing() {
    let work = Work::new();
    for (set, compared) in
        [("light.target=[2, 9, 3]", "of light 0 0 pixels"), ("image.size=[16, 16]", "it; each needs 1000 at least")]
    {
        let mut command = Command::new(GLUMBRA);
        command.current_dir(work.folder.path()).args(["tune", "scene.toml", "--set", set, "--sizes", "128"]);
        let output = command.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.contains("nothing can be tuned") && error.contains(compared), "{error}");
        assert!(output.stdout.is_empty());
    }
}

/// The table that tune prints has the scene's other keys, too, and replaces the scene's own.
#[test]
fn what_tune_chose_is_what_its_toml_draws() {
    let work = Work::new();
    let text = with_keys();
    std::fs::write(work.path("scene.toml"), &text).unwrap();
    let mut command = Command::new(GLUMBRA);
    command.current_dir(work.folder.path()).args(["tune", "scene.toml", "--sizes", "128", "--json", "-"]);
    let tuned: serde_json::Value = serde_json::from_str(&succeed(&mut command)).unwrap();
    let toml = tuned["chosen_toml"].as_str().unwrap();
    for key in ["filter = \"nearest\"", "format = \"depth16\"", "dimming = 0.25", "size = 128"] {
        assert!(toml.contains(key), "{toml}");
    }
    std::fs::write(work.path("pasted.toml"), text.replace(shadow_table(&text), toml)).unwrap();
    let sweep = run::prepare(&work.path("pasted.toml"), &[], &Grid::Own(Vec::new()), &options()).unwrap();
    let context = context::open(&ContextRequest::default()).unwrap();
    let shade = draw_shade(&sweep.scene, 0, &mut Renderer::new(&context)).unwrap();
    let metrics = compare(&sweep.truth, &shade, &Band { texels: 2.0, map_size: [128; 2] }).unwrap();
    assert_eq!(tuned["chosen"]["wrong_percent"].as_f64(), Some(metrics.all.wrong_percent));
    assert_eq!(tuned["compared"].as_u64(), Some(metrics.all.compared as u64));
    let mut command = Command::new(GLUMBRA);
    let told = succeed(command.current_dir(work.folder.path()).args(["tune", "scene.toml", "--sizes", "128"]));
    assert!(told.starts_with(&format!("# {} pixels were compared, ", metrics.all.compared)), "{told}");
}
