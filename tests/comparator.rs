//! The comparator is itself tested to fail: what is wrong on purpose here goes through the very functions that the
//! pixel cases use.

use std::fs;
use std::path::{Path, PathBuf};

#[path = "support/cases/mod.rs"]
mod cases;
use cases::check;
use cases::compare::{Tolerance, compare};
use cases::draw::{self, Wanted};
use cases::file::{Case, Golden};
use cases::golden;
use cases::picture::Picture;

const GOLDEN: &str = "[golden]\nmax = 2\nmean = 0.05\nwhy = \"drawn a moment ago\"\n";

/// A case in a folder of its own, on a scene that the real cases share.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The box scene with `set`, as it is drawn now, as the golden.
    fn with_golden(set: &[&str]) -> Self {
        let bench = Self::new();
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        draw::draw(&scene(), &set, 1, Wanted::Picture).unwrap().picture.write_png(&bench.path("golden.png")).unwrap();
        fs::write(bench.path("golden.driver"), draw::driver()).unwrap();
        bench
    }

    /// Runs the checks of `toml` after `asks` and `scene`.
    fn run(&self, title: &str, set: &[&str], toml: &str) -> Result<(), String> {
        let head = format!("asks = \"{title}\"\nscene = {:?}\nset = {set:?}\n", scene());
        fs::write(self.path("case.toml"), head + toml).unwrap();
        check::run(&Case::read(self.folder.path(), &format!("comparator/{title}")).unwrap())
    }
}

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes/box.toml")
}

/// Asserts that it failed, in words that have `text`.
fn fails(result: Result<(), String>, text: &str) -> String {
    let error = result.expect_err("it passes");
    assert!(error.contains(text), "{error}");
    error
}

#[test]
fn an_honest_golden_passes() {
    Bench::with_golden(&[]).run("honest", &[], GOLDEN).unwrap();
}

#[test]
fn one_changed_pixel_fails_and_its_pictures_are_kept() {
    let bench = Bench::with_golden(&[]);
    let mut changed = Picture::read_png(&bench.path("golden.png")).unwrap();
    changed.data[3 * (100 * 192 + 40) + 1] += 3.0 / 255.0;
    changed.write_png(&bench.path("golden.png")).unwrap();
    let error = fails(bench.run("one-pixel", &[], GOLDEN), "1 of 36864 pixels (0.003 %) differ");
    assert!(error.contains("(at 40, 100)"), "{error}");
    for name in ["actual.png", "expected.png", "difference.png"] {
        let path = error.lines().map(str::trim).find_map(|line| {
            let path = line.strip_prefix("see ").unwrap_or(line);
            path.ends_with(&format!("one-pixel/{name}")).then(|| path.to_owned())
        });
        assert!(Path::new(&path.unwrap()).is_file(), "{name}: {error}");
    }
}

#[test]
fn one_changed_bit_fails_where_exact() {
    let one = Picture { size: [2, 1], channels: 1, data: vec![0.5, 0.25] };
    let mut other = one.clone();
    compare(&one, &other, &Tolerance::EXACT).unwrap();
    other.data[1] = f32::from_bits(other.data[1].to_bits() + 1);
    compare(&one, &other, &Tolerance::EXACT).unwrap_err();
    let nan = Picture { data: vec![0.5, f32::NAN], ..one.clone() };
    compare(&nan, &one, &Tolerance { max: 1.0, mean: 1.0, share: 1.0 }).unwrap_err();
}

#[test]
fn each_limit_counts_alone() {
    let one = Picture { size: [4, 1], channels: 1, data: vec![0.0; 4] };
    let other = Picture { data: vec![0.0, 0.0, 0.5, 0.5], ..one.clone() };
    let all = Tolerance { max: 0.5, mean: 0.25, share: 0.5 };
    compare(&other, &one, &all).unwrap();
    for tolerance in [Tolerance { max: 0.49, ..all }, Tolerance { mean: 0.24, ..all }, Tolerance { share: 0.49, ..all }]
    {
        compare(&other, &one, &tolerance).unwrap_err();
    }
}

#[test]
fn wrong_size_fails() {
    let bench = Bench::with_golden(&["image.size=[192, 191]"]);
    fails(bench.run("wrong-size", &[], GOLDEN), "wrong size: 192x192 with 3 channels, expected 192x191");
}

#[test]
fn a_missing_golden_fails_and_is_not_written() {
    let bench = Bench::new();
    fails(bench.run("missing", &[], GOLDEN), "there is no golden");
    assert!(!bench.path("golden.png").exists());
}

