//! The comparator is itself tested to fail: what is wrong on purpose here goes through the very functions that the
//! pixel cases use.

use std::fs;
use std::path::{Path, PathBuf};

use glumbra::cases::PixelCase;
use glumbra::cases::draw::{DrawnScene, Wanted};
use glumbra::cases::file::Golden;
use glumbra::cases::golden::{self, GoldenFile, GoldenResult};
use glumbra::pictures::Raster;
use glumbra::pictures::compare::{Tolerance, compare};
use glumbra::png_file::PngTexts;

use crate::with_runner;

/// A list of tests by name.
macro_rules! tests {
    ($($name:ident),* $(,)?) => { &[$((stringify!($name), $name)),*] };
}
pub(crate) use tests;

pub const TESTS: &[(&str, fn())] = tests![
    an_honest_golden_passes,
    one_changed_pixel_fails_and_its_pictures_are_kept,
    one_changed_bit_fails_where_exact,
    each_limit_counts_alone,
    wrong_size_fails,
    a_missing_golden_fails_and_is_not_written,
    blessing_writes_and_fails,
    a_golden_of_another_driver_says_so,
    a_shadow_that_vanishes_fails_against_the_golden_of_another_driver,
    shadows_switched_off_fail_against_the_golden,
    the_light_mirrored_fails_against_the_golden,
    shadows_switched_off_fail_by_formula,
    the_light_mirrored_fails_by_formula,
    a_relation_that_does_not_hold_fails,
    an_error_that_does_not_come_fails,
];

const GOLDEN: &str = "[golden]\nmax = 2\nmean = 0.05\nwhy = \"drawn a moment ago\"\n";

/// A case in a folder of its own, on a scene that the real cases share.
pub struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The box scene with `set`, as it is drawn now, as the golden.
    pub fn with_golden(set: &[&str]) -> Self {
        let folder = Self::new();
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        draw(&set).write_png(&folder.path("golden.png")).unwrap();
        fs::write(folder.path("golden.driver"), driver()).unwrap();
        folder
    }

    /// Runs the checks of `toml` after `asks` and `scene`.
    pub fn run(&self, title: &str, set: &[&str], toml: &str) -> Result<(), String> {
        let head = format!("asks = \"{title}\"\nscene = {:?}\nset = {set:?}\n", scene());
        fs::write(self.path("case.toml"), head + toml).unwrap();
        let case =
            PixelCase::read(self.folder.path(), &format!("comparator/{title}")).map_err(|error| error.to_string())?;
        crate::run(&case)
    }
}

/// The box scene with `set`.
pub fn draw(set: &[String]) -> Raster {
    let drawn: DrawnScene =
        with_runner(|runner| runner.drawer().draw(&scene(), set, 1, Wanted::Picture)).expect("the scene draws");
    drawn.picture
}

fn driver() -> String {
    with_runner(|runner| runner.drawer().driver()).unwrap()
}

fn file(folder: &Path) -> GoldenFile<'_> {
    GoldenFile { folder, texts: PngTexts::default() }
}

/// Compares with the golden in `folder`: how, or why it fails.
fn against_golden(actual: &Raster, folder: &Path, wanted: &Golden) -> Result<String, String> {
    match golden::check(actual, wanted, &file(folder), &driver(), false)? {
        GoldenResult::Same(how) => Ok(how),
        GoldenResult::Wrong { why, .. } => Err(why),
        GoldenResult::Written(how) => panic!("{how}"),
    }
}

/// The scene of the tests' cases.
pub fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes/box.toml")
}

/// Asserts that it failed, in words that have `text`.
pub fn fails(result: Result<(), String>, text: &str) -> String {
    let error = result.expect_err("it passes");
    assert!(error.contains(text), "{error}");
    error
}

fn an_honest_golden_passes() {
    Folder::with_golden(&[]).run("honest", &[], GOLDEN).unwrap();
}

