//! What a running report has done so far, a line a row, so that a run that was cut short goes on where it stopped.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::results::Row;

/// Why a journal cannot be kept or read.
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
}

#[derive(Serialize, Deserialize)]
struct Line {
    fingerprint: String,
    row: Row,
}

/// The journal's name in a report's folder.
pub fn path_in(folder: &Path) -> PathBuf {
    folder.join("report.journal.jsonl")
}

/// The rows of `fingerprint` that a journal holds. A last line that was cut off is passed over; no journal holds none.
///
/// # Errors
///
/// A file that cannot be read.
pub fn done(folder: &Path, fingerprint: &str) -> Result<Vec<Row>, Error> {
    let path = path_in(folder);
    let file = match File::open(&path) {
        Ok(file) => file,
        Err(reason) if reason.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(reason) => return Err(Error { path, reason }),
    };
    let mut rows: Vec<Row> = Vec::new();
    for line in BufReader::new(file).lines() {
        let line = line.map_err(|reason| Error { path: path.clone(), reason })?;
        let Ok(Line { fingerprint: of, row }) = serde_json::from_str::<Line>(&line) else { continue };
        if of == fingerprint && !rows.iter().any(|have| have.index == row.index) {
            rows.push(row);
        }
    }
    Ok(rows)
}

/// Keeps a second report out of the folder while this one runs, and empties a journal that is not gone on with.
fn lock(file: &File, resume: bool) -> io::Result<()> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            return Err(io::Error::other("another report is being written into this folder"));
        }
        // Where files cannot be locked, the user has to see to it.
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
    pub fn open(folder: &Path, resume: bool) -> Result<Self, Error> {
        let path = path_in(folder);
        let mut options = OpenOptions::new();
        let options = if resume { options.append(true) } else { options.write(true).truncate(false) };
        match options.create(true).open(&path) {
            Ok(mut file) => {
                lock(&file, resume).map_err(|reason| Error { path: path.clone(), reason })?;
                // A line that was cut off ends here.
                let ended = if resume { file.write_all(b"\n") } else { Ok(()) };
                ended.map_err(|reason| Error { path: path.clone(), reason })?;
                Ok(Self { path, file })
            }
            Err(reason) => Err(Error { path, reason }),
        }
    }

    /// Adds a row; it is on its way to the disk when this returns.
    ///
    /// # Errors
    ///
    /// A full disk, for example.
    pub fn add(&mut self, fingerprint: &str, row: &Row) -> Result<(), Error> {
        let line = Line { fingerprint: fingerprint.to_owned(), row: row.clone() };
        let text = serde_json::to_string(&line).map_err(io::Error::from);
        let written = text.and_then(|text| writeln!(self.file, "{text}").and_then(|()| self.file.flush()));
        written.map_err(|reason| Error { path: self.path.clone(), reason })
    }

    /// Removes the journal of a report that is complete.
    pub fn remove(self) {
        // The report itself is whole; a journal that stays is only untidy.
        let _ = std::fs::remove_file(&self.path);
    }
}
