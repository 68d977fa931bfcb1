//! Errors before a case is drawn. Every message names the file, the line where there is one, and the remedy.

use std::io;
use std::path::PathBuf;

/// Reason why cases cannot be run.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The system refused to read the file.
    #[error("{path}: cannot be read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: io::Error },

    /// A key, a value or a check that cannot be used.
    #[error("{path}:{line}: {message}", path = .path.display())]
    Format { path: PathBuf, line: usize, message: String },

    /// A folder that cannot be searched.
    #[error("{path}: cannot be searched for cases: {reason}", path = .path.display())]
    Folder { path: PathBuf, reason: io::Error },

    /// No `case.toml` in the folders.
    #[error("no case.toml at or below {}", names(.folders))]
    NoCases { folders: Vec<PathBuf> },

    /// Cases that a filter leaves none of.
    #[error("no case of {of} has {} in its name; --list prints the names", quoted(.filters))]
    NoneLeft { of: usize, filters: Vec<String> },

    /// The path of a case is not UTF-8.
    #[error("{path}: is not UTF-8, which a case's name must be", path = .path.display())]
    NoText { path: PathBuf },

    /// Two folders that were given have a case of one name.
    #[error("{first} and {second} are both called {name}: give one folder above both", first = .first.display(), second = .second.display())]
    SameName { first: PathBuf, second: PathBuf, name: String },
}

fn names(folders: &[PathBuf]) -> String {
    folders.iter().map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(", ")
}

fn quoted(filters: &[String]) -> String {
    filters.iter().map(|filter| format!("\"{filter}\"")).collect::<Vec<_>>().join(" or ")
}
