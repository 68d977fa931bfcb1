//! A table of a scene file as written, read key by key with types and ranges: the reading code names each key once, and
//! [`Reader::finish`] refuses unread keys, with file, line and the nearest known key.

use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

pub(super) use super::plain::Plain;
use super::plain::words;
use super::record::{ValueForm, note};
pub use super::suggest::suggest;

/// Place of a value in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Origin {
    /// A line of a file.
    File {
        /// The file, as the user named it or found from there.
        path: Arc<Path>,
        /// From 1.
        line: usize,
    },
    /// The command line, e.g. `--set light.shadow.size=2048`.
    CommandLine(Arc<str>),
    /// A line of the program's own code.
    Code {
        /// Source file, as the compiler was given it.
        file: &'static str,
        /// From 1.
        line: u32,
    },
    /// Supplied by glumbra.
    BuiltIn,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, line } => write!(f, "{}:{line}", path.display()),
            Self::CommandLine(text) => write!(f, "{text}"),
            Self::Code { file, line } => write!(f, "{file}:{line}"),
            Self::BuiltIn => write!(f, "built-in scene"),
        }
    }
}

/// An error in a setting, and its place.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{origin}: {message}")]
pub struct SettingsError {
    /// Place of the setting.
    pub origin: Origin,
    /// Sentence that names the key and says what is wrong.
    pub message: String,
}

impl SettingsError {
    /// An error at `origin`.
    pub fn new(origin: &Origin, message: impl Into<String>) -> Self {
        Self { origin: origin.clone(), message: message.into() }
    }
}

/// Place of a key in its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    origin: Origin,
    /// The dotted name.
    key: String,
}

impl Place {
    /// An error at the key.
    pub fn error(&self, message: impl fmt::Display) -> SettingsError {
        SettingsError::new(&self.origin, format!("`{}` {message}", self.key))
    }
}

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The value.
    pub value: Value,
    /// Place of the value.
    pub origin: Origin,
}

/// A TOML value; arrays and tables keep the place of each part.
#[derive(Clone, Debug)]
pub enum Value {
    /// A string.
    String(String),
    /// An integer.
    Integer(i64),
    /// A number with a point or an exponent; may be infinite or NaN.
    Float(f64),
    /// `true` or `false`.
    Boolean(bool),
    /// An array, of values of any kind.
    Array(Vec<Entry>),
    /// A table.
    Table(Settings),
}

impl Value {
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::String(_) => "a string",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a number",
            Self::Boolean(_) => "true or false",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
        }
    }
}

/// A table of settings, in the order of its keys in the file.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The dotted name for messages, e.g. `light.shadow`; empty for the file's root.
    pub path: String,
    /// Place of the table's header.
    pub origin: Origin,
    /// Keys and values.
    pub entries: Vec<(String, Entry)>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { path: String::new(), origin: Origin::BuiltIn, entries: Vec::new() }
    }
}

impl Settings {
    /// The entry of `key`; `None`: it is not written.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, entry)| entry)
    }

    /// Tests whether no key is written.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Sets `key`, in place if it exists.
    pub fn set(&mut self, key: &str, entry: Entry) {
        match self.entries.iter_mut().find(|(name, _)| name == key) {
            Some((_, old)) => *old = entry,
            None => self.entries.push((key.to_owned(), entry)),
        }
    }

    /// Starts reading; every key must be read before [`Reader::finish`].
    pub fn read(&self) -> Reader<'_> {
        Reader { settings: self, known: Vec::new() }
    }

    /// The dotted name of one of the table's keys, for messages.
    pub(super) fn key(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }
}

/// Reads a [`Settings`] and remembers which keys are known.
#[derive(Debug)]
pub struct Reader<'a> {
    settings: &'a Settings,
    known: Vec<&'static str>,
}

type Result<T> = std::result::Result<T, SettingsError>;

impl<'a> Reader<'a> {
    /// The entry of `key` as written.
    pub fn entry(&mut self, key: &'static str) -> Option<&'a Entry> {
        self.known.push(key);
        self.note(key, || ValueForm::Any);
        self.settings.get(key)
    }

    /// The keys that were read or known.
    pub fn known(&self) -> &[&'static str] {
        &self.known
    }

    /// Place of the table.
    pub fn origin(&self) -> &'a Origin {
        &self.settings.origin
    }

    /// Notes the values that `key` may have, if keys are recorded.
    pub fn note(&self, key: &str, form: impl FnOnce() -> ValueForm) {
        note(|| (self.settings.key(key), form()));
    }

    /// An error at `key`, or at the table where the key is absent.
    pub fn error(&self, key: &str, message: impl fmt::Display) -> SettingsError {
        self.place(key).error(message)
    }

    /// Place of `key`, or of its table where the key is absent: for an error that is found later.
    pub fn place(&self, key: &str) -> Place {
        let origin = self.settings.get(key).map_or(&self.settings.origin, |entry| &entry.origin);
        Place { origin: origin.clone(), key: self.settings.key(key) }
    }

    /// The error of a missing key.
    pub fn missing(&self, key: &str, what: &str) -> SettingsError {
        SettingsError::new(&self.settings.origin, format!("`{}` is missing: {what}", self.settings.key(key)))
    }

    /// Refuses each of `keys` that is written, for the reason that `message` gives: for keys that other tables of the
    /// kind may have.
    pub fn refuse(&self, keys: &[&str], message: &str) -> Result<()> {
        let found = keys.iter().find(|key| self.settings.get(key).is_some());
        found.map_or(Ok(()), |key| Err(self.error(key, message)))
    }

