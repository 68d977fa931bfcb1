//! TOML text to [`Settings`], each entry with its line. The grammar is the `toml` crate's; it knows no meaning of keys.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::Error;
use super::settings::{Entry, Origin, Settings, SettingsError, Value};

/// The table of a whole scene file.
pub(super) fn document(path: &Path, text: &str) -> Result<Settings, Error> {
    let lines = Lines::new(path, text);
    let root = DeTable::parse(text).map_err(|error| lines.syntax_error(&error))?;
    let origin = Origin::File { path: lines.path.clone(), line: 1 };
    Ok(table("", origin, root.get_ref(), &|span| lines.origin(span))?)
}

/// One value, as on the right of `=`; `None` where the text is none. `name` is the dotted name of its key.
pub(super) fn value(name: &str, text: &str, origin: &Origin) -> Result<Option<Entry>, SettingsError> {
    match DeValue::parse(text) {
        Ok(parsed) => entry(name, origin.clone(), parsed.get_ref(), &|_| origin.clone()).map(Some),
        Err(_) => Ok(None),
    }
}

/// Maps a byte span to the place in the file.
type Place<'a> = &'a dyn Fn(Range<usize>) -> Origin;

fn table(name: &str, origin: Origin, source: &DeTable<'_>, place: Place<'_>) -> Result<Settings, SettingsError> {
    let mut sorted: Vec<_> = source.iter().collect();
    sorted.sort_by_key(|(key, _)| key.span().start);
    let mut settings = Settings { path: name.to_owned(), origin, entries: Vec::with_capacity(sorted.len()) };
    for (key, item) in sorted {
        let name = settings.key(key.get_ref());
        let entry = entry(&name, place(key.span()), item.get_ref(), place)?;
        settings.entries.push((key.get_ref().to_string(), entry));
    }
    Ok(settings)
}

fn entry(name: &str, origin: Origin, source: &DeValue<'_>, place: Place<'_>) -> Result<Entry, SettingsError> {
    let out_of_range = |text: &str| SettingsError::new(&origin, format!("`{name}` is out of range: {text}"));
    let value = match source {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Boolean(value) => Value::Boolean(*value),
        DeValue::Integer(digits) => i64::from_str_radix(digits.as_str(), digits.radix())
            .map(Value::Integer)
            .map_err(|_| out_of_range(&digits.to_string()))?,
        DeValue::Float(digits) => {
            digits.as_str().parse().map(Value::Float).map_err(|_| out_of_range(digits.as_str()))?
        }
        DeValue::Datetime(date) => {
            return Err(SettingsError::new(&origin, format!("`{name}` cannot be a date ({date})")));
        }
        DeValue::Array(items) => Value::Array(
            items
                .iter()
                .map(|item| entry(name, place(item.span()), item.get_ref(), place))
                .collect::<Result<_, _>>()?,
        ),
        DeValue::Table(inner) => Value::Table(table(name, origin.clone(), inner, place)?),
    };
    Ok(Entry { value, origin })
}

/// Start of each line of a text.
struct Lines<'t> {
    path: Arc<Path>,
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn new(path: &Path, text: &'t str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { path: path.into(), text, starts }
    }

    /// The line of a byte offset, from 1.
    fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    fn origin(&self, span: Range<usize>) -> Origin {
        Origin::File { path: self.path.clone(), line: self.line(span.start) }
    }

    fn syntax_error(&self, error: &toml::de::Error) -> Error {
        let span = error.span().unwrap_or(0..0);
        let line = self.line(span.start);
        let text = self.text.lines().nth(line - 1).unwrap_or_default();
        Error::Syntax { origin: self.origin(span), message: error.message().to_owned(), text: shown(text) }
    }
}

/// A line as messages show it: its beginning, without control characters.
pub(super) fn shown(line: &str) -> String {
    line.trim().chars().take(200).flat_map(visible).collect()
}

/// Control characters by their escapes, so that a message stays on its line.
fn visible(c: char) -> impl Iterator<Item = char> {
    let escaped = if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    escaped.chars().collect::<Vec<_>>().into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Settings {
        document(Path::new("s.toml"), text).unwrap()
    }

    fn line(origin: &Origin) -> usize {
        match origin {
            Origin::File { line, .. } => *line,
            _ => 0,
        }
    }

    #[test]
    fn every_entry_has_its_line_and_every_table_its_name() {
        let root = parse("a = 1\n\n[[light]]\nb = 2\n[light.shadow]\nc = 3\n[[light]]\nb.d = 4\n");
        let Value::Array(lights) = &root.get("light").unwrap().value else { panic!("no array") };
        let tables: Vec<_> = lights
            .iter()
            .map(|entry| match &entry.value {
                Value::Table(table) => table,
                _ => panic!("no table"),
            })
            .collect();
        assert_eq!(tables.iter().map(|table| line(&table.origin)).collect::<Vec<_>>(), [3, 7]);
        let Value::Table(shadow) = &tables[0].get("shadow").unwrap().value else { panic!("no table") };
        assert_eq!((shadow.path.as_str(), line(&shadow.origin)), ("light.shadow", 5));
        assert_eq!(line(&shadow.get("c").unwrap().origin), 6);
        assert_eq!(line(&tables[1].get("b").unwrap().origin), 8);
    }

    #[test]
    fn keys_keep_the_order_of_the_file() {
        let root = parse("z = 1\na = 2\nm = 3\n");
        assert_eq!(root.entries.iter().map(|(key, _)| key.as_str()).collect::<Vec<_>>(), ["z", "a", "m"]);
    }

    #[test]
    fn the_offending_line_is_shown() {
        let error = document(Path::new("s.toml"), "a = 1\nb = = 2\n").unwrap_err().to_string();
        assert!(error.starts_with("s.toml:2: ") && error.ends_with("\n  b = = 2"), "{error}");
    }

    #[test]
    fn radix_integers_and_overflow() {
        let Value::Integer(value) = parse("a = 0xff").get("a").unwrap().value else { panic!("no integer") };
        assert_eq!(value, 255);
        let error = document(Path::new("s.toml"), "a = 9999999999999999999\n").unwrap_err().to_string();
        assert!(error.contains("s.toml:1: `a` is out of range"), "{error}");
    }
}
