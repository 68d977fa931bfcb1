//! Files that a run writes: tried before it, written as results come, and whole at every moment.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use super::CheckArgs;
use crate::cli::Error;
use crate::cli::json::is_standard_stream;
use crate::conformance::waivers::{self, Waiver};
use crate::conformance::{self, Checked};
use crate::output::{self, atomic_write};

/// Between two writes while rules are run.
const PAUSE: Duration = Duration::from_millis(200);

/// The files of a run.
pub struct Files<'a> {
    json: Option<&'a Path>,
    junit: Option<&'a Path>,
    waivers: Option<&'a Path>,
    written: Option<Instant>,
}

impl<'a> Files<'a> {
    /// Makes the files' folders and tries to write into them.
    ///
    /// # Errors
    ///
    /// Two names of one file, and a file that cannot be written.
    pub fn new(arguments: &'a CheckArgs) -> Result<Self, Error> {
        refuse_one_file_for_two(arguments)?;
        let [json, junit, waivers] =
            [&arguments.json, &arguments.junit, &arguments.write_waivers].map(|path| path.as_deref());
        for path in [json, junit, waivers].into_iter().flatten().filter(|path| !is_standard_stream(path)) {
            try_to_write(path).map_err(|error| Error::WriteFile { path: path.to_owned(), error })?;
        }
        Ok(Self { json, junit, waivers, written: None })
    }

    /// Tests whether standard output is for a file's text.
    pub fn take_standard_output(&self) -> bool {
        [self.json, self.junit].into_iter().flatten().any(is_standard_stream)
    }

    /// Writes the results so far, unless that has just been done. Pipes and devices are left for the end.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write_unfinished(&mut self, checked: &Checked) -> Result<bool, Error> {
        if self.written.is_some_and(|written| written.elapsed() < PAUSE) {
            return Ok(false);
        }
        self.write(checked, |path| !is_standard_stream(path) && path.metadata().map_or(true, |found| found.is_file()))?;
        self.written = Some(Instant::now());
        Ok(true)
    }

    /// Writes all results.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write_all(&self, checked: &Checked, known: &[Waiver]) -> Result<(), Error> {
        self.write(checked, |_| true)?;
        if let Some(path) = self.waivers {
            put(&[(path, waivers::write(checked, known)?)])?;
        }
        Ok(())
    }

    fn write(&self, checked: &Checked, wanted: impl Fn(&Path) -> bool) -> Result<(), Error> {
        let mut files: Vec<(&Path, String)> = Vec::new();
        if let Some(path) = self.json.filter(|path| wanted(path)) {
            files.push((path, output::json::document("check", checked)?));
        }
        if let Some(path) = self.junit.filter(|path| wanted(path)) {
            files.push((path, conformance::junit(checked)?));
        }
        put(&files)
    }
}

/// Writes all, or none.
fn put(files: &[(&Path, String)]) -> Result<(), Error> {
    for (_, text) in files.iter().filter(|(path, _)| is_standard_stream(path)) {
        crate::cli::print(text)?;
    }
    let files: Vec<&(&Path, String)> = files.iter().filter(|(path, _)| !is_standard_stream(path)).collect();
    let paths: Vec<&Path> = files.iter().map(|(path, _)| *path).collect();
    let written = atomic_write::write_all(&paths, |index, path| std::fs::write(path, &files[index].1));
    written.map_err(|(index, error)| Error::WriteFile { path: paths[index].to_owned(), error })
}

/// Makes the folder of a file, and tries whether the file can be written.
fn try_to_write(path: &Path) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| *folder != Path::new("")) {
        std::fs::create_dir_all(folder)?;
    }
    atomic_write::try_to_write(path)
}

fn refuse_one_file_for_two(arguments: &CheckArgs) -> Result<(), Error> {
    let files = [
        ("--json", &arguments.json),
        ("--junit", &arguments.junit),
        ("--waivers", &arguments.waivers),
        ("--write-waivers", &arguments.write_waivers),
        ("--baseline", &arguments.baseline),
    ];
    let files: Vec<_> = files.into_iter().filter_map(|(name, path)| path.as_ref().map(|path| (name, path))).collect();
    for (index, (first, path)) in files.iter().enumerate() {
        if let Some((second, _)) = files[index + 1..].iter().find(|(_, other)| output::is_same_file(path, other)) {
            return Err(Error::SameFile { path: (*path).clone(), first, second });
        }
    }
    Ok(())
}
