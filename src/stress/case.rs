//! A case: a scene file as text and the files that it names, so that it can be saved, changed and loaded anywhere.

use std::fs;
use std::path::{Path, PathBuf};

use crate::scene::{self, Loaded};

/// Where a case comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaseSource {
    /// The table of extreme cases.
    Named,
    /// A seed.
    Random,
    /// A file that was given: what its loader warned of excuses no wrong picture of what it did load.
    File,
}

/// A scene to be drawn in every way.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Unique in a run; part of file names.
    pub name: String,
    pub source: CaseSource,
    /// Extreme property of the scene.
    pub why: String,
    /// The scene file.
    pub toml: String,
    /// Changes to it, as `--set` takes them.
    pub set: Vec<String>,
    /// Names of the built-in meshes and pictures that the scene names.
    pub files: Vec<&'static str>,
    /// Mesh files made for this case, each with its name.
    pub made: Vec<(String, Vec<u8>)>,
    /// Insides of `[light.shadow]` to draw; empty: every technique's rows.
    pub rows: Vec<String>,
    /// True if each light's shade is judged, by the rows.
    pub shades: bool,
    /// True if the picture's colours are judged.
    pub colors: bool,
    /// The stiff parameter that the case varies, and its value.
    pub sweep: Option<(String, f64)>,
    /// True if the scene cannot be drawn, and must be refused.
    pub refused: bool,
    /// Reason why the scene was refused before there was a text of it.
    pub refusal: Option<String>,
}

macro_rules! files {
    ($($name:literal at $path:literal),* $(,)?) => {
        /// Meshes and pictures that cases name, with their bytes.
        pub static FILES: &[(&str, &[u8])] =
            &[$(($name, include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/", $path))) ),*];
    };
}

files! {
    "open_box.obj" at "stress/meshes/open_box.obj",
    "inward_box.obj" at "stress/meshes/inward_box.obj",
    "doubled_box.obj" at "stress/meshes/doubled_box.obj",
    "mixed_box.obj" at "stress/meshes/mixed_box.obj",
    "flat_box.obj" at "stress/meshes/flat_box.obj",
    "both_sides.obj" at "stress/meshes/both_sides.obj",
    "fins.obj" at "stress/meshes/fins.obj",
    "t_junction.obj" at "stress/meshes/t_junction.obj",
    "moebius.obj" at "stress/meshes/moebius.obj",
    "slivers.obj" at "stress/meshes/slivers.obj",
    "soup.obj" at "stress/meshes/soup.obj",
    "tetrahedron.obj" at "stress/meshes/tetrahedron.obj",
    "crossed.obj" at "stress/meshes/crossed.obj",
    "nested_256.obj" at "stress/meshes/nested_256.obj",
    "nested_300.obj" at "stress/meshes/nested_300.obj",
    "fence.png" at "meshes/fence.png",
    "floor.png" at "textures/floor.png",
    "barn-doors.png" at "textures/barn-doors.png",
}

/// The files of [`FILES`] that a scene's text names.
pub fn files_named_in(toml: &str) -> Vec<&'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| toml.contains(&format!("\"{name}\""))).collect()
}

impl Case {
    /// Writes the scene, with all changes in it, and its files into `folder`, which is there. Returns the scene file's path.
    ///
    /// # Errors
    ///
    /// A change that does not fit the scene, or a file that cannot be written, as a sentence.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, String> {
        let made = self.made.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
        let named = FILES.iter().filter(|(name, _)| self.files.contains(name)).copied();
        let path = folder.join(format!("{}.toml", self.name));
        let files = named.chain(made).map(|(name, bytes)| (folder.join(name), bytes));
        for (path, bytes) in files.chain([(path.clone(), self.toml.as_bytes())]) {
            write(&path, bytes)?;
        }
        if !self.set.is_empty() {
            let changed = scene::settings(&path, &self.set).map_err(|error| error.to_string())?;
            write(&path, changed.to_toml().as_bytes())?;
        }
        Ok(path)
    }

    /// The scene file with all changes in it, before it is resolved.
    ///
    /// # Errors
    ///
    /// As [`Case::write`].
    pub fn settings(&self, folder: &Path) -> Result<scene::Settings, String> {
        scene::settings(&self.write(folder)?, &[]).map_err(|error| error.to_string())
    }

    /// Loads the scene by way of files in `folder`, a folder for this purpose alone.
    ///
    /// # Errors
    ///
    /// Reason why the scene is refused, or a file cannot be written, as a sentence.
    pub fn load(&self, folder: &Path) -> Result<Loaded, String> {
        crate::techniques::load(&self.write(folder)?, &[]).map_err(|error| error.to_string())
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(path, bytes).map_err(|error| format!("{}: cannot be written: {error}", path.display()))
}

/// The value of a key of three numbers.
pub(super) fn vector(toml: &str, key: &str) -> Option<glam::DVec3> {
    let inside = toml.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = [")?.strip_suffix(']'))?;
    let numbers: Vec<f64> = inside.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    Some(glam::DVec3::from_slice(numbers.get(..3)?))
}