fn one_changed_pixel_fails_and_its_pictures_are_kept() {
    let folder = Folder::with_golden(&[]);
    let mut changed = golden::read(&folder.path("golden.png")).unwrap();
    changed.data[3 * (100 * 192 + 40) + 1] += 3.0 / 255.0;
    changed.write_png(&folder.path("golden.png")).unwrap();
    let error = fails(folder.run("one-pixel", &[], GOLDEN), "1 of 36864 pixels (0.003 %) differ");
    assert!(error.contains("(at 40, 100)"), "{error}");
    for name in ["actual.png", "expected.png", "difference.png"] {
        let path = error.lines().map(str::trim).find_map(|line| {
            let path = line.strip_prefix("see ").unwrap_or(line);
            path.ends_with(&format!("one-pixel/{name}")).then(|| path.to_owned())
        });
        assert!(Path::new(&path.unwrap()).is_file(), "{name}: {error}");
    }
}

fn one_changed_bit_fails_where_exact() {
    let one = Raster { size: [2, 1], channels: 1, data: vec![0.5, 0.25] };
    let mut other = one.clone();
    compare(&one, &other, &Tolerance::EXACT).unwrap();
    other.data[1] = f32::from_bits(other.data[1].to_bits() + 1);
    compare(&one, &other, &Tolerance::EXACT).unwrap_err();
    let nan = Raster { data: vec![0.5, f32::NAN], ..one.clone() };
    compare(&nan, &one, &Tolerance { max: 1.0, mean: 1.0, share: 1.0, ..Tolerance::EXACT }).unwrap_err();
}

fn each_limit_counts_alone() {
    let one = Raster { size: [4, 1], channels: 1, data: vec![0.0; 4] };
    let other = Raster { data: vec![0.0, 0.0, 0.5, 0.5], ..one.clone() };
    let all = Tolerance { max: 0.5, mean: 0.25, share: 0.5, ..Tolerance::EXACT };
    compare(&other, &one, &all).unwrap();
    for tolerance in [Tolerance { max: 0.49, ..all }, Tolerance { mean: 0.24, ..all }, Tolerance { share: 0.49, ..all }]
    {
        compare(&other, &one, &tolerance).unwrap_err();
    }
}

fn wrong_size_fails() {
    let folder = Folder::with_golden(&["image.size=[192, 191]"]);
    fails(folder.run("wrong-size", &[], GOLDEN), "wrong size: 192x192 with 3 channels, expected 192x191");
}

fn a_missing_golden_fails_and_is_not_written() {
    let folder = Folder::new();
    fails(folder.run("missing", &[], GOLDEN), "there is no golden");
    assert!(!folder.path("golden.png").exists());
}

fn blessing_writes_and_fails() {
    let folder = Folder::new();
    let actual = draw(&[]);
    let wanted = Golden { max: 2.0, mean: 0.05, why: String::new() };
    let written = golden::check(&actual, &wanted, &file(folder.folder.path()), &driver(), true).unwrap();
    assert!(matches!(written, GoldenResult::Written(_)), "{written:?}");
    against_golden(&actual, folder.folder.path(), &wanted).unwrap();
}

fn a_golden_of_another_driver_says_so() {
    let folder = Folder::with_golden(&[]);
    let mut other = golden::read(&folder.path("golden.png")).unwrap();
    let wanted = Golden { max: 2.0, mean: 0.05, why: String::new() };
    let said = against_golden(&other, folder.folder.path(), &wanted).unwrap();
    assert!(
        said.starts_with("compared with the golden of this driver, by 2/255 at most and 0.05/255 in the mean: 0 of"),
        "{said}"
    );
    fs::write(folder.path("golden.driver"), "llvmpipe of another day\n").unwrap();
    other.data[0] = 1.0 - other.data[0].round();
    let said = against_golden(&other, folder.folder.path(), &wanted).unwrap();
    let how = "compared with the golden of another driver, llvmpipe of another day, by 0.75/255 in the mean and 0.6 % of \
               the pixels beyond 16/255: 1 of";
    assert!(said.starts_with(how), "{said}");
    other.data.fill(1.0);
    let error = against_golden(&other, folder.folder.path(), &wanted).unwrap_err();
    assert!(error.contains("of another driver, llvmpipe of another day"), "{error}");
}

