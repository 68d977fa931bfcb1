//! Progress of a running report, one line for each row, so that an interrupted run can continue.

use std::collections::HashSet;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::results::Row;

/// Reason why a journal cannot be written or read.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {reason}", path = .path.display())]
pub struct Error {
    path: PathBuf,
    reason: io::Error,
}

/// An open journal.
pub struct Journal {
    path: PathBuf,
    file: File,
    stamp: String,
}

#[derive(Serialize, Deserialize)]
struct Line {
    /// Fingerprint of the scene and its grid.
    fingerprint: String,
    /// Hash of the driver, the machine and the program: see [`crate::report::store::fingerprint::stamp`].
    #[serde(default)]
    stamp: String,
    row: Row,
}

/// The journal's name in a report's folder.
pub fn path_in(folder: &Path) -> PathBuf {
    folder.join("report.journal.jsonl")
}

/// Rows of a journal, and warnings about the rejected ones.
#[derive(Debug, Default)]
pub struct JournalRows {
    /// Rows, each with the fingerprint of its scene; the first of each index.
    pub rows: Vec<(String, Row)>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// The rows that a journal holds of scenes and grids that `is_known`, by fingerprint and row, under `stamp`. What is
/// damaged, or of something else, is skipped and reported. A missing journal is an empty one.
///
/// # Errors
///
/// A file that cannot be read.
pub fn done(folder: &Path, stamp: &str, is_known: impl Fn(&str, &Row) -> Known) -> Result<JournalRows, Error> {
    let path = path_in(folder);
    let file = match File::open(&path) {
        Ok(file) => file,
        Err(reason) if reason.kind() == io::ErrorKind::NotFound => return Ok(JournalRows::default()),
        Err(reason) => return Err(Error { path, reason }),
    };
    let mut done = JournalRows::default();
    let mut seen = HashSet::new();
    let (mut others, mut strange) = (0, 0);
    for (number, line) in BufReader::new(file).split(b'\n').enumerate() {
        let line = line.map_err(|reason| Error { path: path.clone(), reason })?;
        if line.is_empty() {
            continue;
        }
        let Ok(Line { fingerprint, stamp: of, row }) = serde_json::from_slice::<Line>(&line) else {
            let (path, number) = (path.display(), number + 1);
            done.warnings.push(format!("{path}:{number}: this row is damaged or was cut off; it is measured again"));
            continue;
        };
        match is_known(&fingerprint, &row) {
            Known::OtherScene => others += 1,
            _ if of != stamp => others += 1,
            Known::NoSuchRow => strange += 1,
            Known::Row if seen.insert((fingerprint.clone(), row.index)) => done.rows.push((fingerprint, row)),
            Known::Row => {}
        }
    }
    let path = path.display();
    if others > 0 {
        done.warnings.push(format!(
            "{path}: {others} rows are not taken up: since they were measured a scene, one of its files, the grid, the \
             options, the driver, the machine or glumbra itself has changed"
        ));
    }
    if strange > 0 {
        done.warnings.push(format!("{path}: {strange} rows are not taken up: the grid has no such rows"));
    }
    Ok(done)
}

/// Relation of a journal's row to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Row of the run, with the same settings.
    Row,
    /// Row of a scene, or a grid, that the run does not have.
    OtherScene,
    /// Row of a scene that it has, but with another index or other settings than any.
    NoSuchRow,
}

/// Keeps a second report out of the folder while this one runs, and empties a journal that is not continued.
fn lock(file: &File, resume: bool) -> io::Result<()> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            return Err(io::Error::other("another report is being written into this folder"));
        }
        // If files cannot be locked, the user must take care.
        Ok(()) | Err(TryLockError::Error(_)) => {}
    }
    if resume { Ok(()) } else { file.set_len(0) }
}

impl Journal {
    /// Opens the journal of a folder; `resume` keeps what it holds.
    ///
    /// # Errors
    ///
    /// A file that cannot be made.
    pub fn open(folder: &Path, resume: bool, stamp: &str) -> Result<Self, Error> {
        let path = path_in(folder);
        let mut options = OpenOptions::new();
        let options = if resume { options.append(true) } else { options.write(true).truncate(false) };
        match options.create(true).open(&path) {
            Ok(mut file) => {
                lock(&file, resume).map_err(|reason| Error { path: path.clone(), reason })?;
                // Ends a line that was cut off.
                let ended = if resume { file.write_all(b"\n") } else { Ok(()) };
                ended.map_err(|reason| Error { path: path.clone(), reason })?;
                Ok(Self { path, file, stamp: stamp.to_owned() })
            }
            Err(reason) => Err(Error { path, reason }),
        }
    }

