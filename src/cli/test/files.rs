//! Files of a run: JSON and JUnit are written as results come, the page at the end.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::results::TestResults;
use super::{junit, page};
use crate::cli::Error;
use crate::cli::json::is_standard_stream;
use crate::cli::result_files::{self, Pace, can_be_replaced};
use crate::output::json;

/// The page in the folder of --html.
const PAGE: &str = "index.html";

/// Between two writes while cases are run.
const PAUSE: Duration = Duration::from_secs(1);

/// Files to write.
pub struct ResultFiles {
    json: Option<PathBuf>,
    junit: Option<PathBuf>,
    page: Option<PathBuf>,
    pace: Pace,
    /// There are results that the files do not have yet. So it is at the start: files of an earlier run are of other results.
    behind: bool,
}

impl ResultFiles {
    /// Makes the files' folders and tries to write into them.
    ///
    /// # Errors
    ///
    /// Two names of one file, and a file that cannot be written.
    pub fn new(json: Option<&Path>, junit: Option<&Path>, html: Option<&Path>) -> Result<Self, Error> {
        let page = html.map(|folder| folder.join(PAGE));
        let named = [("--json", json), ("--junit", junit), ("--html", page.as_deref())];
        result_files::refuse_one_file_for_two(&named)?;
        named.iter().filter_map(|(_, path)| *path).try_for_each(result_files::try_to_write)?;
        let [json, junit] = [json, junit].map(|path| path.map(Path::to_owned));
        Ok(Self { json, junit, page, pace: Pace::new(PAUSE), behind: true })
    }

    /// Tests whether standard output is for a file's text.
    pub fn take_standard_output(&self) -> bool {
        [&self.json, &self.junit].into_iter().flatten().any(|path| is_standard_stream(path))
    }

    /// Notes that there is another result.
    pub fn note_result(&mut self) {
        self.behind = true;
    }

    /// Writes the results so far as JSON and JUnit, if the files do not have them and were not written just now. Pipes and
    /// devices are left for the end.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write_unfinished(&mut self, results: &mut TestResults) -> Result<(), Error> {
        if !self.behind {
            return Ok(());
        }
        let Self { json, junit, pace, .. } = self;
        let written = pace.write(|| {
            results.take_time();
            result_files::put(&texts([json, junit], results, can_be_replaced)?)
        })?;
        self.behind = !written;
        Ok(())
    }

    /// Writes all: JSON and JUnit, or none of the two, and the page even if they could not be written.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self, results: &TestResults) -> Result<(), Error> {
        let texts = texts([&self.json, &self.junit], results, |_| true).and_then(|files| result_files::put(&files));
        let page = self.page.iter().try_for_each(|path| result_files::put(&[(path, page::to_html(results))]));
        texts.and(page)
    }
}

/// The results as JSON and JUnit, for each of the two that has a file that is `wanted`.
fn texts<'a>(
    [json, junit]: [&'a Option<PathBuf>; 2],
    results: &TestResults,
    wanted: impl Fn(&Path) -> bool,
) -> Result<Vec<(&'a Path, String)>, Error> {
    let mut files: Vec<(&Path, String)> = Vec::new();
    if let Some(path) = json.as_deref().filter(|path| wanted(path)) {
        files.push((path, json::document("test", results)?));
    }
    if let Some(path) = junit.as_deref().filter(|path| wanted(path)) {
        files.push((path, junit::to_junit(results)?));
    }
    Ok(files)
}
