//! `--set a.b.c=value`: changes to a scene's [`Settings`] from the command line.
//!
//! A segment that meets an array of tables applies to each of them; `light.0.cone` and `light[0].cone` name one. Missing
//! tables are made. The value is TOML; a bare word is a string. `camera=NAME` chooses the camera of that name,
//! `at=SECONDS` a time of animations.

use std::sync::Arc;

use super::assets::is_animated;
use super::parse;
use super::settings::{Entry, Origin, Settings, SettingsError, Value, suggest};

type Result<T> = std::result::Result<T, SettingsError>;

/// Arrays of tables at a scene's root; an override cannot make their first element.
const ARRAYS: [&str; 2] = ["light", "object"];

/// The key of cameras.
const CAMERA: &str = "camera";

/// The key of a time, which stands in objects.
const AT: &str = "at";

/// Greatest depth of nesting.
const MAX_SEGMENTS: usize = 16;

/// Applies each override in order; `text` is the argument of `--set`.
pub(super) fn apply(root: &mut Settings, overrides: &[String]) -> Result<()> {
    overrides.iter().try_for_each(|text| Override::parse(text)?.apply(root))
}

/// Sets one key by its dotted name.
pub(super) fn set(table: &mut Settings, key: &str, entry: Entry) -> Result<()> {
    match segments(key) {
        Some(segments) => Override { segments, entry }.apply(table),
        None => Err(SettingsError::new(&entry.origin, format!("`{key}`: a key is names joined by dots"))),
    }
}

struct Override {
    segments: Vec<String>,
    entry: Entry,
}

impl Override {
    fn parse(text: &str) -> Result<Self> {
        let origin = Origin::CommandLine(format!("--set {text}").into());
        let refuse = |message: &str| Err(SettingsError::new(&origin, message));
        let Some((path, value)) = text.split_once('=') else {
            return refuse("must be written key=value, e.g. light.shadow.size=2048");
        };
        let Some(segments) = segments(path.trim()) else {
            return refuse("the key must be names joined by dots, e.g. light.0.shadow.size or light[0].shadow.size");
        };
        let (name, value) = (named(&segments), value.trim());
        if value.is_empty() {
            return refuse("no value stands after `=` (an empty string is written '\"\"')");
        }
        let entry = match parse::value(&name, value, &origin)? {
            Some(entry) => entry,
            None if value.starts_with(['[', '{', '"', '\'']) => {
                return refuse("the value is not valid TOML");
            }
            None => Entry { value: Value::String(value.to_owned()), origin: origin.clone() },
        };
        Ok(Self { segments, entry })
    }

    fn apply(&self, root: &mut Settings) -> Result<()> {
        let first = &self.segments[0];
        if let ([_], CAMERA, Value::String(name)) = (&self.segments[..], first.as_str(), &self.entry.value) {
            return self.choose_camera(root, name);
        }
        if let ([_], AT) = (&self.segments[..], first.as_str()) {
            return self.set_time(root);
        }
        let deeper = self.segments.len() > 1;
        if deeper && ARRAYS.contains(&first.as_str()) && root.get(first).is_none() {
            return Err(self.refuse(format!("the scene has no [[{first}]]")));
        }
        self.set_in_table(root, &self.segments)
    }

    /// Puts the camera of a name in place of all.
    fn choose_camera(&self, root: &mut Settings, wanted: &str) -> Result<()> {
        let tables: Vec<&Settings> = match root.get(CAMERA).map(|entry| &entry.value) {
            Some(Value::Table(table)) => vec![table],
            Some(Value::Array(items)) => items
                .iter()
                .filter_map(|item| if let Value::Table(table) = &item.value { Some(table) } else { None })
                .collect(),
            _ => Vec::new(),
        };
        let name = |table: &Settings| match table.get("name").map(|entry| &entry.value) {
            Some(Value::String(name)) => Some(name.clone()),
            _ => None,
        };
        if let Some(chosen) = tables.iter().find(|table| name(table).as_deref() == Some(wanted)) {
            let entry = Entry { value: Value::Table((*chosen).clone()), origin: chosen.origin.clone() };
            root.set(CAMERA, entry);
            return Ok(());
        }
        let names: Vec<String> = tables.into_iter().filter_map(name).collect();
        Err(self.refuse(match names.is_empty() {
            true => String::from("no camera of the scene has a `name`"),
            false => format!("no camera is called \"{wanted}\": {}", suggest(wanted, names.iter().map(String::as_str))),
        }))
    }

    /// Sets the time of each object whose file has animations.
    fn set_time(&self, root: &mut Settings) -> Result<()> {
        let mut moved = 0;
        let objects = root.entries.iter_mut().filter(|(key, _)| key == "object");
        for item in objects
            .filter_map(|(_, entry)| if let Value::Array(items) = &mut entry.value { Some(items) } else { None })
            .flatten()
        {
            let Value::Table(object) = &mut item.value else { continue };
            let Some(Entry { value: Value::String(mesh), .. }) = object.get("mesh") else { continue };
            if is_animated(mesh) {
                object.set(AT, self.entry.clone());
                moved += 1;
            }
        }
        match moved {
            0 => Err(self.refuse(String::from("no object's mesh is a .gltf or .glb file, which may have animations"))),
            _ => Ok(()),
        }
    }

