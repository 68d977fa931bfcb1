//! `instances` of an object: the places at which its one mesh is drawn, as an array of tables or as a file of JSON Lines.

use std::path::Path;
use std::sync::Arc;

use glam::DMat4;

use super::placement;
use crate::process;
use crate::scene::settings::{Origin, Reader, Settings, SettingsError, Value};
use crate::scene::{Error, assets, json, read_text};

/// Greatest size of a file of instances, in bytes.
const LONGEST_FILE: u64 = 256 << 20;

/// Greatest number of an object's instances.
const MOST: usize = 1_000_000;

const KEY: &str = "instances";

/// One place of an object.
pub(super) struct Instance {
    /// `object_from_file`: from the mesh file's space to that of the object, whose own placement moves all instances.
    pub placement: DMat4,
    /// Its table or its line, for errors.
    pub origin: Origin,
}

/// Reads `instances`; `None`: the object is drawn once.
pub(super) fn read(reader: &mut Reader<'_>) -> Result<Option<Vec<Instance>>, Error> {
    let instances = match reader.entry(KEY).map(|entry| &entry.value) {
        None => return Ok(None),
        Some(Value::String(_)) => match reader.file(KEY)? {
            Some((name, origin)) => lines(&assets::file(name, origin))?,
            None => return Ok(None),
        },
        Some(Value::Array(_)) => reader.tables(KEY)?.into_iter().map(instance).collect::<Result<_, _>>()?,
        Some(_) => {
            return Err(reader.error(KEY, "must be an array of tables, or a file with a JSON object a line").into());
        }
    };
    if instances.is_empty() {
        return Err(reader.error(KEY, "has none: leave the object out, or `instances`").into());
    }
    if instances.len() > MOST {
        return Err(reader.error(KEY, format_args!("has {}; an object may have {MOST}", instances.len())).into());
    }
    Ok(Some(instances))
}

/// The instances of a file: a JSON object a line, with the keys of an object's placement. Blank lines are skipped.
fn lines(path: &Path) -> Result<Vec<Instance>, Error> {
    let text = read_text(path, LONGEST_FILE)?;
    let shared: Arc<Path> = path.into();
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let reading = process::reading(name, text.len() as u64);
    let counted = text.lines().inspect(|line| reading.advance(line.len() as u64 + 1));
    let lines = counted.enumerate().filter(|(_, line)| !line.trim().is_empty());
    let read = |(index, line): (usize, &str)| {
        let origin = Origin::File { path: shared.clone(), line: index + 1 };
        Ok(instance(&json::table("object.instances", line, &origin)?)?)
    };
    lines.map(read).collect()
}

fn instance(table: &Settings) -> Result<Instance, SettingsError> {
    let mut reader = table.read();
    let placement = placement::read(&mut reader)?;
    reader.finish()?;
    Ok(Instance { placement, origin: table.origin.clone() })
}
