//! Every PNG that a program writes says by which version of glumbra it is, of which scene, and by which driver; without a
//! scene, what it is. No other file than `png_file.rs` encodes one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glumbra::pictures::{self, read_bytes};

use crate::support::xvfb::Xvfb;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn data(path: &str) -> String {
    root().join(path).to_str().unwrap().to_owned()
}

/// Runs a program in a folder, without a display.
fn run(program: &str, folder: &Path, arguments: &[&str], display: Option<&str>) -> Output {
    let mut command = Command::new(program);
    for name in ["CARGO_TARGET_DIR", "DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.envs(display.map(|display| ("DISPLAY", display))).current_dir(folder).args(arguments).output().unwrap()
}

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    run(env!("CARGO_BIN_EXE_glumbra"), folder, arguments, None)
}

type Texts = Vec<(String, String)>;

fn texts(path: &Path) -> Texts {
    pictures::read(path).unwrap_or_else(|error| panic!("{error}")).texts
}

/// Tests that these texts have the version and these keywords, each with words that its text contains. A driver is that of
/// this test's own contexts.
fn assert_says(what: &str, texts: &Texts, wanted: &[(&str, &str)]) {
    let version = concat!("glumbra ", env!("CARGO_PKG_VERSION"));
    for (keyword, words) in wanted.iter().chain(&[("Software", version)]) {
        let said: Vec<_> = texts.iter().filter(|(known, _)| known == keyword).collect();
        assert_eq!(said.len(), 1, "{what}: {keyword} in {texts:?}");
        assert!(said[0].1.contains(words), "{what}: {keyword} of {words} in {texts:?}");
    }
}

/// The one PNG in a folder or below it whose path ends so.
fn find(folder: &Path, end: &str) -> PathBuf {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            match entry.path() {
                path if path.is_dir() => folders.push(path),
                path if path.to_str().unwrap().ends_with(end) => found.push(path),
                _ => {}
            }
        }
    }
    assert_eq!(found.len(), 1, "{end}: {found:?}");
    found.remove(0)
}

const DRIVER: (&str, &str) = ("Driver", ", OpenGL ");

#[test]
fn pictures_and_views_of_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scene = data("data/cases/scenes/box.toml");
    let drawn = glumbra(
        folder.path(),
        &["render", &scene, "-o", "a.png", "--aov", "shade", "--aov", "truth", "--set", "light.shadow.size=64"],
    );
    assert!(drawn.status.success(), "{drawn:?}");
    for name in ["a.png", "a.shade.png", "a.truth.png"] {
        let wanted =
            [("Scene", "scenes/box.toml"), ("Overrides", "shadow.size=64"), ("Technique", "shadow-map"), DRIVER];
        assert_says(name, &texts(&folder.path().join(name)), &wanted);
    }
    let judged = glumbra(folder.path(), &["judge", &scene, "a.shade.png", "-o", "judged.png", "--light", "0"]);
    assert_ne!(judged.status.code(), Some(2), "{judged:?}");
    let wanted = [("Title", "differences of a picture's shade"), ("Scene", "box.toml"), ("Picture", "a.shade.png")];
    assert_says("judge", &texts(&folder.path().join("judged.png")), &wanted);
    let compared = glumbra(folder.path(), &["compare", "a.png", "a.truth.png", "-o", "difference.png"]);
    assert_ne!(compared.status.code(), Some(2), "{compared:?}");
    let wanted = [("Title", "differences of two pictures"), ("Actual", "a.png"), ("Expected", "a.truth.png")];
    assert_says("compare", &texts(&folder.path().join("difference.png")), &wanted);
}

#[test]
fn samples_without_a_window_and_in_one() {
    let folder = tempfile::tempdir().unwrap();
    let server = Xvfb::start();
    for (program, scene, arguments, wanted) in [
        (
            env!("CARGO_BIN_EXE_hw_shadowmaps_simple"),
            "hw_shadowmaps_simple.toml",
            &["--mode", "light", "--r-bias", "0.5"][..],
            &[("Mode", "light"), ("Overrides", "light.shadow.r.bias=0.5"), ("Technique", "shadow-map")][..],
        ),
        (
            env!("CARGO_BIN_EXE_hw_woo_shadowmaps"),
            "hw_shadowmaps_simple.toml",
            &[],
            &[("Technique", "midpoint"), ("Sample", "hw_woo_shadowmaps")],
        ),
        (
            env!("CARGO_BIN_EXE_md2shader"),
            "md2shader.toml",
            &["--frame", "9.5", "--mode", "normal"],
            &[("Frame", "9.5"), ("Mode", "normal"), ("Technique", "shadow-volume")],
        ),
        (env!("CARGO_BIN_EXE_md2bump"), "md2shader.toml", &[], &[("Technique", "none"), ("Sample", "md2bump")]),
    ] {
        let mut ways = vec![(&["--headless", "-o"][..], None)];
        ways.extend(server.as_ref().map(|server| (&["--capture"][..], Some(server.display()))));
        for (way, display) in ways {
            let drawn = run(program, folder.path(), &[way, &["x.png", "--size", "64x64"], arguments].concat(), display);
            assert!(drawn.status.success(), "{drawn:?}");
            let path = folder.path().join("x.png");
            assert_says(program, &texts(&path), &[wanted, &[("Scene", scene), DRIVER]].concat());
            fs::remove_file(path).unwrap();
        }
    }
}

