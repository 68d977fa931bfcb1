//! `include = "room.toml"`: scene files that begin with others. What the file itself says goes over what it includes, and its
//! lights, objects and cameras come after theirs.

use std::path::{Path, PathBuf};

use super::assets::{file, has_extension};
use super::settings::{Entry, Settings, SettingsError, Value};
use super::{Error, LONGEST_FILE, parse, read_text};

/// The key, which stands at a file's root.
pub(super) const KEY: &str = "include";

/// Greatest number of files that one scene is made of; a file that is included twice counts twice.
const MOST_FILES: usize = 256;

/// Arrays of tables that go on where they are written again.
const ARRAYS: [&str; 3] = ["camera", "light", "object"];

/// The table of the scene file `path`, and of what it includes.
///
/// # Errors
///
/// A file that cannot be read or is no TOML; a file that includes itself; a key that is a table in one file and an array in
/// another.
pub(super) fn document(path: &Path) -> Result<Settings, Error> {
    let root = parse::document(path, &read_text(path, LONGEST_FILE)?)?;
    complete(root, path)
}

/// `root`, which was read from `path`, with what it includes.
///
/// # Errors
///
/// As [`document`].
pub(super) fn complete(root: Settings, path: &Path) -> Result<Settings, Error> {
    Includes::of(path).complete(root)
}

/// The files that the scene file `path` includes, each as often as it is included.
///
/// # Errors
///
/// As [`document`].
pub(super) fn files(path: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut includes = Includes::of(path);
    includes.complete(parse::document(path, &read_text(path, LONGEST_FILE)?)?)?;
    Ok(includes.files)
}

struct Includes {
    /// Files that are being read, the outermost first.
    open: Vec<PathBuf>,
    /// Files that were included so far.
    files: Vec<PathBuf>,
}

impl Includes {
    fn of(path: &Path) -> Self {
        Self { open: vec![path.to_owned()], files: Vec::new() }
    }

    fn complete(&mut self, mut root: Settings) -> Result<Settings, Error> {
        let Some(place) = root.entries.iter().position(|(key, _)| key == KEY) else { return Ok(root) };
        let (_, entry) = root.entries.remove(place);
        let mut merged: Option<Settings> = None;
        for entry in names(&entry)? {
            let included = self.read(entry)?;
            merged = Some(match merged {
                None => included,
                Some(before) => merge(before, included)?,
            });
        }
        match merged {
            None => Ok(root),
            Some(before) => Ok(merge(before, root)?),
        }
    }

    fn read(&mut self, entry: &Entry) -> Result<Settings, Error> {
        let refuse = |what: String| Err(SettingsError::new(&entry.origin, format!("`{KEY}` {what}")).into());
        let Value::String(name) = &entry.value else { return refuse(String::from("must name scene files")) };
        let path = file(name, &entry.origin);
        if !has_extension(&path, "toml") {
            return refuse(format!("\"{name}\": a scene ends in .toml"));
        }
        let same = |open: &PathBuf| match (open.canonicalize(), path.canonicalize()) {
            (Ok(open), Ok(path)) => open == path,
            _ => false,
        };
        if let Some(first) = self.open.iter().position(same) {
            let mut chain: Vec<String> = self.open[first..].iter().map(|open| open.display().to_string()).collect();
            chain.push(path.display().to_string());
            return refuse(format!("goes round in a circle: {}", chain.join(" includes ")));
        }
        self.files.push(path.clone());
        if self.files.len() >= MOST_FILES {
            return refuse(format!("\"{name}\": a scene is made of {MOST_FILES} files at most"));
        }
        let unreadable = |error: Error| match error {
            Error::Read { path, reason } => {
                let what = format!("`{KEY}`: {} cannot be read: {reason}", path.display());
                SettingsError::new(&entry.origin, what).into()
            }
            other => other,
        };
        let text = read_text(&path, LONGEST_FILE).map_err(unreadable)?;
        let root = parse::document(&path, &text)?;
        self.open.push(path);
        let complete = self.complete(root);
        self.open.pop();
        complete
    }
}

/// The names in `include`: one, or an array of them.
fn names(entry: &Entry) -> Result<&[Entry], SettingsError> {
    match &entry.value {
        Value::String(_) => Ok(std::slice::from_ref(entry)),
        Value::Array(items) => Ok(items),
        other => {
            let message = format!("`{KEY}` must be a file's name or an array of them, not {}", other.kind());
            Err(SettingsError::new(&entry.origin, message))
        }
    }
}

/// `first` with the keys of `second`: tables key by key, [`ARRAYS`] one after the other, others in place of the first.
fn merge(mut first: Settings, second: Settings) -> Result<Settings, SettingsError> {
    let is_root = first.path.is_empty();
    for (key, entry) in second.entries {
        let Some((_, before)) = first.entries.iter_mut().find(|(name, _)| *name == key) else {
            first.entries.push((key, entry));
            continue;
        };
        let joined = is_root && ARRAYS.contains(&key.as_str());
        match (&mut before.value, entry.value) {
            (Value::Table(table), Value::Table(more)) => *table = merge(std::mem::take(table), more)?,
            (Value::Array(items), Value::Array(more)) if joined => items.extend(more),
            (old @ (Value::Table(_) | Value::Array(_)), new @ (Value::Table(_) | Value::Array(_)))
                if joined && old.kind() != new.kind() =>
            {
                let message = format!("`{key}` is {}, and {} at {}", new.kind(), old.kind(), before.origin);
                return Err(SettingsError::new(&entry.origin, message));
            }
            (_, value) => *before = Entry { value, origin: entry.origin },
        }
    }
    first.origin = second.origin;
    Ok(first)
}
