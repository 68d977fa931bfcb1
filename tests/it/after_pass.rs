//! `glumbra render --after-pass`: the picture as it stands after one of its passes.

use std::path::Path;

use crate::support::contexts::{command, run};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const SLIDE: &str = "data/cases/slide-projector/room/scene.toml";
const SHADOW: [&str; 3] = ["data/cases/scenes/two_lights.toml", "--set", "shading.passes=shadow"];

fn render(arguments: &[&str], folder: &Path) -> Result<image::RgbImage, String> {
    let path = folder.join("out.png");
    let mut command = command(&["render", "-o", path.to_str().unwrap()]);
    command.args(arguments).current_dir(ROOT);
    let output = run(command);
    match output.code {
        0 => Ok(image::open(&path).unwrap().into_rgb8()),
        _ => Err(output.stderr),
    }
}

#[test]
fn a_slide_comes_about_pass_by_pass() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second, third, fourth] = ["1", "slide of light 0", "3", "surfaces' colours"]
        .map(|pass| render(&[SLIDE, "--after-pass", pass], folder.path()).unwrap());
    // A point of the wall in the first slide's red, and a corner without a surface.
    let [wall, corner] = [(76, 44), (2, 2)];
    let (x, y) = wall;
    assert_eq!([first.get_pixel(x, y).0, first.get_pixel(corner.0, corner.1).0], [[51, 51, 51], [102, 0, 102]]);
    assert_eq!(second.get_pixel(x, y).0, [204, 51, 51], "ambient light and 0.6 of red");
    assert!(third != second, "the second slide");
    assert_eq!(fourth, render(&[SLIDE], folder.path()).unwrap(), "the last pass's is the picture");
}

#[test]
fn a_pass_of_alpha_is_shown_as_gray() {
    let folder = tempfile::tempdir().unwrap();
    let after = |pass: &str| render(&[&SHADOW[..], &["--after-pass", pass]].concat(), folder.path());
    let ambient = after("ambient light").unwrap();
    assert!(ambient.pixels().collect::<std::collections::HashSet<_>>().len() < 8, "a colour for each material");
    let shade = after("shade of light 0").unwrap();
    let gray = |color: [u8; 3]| color[0] == color[1] && color[1] == color[2];
    assert!(shade.pixels().all(|pixel| gray(pixel.0)));
    let count = |value: u8| shade.pixels().filter(|pixel| pixel.0[0] == value).count();
    assert!(count(255) > 5000 && count(0) > 2000, "{} lit, {} dark", count(255), count(0));
    assert_eq!(after("light 1").unwrap(), render(&SHADOW, folder.path()).unwrap());
}

#[test]
fn wrong_passes_are_taught() {
    let folder = tempfile::tempdir().unwrap();
    let after = |pass: &str| render(&[&SHADOW[..], &["--after-pass", pass]].concat(), folder.path()).unwrap_err();
    let all = "1 \"light 0: depth\", 2 \"light 1: depth\", 3 \"ambient light\", 4 \"shade of light 0\", 5 \"light 0\", 6 \"shade of light 1\", 7 \"light 1\"";
    for wanted in ["8", "0", "shade"] {
        let error = after(wanted);
        assert!(error.contains(&format!("--after-pass {wanted}: the plan has no such pass; it has {all}")), "{error}");
    }
    let error = after("light 1: depth");
    let expected = "--after-pass 2: \"light 1: depth\" comes before the picture has anything in it; passes that draw into it are 3 \"ambient light\"";
    assert!(error.contains(expected), "{error}");
    let error = render(&[SLIDE, "--after-pass", "1", "--aov", "depth"], folder.path()).unwrap_err();
    assert!(error.contains("cannot be used with"), "{error}");
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none(), "nothing is written");
}

/// Each view of a surface in each way of lighting: what per-vertex lighting needs is in the vertex shader of views, too.
#[test]
fn views_of_light_are_drawn_per_vertex_too() {
    let folder = tempfile::tempdir().unwrap();
    for lighting in ["shading.lighting=per-fragment", "shading.lighting=per-vertex"] {
        for view in ["decal", "depth", "diffuse", "specular", "normal", "shade", "gloss"] {
            let path = folder.path().join("out.png");
            let mut command = command(&["render", "data/cases/scenes/box.toml", "-o", path.to_str().unwrap()]);
            command.args(["--set", lighting, "--aov", view]).current_dir(ROOT);
            let output = run(command);
            assert_eq!(output.code, 0, "{lighting}, {view}: {}", output.stderr);
        }
    }
}