    fn wrong(&self, key: &str, expected: &str, found: &Value) -> SettingsError {
        self.error(key, format_args!("must be {expected}, not {}", found.kind()))
    }

    /// A string; `None`: the key is not written.
    pub fn string(&mut self, key: &'static str) -> Result<Option<&'a str>> {
        self.note(key, || ValueForm::Text);
        match self.entry(key).map(|entry| &entry.value) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(other) => Err(self.wrong(key, "a string", other)),
        }
    }

    /// `true` or `false`; `None`: the key is not written.
    pub fn boolean(&mut self, key: &'static str) -> Result<Option<bool>> {
        self.note(key, || ValueForm::Boolean);
        match self.entry(key).map(|entry| &entry.value) {
            None => Ok(None),
            Some(Value::Boolean(value)) => Ok(Some(*value)),
            Some(other) => Err(self.wrong(key, "true or false", other)),
        }
    }

    /// An integer in `range`; `None`: the key is not written.
    pub fn integer(&mut self, key: &'static str, range: RangeInclusive<i64>) -> Result<Option<i64>> {
        self.note(key, || ValueForm::Integer(range.clone()));
        let value = match self.entry(key).map(|entry| &entry.value) {
            None => return Ok(None),
            Some(Value::Integer(value)) => *value,
            Some(other) => return Err(self.wrong(key, "an integer", other)),
        };
        if !range.contains(&value) {
            return Err(self.error(key, format_args!("must be in {}..={}, not {value}", range.start(), range.end())));
        }
        Ok(Some(value))
    }

    /// A finite number in `range`; integers count as numbers.
    pub fn number(&mut self, key: &'static str, range: RangeInclusive<f64>) -> Result<Option<f64>> {
        self.note(key, || ValueForm::Number(range.clone()));
        let Some(entry) = self.entry(key) else {
            return Ok(None);
        };
        self.finite(key, entry).and_then(|value| self.within(key, value, &range)).map(Some)
    }

    /// `N` finite numbers, each in `range`.
    pub fn numbers<const N: usize>(
        &mut self,
        key: &'static str,
        range: RangeInclusive<f64>,
    ) -> Result<Option<[f64; N]>> {
        self.note(key, || ValueForm::Numbers(N, range.clone()));
        let Some(entry) = self.entry(key) else {
            return Ok(None);
        };
        let Value::Array(items) = &entry.value else {
            return Err(self.wrong(key, &format!("an array of {N} numbers"), &entry.value));
        };
        if items.len() != N {
            return Err(self.error(key, format_args!("must have {N} numbers, not {}", items.len())));
        }
        let mut out = [0.0; N];
        for (slot, item) in out.iter_mut().zip(items) {
            *slot = self.finite(key, item).and_then(|value| self.within(key, value, &range))?;
        }
        Ok(Some(out))
    }

    /// One of the named choices.
    pub fn choice<T: Copy>(&mut self, key: &'static str, choices: &[(&str, T)]) -> Result<Option<T>> {
        self.note(key, || ValueForm::Choice(choices.iter().map(|(name, _)| (*name).to_owned()).collect()));
        let Some(text) = self.string(key)? else {
            return Ok(None);
        };
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(Some(*value));
        }
        let names = choices.iter().map(|(name, _)| *name);
        Err(self.error(key, format_args!("cannot be \"{text}\": {}", suggest(text, names))))
    }

    /// A sub-table.
    pub fn table(&mut self, key: &'static str) -> Result<Option<&'a Settings>> {
        self.note(key, || ValueForm::Table);
        match self.entry(key).map(|entry| &entry.value) {
            None => Ok(None),
            Some(Value::Table(table)) => Ok(Some(table)),
            Some(other) => Err(self.wrong(key, "a table", other)),
        }
    }

    /// An array of tables (`[[key]]`); empty where absent.
    pub fn tables(&mut self, key: &'static str) -> Result<Vec<&'a Settings>> {
        self.note(key, || ValueForm::Tables);
        let items = match self.entry(key).map(|entry| &entry.value) {
            None => return Ok(Vec::new()),
            Some(Value::Array(items)) => items,
            Some(other) => {
                return Err(self.wrong(key, &format!("an array of tables, [[{key}]]"), other));
            }
        };
        items
            .iter()
            .map(|item| match &item.value {
                Value::Table(table) => Ok(table),
                other => Err(self.wrong(key, &format!("an array of tables, [[{key}]]"), other)),
            })
            .collect()
    }

    /// Refuses keys that nobody read.
    pub fn finish(self) -> Result<()> {
        for (key, entry) in &self.settings.entries {
            if !self.known.contains(&key.as_str()) {
                let hint = suggest(key, self.known.iter().copied());
                let place = if self.settings.path.is_empty() {
                    String::from("the scene")
                } else {
                    format!("[{}]", self.settings.path)
                };
                return Err(SettingsError::new(&entry.origin, format!("unknown key `{key}` in {place}: {hint}")));
            }
        }
        Ok(())
    }

    fn finite(&self, key: &str, entry: &Entry) -> Result<f64> {
        let value = match &entry.value {
            Value::Integer(value) => *value as f64,
            Value::Float(value) => *value,
            other => return Err(self.wrong(key, "a number", other)),
        };
        if value.is_finite() { Ok(value) } else { Err(self.error(key, format_args!("must be finite, not {value}"))) }
    }

    fn within(&self, key: &str, value: f64, range: &RangeInclusive<f64>) -> Result<f64> {
        if range.contains(&value) {
            return Ok(value);
        }
        Err(self.error(key, format_args!("must be {}, not {}", words(range), Plain(value))))
    }
}

#[cfg(test)]
#[path = "settings_tests.rs"]
mod tests;
