//! Which settings a report sweeps: by default every technique's own axes, or those of a TOML file.

use std::path::{Path, PathBuf};

use crate::scene::LightKind;
use crate::techniques::{Axis, TABLE, Technique};

/// One setting of `[light.shadow]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Setting {
    pub technique: String,
    /// Keys and values in TOML, in the order of the axes.
    pub keys: Vec<(String, String)>,
}

/// Why a grid file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("{path}: cannot be read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: std::io::Error },
    #[error("{path}: {reason}", path = .path.display())]
    Toml { path: PathBuf, reason: String },
    #[error("{path}: has no [[sweep]]; write one with a technique and an array of values for each key to vary", path = .path.display())]
    Empty { path: PathBuf },
    #[error("{path}: [[sweep]] number {number}: {what}", path = .path.display())]
    Sweep { path: PathBuf, number: usize, what: String },
}

impl Setting {
    /// `technique = "…", key = value, …` for an inline table.
    pub fn to_inline(&self) -> String {
        let keys = self.keys.iter().map(|(key, value)| format!(", {key} = {value}"));
        format!("technique = \"{}\"{}", self.technique, keys.collect::<String>())
    }
}

/// What a report sweeps of each scene.
#[derive(Clone, Debug)]
pub enum Grid {
    /// Every technique that serves the light, over its own axes; `quick` takes few values of each.
    Standard { quick: bool },
    /// The same for every light, whether its kind is served or not.
    Own(Vec<Setting>),
}

impl Grid {
    /// The settings for a light of this `kind`.
    pub fn settings(&self, kind: &LightKind) -> Vec<Setting> {
        match self {
            Self::Standard { quick } => standard(*quick, kind),
            Self::Own(settings) => settings.clone(),
        }
    }
}

fn standard(quick: bool, kind: &LightKind) -> Vec<Setting> {
    let values = |axis: &Axis| {
        let values = if quick { axis.quick } else { axis.values };
        (axis.key.to_owned(), values.iter().map(|value| (*value).to_owned()).collect())
    };
    let of = |technique: &&'static dyn Technique| {
        let (name, grids) =
            (technique.name(), [technique.axes()].into_iter().chain(technique.more_axes(kind).iter().copied()));
        grids.flat_map(move |axes| product(name, &axes.iter().map(values).collect::<Vec<_>>()))
    };
    TABLE.iter().filter(|technique| technique.serves(kind).is_ok()).flat_map(of).collect()
}

/// A grid of one's own: `[[sweep]]` tables with `technique` and, for each other key, a value or an array of values.
///
/// # Errors
///
/// A file that cannot be read, is no TOML or has no sweep, or a sweep without a technique.
pub fn load(path: &Path) -> Result<Vec<Setting>, Error> {
    let text = std::fs::read_to_string(path).map_err(|reason| Error::Read { path: path.to_owned(), reason })?;
    let table: toml::Table = text
        .parse()
        .map_err(|reason: toml::de::Error| Error::Toml { path: path.to_owned(), reason: reason.to_string() })?;
    if let Some(key) = table.keys().find(|key| *key != "sweep") {
        let hint = crate::scene::suggest(key, ["sweep"].into_iter());
        return Err(Error::Toml { path: path.to_owned(), reason: format!("unknown key `{key}`: {hint}") });
    }
    let sweeps = table.get("sweep").and_then(toml::Value::as_array).filter(|sweeps| !sweeps.is_empty());
    let sweeps = sweeps.ok_or_else(|| Error::Empty { path: path.to_owned() })?;
    let mut settings = Vec::new();
    for (index, sweep) in sweeps.iter().enumerate() {
        let wrong = |what: String| Error::Sweep { path: path.to_owned(), number: index + 1, what };
        settings.extend(read_sweep(sweep).map_err(wrong)?);
    }
    let mut seen = std::collections::HashSet::new();
    settings.retain(|setting| seen.insert(setting.clone()));
    Ok(settings)
}

fn read_sweep(sweep: &toml::Value) -> Result<Vec<Setting>, String> {
    let table = sweep.as_table().ok_or("must be a table")?;
    let technique = table.get("technique").and_then(toml::Value::as_str).ok_or("`technique` is missing")?;
    if !TABLE.iter().any(|row| row.name() == technique) {
        let names = TABLE.iter().map(|row| row.name());
        return Err(format!("technique \"{technique}\": {}", crate::scene::suggest(technique, names)));
    }
    let mut axes = Vec::new();
    for (key, value) in table.iter().filter(|(key, _)| *key != "technique") {
        let values = match value.as_array() {
            Some(values) if values.is_empty() => return Err(format!("`{key}` has no values")),
            Some(values) => values.iter().map(ToString::to_string).collect(),
            None => vec![value.to_string()],
        };
        axes.push((key.clone(), values));
    }
    Ok(product(technique, &axes))
}

/// Every combination, the last axis fastest.
fn product(technique: &str, axes: &[(String, Vec<String>)]) -> Vec<Setting> {
    let mut settings = vec![Setting { technique: technique.to_owned(), keys: Vec::new() }];
    for (key, values) in axes {
        let with = |setting: &Setting, value: &String| {
            let mut longer = setting.clone();
            longer.keys.push((key.clone(), value.clone()));
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
        use crate::scene::{Frustum, LightShape, Spot};
        let (position, target, up) = (glam::DVec3::Y, glam::DVec3::ZERO, glam::DVec3::Z);
        let frustum = Frustum { position, target, up, cone_radians: 1.0, near: 0.1, far: 10.0 };
        let attenuation = [1.0, 0.0, 0.0];
        LightKind::Spot(Spot { frustum, shape: LightShape::Cone, attenuation, image: None, frustum_shown: false })
    }

    #[test]
    fn a_sweep_is_the_product_of_its_axes() {
        let sweep: toml::Value =
            toml::Value::Table("technique = \"shadow-map\"\nsize = [512, 1024]\nfilter = \"linear\"\noffset = [{ factor = 1.0 }, { factor = 2.0 }]".parse().unwrap());
        let settings = read_sweep(&sweep).unwrap();
        assert_eq!(settings.len(), 4);
        assert!(
            settings
                .iter()
                .any(|s| s.to_inline().contains("size = 1024") && s.to_inline().contains("{ factor = 2.0 }"))
        );
    }

    #[test]
    fn the_standard_grids_name_every_technique() {
        for quick in [true, false] {
            let settings = standard(quick, &spot());
            for row in TABLE {
                assert!(settings.iter().any(|setting| setting.technique == row.name()), "{}", row.name());
            }
        }
        assert!(standard(true, &spot()).len() < standard(false, &spot()).len());
    }

    #[test]
    fn a_light_is_swept_by_the_techniques_that_serve_it() {
        let sun = LightKind::Directional { direction: glam::DVec3::NEG_Y };
        let settings = Grid::Standard { quick: true }.settings(&sun);
        assert!(settings.iter().any(|setting| setting.technique == "none"));
        for setting in settings {
            let row = TABLE.iter().find(|row| row.name() == setting.technique).unwrap();
            assert_eq!(row.serves(&sun), Ok(()), "{}", setting.technique);
        }
    }
}
