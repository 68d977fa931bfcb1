//! Settings that a report sweeps: by default every technique's own axes, or those of a TOML file.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::scene::{self, Entry, LightKind, Origin, Settings, SettingsError, Value};
use crate::techniques::{self, Axis, TABLE, Technique};

/// The most rows that a grid may have. Each takes a frame's time, some kilobytes of memory and a line of the page.
pub const MOST_ROWS: usize = 100_000;

/// Reason why a grid file cannot be used.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The file cannot be read, or is no TOML.
    #[error(transparent)]
    File(#[from] scene::Error),
    /// An unknown key or a wrong value, with its line.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The file has no sweep.
    #[error("{path}: has no [[sweep]]; write one with a technique and an array of values for each key to vary", path = .path.display())]
    Empty { path: PathBuf },
    /// The sweeps have more combinations than a report may have rows.
    #[error("{path}: is a grid of {rows} rows, more than {MOST_ROWS}: list fewer values, or split it", path = .path.display())]
    TooManyRows { path: PathBuf, rows: u64 },
}

/// `technique = "…", key = value, …` of a table, as the inside of an inline table.
pub fn to_inline(settings: &Settings) -> String {
    let entries = settings.entries.iter().map(|(key, entry)| format!("{key} = {}", entry.value.to_toml()));
    entries.collect::<Vec<_>>().join(", ")
}

/// Sweep of each scene. A setting holds `technique` and the keys that are varied.
#[derive(Clone, Debug)]
pub enum Grid {
    /// Every technique that serves the light, over its own axes.
    Standard {
        /// True for few values of each axis.
        quick: bool,
    },
    /// The same for every light.
    Own(Vec<Settings>),
}

impl Grid {
    /// The settings for a light of this `kind`.
    ///
    /// # Errors
    ///
    /// An axis of a technique that is no TOML.
    pub fn settings(&self, kind: &LightKind) -> Result<Vec<Settings>, scene::Error> {
        match self {
            Self::Standard { quick } => standard(*quick, kind),
            Self::Own(settings) => Ok(settings.clone()),
        }
    }
}

fn standard(quick: bool, kind: &LightKind) -> Result<Vec<Settings>, scene::Error> {
    let mut settings = Vec::new();
    for technique in TABLE.iter().filter(|technique| technique.serves(kind).is_ok()) {
        let grids = [technique.axes()].into_iter().chain(technique.more_axes(kind).iter().copied());
        for axes in grids {
            let axes = axes.iter().map(|axis| values_of(axis, quick)).collect::<Result<Vec<_>, _>>()?;
            settings.extend(product(&technique_entry(technique.name()), &axes));
        }
    }
    Ok(settings)
}

/// An axis: a key and its values.
type Values = (String, Vec<Entry>);

fn values_of(axis: &Axis, quick: bool) -> Result<Values, scene::Error> {
    let values = if quick { axis.quick } else { axis.values };
    let entries = values.iter().map(|value| axis.entry(value)).collect::<Result<Vec<_>, _>>()?;
    Ok((axis.key.to_owned(), entries))
}

fn technique_entry(name: &str) -> Entry {
    Entry { value: Value::String(name.to_owned()), origin: Origin::BuiltIn }
}

/// Reads a grid file: `[[sweep]]` tables with `technique` and, for each other key, a value or an array of values. The names
/// of keys are checked here, and how many rows there will be, before any row is made; values are checked with the scene
/// that they go into.
///
/// # Errors
///
/// A file that cannot be read, is no TOML or has no sweep; a sweep without a technique, or with a key that its technique
/// does not read; more rows than [`MOST_ROWS`].
pub fn load(path: &Path) -> Result<Vec<Settings>, Error> {
    let table = scene::table(path)?;
    let mut reader = table.read();
    let sweeps = reader.tables("sweep")?;
    reader.finish()?;
    if sweeps.is_empty() {
        return Err(Error::Empty { path: path.to_owned() });
    }
    let sweeps = sweeps.into_iter().map(read_sweep).collect::<Result<Vec<_>, _>>()?;
    let count = |axes: &[Values]| axes.iter().fold(1_u64, |rows, (_, values)| rows.saturating_mul(values.len() as u64));
    let rows = sweeps.iter().fold(0_u64, |rows, (_, axes)| rows.saturating_add(count(axes)));
    if rows > MOST_ROWS as u64 {
        return Err(Error::TooManyRows { path: path.to_owned(), rows });
    }
    let mut settings: Vec<Settings> = sweeps.iter().flat_map(|(technique, axes)| product(technique, axes)).collect();
    let mut seen = HashSet::new();
    settings.retain(|setting| seen.insert(to_inline(setting)));
    Ok(settings)
}

