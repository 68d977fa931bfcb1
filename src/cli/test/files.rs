//! Files of a run: tried before it, written whole at its end.

use std::path::{Path, PathBuf};

use super::results::TestResults;
use super::{junit, page};
use crate::cli::Error;
use crate::cli::json::is_standard_stream;
use crate::output::{self, atomic_write, json};

/// The page in the folder of --html.
const PAGE: &str = "index.html";

/// Files to write.
pub struct ResultFiles {
    json: Option<PathBuf>,
    junit: Option<PathBuf>,
    page: Option<PathBuf>,
}

impl ResultFiles {
    /// Makes the files' folders and tries to write into them.
    ///
    /// # Errors
    ///
    /// Two names of one file, and a file that cannot be written.
    pub fn new(json: Option<&Path>, junit: Option<&Path>, html: Option<&Path>) -> Result<Self, Error> {
        let files = Self {
            json: json.map(Path::to_owned),
            junit: junit.map(Path::to_owned),
            page: html.map(|folder| folder.join(PAGE)),
        };
        let named = [("--json", &files.json), ("--junit", &files.junit), ("--html", &files.page)];
        let named: Vec<_> = named.into_iter().filter_map(|(name, path)| Some((name, path.as_ref()?))).collect();
        for (index, (first, path)) in named.iter().enumerate() {
            if let Some((second, _)) = named[index + 1..].iter().find(|(_, other)| output::is_same_file(path, other)) {
                return Err(Error::SameFile { path: (*path).clone(), first, second });
            }
            if !is_standard_stream(path) {
                try_to_write(path).map_err(|error| Error::WriteFile { path: (*path).clone(), error })?;
            }
        }
        Ok(files)
    }

    /// Tests whether standard output is for a file's text.
    pub fn take_standard_output(&self) -> bool {
        [&self.json, &self.junit].into_iter().flatten().any(|path| is_standard_stream(path))
    }

    /// Writes all, or none.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self, results: &TestResults) -> Result<(), Error> {
        let mut files: Vec<(&Path, String)> = Vec::new();
        if let Some(path) = &self.json {
            files.push((path, json::document("test", results)?));
        }
        if let Some(path) = &self.junit {
            files.push((path, junit::to_junit(results)?));
        }
        if let Some(path) = &self.page {
            files.push((path, page::to_html(results)));
        }
        let (screen, files): (Vec<_>, Vec<_>) = files.into_iter().partition(|(path, _)| is_standard_stream(path));
        screen.iter().try_for_each(|(_, text)| crate::cli::print(text))?;
        let paths: Vec<&Path> = files.iter().map(|(path, _)| *path).collect();
        let written = atomic_write::write_all(&paths, |index, path| std::fs::write(path, &files[index].1));
        written.map_err(|(index, error)| Error::WriteFile { path: paths[index].to_owned(), error })
    }
}

/// Makes the folder of a file, and tries whether the file can be written.
fn try_to_write(path: &Path) -> std::io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| *folder != Path::new("")) {
        std::fs::create_dir_all(folder)?;
    }
    atomic_write::try_to_write(path)
}
