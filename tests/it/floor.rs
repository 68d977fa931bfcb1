//! `--no-floor`, in every command that takes a model.

use std::path::Path;
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;
use glumbra::report::store::merge;

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Arguments of each command after the scene, on a picture that is drawn at once.
const COMMANDS: [&[&str]; 4] = [
    &["render", "--size", "64x48", "-o", "out.npy"],
    &["plan", "--size", "64x48"],
    &["tune", "--size", "64x48", "--sizes", "64"],
    &["report", "--size", "64x48", "--grid", "grid.toml", "--runs", "1", "-o", "out"],
];

const GRID: &str = "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [64]\n";

fn file(path: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path).to_str().unwrap().to_owned()
}

/// Only models are supplied with a floor, so that the option on a scene is a mistake.
#[test]
fn every_command_refuses_a_scene_without_floor() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("grid.toml"), GRID).unwrap();
    let (scene, model) = (file("data/cases/scenes/box.toml"), file("data/meshes/concave.obj"));
    for command in COMMANDS {
        let refused = glumbra(folder.path(), &[&[command[0], &scene, "--no-floor"], &command[1..]].concat());
        let error = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(1), "{command:?}: {error}");
        assert!(error.contains("box.toml is a scene; only a model is supplied with a floor"), "{error}");
    }
    // Whichever of a report's scenes it is.
    let mixed = [&["report", &model, &scene, "--no-floor"], &COMMANDS[3][1..]].concat();
    assert!(text(&glumbra(folder.path(), &mixed).stderr).contains("box.toml is a scene"));
    assert!(!folder.path().join("out").exists() && !folder.path().join("out.npy").exists());
}

/// Without its floor a report's scene has the model's triangles alone, by the option as by the key.
#[test]
fn a_report_of_a_model_has_no_floor_if_none_is_wanted() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("grid.toml"), GRID).unwrap();
    let model = file("data/meshes/concave.obj");
    let scene_of = |floor: &[&str]| {
        let done = glumbra(folder.path(), &[&["report", &model], floor, &COMMANDS[3][1..]].concat());
        assert!(done.status.success(), "{floor:?}: {}", text(&done.stderr));
        merge::load(&folder.path().join("out")).unwrap().scenes.remove(0)
    };
    let [with, option, key] = [&[][..], &["--no-floor"], &["--set", "floor=false"]].map(scene_of);
    assert!(with.triangles > option.triangles, "{} and {}", with.triangles, option.triangles);
    assert_eq!((option.triangles, &option.fingerprint), (key.triangles, &key.fingerprint));
}
