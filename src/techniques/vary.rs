//! Tables `[light.shadow]` made from others: a scene's own with other keys in it, for reports, which vary keys and compare
//! techniques. Values only, no text that would have to be parsed; `read.rs` checks them.

use super::read::keys;
use super::{TABLE, Technique};
use crate::scene::{self, Entry, Origin, Settings, Value};

/// The technique whose polygon offset is tuned.
const TUNED: &dyn Technique = &super::shadow_map::ShadowMap;

/// Key of the polygon offset.
const OFFSET: &str = "offset";

/// The name of the technique that a table chooses.
pub fn technique_of(settings: &Settings) -> &str {
    match settings.get("technique").map(|entry| &entry.value) {
        Some(Value::String(name)) => name,
        _ => "none",
    }
}

/// A scene's `[light.shadow]` with the keys of `setting` in place of its own, as with `render --set`; without keys that the
/// technique does not read. Written into the scene file it draws the same.
pub fn over(written: &Settings, setting: &Settings) -> Settings {
    let mut merged = setting.clone();
    merged.path.clone_from(&written.path);
    for (key, entry) in &written.entries {
        if merged.get(key).is_none() {
            merged.set(key, entry.clone());
        }
    }
    readable(&merged)
}

/// A copy without the keys that only other techniques read.
pub fn readable(settings: &Settings) -> Settings {
    let name = technique_of(settings);
    let (mine, others): (Vec<_>, Vec<_>) = TABLE.iter().partition(|technique| technique.name() == name);
    let keys = |rows: Vec<&&'static dyn Technique>| -> Vec<&str> {
        rows.into_iter().flat_map(|technique| keys(*technique)).collect()
    };
    let (mine, others) = (keys(mine), keys(others));
    let mut kept = settings.clone();
    kept.entries.retain(|(key, _)| {
        let key = key.as_str();
        key == "technique" || mine.contains(&key) || !others.contains(&key)
    });
    kept
}

/// The technique whose polygon offset is tuned, by default.
pub fn tuned() -> Settings {
    chosen(TUNED)
}

/// `written` as a shadow map without any bias but its polygon offset.
pub fn tunable(written: &Settings) -> Settings {
    let mut bare = written.clone();
    bare.entries.retain(|(key, _)| key != "bias");
    over(&bare, &chosen(TUNED))
}

/// `written` as a shadow map of this size and polygon offset, without any other bias.
pub fn with_offset(written: &Settings, size: u32, factor: f64, units: f64) -> Settings {
    over(&tunable(written), &offset_keys(size, factor, units))
}

/// The keys that [`with_offset`] sets.
pub fn offset_keys(size: u32, factor: f64, units: f64) -> Settings {
    let mut offset = Settings { path: format!("light.shadow.{OFFSET}"), ..Settings::default() };
    offset.set("factor", entry(Value::Float(factor)));
    offset.set("units", entry(Value::Float(units)));
    let mut keys = chosen(TUNED);
    keys.set("size", entry(Value::Integer(size.into())));
    keys.set(OFFSET, entry(Value::Table(offset)));
    keys
}

/// `keys` with a map's `size`, and with those keys of `written` that the technique of `keys` shares with the shadow map
/// that it is compared with.
pub fn beside_tuned(written: &Settings, size: u32, keys: &Settings) -> Settings {
    let own = TABLE.iter().find(|row| row.name() == technique_of(keys)).map_or(Vec::new(), |row| super::keys(*row));
    let tuned = super::keys(TUNED);
    let mut shared = written.clone();
    shared.entries.retain(|(key, _)| own.contains(&key.as_str()) && tuned.contains(&key.as_str()));
    let mut keys = keys.clone();
    keys.set("size", entry(Value::Integer(size.into())));
    over(&shared, &keys)
}

/// Techniques that draw shadows and have no polygon offset to tune; each with the first value of each of
/// its quick report's axes.
///
/// # Errors
///
/// An axis whose value is no TOML.
pub fn rivals() -> Result<Vec<(&'static dyn Technique, Settings)>, scene::Error> {
    let has_offset = |technique: &dyn Technique| technique.axes().iter().any(|axis| axis.key == OFFSET);
    let rows = TABLE.iter().filter(|technique| technique.draws_shadows() && !has_offset(**technique));
    rows.map(|technique| Ok((*technique, plainest(*technique)?))).collect()
}

fn plainest(technique: &dyn Technique) -> Result<Settings, scene::Error> {
    let mut plainest = chosen(technique);
    for axis in technique.axes() {
        if let Some(value) = axis.quick.first() {
            plainest.set(axis.key, axis.entry(value)?);
        }
    }
    Ok(plainest)
}

/// A table that names a technique, and no more.
fn chosen(technique: &dyn Technique) -> Settings {
    let mut table = Settings { path: String::from("light.shadow"), ..Settings::default() };
    table.set("technique", entry(Value::String(technique.name().to_owned())));
    table
}

fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}
