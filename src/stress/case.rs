//! A case: a scene file as text and the files that it names, so that it can be saved, changed and loaded anywhere.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::scene::{self, Loaded};

/// A scene to be drawn in every way.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Unique in a run; part of file names.
    pub name: String,
    /// The scene file.
    pub toml: String,
    /// Changes to it, as `--set` takes them.
    pub set: Vec<String>,
    /// Names of the meshes and pictures of [`FILES`] that the scene names.
    pub files: Vec<&'static str>,
    /// The stiff parameter that the case varies, and its value.
    pub sweep: Option<(String, f64)>,
    /// Whether the scene cannot be drawn, and must be refused.
    pub refused: bool,
    /// Whether each technique is drawn with its default settings alone.
    pub defaults: bool,
}

macro_rules! files {
    ($($name:literal at $path:literal),* $(,)?) => {
        /// Meshes and pictures that cases name, with their bytes.
        pub const FILES: &[(&str, &[u8])] =
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
    "fence.png" at "meshes/fence.png",
}

/// The files of [`FILES`] that a scene's text names.
pub fn files_named_in(toml: &str) -> Vec<&'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| toml.contains(&format!("\"{name}\""))).collect()
}

impl Case {
    /// Writes the scene and its files into `folder`, which is there. Returns the scene file's path.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path) -> io::Result<PathBuf> {
        for (name, bytes) in FILES.iter().filter(|(name, _)| self.files.contains(name)) {
            let path = folder.join(name);
            if !path.exists() {
                fs::write(path, bytes)?;
            }
        }
        let path = folder.join(format!("{}.toml", self.name));
        fs::write(&path, &self.toml)?;
        Ok(path)
    }

    /// Loads the scene by way of files in `folder`, a folder for this purpose alone.
    ///
    /// # Errors
    ///
    /// Why the scene is refused, or why a file cannot be written, as a sentence.
    pub fn load(&self, folder: &Path) -> Result<Loaded, String> {
        let path = self.write(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        scene::load(&path, &self.set).map_err(|error| error.to_string())
    }
}
