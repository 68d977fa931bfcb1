//! Oddities of a file that can still be used: each kind once, with its first line and its number of occurrences.

use std::path::{Path, PathBuf};

use super::Warning;

/// The kinds met so far, in the order of their first lines.
#[derive(Debug, Default)]
pub(super) struct WarningTally {
    kinds: Vec<Kind>,
}

#[derive(Debug)]
struct Kind {
    name: String,
    path: PathBuf,
    line: usize,
    message: String,
    count: usize,
}

impl WarningTally {
    /// Counts something of the kind `name`; `message` is called at its first occurrence.
    pub fn note(&mut self, name: &str, path: &Path, line: usize, message: impl FnOnce() -> String) {
        match self.kinds.iter_mut().find(|kind| kind.name == name) {
            Some(kind) => kind.count += 1,
            None => self.kinds.push(Kind {
                name: name.to_owned(),
                path: path.to_owned(),
                line,
                message: message(),
                count: 1,
            }),
        }
    }

    /// A warning for each kind.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> {
        self.kinds.iter().map(|kind| {
            let message = match kind.count {
                1 => kind.message.clone(),
                count => format!("{} ({count} times)", kind.message),
            };
            Warning { path: kind.path.clone(), line: kind.line, message }
        })
    }
}
