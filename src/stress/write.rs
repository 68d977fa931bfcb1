//! A run's outcome as files: `stress.json`, `stress.html`, and scenes that fail, made small.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::case::Case;
use super::results::CaseResult;
use super::{page, plot};
use crate::output::{atomic_write, json};
use crate::report::show::plots;

/// Reason why a run's results could not be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The system refused to make the folder.
    #[error("{path}: the folder cannot be made: {reason}", path = .path.display())]
    Folder { path: PathBuf, reason: io::Error },
    /// The system refused to write a file.
    #[error("{path}: cannot be written: {reason}", path = .path.display())]
    Write { path: PathBuf, reason: io::Error },
    /// The results cannot be put in JSON.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// A sweep's plot cannot be drawn.
    #[error(transparent)]
    Plot(#[from] plots::Error),
    /// A case's scene cannot be saved.
    #[error("{0}")]
    Scene(String),
}

/// All of a run, as JSON has it.
#[derive(serde::Serialize)]
struct Run<'a> {
    seed: u64,
    cases: &'a [CaseResult],
}

/// The JSON of a run.
///
/// # Errors
///
/// An error of the encoder.
pub fn to_json(seed: u64, results: &[CaseResult]) -> Result<String, Error> {
    Ok(json::document("stress", &Run { seed, cases: results })?)
}

/// Writes `stress.html` and `stress.json` into `folder`, and the `reduced` scenes into its folder `scenes`. Both folders
/// are made where they are missing. Scenes of an earlier run are removed.
///
/// # Errors
///
/// The first thing that could not be written.
pub fn write(folder: &Path, seed: u64, results: &[CaseResult], reduced: &[Case]) -> Result<(), Error> {
    make(folder)?;
    let scenes = folder.join("scenes");
    remove_scenes(&scenes);
    if !reduced.is_empty() {
        make(&scenes)?;
    }
    for case in reduced {
        case.write(&scenes).map_err(Error::Scene)?;
    }
    let plots = plot::sweeps(results)?;
    let files = [
        (folder.join("stress.json"), to_json(seed, results)?.into_bytes()),
        (folder.join("stress.html"), page::to_html(results, &plots).into_bytes()),
    ];
    let paths: Vec<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    let written = atomic_write::write_all(&paths, |index, path| fs::write(path, &files[index].1));
    written.map_err(|(index, reason)| Error::Write { path: paths[index].to_owned(), reason })
}

fn make(folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|reason| Error::Folder { path: folder.to_owned(), reason })
}

/// Removes what an earlier run reduced, so that the folder holds this run's scenes alone.
fn remove_scenes(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with("reduced-") && name.ends_with(".toml") {
            // A file that cannot be removed is overwritten or stays: the page names the scenes of this run.
            let _ = fs::remove_file(path);
        }
    }
}
