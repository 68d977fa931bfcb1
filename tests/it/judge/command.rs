//! `glumbra judge` as a person meets it.

use std::path::Path;
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn scene() -> String {
    format!("{}/data/cases/scenes/two_lights.toml", env!("CARGO_MANIFEST_DIR"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with the scene's picture and shade: `a.png`, `a.shade.png`.
fn drawn() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "light.shadow.size=128"];
    let done = glumbra(folder.path(), &[&["render", &scene(), "-o", "a.png", "--aov", "shade"], &set[..]].concat());
    assert!(done.status.success(), "{}", text(&done.stderr));
    folder
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{}{}", text(&output.stdout), text(&output.stderr)))
}

#[test]
fn limits_decide_the_exit_status() {
    let folder = drawn();
    let judge = |more: &[&str]| glumbra(folder.path(), &[&["judge", &scene(), "a.shade.png"], more].concat());
    let found = json(&judge(&["--json", "-", "--max-outside", "1000000"]));
    assert_eq!((found["within"].as_bool(), found["schema_version"].as_u64()), (Some(true), Some(1)));
    let number = |key: &str| found[key].as_f64().unwrap();
    assert!(number("compared") > 10_000.0 && number("false_shadow") > 0.0 && number("leak") > 0.0, "{found}");
    let share = 100.0 * number("leak") / number("compared");
    assert!((number("leak_percent") - share).abs() < 1e-9);
    // Each limit alone, a little above what is found and a little below.
    for (option, value) in [("--max-false-shadow", number("false_shadow_percent")), ("--max-leak", share)] {
        assert_eq!(judge(&[option, &format!("{}", value * 1.01)]).status.code(), Some(0), "{option}");
        let fails = judge(&[option, &format!("{}", value * 0.99)]);
        assert_eq!(fails.status.code(), Some(1), "{option}");
        assert!(text(&fails.stdout).contains(&format!("is beyond {option}")), "{}", text(&fails.stdout));
    }
    let edge = found["edges"][1]["mean_pixels"].as_f64().unwrap();
    let by_edge = |limit: f64| judge(&["--max-edge", &limit.to_string()]).status.code();
    assert_eq!([by_edge(edge * 1.01), by_edge(edge * 0.99)], [Some(0), Some(1)], "{edge}");
    let exact = json(&judge(&["--band", "exact", "--json", "-"]));
    let outside = exact["outside_band"].as_u64().unwrap();
    assert!(outside > 0);
    let limit = |most: u64| judge(&["--band", "exact", "--max-outside", &most.to_string()]).status.code();
    assert_eq!([limit(outside), limit(outside - 1)], [Some(0), Some(1)]);
}

#[test]
fn what_is_wrong_is_said_and_drawn() {
    let folder = drawn();
    let done = glumbra(folder.path(), &["judge", &scene(), "a.shade.png", "--band", "technique", "-o", "wrong.png"]);
    let said = text(&done.stdout);
    assert_eq!(done.status.code(), Some(0), "{said}{}", text(&done.stderr));
    for expected in [
        "a.shade.png, 192x192, against light 0",
        "note: Overrides of the picture: light.shadow.size=128; given: none",
        "worst places",
        "true shadow edge, which box casts",
        "no limits are given",
    ] {
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let counted = json(&glumbra(folder.path(), &["judge", &scene(), "a.shade.png", "--json", "-"]));
    let picture = image::open(folder.path().join("wrong.png")).unwrap().to_rgb8();
    let count = |color: [u8; 3]| picture.pixels().filter(|pixel| pixel.0 == color).count() as u64;
    use glumbra::judge::difference::{FALSE_SHADOW, LEAK};
    // A picture has the wrong pixels that turned away from the light, too.
    assert!(count(FALSE_SHADOW) >= counted["false_shadow"].as_u64().unwrap());
    assert!(count(LEAK) >= counted["leak"].as_u64().unwrap() && count(LEAK) > 0);
}

#[test]
fn mistakes_are_named() {
    let folder = drawn();
    let picture = image::open(folder.path().join("a.shade.png")).unwrap();
    picture.flipv().save(folder.path().join("over.png")).unwrap();
    let judge = |arguments: &[&str]| glumbra(folder.path(), &[&["judge", &scene()], arguments].concat());
    let over = judge(&["over.png"]);
    assert!(text(&over.stdout).contains("mistake: the picture is upside down"), "{}", text(&over.stdout));
    let other = judge(&["a.shade.png", "--light", "1"]);
    assert!(
        text(&other.stdout).contains("mistake: the picture shows light 0: try --light 0"),
        "{}",
        text(&other.stdout)
    );
    for (arguments, error) in [
        (&["a.png"][..], "it is no shade, for the pixel"),
        (&["a.shade.png", "--light", "7"], "there is no light 7"),
        (&["a.shade.png", "--size", "64x64"], "it has 192x192 pixels, the scene's image 64x64"),
        (&["a.shade.png", "--kind", "color"], "--kind color needs red, green and blue"),
        (&["nothing.png"], "nothing.png: "),
        (&["a.shade.png", "-o", "a.shade.png"], "this file is read"),
        (&["a.shade.png", "-o", "wrong.exr"], "is a PNG"),
        (&["a.shade.png", "--band", "wide"], "is no number of pixels"),
    ] {
        let done = judge(arguments);
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(error) && done.stdout.is_empty(), "{arguments:?}: {said}");
    }
}

/// Colours by the scene's own lighting, and shades as the part that is left of the light.
#[test]
fn colored_pictures_are_judged() {
    let folder = drawn();
    let own = glumbra(
        folder.path(),
        &[
            "judge",
            &scene(),
            "a.png",
            "--kind",
            "color",
            "--band",
            "technique",
            "--max-outside",
            "0",
            "--set",
            "light.shadow.size=128",
        ],
    );
    assert_eq!(own.status.code(), Some(0), "{}{}", text(&own.stdout), text(&own.stderr));
    assert!(!text(&own.stdout).contains("mistake"), "{}", text(&own.stdout));
    let picture = image::open(folder.path().join("a.png")).unwrap().to_rgb8();
    image::imageops::flip_vertical(&picture).save(folder.path().join("over.png")).unwrap();
    let over = glumbra(folder.path(), &["judge", &scene(), "over.png", "--kind", "color"]);
    assert!(text(&over.stdout).contains("mistake: the picture is upside down"), "{}", text(&over.stdout));
    // Another lighting model for glumbra: half as bright, with another light and ambient light in it.
    let render = |name: &str, set: &[&str]| {
        let set = set.iter().flat_map(|set| ["--set", set]);
        let set: Vec<&str> = set.chain(["--set", "light.shadow.size=128"]).collect();
        let done = glumbra(folder.path(), &[&["render", &scene(), "-o", name], &set[..]].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
    };
    render("shown.png", &[]);
    render("open.png", &["light.0.shadow.technique=none"]);
    render("off.png", &["light.0.color=[0.0, 0.0, 0.0]"]);
    let judge =
        |more: &[&str]| glumbra(folder.path(), &[&["judge", &scene(), "shown.png", "--json", "-"], more].concat());
    let ratio = json(&judge(&["--unshadowed", "open.png", "--light-off", "off.png"]));
    let shade = json(&glumbra(folder.path(), &["judge", &scene(), "a.shade.png", "--json", "-"]));
    let number = |of: &serde_json::Value, key: &str| of[key].as_f64().unwrap();
    let [by_ratio, by_shade] = [&ratio, &shade].map(|of| number(of, "false_shadow") + number(of, "leak"));
    assert!((by_ratio - by_shade).abs() <= 0.2 * by_shade + 5.0, "{by_ratio} {by_shade}");
    assert!(number(&ratio, "outside_band") <= 0.5 * by_ratio && number(&ratio, "compared") > 10_000.0, "{ratio}");
    // Without shadows at all, the shadow leaks.
    let open = glumbra(
        folder.path(),
        &["judge", &scene(), "open.png", "--unshadowed", "open.png", "--light-off", "off.png", "--max-leak", "1"],
    );
    assert_eq!(open.status.code(), Some(1), "{}", text(&open.stdout));
}