/// The sweep's technique, and each other key with its values.
fn read_sweep(sweep: &Settings) -> Result<(Entry, Vec<Values>), SettingsError> {
    let mut reader = sweep.read();
    let Some(name) = reader.string("technique")? else {
        return Err(reader.missing("technique", "each [[sweep]] names one"));
    };
    let Some(technique) = TABLE.iter().find(|row| row.name() == name) else {
        let names = TABLE.iter().map(|row| row.name());
        return Err(reader.error("technique", format_args!("cannot be \"{name}\": {}", scene::suggest(name, names))));
    };
    let mut axes = Vec::new();
    for (key, entry) in sweep.entries.iter().filter(|(key, _)| key != "technique") {
        check_key(*technique, key, entry)?;
        let values = match &entry.value {
            Value::Array(values) if values.is_empty() => return Err(reader.error(key, "has no values")),
            Value::Array(values) => values.clone(),
            _ => vec![entry.clone()],
        };
        axes.push((key.clone(), values));
    }
    let technique = sweep.get("technique").cloned().unwrap_or_else(|| technique_entry(name));
    Ok((technique, axes))
}

/// Refuses a key that would vary nothing.
fn check_key(technique: &dyn Technique, key: &str, entry: &Entry) -> Result<(), SettingsError> {
    if techniques::keys(technique).contains(&key) {
        return Ok(());
    }
    let others: Vec<&str> =
        TABLE.iter().filter(|row| techniques::keys(**row).contains(&key)).map(|row| row.name()).collect();
    if !others.is_empty() {
        let (name, others) = (technique.name(), others.join(", "));
        let message = format!("`{key}` changes nothing under technique = \"{name}\": it is a key of {others}");
        return Err(SettingsError::new(&entry.origin, message));
    }
    let mut alone = Settings { path: String::from("sweep"), ..Settings::default() };
    alone.set(key, entry.clone());
    let mut keys = alone.read();
    // Only the unknown key can be wrong here.
    let _ = technique.check(&mut keys);
    keys.finish()
}

