//! `case.toml`: the keys of a pixel test. Unknown keys are refused; every check says why it must hold.
//!
//! These comments are the reference: the table of `data/cases/README.md` is written from them.

use std::path::PathBuf;

use serde::Deserialize;

/// Sets of overrides.
pub type Sets = Vec<Vec<String>>;

/// The whole file. Checks are made in this order.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checks {
    /// The one question that the case asks.
    pub asks: String,
    /// The scene's file, relative to the case's folder; `scene.toml` where absent.
    #[serde(default = "own_scene")]
    pub scene: PathBuf,
    /// Overrides, as `--set` takes them, before those of each check.
    #[serde(default)]
    pub set: Vec<String>,
    /// Every check is made with each of these, after `set`.
    pub for_each: Option<Sets>,
    /// A command that draws in place of glumbra: its program and arguments, with placeholders in braces.
    pub render: Option<Vec<String>>,
    /// The scene is refused with an error that has this text. No other check can stand beside it: nothing is drawn.
    pub fails_with: Option<String>,
    /// A warning that has this text is given.
    pub warns: Option<String>,
    /// Something is left out, in words that have this text.
    pub leaves_out: Option<String>,
    /// Pixels with a known answer.
    #[serde(default)]
    pub pick: Vec<Pick>,
    /// Points of a shadow's outline, by central projection.
    #[serde(default)]
    pub edge: Vec<Edge>,
    /// Ends of the light's reach.
    #[serde(default)]
    pub cone: Vec<Cone>,
    /// Shares of the pixels that are of one class.
    #[serde(default)]
    pub count: Vec<ClassCount>,
    /// Set-ups that must show the same.
    #[serde(default)]
    pub same: Vec<Same>,
    /// Nothing of what was drawn before may show.
    #[serde(default)]
    pub after: Vec<After>,
    /// Pictures that add up.
    #[serde(default)]
    pub sum: Vec<Sum>,
    /// Shadows against exact visibility, pixel by pixel.
    #[serde(default)]
    pub truth: Vec<TruthCheck>,
    /// A picture that was found right before.
    pub golden: Option<Golden>,
}

fn own_scene() -> PathBuf {
    PathBuf::from("scene.toml")
}

/// How much of a light arrives at a pixel, in words.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// All of the light arrives.
    Lit,
    /// None of the light arrives.
    Shadowed,
    /// Some of the light arrives: a filtered edge.
    Partial,
    /// No surface, or one that lies outside the light's cone or frustum.
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
    /// The light of `class` and `shade`, from 0.
    #[serde(default)]
    pub light: usize,
    /// Overrides, after the case's.
    #[serde(default)]
    pub set: Vec<String>,
    /// Once with each of these sets of overrides.
    pub for_each: Option<Sets>,
    /// How much of the light arrives, in words.
    pub class: Option<Class>,
    /// How much of the light arrives: 1 lit, 0 shadowed.
    pub shade: Option<f64>,
    /// The picture's colour, RGB in 255ths.
    pub color: Option<[f64; 3]>,
    /// The picture's colour by the illumination formula, at the pixel's centre on the plane through `at`.
    pub formula: Option<Formula>,
    /// The largest difference of `shade`, `color` and `formula`, in 255ths; 1 where absent.
    #[serde(default = "one")]
    pub within: f64,
    /// The reason why it must be so.
    pub why: String,
}

fn one() -> f64 {
    1.0
}

/// Facts that the formula cannot derive.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Formula {
    /// Normal of the surface at the point.
    pub normal: [f64; 3],
    /// Index of the object whose material it is.
    pub object: usize,
    /// Shade of each light: 1 lit, 0 shadowed.
    pub shade: Vec<f64>,
    /// Value of each light's image, where it has one.
    #[serde(default)]
    pub beam: Vec<[f64; 3]>,
    /// Value of the surface's own image.
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
    /// The floor's height, y; 0 where absent.
    #[serde(default)]
    pub floor: f64,
    /// Overrides, after the case's.
    #[serde(default)]
    pub set: Vec<String>,
    /// Once with each of these sets of overrides.
    pub for_each: Option<Sets>,
    /// The reason why it must be so.
    pub why: String,
}

/// A sphere of the world.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its middle in the world.
    pub center: [f64; 3],
    /// Its radius.
    pub radius: f64,
}

/// End of the light's reach on a horizontal floor, along a ray in it from below the light's target.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Direction of the ray, in the floor.
    pub towards: [f64; 3],
    /// The floor's height, y; 0 where absent.
    #[serde(default)]
    pub floor: f64,
    /// Overrides, after the case's.
    #[serde(default)]
    pub set: Vec<String>,
    /// Once with each of these sets of overrides.
    pub for_each: Option<Sets>,
    /// The reason why it must be so.
    pub why: String,
}