#[test]
fn sheets_of_figures() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = glumbra(folder.path(), &["figures", "--only", "hsm-title", "-o", "out"]);
    assert!(drawn.status.success(), "{drawn:?}");
    let wanted =
        [("Title", "figure hsm-title: "), ("Source", "Hardware Shadow Mapping"), ("Scene", "workshop"), DRIVER];
    assert_says("figure", &texts(&folder.path().join("out/hsm-title.png")), &wanted);
}

#[test]
fn goldens_and_failures_of_pixel_tests() {
    let folder = tempfile::tempdir().unwrap();
    let case = |keys: &str| {
        let scene = data("data/cases/scenes/box.toml");
        fs::create_dir_all(folder.path().join("all/c")).unwrap();
        let golden = "[golden]\nmax = 2\nmean = 0.05\nwhy = \"now\"\n";
        let text = format!("asks = \"Is it?\"\nscene = {scene:?}\n{keys}{golden}");
        fs::write(folder.path().join("all/c/case.toml"), text).unwrap();
    };
    case("");
    glumbra(folder.path(), &["test", "all", "--bless"]);
    let golden = texts(&folder.path().join("all/c/golden.png"));
    assert_says("golden", &golden, &[("Title", "golden picture of the pixel test c"), ("Scene", "box.toml"), DRIVER]);
    case("set = [\"light.shadow.technique=none\"]\n");
    glumbra(folder.path(), &["test", "all", "--failures", "out"]);
    for name in ["actual", "expected", "difference"] {
        let title = format!("{name} picture of the pixel test c");
        let path = folder.path().join("out/c").join(name).with_extension("png");
        assert_says(name, &texts(&path), &[("Title", &title), ("Scene", "box.toml"), DRIVER]);
    }
    // Another renderer's driver is not known: its command is.
    case("render = [\"cp\", \"../../other.png\", \"{out}\"]\n");
    fs::copy(folder.path().join("out/c/difference.png"), folder.path().join("other.png")).unwrap();
    glumbra(folder.path(), &["test", "all", "--failures", "out"]);
    let actual = texts(&folder.path().join("out/c/actual.png"));
    assert_says("command", &actual, &[("Driver", "the command cp ../../other.png")]);
}

/// Pictures in a page, in their order.
fn pictures_in(page: &Path) -> Vec<Texts> {
    let page = fs::read_to_string(page).unwrap();
    let codes = page.split("data:image/png;base64,").skip(1).map(|rest| rest.split('"').next().unwrap());
    codes.map(|code| read_bytes(&BASE64_STANDARD.decode(code).unwrap()).unwrap().texts).collect()
}

#[test]
fn pictures_of_reports_and_stress_tests() {
    let folder = tempfile::tempdir().unwrap();
    let scene = data("data/cases/scenes/box.toml");
    fs::write(folder.path().join("grid.toml"), "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [64]\n").unwrap();
    let drawn = glumbra(folder.path(), &["report", &scene, "--grid", "grid.toml", "-o", "report"]);
    assert!(folder.path().join("report/report.html").is_file(), "{drawn:?}");
    let pictures = folder.path().join("report/pictures");
    assert_says(
        "picture",
        &texts(&find(&pictures, "-picture.png")),
        &[("Title", "the scene as written"), ("Scene", "box.toml"), DRIVER],
    );
    assert_says(
        "truth",
        &texts(&find(&pictures, "-truth.png")),
        &[("Title", "exact visibility"), ("Scene", "box.toml")],
    );
    let row = texts(&find(&pictures, "-row-0.png"));
    assert_says(
        "row",
        &row,
        &[("Scene", "box.toml"), ("Row", "0"), ("Settings", "technique = \"shadow-map\""), DRIVER],
    );
    assert!(pictures_in(&folder.path().join("report/report.html")).len() >= 3);

    let drawn = glumbra(
        folder.path(),
        &["stress", "--case", "map-size-1e0", "--technique", "shadow-map", "--one-in", "100", "-o", "stress"],
    );
    let found = pictures_in(&folder.path().join("stress/stress.html"));
    assert!(found.len() >= 3, "{drawn:?}");
    for texts in &found {
        assert_says(
            "stress",
            texts,
            &[("Scene", "stress case "), ("Settings", "technique = "), ("Light", "0"), DRIVER],
        );
    }
    assert!(found.iter().any(|texts| texts.iter().any(|(_, text)| text == "exact visibility")));
}

#[test]
fn skins_that_are_packed_again() {
    let folder = tempfile::tempdir().unwrap();
    let [model, skin] = ["data/meshes/knight.md2", "data/textures/knight.png"].map(data);
    let packed = glumbra(folder.path(), &["repack", &model, "--decal", &skin, "-o", "out"]);
    assert!(packed.status.success(), "{packed:?}");
    let wanted = [("Title", "a skin that was packed again"), ("Source", "knight.png"), ("Model", "knight.md2")];
    assert_says("skin", &texts(&folder.path().join("out/knight.png")), &wanted);
}

/// Files of `src/` whose code encodes a picture without `png_file.rs`. Tests in them may.
#[test]
fn one_file_encodes() {
    let encoders = ["PngEncoder", "png::Encoder", "JpegEncoder", "write_to(", ".save(", "save_buffer"];
    let mut found = Vec::new();
    let mut folders = vec![root().join("src")];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.extension().and_then(|extension| extension.to_str()) {
                None if path.is_dir() => folders.push(path),
                Some("rs") if !path.to_str().unwrap().ends_with("tests.rs") => {
                    let text = fs::read_to_string(&path).unwrap();
                    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
                    if encoders.iter().any(|encoder| code.contains(encoder)) {
                        found.push(path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned());
                    }
                }
                _ => {}
            }
        }
    }
    assert_eq!(found, ["src/png_file.rs"], "a PNG that says nothing of itself");
}
