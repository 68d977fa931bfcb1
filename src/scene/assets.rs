//! The files that a scene names: each is loaded once however often it is used, and its loader's warnings are kept.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Error;
use super::settings::{Origin, SettingsError, suggest};
use crate::geometry::{self, Mesh, Texture};

/// Files in memory, each by its name.
type Files = &'static [(&'static str, &'static [u8])];

/// Meshes and textures loaded so far.
#[derive(Default)]
pub(super) struct Assets {
    /// Meshes by built-in name, or by the file's canonical path.
    meshes: HashMap<PathBuf, Arc<Mesh>>,
    textures: HashMap<PathBuf, Arc<Texture>>,
    /// Pictures and OBJ files in memory, by the names that the scene file has for them.
    pictures: Files,
    models: Files,
    /// Warnings of the loaders and of the scene, each once.
    pub warnings: Vec<String>,
}

impl Assets {
    /// Assets with pictures and OBJ files in memory, each by its name in the scene file.
    pub fn with_files(pictures: Files, models: Files) -> Self {
        Self { pictures, models, ..Self::default() }
    }

    /// A built-in mesh, or one of a file named from `origin`.
    pub fn mesh(&mut self, name: &str, origin: &Origin) -> Result<Arc<Mesh>, Error> {
        if let Some(mesh) = self.primitive(name) {
            return Ok(mesh);
        }
        let path = file(name, origin);
        if !has_extension(&path, "obj") {
            let hint = suggest(name, geometry::PRIMITIVES.iter().copied());
            let message = format!("no mesh \"{name}\": neither built in ({hint}) nor a file that ends in .obj");
            return Err(SettingsError::new(origin, message).into());
        }
        self.model_in(&path, embedded(self.models, name, origin))
            .map_err(|source| Error::Asset { origin: origin.clone(), source })
    }

    /// Keeps a warning, once.
    pub fn warn(&mut self, warning: String) {
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// An OBJ file.
    pub fn model(&mut self, path: &Path) -> Result<Arc<Mesh>, geometry::Error> {
        self.model_in(path, None)
    }

    fn model_in(&mut self, path: &Path, embedded: Option<&[u8]>) -> Result<Arc<Mesh>, geometry::Error> {
        let key = canonical(path);
        if let Some(mesh) = self.meshes.get(&key) {
            return Ok(mesh.clone());
        }
        let (mesh, warnings) = match embedded {
            Some(bytes) => geometry::decode_obj(path, bytes)?,
            None => geometry::load_obj(path)?,
        };
        self.warnings.extend(warnings.iter().map(ToString::to_string));
        let mesh = Arc::new(mesh);
        self.meshes.insert(key, mesh.clone());
        Ok(mesh)
    }

    /// Registers a model under `name` too, for paths that are not UTF-8.
    pub fn also_known_as(&mut self, name: &str, mesh: &Arc<Mesh>) {
        self.meshes.insert(canonical(Path::new(name)), mesh.clone());
    }

    /// A picture file named from `origin`.
    pub fn texture(&mut self, name: &str, origin: &Origin) -> Result<Arc<Texture>, Error> {
        let path = file(name, origin);
        let key = canonical(&path);
        if let Some(texture) = self.textures.get(&key) {
            return Ok(texture.clone());
        }
        let texture = match embedded(self.pictures, name, origin) {
            Some(bytes) => geometry::decode_texture(&path, bytes),
            None => geometry::load_texture(&path),
        };
        let texture = Arc::new(texture.map_err(|source| Error::Asset { origin: origin.clone(), source })?);
        self.textures.insert(key, texture.clone());
        Ok(texture)
    }

    fn primitive(&mut self, name: &str) -> Option<Arc<Mesh>> {
        if let Some(mesh) = self.meshes.get(Path::new(name)) {
            return Some(mesh.clone());
        }
        let mesh = Arc::new(geometry::primitive(name)?);
        self.meshes.insert(PathBuf::from(name), mesh.clone());
        Some(mesh)
    }
}

/// The file in memory that a scene file names.
fn embedded(files: Files, name: &str, origin: &Origin) -> Option<&'static [u8]> {
    let by_the_file = matches!(origin, Origin::File { .. });
    files.iter().find(|(known, _)| by_the_file && *known == name).map(|(_, bytes)| *bytes)
}

/// A file's name is relative to the scene file that names it; on the command line, to the current folder.
pub(super) fn file(name: &str, origin: &Origin) -> PathBuf {
    match origin {
        Origin::File { path, .. } => path.parent().unwrap_or(Path::new("")).join(name),
        Origin::CommandLine(_) | Origin::BuiltIn => PathBuf::from(name),
    }
}

/// Path that identifies a file; absolute, so never a built-in's name.
fn canonical(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| Path::new("/").join(path))
}

/// Tests whether `path` ends in `.extension`, in whatever case.
pub(super) fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