/// The box's shadow and one of nine pixels are too small for the mean; a rim as long as the picture is wide is none.
fn a_shadow_that_vanishes_fails_against_the_golden_of_another_driver() {
    let folder = Folder::with_golden(&[]);
    fs::write(folder.path("golden.driver"), "llvmpipe of another day\n").unwrap();
    let golden = golden::read(&folder.path("golden.png")).unwrap();
    let wanted = Golden { max: 2.0, mean: 0.05, why: String::new() };
    let check = |picture: &Raster| against_golden(picture, folder.folder.path(), &wanted);
    let dotted = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
        let mut picture = golden.clone();
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let first = 3 * (y * 192 + x);
            picture.data[first..first + 3].iter_mut().for_each(|value| *value = if *value > 0.5 { 0.3 } else { 0.7 });
        }
        picture
    };
    check(&dotted(0..192, 100..101)).unwrap();
    let error = check(&dotted(90..93, 100..103)).unwrap_err();
    assert!(error.contains("a spot at (90, 100) differs as a whole"), "{error}");
    let error = check(&dotted(0..192, 100..102)).unwrap_err();
    assert!(error.contains("at most 0.600 % may"), "{error}");
    let small = ["object.1.scale=0.12", "object.1.translate=[0, 0.06, 0]"].map(String::from);
    let with = draw(&small);
    with.write_png(&folder.path("golden.png")).unwrap();
    let set = [&small[..], &[NO_SHADOW.to_owned()]].concat();
    let without = draw(&set);
    let error = check(&without).unwrap_err();
    assert!(error.contains("differs as a whole"), "{error}");
    let mean = compare(&without, &with, &Tolerance { max: 1.0, mean: 0.75 / 255.0, share: 1.0, ..Tolerance::EXACT });
    mean.expect("small enough that the mean does not show it");
}

const NO_SHADOW: &str = "light.shadow={ technique = \"none\" }";
const MIRRORED: &str = "light.position=[2.0, 5.0, 1.5]";

fn shadows_switched_off_fail_against_the_golden() {
    fails(Folder::with_golden(&[]).run("no-shadow", &[NO_SHADOW], GOLDEN), "differ");
}

fn the_light_mirrored_fails_against_the_golden() {
    fails(Folder::with_golden(&[]).run("mirrored-light", &[MIRRORED], GOLDEN), "differ");
}

const EDGE: &str = "[[edge]]\ncaster = [0.5, 1, 0]\noutward = [1, 0, 0]\nwhy = \"\"\n";
const PICK: &str = "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"shadowed\"\nwhy = \"\"\n";
const FORMULA: &str =
    "[[pick]]\nat = [0.8, 0, -0.4]\nformula = { normal = [0, 1, 0], object = 0, shade = [0] }\nwhy = \"\"\n";

fn shadows_switched_off_fail_by_formula() {
    for (index, checks) in [EDGE, PICK, FORMULA].into_iter().enumerate() {
        Folder::new().run("formula", &[], checks).unwrap();
        Folder::new().run(&format!("formula-{index}"), &[NO_SHADOW], checks).unwrap_err();
    }
}

fn the_light_mirrored_fails_by_formula() {
    for (index, checks) in [PICK, FORMULA].into_iter().enumerate() {
        Folder::new().run(&format!("formula-mirrored-{index}"), &[MIRRORED], checks).unwrap_err();
    }
}

fn a_relation_that_does_not_hold_fails() {
    let checks = "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.size=128\"]]\nexact = true\nwhy = \"\"\n";
    fails(Folder::new().run("relation", &[], checks), "none may");
}

fn an_error_that_does_not_come_fails() {
    fails(Folder::new().run("no-error", &[], "fails_with = \"x\"\n"), "the scene draws");
    let folder = Folder::new();
    fails(folder.run("other-error", &["light.cone=0"], "fails_with = \"unheard of\"\n"), "without \"unheard of\"");
}