    /// Adds a row; it is written when this returns.
    ///
    /// # Errors
    ///
    /// A full disk, for example.
    pub fn add(&mut self, fingerprint: &str, row: &Row) -> Result<(), Error> {
        let line = Line { fingerprint: fingerprint.to_owned(), stamp: self.stamp.clone(), row: row.clone() };
        let text = serde_json::to_string(&line).map_err(io::Error::from);
        let written = text.and_then(|text| writeln!(self.file, "{text}").and_then(|()| self.file.flush()));
        written.map_err(|reason| Error { path: self.path.clone(), reason })
    }

    /// Removes the journal of a report that is complete.
    pub fn remove(self) {
        // The report itself is complete; a remaining journal does no harm.
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::samples;

    /// Writes a journal of the sample's rows under stamp "s", applies `change` to its bytes, and reads it again.
    fn after(change: impl FnOnce(&mut Vec<u8>)) -> JournalRows {
        let folder = tempfile::tempdir().unwrap();
        let rows = samples::report().scenes.remove(0).rows;
        let mut journal = Journal::open(folder.path(), false, "s").unwrap();
        rows[..5].iter().for_each(|row| journal.add("f1", row).unwrap());
        let path = path_in(folder.path());
        let mut bytes = std::fs::read(&path).unwrap();
        change(&mut bytes);
        std::fs::write(&path, bytes).unwrap();
        let is_known = |fingerprint: &str, row: &Row| match fingerprint {
            "f1" if rows.get(row.index) == Some(row) => Known::Row,
            "f1" => Known::NoSuchRow,
            _ => Known::OtherScene,
        };
        done(folder.path(), "s", is_known).unwrap()
    }

    fn replace(bytes: &mut Vec<u8>, from: &str, to: &str) {
        *bytes = String::from_utf8(bytes.clone()).unwrap().replacen(from, to, 1).into_bytes();
    }

    #[test]
    fn a_whole_journal_comes_back() {
        let done = after(|_| ());
        assert_eq!((done.rows.len(), done.warnings.len()), (5, 0), "{:?}", done.warnings);
    }

    #[test]
    fn a_byte_that_is_no_text_costs_one_row() {
        let done = after(|bytes| {
            let third = bytes.split_inclusive(|byte| *byte == b'\n').take(2).map(<[u8]>::len).sum::<usize>();
            bytes[third + 9] = 0xff;
        });
        assert_eq!(done.rows.iter().map(|(_, row)| row.index).collect::<Vec<_>>(), [0, 1, 3, 4]);
        assert!(done.warnings.len() == 1 && done.warnings[0].contains(".jsonl:3: this row is damaged"), "{done:?}");
    }

    #[test]
    fn a_line_that_was_cut_off_costs_its_row() {
        let done = after(|bytes| bytes.truncate(bytes.len() - 20));
        assert_eq!((done.rows.len(), done.warnings.len()), (4, 1));
    }

    #[test]
    fn rows_that_the_grid_has_not_are_not_believed() {
        let index = after(|bytes| replace(bytes, "\"index\":4", "\"index\":9999"));
        let settings = after(|bytes| replace(bytes, "\"size\",\"256\"", "\"size\",\"257\""));
        for done in [index, settings] {
            assert_eq!(done.rows.len(), 4);
            assert!(done.warnings.len() == 1 && done.warnings[0].contains("1 rows are not taken up"), "{done:?}");
        }
    }

    #[test]
    fn rows_of_something_else_are_not_mixed_in() {
        let scene = after(|bytes| replace(bytes, "\"fingerprint\":\"f1\"", "\"fingerprint\":\"f2\""));
        let stamp = after(|bytes| replace(bytes, "\"stamp\":\"s\"", "\"stamp\":\"t\""));
        let older = after(|bytes| replace(bytes, "\"stamp\":\"s\",", ""));
        for done in [scene, stamp, older] {
            assert_eq!(done.rows.len(), 4);
            assert!(done.warnings.len() == 1 && done.warnings[0].contains("has changed"), "{done:?}");
        }
    }
}