#[test]
fn blessing_writes_and_fails() {
    let bench = Bench::new();
    let actual = draw::draw(&scene(), &[], 1, Wanted::Picture).unwrap().picture;
    let wanted = Golden { max: 2.0, mean: 0.05, why: String::new() };
    golden::check(&actual, bench.folder.path(), &wanted, true).unwrap_err();
    golden::check(&actual, bench.folder.path(), &wanted, false).unwrap();
}

/// On another driver the maximum is not asked for, and it is said.
#[test]
fn a_golden_of_another_driver_is_compared_by_its_mean_and_says_so() {
    let bench = Bench::with_golden(&[]);
    let mut other = Picture::read_png(&bench.path("golden.png")).unwrap();
    let wanted = Golden { max: 2.0, mean: 0.05, why: String::new() };
    let said = golden::check(&other, bench.folder.path(), &wanted, false).unwrap();
    assert!(
        said.starts_with("compared with the golden of this driver, by 2/255 at most and 0.05/255 in the mean: 0 of"),
        "{said}"
    );
    fs::write(bench.path("golden.driver"), "llvmpipe of another day\n").unwrap();
    other.data[0] = 1.0 - other.data[0].round();
    let said = golden::check(&other, bench.folder.path(), &wanted, false).unwrap();
    let how =
        "compared with the golden of another driver, llvmpipe of another day, by 0.75/255 in the mean alone: 1 of";
    assert!(said.starts_with(how), "{said}");
    other.data.fill(1.0);
    let (error, _) = golden::check(&other, bench.folder.path(), &wanted, false).unwrap_err();
    assert!(error.contains("of another driver, llvmpipe of another day"), "{error}");
}

#[test]
fn an_empty_case_fails() {
    fails(Bench::new().run("empty", &[], ""), "the case has no checks");
    let nothing = "[[pick]]\nat = [0, 0, 0]\nwhy = \"\"\n";
    fails(Bench::new().run("empty-pick", &[], nothing), "a pick expects nothing");
    let nothing = "[[same]]\nof = [\"shade\"]\nsets = []\nexact = true\nwhy = \"\"\n";
    fails(Bench::new().run("empty-same", &[], nothing), "compares nothing");
}

#[test]
fn an_unknown_key_fails() {
    let bench = Bench::new();
    fs::write(bench.path("case.toml"), "asks = \"\"\npicks = []\n").unwrap();
    assert!(Case::read(bench.folder.path(), "unknown").unwrap_err().contains("unknown field `picks`"));
}

const NO_SHADOW: &str = "light.shadow={ technique = \"none\" }";
const MIRRORED: &str = "light.position=[2.0, 5.0, 1.5]";

#[test]
fn shadows_switched_off_fail_against_the_golden() {
    fails(Bench::with_golden(&[]).run("no-shadow", &[NO_SHADOW], GOLDEN), "differ");
}

#[test]
fn the_light_mirrored_fails_against_the_golden() {
    fails(Bench::with_golden(&[]).run("mirrored-light", &[MIRRORED], GOLDEN), "differ");
}

const EDGE: &str = "[[edge]]\ncaster = [0.5, 1, 0]\noutward = [1, 0, 0]\nwhy = \"\"\n";
const PICK: &str = "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"shadowed\"\nwhy = \"\"\n";
const FORMULA: &str =
    "[[pick]]\nat = [0.8, 0, -0.4]\nformula = { normal = [0, 1, 0], object = 0, shade = [0] }\nwhy = \"\"\n";

#[test]
fn shadows_switched_off_fail_by_formula() {
    for (index, checks) in [EDGE, PICK, FORMULA].into_iter().enumerate() {
        Bench::new().run("formula", &[], checks).unwrap();
        Bench::new().run(&format!("formula-{index}"), &[NO_SHADOW], checks).unwrap_err();
    }
}

#[test]
fn the_light_mirrored_fails_by_formula() {
    for (index, checks) in [PICK, FORMULA].into_iter().enumerate() {
        Bench::new().run(&format!("formula-mirrored-{index}"), &[MIRRORED], checks).unwrap_err();
    }
}

#[test]
fn a_relation_that_does_not_hold_fails() {
    let checks = "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.size=128\"]]\nexact = true\nwhy = \"\"\n";
    fails(Bench::new().run("relation", &[], checks), "none may");
}

#[test]
fn an_error_that_does_not_come_fails() {
    fails(Bench::new().run("no-error", &[], "fails_with = \"x\"\n"), "the scene draws");
    let bench = Bench::new();
    fails(bench.run("other-error", &["light.cone=0"], "fails_with = \"unheard of\"\n"), "without \"unheard of\"");
}
