//! `--json FILE`, the same in every command: a file, or `-` for standard output in place of the text.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::Error;
use crate::output::{atomic_write, json};

/// The name that stands for standard input or standard output.
const STANDARD_STREAM: &str = "-";

/// `--json` of a command that also prints text.
#[derive(Clone, Debug, Args)]
pub struct JsonArgs {
    /// Writes the results as JSON to a file; - is standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl JsonArgs {
    /// Tests whether JSON is asked for.
    pub fn is_wanted(&self) -> bool {
        self.json.is_some()
    }

    /// Tests whether standard output is for the JSON.
    pub fn takes_standard_output(&self) -> bool {
        self.json.as_deref().is_some_and(is_standard_stream)
    }

    /// Writes `value` as the results of `command`, if that is asked for.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self, command: &str, value: &impl Serialize) -> Result<(), Error> {
        match &self.json {
            Some(path) => put(path, &json::document(command, value)?),
            None => Ok(()),
        }
    }
}

/// Tests whether `path` stands for standard input or standard output.
pub fn is_standard_stream(path: &Path) -> bool {
    path == Path::new(STANDARD_STREAM)
}

/// Writes a text to a file, whole or not at all, or on standard output.
///
/// # Errors
///
/// A file that cannot be written.
pub fn put(path: &Path, text: &str) -> Result<(), Error> {
    if is_standard_stream(path) {
        return super::print(text);
    }
    let written = atomic_write::write_all(&[path], |_, path| std::fs::write(path, text));
    written.map_err(|(_, error)| Error::WriteFile { path: path.to_owned(), error })
}
