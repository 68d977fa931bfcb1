//! Textures that statements of MTL name.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::map_options::Values;
use super::{Placement, Texture, texture};

/// A texture that a material names.
#[derive(Debug)]
pub(super) struct Map {
    pub material: usize,
    pub statement: Statement,
    /// The library's file and line.
    pub path: PathBuf,
    pub line: usize,
    pub placement: Placement,
    pub values: Values,
    /// The file as written.
    pub written: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Statement {
    Decal,
    Alpha,
    /// Ignored: most files name map_Kd's picture here too, and the decal modulates ambient light.
    Ambient,
}

impl Statement {
    pub fn name(self) -> &'static str {
        match self {
            Self::Decal => "map_Kd",
            Self::Alpha => "map_d",
            Self::Ambient => "map_Ka",
        }
    }

    /// Names what is drawn if its texture is missing.
    pub fn without(self) -> &'static str {
        match self {
            Self::Alpha => "the surface has no holes",
            Self::Decal | Self::Ambient => "the plain colour is drawn",
        }
    }
}

/// The textures of a library, each loaded once for each change of its values.
#[derive(Default)]
pub(super) struct LoadedMaps {
    pictures: HashMap<PathBuf, Result<Arc<Texture>, String>>,
    changed: Vec<(PathBuf, Statement, Values, Arc<Texture>)>,
}

impl LoadedMaps {
    /// The texture of a map, or why there is none.
    pub fn texture(&mut self, map: &Map) -> Result<Arc<Texture>, String> {
        let found = map.find().ok_or_else(|| format!("there is no file '{}'", map.written))?;
        let load = || texture::load_texture(&found).map(Arc::new).map_err(|error| error.to_string());
        let picture = self.pictures.entry(found.clone()).or_insert_with(load).clone()?;
        if map.values == Values::default() {
            return Ok(picture);
        }
        let is_known = |known: &&(PathBuf, Statement, Values, Arc<Texture>)| {
            (&known.0, known.1, known.2) == (&found, map.statement, map.values)
        };
        if let Some((.., texture)) = self.changed.iter().find(is_known) {
            return Ok(texture.clone());
        }
        let texture = Arc::new(match map.statement {
            Statement::Alpha => map.values.of_scalar(&picture),
            Statement::Decal | Statement::Ambient => map.values.of_color(&picture),
        });
        self.changed.push((found, map.statement, map.values, texture.clone()));
        Ok(texture)
    }
}

impl Map {
    pub fn find(&self) -> Option<PathBuf> {
        texture::find_file(self.path.parent().unwrap_or(Path::new("")), &self.written)
    }
}