/// Every combination, the last axis fastest.
fn product(technique: &Entry, axes: &[Values]) -> Vec<Settings> {
    let mut first = Settings { path: String::from("light.shadow"), ..Settings::default() };
    first.origin = technique.origin.clone();
    first.set("technique", technique.clone());
    let mut settings = vec![first];
    for (key, values) in axes {
        let with = |setting: &Settings, value: &Entry| {
            let mut longer = setting.clone();
            longer.set(key, value.clone());
            longer
        };
        settings = settings.iter().flat_map(|setting| values.iter().map(move |value| with(setting, value))).collect();
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot() -> LightKind {
        use crate::scene::{Frustum, ImageFilter, Interpolation, LightShape, Spot};
        let (position, target, up) = (glam::DVec3::Y, glam::DVec3::ZERO, glam::DVec3::Z);
        let frustum = Frustum {
            position,
            target,
            up,
            cone_radians: 1.0,
            aspect: 1.0,
            near: 0.1,
            far: 10.0,
            lean: glam::DVec2::ZERO,
        };
        let attenuation = [1.0, 0.0, 0.0];
        LightKind::Spot(Spot {
            frustum,
            shape: LightShape::Cone,
            attenuation,
            image: None,
            image_filter: ImageFilter::Linear,
            beam: None,
            falloff: None,
            interpolation: Interpolation::Perspective,
            frustum_shown: false,
            focus: None,
        })
    }

    fn load_text(text: &str) -> Result<Vec<Settings>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grid");
        std::fs::write(&path, text).unwrap();
        load(&path).map_err(|error| error.to_string())
    }

    fn name(settings: &Settings) -> String {
        settings.get("technique").unwrap().value.to_toml()
    }

    #[test]
    fn a_sweep_is_the_product_of_its_axes() {
        let settings = load_text(
            "[[sweep]]\ntechnique = \"shadow-map\"\nsize = [512, 1024]\nfilter = \"linear\"\n\
             offset = [{ factor = 1.0 }, { factor = 2.0 }]\n[[sweep]]\ntechnique = \"shadow-map\"\nsize = 512\n\
             filter = \"linear\"\noffset = { factor = 1.0 }\n",
        );
        let inline: Vec<String> = settings.unwrap().iter().map(to_inline).collect();
        assert_eq!(inline.len(), 4, "{inline:?}");
        assert_eq!(
            inline[3],
            "technique = \"shadow-map\", size = 1024, filter = \"linear\", offset = { factor = 2.0 }"
        );
    }

    #[test]
    fn keys_that_vary_nothing_are_refused_with_their_line() {
        for (keys, expected) in [
            ("technique = \"shadow-map\"\nsise = [1]", "grid:3: unknown key `sise` in [sweep]: did you mean `size`?"),
            (
                "technique = \"shadow-map\"\nmethod = [1]",
                "grid:3: `method` changes nothing under technique = \"shadow-map\"",
            ),
            ("technique = \"shadow-map\"\nsize = []", "grid:3: `sweep.size` has no values"),
            ("technique = \"shadow-mop\"", "did you mean `shadow-map`?"),
            ("size = [1]", "grid:1: `sweep.technique` is missing"),
            ("technique = \"none\"\n[[sweap]]", "unknown key `sweap` in the scene: did you mean `sweep`?"),
        ] {
            let error = load_text(&format!("[[sweep]]\n{keys}\n")).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }

    /// Eight keys of ten values: the names are checked, and the rows counted, before any is made.
    #[test]
    fn a_product_is_counted_before_it_is_made() {
        let values = "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]";
        let with = |keys: &[String]| {
            let keys: String = keys.iter().map(|key| format!("{key} = {values}\n")).collect();
            load_text(&format!("[[sweep]]\ntechnique = \"shadow-map\"\n{keys}")).unwrap_err()
        };
        let unknown: Vec<String> = (0..8).map(|index| format!("key{index}")).collect();
        assert!(with(&unknown).contains("unknown key `key0`"), "{}", with(&unknown));
        let known = ["size", "format", "filter", "kernel", "offset", "bias", "dimming", "guard"].map(String::from);
        assert!(with(&known).contains("is a grid of 100000000 rows, more than 100000"), "{}", with(&known));
    }

    #[test]
    fn the_standard_grids_name_every_technique() {
        for quick in [true, false] {
            let settings = standard(quick, &spot()).unwrap();
            for row in TABLE {
                assert!(
                    settings.iter().any(|setting| name(setting) == format!("\"{}\"", row.name())),
                    "{}",
                    row.name()
                );
            }
        }
        assert!(standard(true, &spot()).unwrap().len() < standard(false, &spot()).unwrap().len());
    }

    #[test]
    fn every_axis_is_a_key_that_its_technique_reads() {
        for technique in TABLE {
            for axis in technique.axes().iter().chain(technique.more_axes(&spot()).iter().copied().flatten()) {
                assert!(techniques::keys(*technique).contains(&axis.key), "{} {}", technique.name(), axis.key);
            }
        }
    }

    #[test]
    fn a_light_is_swept_by_the_techniques_that_serve_it() {
        let sun = LightKind::Directional { direction: glam::DVec3::NEG_Y };
        let settings = Grid::Standard { quick: true }.settings(&sun).unwrap();
        assert!(settings.iter().any(|setting| name(setting) == "\"none\""));
        for setting in settings {
            let row = TABLE.iter().find(|row| name(&setting) == format!("\"{}\"", row.name())).unwrap();
            assert_eq!(row.serves(&sun), Ok(()), "{}", row.name());
        }
    }
}
