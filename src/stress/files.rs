//! Cases from files that are given: a model with lights put around it, or a scene with its own.

use std::path::Path;

use glam::DVec3;

use super::case::{Case, CaseSource};
use crate::math::Aabb;
use crate::scene::{self, Loaded, Scene, Settings, Value};
use crate::techniques;

/// Size of the pictures, in pixels, where none is wanted: that of the random scenes.
const SIZE: [u32; 2] = [160, 120];

/// Parts of an animation's length at which a model is drawn, beside how it stands.
const TIMES: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];

/// Places of the lights around a model in radii from its middle: a lamp to all sides, and a spotlight that stands low and near.
const LAMP: DVec3 = DVec3::new(0.9, 1.7, 0.4);
const LOW_SPOT: DVec3 = DVec3::new(1.6, 0.8, -1.2);
/// Direction of the sun's light.
const SUN: DVec3 = DVec3::new(-0.7, -1.0, 0.5);

/// Changes of the files' scenes.
#[derive(Clone, Debug, Default)]
pub struct FileChanges {
    /// Size of the pictures in pixels; `None`: 160 × 120.
    pub size: Option<[u32; 2]>,
    /// Changes of each scene, as `--set` takes them.
    pub set: Vec<String>,
    /// Times of the first animation in seconds; empty: as the file stands and, if it has an animation, at a third and two
    /// thirds of its length.
    pub at: Vec<f64>,
}

/// Cases of a file, one for each time, and its loader's warnings. A file that cannot be loaded is a case that says why.
pub fn cases(path: &Path, changes: &FileChanges) -> (Vec<Case>, Vec<String>) {
    let times = match changes.at.is_empty() {
        // A file that is refused has no length: its case says why.
        true => times_of(scene::model_seconds(path).unwrap_or(0.0)),
        false => changes.at.iter().map(|seconds| Some(*seconds)).collect(),
    };
    let mut warnings = Vec::new();
    let mut case = |seconds: &Option<f64>| {
        let plain = plain_case(path, *seconds);
        match scene_of(path, changes, *seconds) {
            Ok((toml, said)) => {
                warnings.extend(said.into_iter().filter(|said| !warnings.contains(said)).collect::<Vec<_>>());
                Case { toml, ..plain }
            }
            Err(why) => Case { refusal: Some(why), refused: true, ..plain },
        }
    };
    let cases = times.iter().map(&mut case).collect();
    (cases, warnings)
}

fn times_of(length: f64) -> Vec<Option<f64>> {
    let moving = TIMES.iter().filter(|_| length > 0.0).map(|part| Some(part * length));
    std::iter::once(None).chain(moving).collect()
}

fn plain_case(path: &Path, seconds: Option<f64>) -> Case {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let time = seconds.map_or(String::new(), |seconds| format!("@{seconds:.3}"));
    Case {
        // Part of a file's name.
        name: format!("{file}{time}").replace(|c: char| c.is_control() || "/\\:*?\"<>|".contains(c), "_"),
        source: CaseSource::File,
        why: path.display().to_string(),
        toml: String::new(),
        set: Vec::new(),
        files: Vec::new(),
        made: Vec::new(),
        rows: Vec::new(),
        shades: true,
        colors: true,
        sweep: None,
        refused: false,
        refusal: None,
    }
}

/// The scene's text with absolute paths, and its loader's warnings.
fn scene_of(path: &Path, changes: &FileChanges, seconds: Option<f64>) -> Result<(String, Vec<String>), String> {
    let [width, height] = changes.size.unwrap_or(SIZE);
    let mut overrides = vec![format!("image.size=[{width}, {height}]")];
    overrides.extend(seconds.map(|seconds| format!("at={}", Value::Float(seconds).to_toml())));
    overrides.extend(changes.set.iter().cloned());
    let settings = scene::portable_settings(path, &overrides).map_err(|error| error.to_string())?;
    let Loaded { scene, warnings, .. } = techniques::load(path, &overrides).map_err(|error| error.to_string())?;
    let mut toml = settings.to_toml();
    if scene::is_model(path) {
        toml.push_str(&lights_around(&bounds(&scene, &settings)));
    } else if scene.lights.is_empty() {
        return Err(format!("{}: has no light, and so no shadow to judge", path.display()));
    }
    Ok((toml, warnings))
}

/// Bounds of the model without the floor that is supplied under it.
fn bounds(scene: &Scene, settings: &Settings) -> Aabb {
    let tables = match settings.get("object").map(|entry| &entry.value) {
        Some(Value::Array(tables)) => tables.len(),
        _ => 1,
    };
    let supplied = tables.saturating_sub(1);
    let own = &scene.objects[..scene.objects.len().saturating_sub(supplied)];
    own.iter().map(|object| object.world_bounds()).reduce(Aabb::union).unwrap_or(Aabb::EMPTY)
}

/// Lights of every kind around a model, as text of a scene file.
fn lights_around(bounds: &Aabb) -> String {
    let (middle, radius) = (bounds.center(), 0.5 * (bounds.max - bounds.min).length());
    let place = |radii: DVec3| (middle + radius * radii).to_array();
    let [lamp, low, middle] = [place(LAMP), place(LOW_SPOT), middle.to_array()];
    let sun = SUN.to_array();
    let shadow = "shadow = { technique = \"shadow-map\" }";
    format!(
        "\n[[light]]\nname = \"lamp\"\nkind = \"point\"\nposition = {lamp:?}\n{shadow}\n\
         \n[[light]]\nname = \"sun\"\nkind = \"directional\"\ndirection = {sun:?}\n{shadow}\n\
         \n[[light]]\nname = \"low spot\"\nkind = \"spot\"\nposition = {low:?}\ntarget = {middle:?}\ncone = 80\n\
         shape = \"cone\"\n{shadow}\n"
    )
}
