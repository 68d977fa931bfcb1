//! Names that are no text, links, pipes, and outputs that would take the place of inputs.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;

use super::*;

#[test]
fn a_path_that_is_no_utf_8_keeps_its_bytes_in_json() {
    let folder = work();
    let name = OsStr::from_bytes(b"caf\xe9.toml");
    fs::rename(folder.path().join("scene.toml"), folder.path().join(name)).unwrap();
    let output = Command::new(GLUMBRA)
        .current_dir(folder.path())
        .arg("render")
        .arg(name)
        .args(["--quiet", "--json", "-", "--aov", "shade"])
        .output()
        .unwrap();
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let json = &json["scenes"][0];
    assert_eq!(json["scene"], "caf\u{fffd}.toml");
    assert_eq!(json["path_bytes"]["caf\u{fffd}.toml"], "636166e92e746f6d6c");
    assert_eq!(json["path_bytes"]["caf\u{fffd}.shade.png"], "636166e92e73686164652e706e67");
    assert!(folder.path().join(OsStr::from_bytes(b"caf\xe9.png")).is_file());
}

#[test]
fn a_scene_that_could_not_name_its_model_is_not_printed() {
    let folder = tempfile::tempdir().unwrap();
    let name = OsStr::from_bytes(b"caf\xe9.obj");
    fs::write(folder.path().join(name), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let mut command = Command::new(GLUMBRA);
    let output = command.current_dir(folder.path()).arg("plan").arg(name).arg("--print-scene").output().unwrap();
    assert_eq!(refusal(&output, 1, "is not UTF-8, which a scene's text must be"), None);
    assert!(output.stdout.is_empty());
}

#[test]
fn a_view_that_is_asked_for_twice_is_written_once() {
    for twice in ["--aov shade --aov shade", "--aov shade --aov shade@0"] {
        let folder = work();
        let output = run(folder.path(), &format!("glumbra render scene.toml -o x.png {twice}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let warnings = text(&output.stderr);
        assert_eq!(warnings.lines().next(), Some("warning: --aov names PICTURE.shade twice; it is written once"));
        assert_eq!(warnings.lines().filter(|line| line.starts_with("wrote ")).count(), 2, "{warnings}");
        assert_eq!(names(folder.path()), ["scene.toml", "x.png", "x.shade.png"]);
    }
}

#[test]
fn a_link_is_followed_and_a_pipe_is_written_to() {
    let folder = work();
    let script = "mkdir real; ln -s real/y.png x.png; mkfifo x.shade.png; cat x.shade.png > read & \
                  glumbra render scene.toml -o x.png --aov shade --quiet && wait";
    let output = run(folder.path(), script);
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    assert_eq!(names(folder.path()), ["read", "real", "scene.toml", "x.png", "x.shade.png"]);
    assert!(folder.path().join("x.png").is_symlink());
    for name in ["real/y.png", "read"] {
        let picture = image::ImageReader::open(folder.path().join(name)).unwrap().with_guessed_format().unwrap();
        assert_eq!(picture.into_dimensions().unwrap(), (96, 96), "{name}");
    }
}

#[test]
fn what_a_scene_reads_is_not_overwritten() {
    let decal = "sed -i 's/mesh = \"box\"/&\\nmaterial = { decal = \"x.png\" }/' scene.toml; \
                 glumbra render scene.toml -o made.png --size 64x64 2>/dev/null; \
                 cp \"$ROOT/data/textures/spot.png\" x.png; cp x.png x.shade.png; ";
    for (script, expected) in [
        ("glumbra render scene.toml -o x.png", "x.png: the scene reads this file; name another for the picture"),
        ("ln -s x.png y.png; glumbra render scene.toml -o y.png", "y.png: the scene reads this file"),
        (
            "sed -i s/x.png/x.shade.png/ scene.toml; glumbra render scene.toml -o x.png --aov shade",
            "x.shade.png: the scene reads",
        ),
    ] {
        let folder = work();
        let mut command = shell(folder.path(), &format!("{decal}{script}"));
        let output = command.env("ROOT", env!("CARGO_MANIFEST_DIR")).output().unwrap();
        assert_eq!(refusal(&output, 1, expected), None, "{script}");
        let spot = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/data/textures/spot.png")).unwrap();
        assert!(["x.png", "x.shade.png"].iter().all(|name| fs::read(folder.path().join(name)).unwrap() == spot));
    }
}

#[test]
fn one_file_for_two_purposes_is_refused() {
    refused(&[
        ("twice", "glumbra check --filter D1 --json x --junit x", 2, "x: --json and --junit name the same file"),
        (
            "read",
            "touch x; glumbra check --filter D1 --junit x --waivers ./x",
            2,
            "--junit and --waivers name the same file",
        ),
    ]);
}
