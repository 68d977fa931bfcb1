//! Files that `glumbra check` writes: results, and waivers.

use std::path::Path;
use std::time::Duration;

use super::CheckArgs;
use crate::cli::Error;
use crate::cli::json::is_standard_stream;
use crate::cli::result_files::{self, Pace, can_be_replaced, put};
use crate::conformance::waivers::{self, Waiver};
use crate::conformance::{self, Checked};
use crate::output;

/// Between two writes while rules are run.
const PAUSE: Duration = Duration::from_millis(200);

/// The files of a run.
pub struct Files<'a> {
    json: Option<&'a Path>,
    junit: Option<&'a Path>,
    waivers: Option<&'a Path>,
    pace: Pace,
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
        [json, junit, waivers].into_iter().flatten().try_for_each(result_files::try_to_write)?;
        Ok(Self { json, junit, waivers, pace: Pace::new(PAUSE) })
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
        let Self { json, junit, pace, .. } = self;
        pace.write(|| write([*json, *junit], checked, can_be_replaced))
    }

    /// Writes all results.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write_all(&self, checked: &Checked, known: &[Waiver]) -> Result<(), Error> {
        write([self.json, self.junit], checked, |_| true)?;
        if let Some(path) = self.waivers {
            put(&[(path, waivers::write(checked, known)?)])?;
        }
        Ok(())
    }
}

/// Writes those of the files that are `wanted`.
fn write([json, junit]: [Option<&Path>; 2], checked: &Checked, wanted: impl Fn(&Path) -> bool) -> Result<(), Error> {
    let mut files: Vec<(&Path, String)> = Vec::new();
    if let Some(path) = json.filter(|path| wanted(path)) {
        files.push((path, output::json::document("check", checked)?));
    }
    if let Some(path) = junit.filter(|path| wanted(path)) {
        files.push((path, conformance::junit(checked)?));
    }
    put(&files)
}

fn refuse_one_file_for_two(arguments: &CheckArgs) -> Result<(), Error> {
    result_files::refuse_one_file_for_two(&[
        ("--json", arguments.json.as_deref()),
        ("--junit", arguments.junit.as_deref()),
        ("--waivers", arguments.waivers.as_deref()),
        ("--write-waivers", arguments.write_waivers.as_deref()),
        ("--baseline", arguments.baseline.as_deref()),
    ])
}
