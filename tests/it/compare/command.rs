//! `glumbra compare` as a person meets it, and the texts in the pictures of `glumbra render`.

use std::path::Path;
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// `a.png`, and `b.png` with three pixels that differ by 3, 10 and 40 codes.
fn two() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut picture = image::RgbImage::from_fn(50, 40, |x, y| image::Rgb([(x * 3) as u8, (y * 4) as u8, 100]));
    picture.save(folder.path().join("a.png")).unwrap();
    for ([x, y], channel, off) in [([10, 20], 0, 3), ([11, 21], 1, 10), ([12, 22], 2, 40)] {
        picture.get_pixel_mut(x, y).0[channel] += off;
    }
    picture.save(folder.path().join("b.png")).unwrap();
    folder
}

fn status(folder: &Path, arguments: &[&str]) -> Option<i32> {
    glumbra(folder, &[&["compare", "b.png", "a.png"], arguments].concat()).status.code()
}

#[test]
fn limits_decide_the_exit_status() {
    let folder = two();
    let folder = folder.path();
    assert_eq!(glumbra(folder, &["compare", "a.png", "a.png"]).status.code(), Some(0));
    let mean = 53.0 / (50.0 * 40.0 * 3.0);
    for (arguments, expected) in [
        (&[][..], 1),
        (&["--max", "40"], 0),
        (&["--max", "39.9"], 1),
        (&["--max", "10", "--share", "0.05"], 0),
        (&["--max", "9", "--share", "0.05"], 1),
        (&["--max", "9", "--share", "0.1"], 0),
        (&["--max", "0", "--share", "0.15"], 0),
        (&["--max", "0", "--share", "0.149"], 1),
        (&["--max", "2", "--share", "1", "--spot", "1"], 1),
        (&["--max", "2", "--share", "1", "--spot", "2"], 0),
        (&["--mean", &format!("{}", mean * 1.05)], 0),
        (&["--mean", &format!("{}", mean * 0.95)], 1),
        (&["--max", "40", "--mean", "0"], 1),
        (&["--flip"], 1),
        (&["--flip", "0.1"], 0),
        (&["--flip", "0"], 1),
        (&["--max", "39", "--flip", "0.1"], 1),
        (&["--share", "1"], 2),
        (&["--max", "-1"], 2),
        (&["--max", "1", "--share", "101"], 2),
        (&["-o", "a.png"], 2),
        (&["-o", "c.exr"], 2),
    ] {
        assert_eq!(status(folder, arguments), Some(expected), "{arguments:?}");
    }
    for other in ["nothing.png", "."] {
        assert_eq!(glumbra(folder, &["compare", "a.png", other]).status.code(), Some(2));
    }
    image::RgbImage::new(50, 41).save(folder.join("c.png")).unwrap();
    let done = glumbra(folder, &["compare", "a.png", "c.png"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("a.png and c.png cannot be compared: the sizes differ: 50x40 and 50x41"));
}

#[test]
fn what_differs_is_said_and_drawn() {
    let folder = two();
    let done = glumbra(folder.path(), &["compare", "b.png", "a.png", "-o", "d.png", "--flip"]);
    let said = text(&done.stdout);
    assert_eq!(done.status.code(), Some(1), "{said}{}", text(&done.stderr));
    for expected in [
        "b.png and a.png: 50x40, RGB",
        "differ     3 of 2000 pixels (0.1500 %), in columns 10 to 12, rows 20 to 22; the first is (10, 20)",
        "at most    40.0000 codes of 255, at (12, 22) in blue",
        "mean       0.008833 codes",
        "FLIP       ",
        "--max 0 --share 0.15\n",
        "--max 4 --share 0.1\n",
        "--max 16 --share 0.05\n",
        "--max 40\n",
        "--mean 0.008834\n",
        "beyond the limits",
    ] {
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let picture = image::open(folder.path().join("d.png")).unwrap().to_rgb8();
    assert_eq!(picture.pixels().filter(|pixel| pixel.0 != [0; 3]).count(), 3);
    assert_eq!(
        [[10, 20], [11, 21], [12, 22]].map(|[x, y]| picture.get_pixel(x, y).0),
        [[48, 0, 0], [0, 159, 0], [0, 0, 255]]
    );
}

/// Every tolerance that is printed passes, and a little less does not.
#[test]
fn tolerances_that_are_said_to_pass_do() {
    let folder = two();
    let done = glumbra(folder.path(), &["compare", "b.png", "a.png", "--json", "-"]);
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((json["within"].as_bool(), json["differing"].as_u64()), (Some(false), Some(3)));
    assert_eq!((json["worst"].to_string(), json["bounds"].to_string()), ("[12,22]".into(), "[[10,20],[12,22]]".into()));
    let passing = json["passing"].as_array().unwrap();
    assert!(passing.len() >= 5, "{json}");
    for row in passing {
        let [max, share] = ["max_codes", "share_percent"].map(|key| row[key].as_f64().unwrap());
        assert_eq!(
            status(folder.path(), &["--max", &max.to_string(), "--share", &share.to_string()]),
            Some(0),
            "{row}"
        );
        let less = (share - 0.01).max(0.0).to_string();
        let expected = if share > 0.0 { 1 } else { 0 };
        assert_eq!(status(folder.path(), &["--max", &max.to_string(), "--share", &less]), Some(expected), "{row}");
    }
}

/// Pictures of different settings say so; two of one setting are equal to the byte, texts included.
#[test]
fn pictures_say_what_they_show() {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!("{}/data/cases/scenes/box.toml", env!("CARGO_MANIFEST_DIR"));
    let render = |name: &str, more: &[&str]| {
        let done = glumbra(folder.path(), &[&["render", &scene, "--size", "64x48", "-o", name], more].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
    };
    render("a.png", &[]);
    render("again.png", &[]);
    render("b.png", &["--set", "light.shadow.technique=shadow-volume", "--aov", "shade"]);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("a.png") == bytes("again.png"));
    let texts = glumbra::pictures::read(&folder.path().join("b.shade.png")).unwrap().texts;
    let said = |keyword: &str| texts.iter().find(|(known, _)| known == keyword).map_or("", |(_, text)| text);
    assert_eq!(said("Software"), concat!("glumbra ", env!("CARGO_PKG_VERSION")));
    assert_eq!(said("Scene"), scene);
    assert_eq!(said("Overrides"), "image.size=[64, 48] light.shadow.technique=shadow-volume");
    assert_eq!(said("Technique"), "shadow-volume");
    assert!(said("Driver").contains("OpenGL"), "{texts:?}");
    let done = glumbra(folder.path(), &["compare", "a.png", "b.png", "--max", "255"]);
    let said = text(&done.stdout);
    assert!(said.contains("Technique differs: shadow-map and shadow-volume"), "{said}");
    assert!(!said.contains("Driver differs") && !said.contains("Scene differs"), "{said}");
}
