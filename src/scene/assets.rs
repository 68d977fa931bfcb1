//! The files that a scene names: each is loaded once however often it is used, and its loader's warnings are kept.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Error;
use super::settings::{Origin, SettingsError, suggest};
use crate::geometry::{self, Mesh, Texture};

/// Meshes and textures loaded so far.
#[derive(Default)]
pub(super) struct Assets {
    /// Meshes by built-in name, or by the file's canonical path.
    meshes: HashMap<PathBuf, Arc<Mesh>>,
    textures: HashMap<PathBuf, Arc<Texture>>,
    /// Pictures in memory, by the names that the scene file has for them.
    embedded: &'static [(&'static str, &'static [u8])],
    /// Warnings of the loaders and of the scene, each once.
    pub warnings: Vec<String>,
}

impl Assets {
    /// Assets with pictures in memory, each by its name in the scene file.
    pub fn with_pictures(embedded: &'static [(&'static str, &'static [u8])]) -> Self {
        Self { embedded, ..Self::default() }
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
        self.model(&path).map_err(|source| Error::Asset { origin: origin.clone(), source })
    }

    /// Keeps a warning, once.
    pub fn warn(&mut self, warning: String) {
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// An OBJ file.
    pub fn model(&mut self, path: &Path) -> Result<Arc<Mesh>, geometry::Error> {
        let key = canonical(path);
        if let Some(mesh) = self.meshes.get(&key) {
            return Ok(mesh.clone());
        }
        let (mesh, warnings) = geometry::load_obj(path)?;
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
        let texture = match self.embedded_picture(name, origin) {
            Some(bytes) => geometry::decode_texture(&path, bytes),
            None => geometry::load_texture(&path),
        };
        let texture = Arc::new(texture.map_err(|source| Error::Asset { origin: origin.clone(), source })?);
        self.textures.insert(key, texture.clone());
        Ok(texture)
    }

    fn embedded_picture(&self, name: &str, origin: &Origin) -> Option<&'static [u8]> {
        let by_the_file = matches!(origin, Origin::File { .. });
        self.embedded.iter().find(|(known, _)| by_the_file && *known == name).map(|(_, bytes)| *bytes)
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
