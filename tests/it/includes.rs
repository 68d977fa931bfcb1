//! Scenes that are made of several files, and that have several cameras.

use std::fs;
use std::path::Path;

use glumbra::scene::{Error, Loaded};

use crate::support::load_file;
/// A room: a floor, a box on it, a light and two cameras.
const ROOM: &str = r#"
[image]
size = [64, 48]

[shading]
ambient = [0.1, 0.2, 0.3]

[[camera]]
name = "front"
eye = [0, 2, 6]
target = [0, 0.5, 0]

[[camera]]
name = "above"
eye = [0, 8, 0.1]
target = [0, 0, 0]
fov_y = 50

[[light]]
position = [2, 5, 3]
target = [0, 0, 0]
cone = 60
shadow = { technique = "shadow-map", size = 128 }

[[object]]
mesh = "quad"
scale = [4, 1, 4]
"#;

fn written(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// All values of the scene, without the places where they are written.
fn shown(loaded: Result<Loaded, Error>) -> String {
    let text = format!("{:?}", loaded.unwrap_or_else(|error| panic!("{error}")).scene);
    let (first, rest) = text.split_once("origin: File {").unwrap();
    let rest = rest.split("origin: File {").map(|part| part.split_once('}').unwrap().1);
    [first].into_iter().chain(rest).collect()
}

/// The error, with `folder` cut off the names of files.
fn refused(folder: &Path, name: &str, overrides: &[&str]) -> String {
    let error = load_file(&folder.join(name), overrides).expect_err("it is refused").to_string();
    error.replace(&format!("{}/", folder.display()), "")
}

#[test]
fn what_is_included_stands_before_and_is_overruled() {
    let box_of_own = "[[object]]\nmesh = \"box\"\nname = \"mine\"\n";
    let own = format!(
        "include = \"rooms/room.toml\"\n[image]\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n{box_of_own}"
    );
    let folder = written(&[("rooms/room.toml", ROOM), ("scene.toml", &own)]);
    let whole = ROOM
        .replace("ambient = [0.1, 0.2, 0.3]", "ambient = [0, 0, 0]")
        .replace("[image]", "[image]\nbackground = [0, 0, 0]");
    let flat = written(&[("scene.toml", &(whole + box_of_own))]);
    let (ours, theirs) = (folder.path().join("scene.toml"), flat.path().join("scene.toml"));
    let expected = shown(load_file(&theirs, &[]));
    assert!(expected.contains("size\", Entry { value: Integer(128)") && expected.len() > 1000, "{expected}");
    assert_eq!(shown(load_file(&ours, &[])), expected);
    let text = fs::read_to_string(&ours).unwrap();
    assert_eq!(shown(glumbra::load_str(&text, folder.path(), &[])), expected);
}

#[test]
fn files_are_found_from_the_file_that_names_them() {
    let parts = "include = [\"sub/floor.toml\", \"sub/deep/light.toml\"]\n";
    let folder = written(&[
        ("scene.toml", parts),
        ("sub/floor.toml", "[[object]]\nmesh = \"three.obj\"\n"),
        ("sub/three.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n"),
        ("sub/deep/light.toml", "include = \"../light.toml\"\n"),
        ("sub/light.toml", "[[light]]\nkind = \"point\"\nposition = [0, 1, 0]\n"),
    ]);
    let loaded = load_file(&folder.path().join("scene.toml"), &[]).unwrap();
    assert_eq!((loaded.scene.objects.len(), loaded.scene.lights.len()), (1, 1));
    let error = load_file(&folder.path().join("scene.toml"), &["light.cone=30"]).unwrap_err().to_string();
    assert!(error.contains("no key of a point light"), "{error}");
}

#[test]
fn errors_name_the_file_that_has_them() {
    let folder = written(&[
        ("a.toml", "include = \"b.toml\"\n"),
        ("b.toml", "\ninclude = [\"c.toml\"]\n"),
        ("c.toml", "include = \"a.toml\"\n"),
        ("wrong.toml", "include = \"key.toml\"\n"),
        ("key.toml", "[[object]]\nmesh = \"quad\"\nmash = 1\n"),
        ("absent.toml", "# first\ninclude = \"none.toml\"\n"),
        ("number.toml", "include = 3\n"),
        ("numbers.toml", "include = [\"key.toml\",\n 3]\n"),
        ("picture.toml", "include = \"a.png\"\n"),
        ("inner.toml", "[[object]]\nmesh = \"quad\"\ninclude = \"key.toml\"\n"),
        ("table.toml", "include = \"room.toml\"\n[camera]\neye = [1, 1, 1]\n"),
        ("room.toml", ROOM),
    ]);
    for (name, expected) in [
        (
            "a.toml",
            "c.toml:1: `include` goes round in a circle: a.toml includes b.toml includes c.toml includes a.toml",
        ),
        ("wrong.toml", "key.toml:3: unknown key `mash` in [object]: did you mean `mesh`?"),
        ("absent.toml", "absent.toml:2: `include`: none.toml cannot be read: No such file"),
        ("number.toml", "number.toml:1: `include` must be a file's name or an array of them, not an integer"),
        ("numbers.toml", "numbers.toml:2: `include` must name scene files"),
        ("picture.toml", "picture.toml:1: `include` \"a.png\": a scene ends in .toml"),
        ("inner.toml", "inner.toml:3: unknown key `include` in [object]"),
        ("table.toml", "table.toml:2: `camera` is a table, and an array at room.toml:8"),
    ] {
        let error = refused(folder.path(), name, &[]);
        assert!(error.starts_with(expected), "{name}: {error}");
    }
    let error = refused(folder.path(), "room.toml", &["include=key.toml"]);
    assert!(error.contains("--set include=key.toml: `include` can stand in a scene file alone"), "{error}");
}

#[test]
fn files_that_double_are_stopped() {
    let mut files: Vec<(String, String)> = (0..20)
        .map(|level| (format!("{level}.toml"), format!("include = [\"{0}.toml\", \"{0}.toml\"]\n", level + 1)))
        .collect();
    files.push((String::from("20.toml"), String::from("[[object]]\nmesh = \"quad\"\n")));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let folder = written(&files);
    let error = refused(folder.path(), "0.toml", &[]);
    assert!(error.contains("a scene is made of 256 files at most"), "{error}");
}

#[test]
fn one_of_several_cameras_is_chosen_by_its_name() {
    let folder = written(&[("room.toml", ROOM)]);
    let path = folder.path().join("room.toml");
    let eye = |overrides: &[&str]| load_file(&path, overrides).unwrap().scene.camera.eye.to_array();
    assert_eq!(eye(&[]), [0.0, 2.0, 6.0]);
    assert_eq!(eye(&["camera=above"]), [0.0, 8.0, 0.1]);
    assert_eq!(eye(&["camera.1.eye=[1, 9, 1]", "camera=above"]), [1.0, 9.0, 1.0]);
    assert_eq!(eye(&["camera=above", "camera.eye=[1, 7, 1]"]), [1.0, 7.0, 1.0]);
    let error = refused(folder.path(), "room.toml", &["camera=abov"]);
    assert_eq!(error, "--set camera=abov: no camera is called \"abov\": did you mean `above`? (known: above, front)");
    for (from, to, expected) in [
        ("name = \"above\"\n", "", "room.toml:13: `camera.name` is missing: `--camera NAME` chooses one of several"),
        ("\"above\"", "\"front\"", "room.toml:14: `camera.name` \"front\" is the name of another camera, too"),
        ("fov_y = 50", "fov_y = 500", "room.toml:17: `camera.fov_y` must be above 1"),
    ] {
        fs::write(&path, ROOM.replace(from, to)).unwrap();
        let error = refused(folder.path(), "room.toml", &[]);
        assert!(error.starts_with(expected), "{error}");
    }
    fs::write(&path, "camera = []\n[[object]]\nmesh = \"quad\"\n").unwrap();
    assert!(refused(folder.path(), "room.toml", &[]).contains("is an empty array"), "an empty array");
    fs::write(&path, "[[object]]\nmesh = \"quad\"\n").unwrap();
    assert!(refused(folder.path(), "room.toml", &["camera=a"]).contains("no camera of the scene has a `name`"));
}

#[test]
fn the_command_draws_through_the_camera_and_prints_the_whole_scene() {
    let folder = written(&[("room.toml", ROOM), ("scene.toml", "include = \"room.toml\"\n")]);
    let glumbra = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("glumbra").unwrap();
        command.current_dir(folder.path()).args(arguments).assert().success().get_output().stdout.clone()
    };
    let printed = glumbra(&["plan", "scene.toml", "--camera", "above", "--print-scene"]);
    fs::write(folder.path().join("whole.toml"), &printed).unwrap();
    glumbra(&["render", "whole.toml", "-o", "whole.png"]);
    glumbra(&["render", "scene.toml", "--camera", "above", "-o", "above.png"]);
    glumbra(&["render", "scene.toml", "-o", "front.png"]);
    let picture = |name: &str| image::open(folder.path().join(name)).unwrap().to_rgba8();
    assert_eq!(picture("whole.png"), picture("above.png"));
    assert_ne!(picture("whole.png"), picture("front.png"));
}
