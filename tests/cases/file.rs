//! `case.toml`: what must be seen of a scene. Unknown keys are refused; every check says why.
//!
//! `for_each` repeats a check, or in the head of the file the whole case, with each of several sets of overrides:
//!
//! ```toml
//! for_each = [["light.shadow.bias=adaptive"], ["light.shadow.bias=normal-offset", "light.shadow.size=1024"]]
//! ```
//!
//! Overrides are applied in this order: `set` of the case, a set of the case's `for_each`, a set of the check's
//! `for_each`, `set` of the check. An error names the sets with which it came.

use std::path::{Path, PathBuf};

use serde::Deserialize;

/// A case folder, read.
#[derive(Clone, Debug)]
pub struct Case {
    pub folder: PathBuf,
    /// `technique/case`, or a name of a test's own.
    pub name: String,
    pub checks: Checks,
    /// The set of the case's `for_each` that is part of `checks.set`.
    pub variant: Option<Vec<String>>,
}

impl Case {
    /// Reads `folder/case.toml`.
    pub fn read(folder: &Path, name: &str) -> Result<Self, String> {
        let path = folder.join("case.toml");
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let checks = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(Self { folder: folder.to_owned(), name: name.to_owned(), checks, variant: None })
    }

    /// The case once for each set of its `for_each`; itself where it has none.
    pub fn variants(&self) -> Vec<Self> {
        let Some(sets) = &self.checks.for_each else { return vec![self.clone()] };
        let with = |set: &Vec<String>| {
            let mut case = Self { variant: Some(set.clone()), ..self.clone() };
            case.checks.set.extend_from_slice(set);
            case
        };
        sets.iter().map(with).collect()
    }

    /// The scene's file.
    pub fn scene(&self) -> PathBuf {
        self.folder.join(&self.checks.scene)
    }
}

/// Sets of overrides.
pub type Sets = Vec<Vec<String>>;

/// The file. Checks are made in this order.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checks {
    /// The one question that the case asks.
    pub asks: String,
    /// Relative to the case's folder.
    #[serde(default = "own_scene")]
    pub scene: PathBuf,
    /// Overrides, as `--set` takes them, before those of each check.
    #[serde(default)]
    pub set: Vec<String>,
    /// Every check is made with each of these, after `set`.
    pub for_each: Option<Sets>,
    /// The scene is refused with an error that has this text. No other check can stand beside it: nothing is drawn.
    pub fails_with: Option<String>,
    /// A warning that has this text is given.
    pub warns: Option<String>,
    /// Something is left out, in words that have this text.
    pub leaves_out: Option<String>,
    #[serde(default)]
    pub pick: Vec<Pick>,
    #[serde(default)]
    pub edge: Vec<Edge>,
    #[serde(default)]
    pub cone: Vec<Cone>,
    #[serde(default)]
    pub count: Vec<Count>,
    #[serde(default)]
    pub same: Vec<Same>,
    #[serde(default)]
    pub after: Vec<After>,
    #[serde(default)]
    pub sum: Vec<Sum>,
    pub golden: Option<Golden>,
}

fn own_scene() -> PathBuf {
    PathBuf::from("scene.toml")
}

/// Value of the shade view at a pixel.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    Lit,
    Shadowed,
    Partial,
    Outside,
}

/// One pixel with a known answer.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pick {
    /// A point of the world; the test finds its pixel.
    pub at: Option<[f64; 3]>,
    /// Or the pixel itself, from the top left.
    pub pixel: Option<[u32; 2]>,
    #[serde(default)]
    pub light: usize,
    #[serde(default)]
    pub set: Vec<String>,
    pub for_each: Option<Sets>,
    pub class: Option<Class>,
    pub shade: Option<f64>,
    /// RGB in 255ths.
    pub color: Option<[f64; 3]>,
    /// The illumination formula at the pixel's centre on the plane through `at`.
    pub formula: Option<Formula>,
    /// In 255ths.
    #[serde(default = "one")]
    pub within: f64,
    pub why: String,
}

fn one() -> f64 {
    1.0
}

/// Facts that the formula cannot derive.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Formula {
    pub normal: [f64; 3],
    /// Index of the object whose material it is.
    pub object: usize,
    /// Shade of each light: 1 lit, 0 shadowed.
    pub shade: Vec<f64>,
    /// Value of each light's image, where it has one.
    #[serde(default)]
    pub beam: Vec<[f64; 3]>,
    #[serde(default = "white")]
    pub decal: [f64; 3],
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

/// The shadow of one point of a caster's silhouette on a horizontal floor, by central projection from the light: shadowed
/// towards the shadow's middle, lit away from it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Edge {
    /// The point of the silhouette.
    pub caster: Option<[f64; 3]>,
    /// Or the sphere that has it.
    pub sphere: Option<Sphere>,
    /// Away from the shadow, in the floor.
    pub outward: [f64; 3],
    #[serde(default)]
    pub floor: f64,
    #[serde(default)]
    pub set: Vec<String>,
    pub for_each: Option<Sets>,
    pub why: String,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    pub center: [f64; 3],
    pub radius: f64,
}

/// End of the light's reach on a horizontal floor, along a ray in it from below the light's target.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    pub towards: [f64; 3],
    #[serde(default)]
    pub floor: f64,
    #[serde(default)]
    pub set: Vec<String>,
    pub for_each: Option<Sets>,
    pub why: String,
}

/// The share of the drawn and reached pixels that are of one class. `least` or `most` must exclude something.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Count {
    #[serde(default)]
    pub light: usize,
    pub class: Class,
    #[serde(default)]
    pub least: f64,
    #[serde(default = "one")]
    pub most: f64,
    #[serde(default)]
    pub set: Vec<String>,
    pub for_each: Option<Sets>,
    pub why: String,
}

/// A picture that set-ups share.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Of {
    Picture,
    Shade,
    Depth,
    LightDepth,
    LightDistance,
}

/// Set-ups that must show the same.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Same {
    pub of: Vec<Of>,
    /// Reference of the others: the case's scene with these overrides, and `frames` frames of it.
    #[serde(default)]
    pub with: Vec<String>,
    pub sets: Sets,
    /// Before `with` and before each of `sets`.
    pub for_each: Option<Sets>,
    #[serde(default)]
    pub light: usize,
    /// Another scene than the case's own for the others.
    pub scene: Option<PathBuf>,
    #[serde(default = "one_frame")]
    pub frames: u32,
    /// To the bit.
    #[serde(default)]
    pub exact: bool,
    /// Or by at most `max`, in at most this share of the pixels: a small difference anywhere, or any difference in a few
    /// pixels.
    pub max: Option<f64>,
    pub share: Option<f64>,
    pub why: String,
}

fn one_frame() -> u32 {
    1
}

/// A renderer that has drawn other set-ups just before must draw the case's own as a new one does, to the bit.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct After {
    pub of: Vec<Of>,
    /// Frames that are drawn before.
    pub firsts: Sets,
    pub why: String,
}

/// Float pictures that add up: the case's own = the sum of `plus` less the sum of `minus`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sum {
    pub plus: Sets,
    #[serde(default)]
    pub minus: Sets,
    pub max: f64,
    pub why: String,
}

/// `golden.png`, in 255ths, on the driver that drew it. On another one a tolerance of all goldens holds: `golden.rs`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Golden {
    pub max: f64,
    pub mean: f64,
    pub why: String,
}
