//! Keys of scene files: `glumbra keys` lists what may stand in one, data/scenes/keys.md is that list as a page, and
//! data/scenes/schema.json is it for editors.
//!
//! Which keys there are, and which values each may have, is recorded while scenes that have every table are read. What a
//! key is for, and what holds without it, stand in data/keys.toml; tests hold both lists together.

mod exemplars;
mod find;
mod schema;
mod show;

use serde::{Deserialize, Serialize};

pub use exemplars::EXEMPLARS;
pub use find::{NoSuchKey, find};
pub use schema::schema;
pub use show::{details, list, page};

use crate::scene::{self, ValueForm};
use crate::techniques;

/// The table whose keys shadow techniques read.
const SHADOW: &str = "light.shadow.";
/// The table that takes the keys of [light.shadow], which are not listed again.
const MAP: &str = "object.material.photo.map.";

/// A key of scene files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Key {
    /// The path, without numbers of lights, objects and cameras: `light.shadow.size`.
    pub key: String,
    /// Purpose.
    pub is: String,
    /// Values that it may have, in words.
    pub values: String,
    /// Meaning of its absence.
    pub absent: Absent,
    /// Shadow techniques that read it; empty: it is no key of `[light.shadow]`.
    pub read_by: Vec<&'static str>,
    /// The values' types and ranges, any of which may stand.
    #[serde(skip)]
    pub forms: Vec<ValueForm>,
}

/// Meaning of a key's absence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Absent {
    /// An error: its table needs it.
    Needed,
    /// As this value, in TOML.
    Default(String),
    /// As these words say.
    Words(String),
}

/// Fault of this program's own lists of keys.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Scene(#[from] scene::Error),
    #[error("data/keys.toml: {0}")]
    List(#[from] toml::de::Error),
    #[error("data/keys.toml: `{key}` {what}")]
    Row { key: String, what: &'static str },
}

/// A row of data/keys.toml.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    key: String,
    is: String,
    #[serde(default)]
    needed: bool,
    default: Option<String>,
    absent: Option<String>,
    values: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rows {
    keys: Vec<Row>,
}

/// Every key, in the order of data/keys.toml.
///
/// # Errors
///
/// A list that is no TOML, or that does not have the keys which are read: faults of this program.
pub fn table() -> Result<Vec<Key>, Error> {
    let rows: Rows = toml::from_str(include_str!("../../data/keys.toml"))?;
    let mut recorded = recorded()?;
    let mut table = Vec::with_capacity(rows.keys.len());
    for row in rows.keys {
        let Some(place) = recorded.iter().position(|(key, _)| *key == row.key) else {
            return Err(Error::Row { key: row.key, what: "is read by nothing" });
        };
        let (_, forms) = recorded.swap_remove(place);
        table.push(row.with_forms(forms)?);
    }
    match recorded.into_iter().next() {
        Some((key, _)) => Err(Error::Row { key, what: "is read, and has no row" }),
        None => Ok(table),
    }
}

impl Row {
    fn with_forms(self, forms: Vec<ValueForm>) -> Result<Key, Error> {
        let Self { key, is, needed, default, absent, values } = self;
        let absent = match (needed, default, absent) {
            (true, None, None) => Absent::Needed,
            (false, Some(value), None) => Absent::Default(value),
            (false, None, Some(words)) => Absent::Words(words),
            _ => return Err(Error::Row { key, what: "has not exactly one of `needed`, `default` and `absent`" }),
        };
        // Words stand where the code itself tells kinds of values apart: what is recorded is then a part of them.
        let forms = if values.is_some() { vec![ValueForm::Any] } else { forms };
        let values = values.unwrap_or_else(|| forms.iter().map(ValueForm::words).collect::<Vec<_>>().join(", or "));
        let read_by = readers(&key);
        Ok(Key { key, is, values, absent, read_by, forms })
    }
}

/// Names of the techniques that read a key of `[light.shadow]`; none of another table.
fn readers(key: &str) -> Vec<&'static str> {
    let Some(name) = key.strip_prefix(SHADOW).and_then(|path| path.split('.').next()) else { return Vec::new() };
    let reads = |row: &&&dyn techniques::Technique| name == "technique" || techniques::keys(**row).contains(&name);
    techniques::TABLE.iter().filter(reads).map(|row| row.name()).collect()
}

/// The keys that are read while every exemplar is loaded, each with its forms.
///
/// # Errors
///
/// An exemplar that cannot be loaded.
fn recorded() -> Result<Vec<(String, Vec<ValueForm>)>, scene::Error> {
    let (loaded, mut keys) =
        scene::record(|| EXEMPLARS.iter().try_for_each(|exemplar| techniques::load_embedded(exemplar, &[]).map(drop)));
    loaded?;
    keys.retain(|(key, _)| !key.starts_with(MAP));
    Ok(keys)
}
