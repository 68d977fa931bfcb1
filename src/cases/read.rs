//! A case's folder, read: `case.toml` with the lines of its checks.

use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::Error;
use super::file::Checks;
use super::refused;

/// The file of a case in its folder.
pub const FILE: &str = "case.toml";

/// A case folder, read.
#[derive(Clone, Debug)]
pub struct PixelCase {
    /// Folder of `case.toml`, in which commands are run.
    pub folder: PathBuf,
    /// The folder's path below the one that was searched, with `/`; or a name of a test's own.
    pub name: String,
    /// The file.
    pub checks: Checks,
    /// The set of the case's `for_each` that is part of `checks.set`.
    pub variant: Option<Vec<String>>,
    lines: Lines,
}

impl PixelCase {
    /// Reads `folder/case.toml`, and refuses checks that could not fail.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, that has another key or value than a case has, or a check that is worth nothing: with its
    /// path and line.
    pub fn read(folder: &Path, name: &str) -> Result<Self, Error> {
        let path = folder.join(FILE);
        let text = std::fs::read_to_string(&path).map_err(|reason| Error::Read { path, reason })?;
        Self::parse(&text, folder, name)
    }

    /// As [`PixelCase::read`], from the text of a `case.toml` that stands, or could stand, in `folder`.
    ///
    /// # Errors
    ///
    /// Another key or value than a case has, or a check that is worth nothing: with the line.
    pub fn parse(text: &str, folder: &Path, name: &str) -> Result<Self, Error> {
        let path = folder.join(FILE);
        let checks = toml::from_str(text).map_err(|error| {
            let line = line_of(text, error.span().map_or(0, |span| span.start));
            Error::Format { path: path.clone(), line, message: error.message().to_owned() }
        })?;
        let lines = Lines::of(text);
        let case = Self { folder: folder.to_owned(), name: name.to_owned(), checks, variant: None, lines };
        refused::check(&case.checks).map_err(|(place, message)| {
            let line = place.and_then(|(kind, index)| case.line(kind, index)).unwrap_or(1);
            Error::Format { path, line, message }
        })?;
        Ok(case)
    }

    /// The case once for each set of its `for_each`; itself where it has none.
    pub fn variants(&self) -> Vec<Self> {
        let Some(sets) = &self.checks.for_each else { return vec![self.clone()] };
        let with = |set: &Vec<String>| {
            let mut case = Self { variant: Some(set.clone()), ..self.clone() };
            case.checks.set.extend_from_slice(set);
            case
        };
        sets.iter().map(with).collect()
    }

    /// The scene's file.
    pub fn scene(&self) -> PathBuf {
        self.folder.join(&self.checks.scene)
    }

    /// Line of the check that is number `index`, from 0, of its kind. `kind`: its key in the file.
    pub fn line(&self, kind: &str, index: usize) -> Option<usize> {
        let (_, lines) = self.lines.0.iter().find(|(known, _)| known == kind)?;
        lines.get(index).or(lines.first()).copied()
    }
}

/// Lines of each key of the file; of an array of tables, the lines of its tables.
#[derive(Clone, Debug, Default)]
struct Lines(Vec<(String, Vec<usize>)>);

impl Lines {
    fn of(text: &str) -> Self {
        let Ok(table) = DeTable::parse(text) else { return Self::default() };
        let lines = table.get_ref().iter().map(|(key, value)| {
            let own = line_of(text, key.span().start);
            let lines = match value.get_ref() {
                DeValue::Array(items)
                    if !items.is_empty() && items.iter().all(|item| matches!(item.get_ref(), DeValue::Table(_))) =>
                {
                    items.iter().map(|item| line_of(text, item.span().start)).collect()
                }
                _ => vec![own],
            };
            (key.get_ref().to_string(), lines)
        });
        Self(lines.collect())
    }
}

/// Number of the line, from 1, that has the byte at `offset`.
fn line_of(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
}