/// The share of the drawn and reached pixels that are of one class. `least` or `most` must exclude something.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClassCount {
    /// The light, from 0; 0 where absent.
    #[serde(default)]
    pub light: usize,
    /// The class that is counted.
    pub class: Class,
    /// The least share, from 0 to 1; 0 where absent.
    #[serde(default)]
    pub least: f64,
    /// The greatest share, from 0 to 1; 1 where absent.
    #[serde(default = "one")]
    pub most: f64,
    /// Overrides, after the case's.
    #[serde(default)]
    pub set: Vec<String>,
    /// Once with each of these sets of overrides.
    pub for_each: Option<Sets>,
    /// The reason why it must be so.
    pub why: String,
}

/// A picture that set-ups share: the picture, or a view as `--aov` has it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Of {
    /// The picture.
    Picture,
    /// How much of the light arrives.
    Shade,
    /// Depth from the camera.
    Depth,
    /// The light's depth map.
    LightDepth,
    /// Distance from the light.
    LightDistance,
}

/// Set-ups that must show the same.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Same {
    /// The pictures that are compared.
    pub of: Vec<Of>,
    /// Reference of the others: the case's scene with these overrides, and `frames` frames of it.
    #[serde(default)]
    pub with: Vec<String>,
    /// Overrides of the others.
    pub sets: Sets,
    /// Before `with` and before each of `sets`.
    pub for_each: Option<Sets>,
    /// The light of a view, from 0.
    #[serde(default)]
    pub light: usize,
    /// Another scene than the case's own for the others.
    pub scene: Option<PathBuf>,
    /// Frames that are drawn, 1 where absent; the last is compared.
    #[serde(default = "one_frame")]
    pub frames: u32,
    /// To the bit.
    #[serde(default)]
    pub exact: bool,
    /// Or by at most `max`, in at most this share of the pixels: a small difference anywhere, or any difference in a few
    /// pixels.
    pub max: Option<f64>,
    /// The share of the pixels, from 0 to 1.
    pub share: Option<f64>,
    /// The reason why it must be so.
    pub why: String,
}

fn one_frame() -> u32 {
    1
}

/// A renderer that has drawn other set-ups just before must draw the case's own as a new one does, to the bit.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct After {
    /// The pictures that are compared.
    pub of: Vec<Of>,
    /// Frames that are drawn before.
    pub firsts: Sets,
    /// The reason why it must be so.
    pub why: String,
}

/// Float pictures that add up: the case's own = the sum of `plus` less the sum of `minus`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sum {
    /// Overrides of each picture that is added.
    pub plus: Sets,
    /// Overrides of each picture that is taken away.
    #[serde(default)]
    pub minus: Sets,
    /// The largest difference of any channel, where 1 is white.
    pub max: f64,
    /// The reason why it must be so.
    pub why: String,
}

/// The shade of a light against exact visibility, which rays find from the scene alone. Percentages are of the pixels that
/// both show and of which the truth is certain.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TruthCheck {
    /// The light, from 0; 0 where absent.
    #[serde(default)]
    pub light: usize,
    /// The greatest percentage that is lit and drawn dark: acne, and light lost at edges. 0 where absent.
    #[serde(default)]
    pub false_shadow: f64,
    /// The greatest percentage that is in shadow and drawn lit; 0 where absent.
    #[serde(default)]
    pub leak: f64,
    /// The greatest percentage that is wrong outside `bound` or `band`; 0 where absent.
    #[serde(default)]
    pub outside_band: f64,
    /// The greatest mean distance, in pixels, from true shadow edges to the nearest that are drawn: it finds shadows that lie
    /// slightly aside.
    pub edge: Option<f64>,
    /// Wrong pixels that count as inside: by default those that the technique's own map explains, and of a command those
    /// of `band` = 3.
    pub bound: Option<MayBeWrong>,
    /// Or those so many pixels from a true shadow edge.
    pub band: Option<f64>,
    /// Overrides, after the case's.
    #[serde(default)]
    pub set: Vec<String>,
    /// Once with each of these sets of overrides.
    pub for_each: Option<Sets>,
    /// The reason why it must be so.
    pub why: String,
}

/// Renderers by where they may be wrong.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum MayBeWrong {
    /// Within the texels of the scene's map, the reach of its filter, and the reach of its bias.
    Technique,
    /// Nowhere: every wrong pixel counts as outside.
    Exact,
}

/// `golden.png`, in 255ths, on the driver that drew it. On another one a tolerance of all goldens holds: `golden.rs`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Golden {
    /// The largest difference of any channel, in 255ths.
    pub max: f64,
    /// The mean difference of all channels, in 255ths.
    pub mean: f64,
    /// The reason why it must be so.
    pub why: String,
}
