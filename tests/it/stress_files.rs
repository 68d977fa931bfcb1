//! `glumbra stress FILE`: a model of one's own is judged in lights of every kind, at several times, and what its loader warns
//! of excuses no wrong picture.

use std::path::Path;
use std::process::Output;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::scene::LightKind;
use glumbra::stress::files::{self, FileChanges};
use glumbra::stress::{self, Case, CaseSource, StressOptions, Verdict};
use serde_json::{Value, json};

use crate::gltf::glb::{Glb, wedge};

fn small() -> FileChanges {
    FileChanges { size: Some([48, 36]), ..FileChanges::default() }
}

fn options(technique: &str) -> StressOptions {
    let technique = Some(technique.to_owned());
    StressOptions { jobs: 1, technique, one_in: 1, pictures: false, context: ContextRequest::default() }
}

/// A wedge that its file moves to the right within three seconds.
fn moving() -> Glb {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let node = glb.root(json!({ "mesh": mesh }));
    let (input, output) = (glb.floats(&[[0.0], [3.0]]), glb.floats(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]));
    let sampler = json!({ "input": input, "output": output });
    let channel = json!({ "sampler": 0, "target": { "node": node, "path": "translation" } });
    glb.push("animations", json!({ "channels": [channel], "samplers": [sampler] }));
    glb
}

fn x_of(case: &Case) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    case.load(folder.path()).unwrap().scene.objects[0].world_from_model.w_axis.x
}

#[test]
fn a_model_is_judged_in_lights_of_every_kind_and_at_three_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = moving().write(folder.path(), "moving.glb");
    let (cases, _) = files::cases(&path, &small());
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ["moving.glb", "moving.glb@1.000", "moving.glb@2.000"]);
    assert_eq!(cases.iter().map(x_of).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
    let (at, _) = files::cases(&path, &FileChanges { at: vec![0.5, 3.0], ..small() });
    assert_eq!(at.iter().map(x_of).collect::<Vec<_>>(), [0.5, 3.0]);

    let place = tempfile::tempdir().unwrap();
    let scene = cases[0].load(place.path()).unwrap().scene;
    assert_eq!(scene.image.size, [48, 36]);
    let kind = |light: &glumbra::scene::Light| match light.kind {
        LightKind::Spot(_) => "spot",
        LightKind::Point(_) => "point",
        LightKind::Directional { .. } => "sun",
    };
    assert_eq!(scene.lights.iter().map(kind).collect::<Vec<_>>(), ["spot", "point", "sun", "spot"]);
    let context = context::open(&ContextRequest::default()).unwrap();
    let result = stress::draw_case(&cases[2], &options("shadow-volume"), &mut Renderer::new(&context));
    assert_eq!(result.refused, None);
    // Changed settings of the first light of each kind, and the defaults of the second spotlight, twice each.
    let rows = |light| result.rows.iter().filter(|row| row.light == light).count();
    assert!(rows(0) > 2 && rows(1) > 2 && rows(2) > 2 && rows(3) == 2, "{:?}", [rows(0), rows(1), rows(2), rows(3)]);
    let wrong: Vec<_> = result.rows.iter().filter(|row| row.verdict != Verdict::Right).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    assert!(result.rows.iter().all(|row| row.compared > 300), "of {} pixels", 48 * 36);
}

/// A bias that leaks is silently wrong, whether or not the loader has warned of the file.
#[test]
fn what_the_loader_warns_of_excuses_no_wrong_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = moving();
    glb.json["extensionsUsed"] = json!(["EXT_of_no_one"]);
    let path = glb.write(folder.path(), "odd.glb");
    let (cases, warnings) = files::cases(&path, &FileChanges { size: Some([160, 120]), at: vec![0.0], ..small() });
    assert!(warnings.iter().any(|warning| warning.contains("EXT_of_no_one")), "{warnings:?}");
    let leaking = String::from("technique = \"shadow-map\", r = { scale = 0.5, bias = 0.4 }");
    let given = Case { rows: vec![leaking], colors: false, ..cases[0].clone() };
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut verdict = |case: &Case| {
        let result = stress::draw_case(case, &options("shadow-map"), &mut renderer);
        result.rows.iter().find(|row| row.light == 0).unwrap().verdict
    };
    assert_eq!(verdict(&given), Verdict::SilentlyWrong);
    assert_eq!(verdict(&Case { source: CaseSource::Named, ..given }), Verdict::Warned);
}

/// `glumbra stress` in a folder, of few rows.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = assert_cmd::Command::cargo_bin("glumbra").unwrap();
    let few = ["--technique", "second-depth", "--size", "32x24", "--json", "-"];
    command.current_dir(folder).arg("stress").args(arguments).args(few).output().unwrap()
}

#[test]
fn files_that_cannot_be_judged_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    moving().write(folder.path(), "good.glb");
    std::fs::write(at("bad.glb"), "no model").unwrap();
    std::fs::write(at("dark.toml"), "[[object]]\nmesh = \"box\"\n").unwrap();
    std::fs::create_dir(at("two")).unwrap();
    moving().write(&at("two"), "good.glb");

    let output = run(folder.path(), &["good.glb", "bad.glb", "two/good.glb", "--at", "1"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(0) && error.contains("error: bad.glb@1.000 is refused: bad.glb"), "{error}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let cases = found["cases"].as_array().unwrap();
    let told = |case: &Value| (case["name"].as_str().unwrap().to_owned(), case["refused"].as_str().map(str::to_owned));
    let [good, bad, second] = [0, 1, 2].map(|at| told(&cases[at]));
    assert_eq!((good, second), ((String::from("good.glb@1.000"), None), (String::from("good.glb@1.000-2"), None)));
    assert!(bad.1.is_some_and(|why| why.contains("bad.glb")), "{found}");

    let output = run(folder.path(), &["dark.toml"]);
    assert!(output.status.code() == Some(2), "nothing is drawn");
    assert!(String::from_utf8_lossy(&output.stdout).contains("has no light"));
    for (arguments, code, expected) in [
        (&["none.glb"][..], 2, "none.glb: cannot be read"),
        (&["good.glb", "--seed", "3"], 2, "--seed"),
        (&["good.glb", "--case", "elsewhere"], 2, "no case of the given files"),
    ] {
        let output = run(folder.path(), arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code) && error.contains(expected), "{arguments:?}: {error}");
    }
    let output = assert_cmd::Command::cargo_bin("glumbra").unwrap().args(["stress", "--at", "1"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}