    fn set_in_table(&self, table: &mut Settings, segments: &[String]) -> Result<()> {
        let Some((key, rest)) = segments.split_first() else {
            return Ok(());
        };
        if rest.is_empty() {
            table.set(key, self.entry.clone());
            return Ok(());
        }
        if table.get(key).is_none() {
            let origin = self.entry.origin.clone();
            let made = Settings { path: table.key(key), origin: origin.clone(), entries: Vec::new() };
            table.set(key, Entry { value: Value::Table(made), origin });
        }
        let name = table.key(key);
        match table.entries.iter_mut().find(|(other, _)| other == key) {
            Some((_, entry)) => self.set_in_value(&mut entry.value, &name, rest),
            None => Ok(()),
        }
    }

    fn set_in_value(&self, value: &mut Value, name: &str, segments: &[String]) -> Result<()> {
        let kind = value.kind();
        match value {
            Value::Table(table) => self.set_in_table(table, segments),
            Value::Array(items) => self.set_in_array(items, name, segments),
            _ => Err(self.refuse(format!("`{name}` is {kind}, not a table"))),
        }
    }

    fn set_in_array(&self, items: &mut [Entry], name: &str, segments: &[String]) -> Result<()> {
        let Some(index) = segments.first().and_then(|segment| index(segment)) else {
            if items.is_empty() {
                return Err(self.refuse(format!("`{name}` is empty")));
            }
            return items.iter_mut().try_for_each(|item| match &mut item.value {
                Value::Table(table) => self.set_in_table(table, segments),
                other => Err(self.refuse(format!("`{name}` holds {}, not tables", other.kind()))),
            });
        };
        let count = items.len();
        let Some(item) = items.get_mut(index) else {
            let have = if count == 1 { String::from("1 entry") } else { format!("{count} entries") };
            return Err(self.refuse(format!("`{name}` has {have}, numbered from 0")));
        };
        if segments.len() == 1 {
            *item = self.entry.clone();
            return Ok(());
        }
        self.set_in_value(&mut item.value, name, &segments[1..])
    }

    fn refuse(&self, message: String) -> SettingsError {
        SettingsError::new(&self.entry.origin, message)
    }
}

/// `light[0].shadow.size` and `light.0.shadow.size` to `light`, `0`, `shadow`, `size`.
fn segments(path: &str) -> Option<Vec<String>> {
    let mut out = Vec::new();
    for part in path.split('.') {
        let (name, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        out.push(name.to_owned());
        while !rest.is_empty() {
            let (number, after) = rest.strip_prefix('[')?.split_once(']')?;
            out.push(index(number)?.to_string());
            rest = after;
        }
    }
    let is_name =
        |name: &String| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    (out.len() <= MAX_SEGMENTS && index(&out[0]).is_none() && out.iter().all(is_name)).then_some(out)
}

fn index(segment: &str) -> Option<usize> {
    segment.bytes().all(|b| b.is_ascii_digit()).then(|| segment.parse().ok()).flatten()
}

/// The dotted name as a scene file's messages have it, without numbers.
fn named(segments: &[String]) -> Arc<str> {
    let names: Vec<&str> = segments.iter().map(String::as_str).filter(|name| index(name).is_none()).collect();
    names.join(".").into()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const SCENE: &str = "[camera]\neye = [1, 2, 3]\n[[light]]\ncone = 1\n[light.shadow]\n[[light]]\ncone = 2\n";

    fn set(text: &str) -> std::result::Result<String, String> {
        let mut root = parse::document(Path::new("s.toml"), SCENE).map_err(|error| error.to_string())?;
        apply(&mut root, &[text.to_owned()]).map_err(|error| error.to_string())?;
        Ok(root.to_toml())
    }

    #[test]
    fn a_name_means_each_table_and_a_number_one() {
        assert_eq!(set("light.cone=5").unwrap().matches("cone = 5").count(), 2);
        for text in ["light.1.cone=5", "light[1].cone=5"] {
            let toml = set(text).unwrap();
            assert!(toml.contains("cone = 1") && toml.contains("cone = 5") && !toml.contains("cone = 2"), "{toml}");
        }
        assert!(set("camera.eye.1=7").unwrap().contains("eye = [1, 7, 3]"));
    }

    #[test]
    fn bare_words_are_strings_and_tables_are_made() {
        assert!(set("light.shadow.transfer=copy").unwrap().contains("transfer = \"copy\""));
        assert!(set("image.size=[3, 4]").unwrap().contains("[image]\nsize = [3, 4]"));
        assert!(set("light.0.shadow.offset.factor=2.5").unwrap().contains("offset = { factor = 2.5 }"));
        assert!(set("light.0.image=../a=b.png").unwrap().contains("image = \"../a=b.png\""));
    }

    #[test]
    fn what_cannot_be_is_refused_with_the_text() {
        for (text, expected) in [
            ("light", "must be written key=value"),
            ("=1", "the key must be names"),
            ("a..b=1", "the key must be names"),
            ("light[x].a=1", "the key must be names"),
            ("0.a=1", "the key must be names"),
            ("a=", "no value stands after"),
            ("a=[1,", "not valid TOML"),
            ("light.2.cone=1", "`light` has 2 entries, numbered from 0"),
            ("light.cone.x=1", "`light.cone` is an integer, not a table"),
            ("camera.eye.x=1", "`camera.eye` holds an integer, not tables"),
            ("object.lit=false", "the scene has no [[object]]"),
            ("a=99999999999999999999", "`a` is out of range"),
        ] {
            let error = set(text).unwrap_err();
            assert!(error.starts_with(&format!("--set {text}: ")) && error.contains(expected), "{error}");
        }
    }
}
