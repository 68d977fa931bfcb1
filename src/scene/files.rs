//! The files that a scene's text names, by paths that hold from any folder.

use std::path::{Path, PathBuf};

use super::assets::{file, split_part};
use super::settings::{Settings, Value};
use super::{Error, Origin};
use crate::geometry;

/// The keys that name files, by the tables that have them.
const KEYS: [(&str, &str); 11] = [
    ("light", "image"),
    ("light.beam", "shield"),
    ("object", "instances"),
    ("object", "mesh"),
    ("object.material", "decal"),
    ("object.material", "alpha"),
    ("object.material", "gloss"),
    ("object.material.bump", "height"),
    ("object.material.bump", "normal_map"),
    ("object.material.photo", "image"),
    ("shading", "combiners"),
];

/// Makes each file's name an absolute path. `model`: the file around which the scene is supplied, which is named as it was
/// given.
pub(super) fn make_absolute(table: &mut Settings, model: Option<&Path>) -> Result<(), Error> {
    let path = table.path.clone();
    for (key, entry) in &mut table.entries {
        let names_file = KEYS.contains(&(path.as_str(), key.as_str()));
        match &mut entry.value {
            Value::String(name) if names_file && !is_primitive(key, name) && !is_decal_alpha(key, name) => {
                let found = match (&entry.origin, model) {
                    (Origin::BuiltIn, Some(model)) => model.to_owned(),
                    (origin, _) => file(name, origin),
                };
                *name = absolute(&found)?;
            }
            Value::Table(inner) => make_absolute(inner, model)?,
            Value::Array(items) => {
                for item in items {
                    if let Value::Table(inner) = &mut item.value {
                        make_absolute(inner, model)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn is_primitive(key: &str, name: &str) -> bool {
    key == "mesh" && geometry::PRIMITIVES.contains(&name)
}

fn is_decal_alpha(key: &str, name: &str) -> bool {
    key == "gloss" && name == "decal-alpha"
}

fn absolute(path: &Path) -> Result<String, Error> {
    if let Some((file, Some(part))) = path.to_str().map(split_part) {
        return Ok(format!("{}#{part}", absolute(Path::new(file))?));
    }
    let absolute: PathBuf = path.canonicalize().map_err(|reason| Error::Read { path: path.to_owned(), reason })?;
    absolute.into_os_string().into_string().map_err(|path| Error::NoText { path: path.into() })
}
