//! Reads reports back and joins the parts of a sweep, wherever they were measured.
//!
//! Parts belong together when their scenes have the same fingerprints and one driver drew them: then every number but the
//! times is the same as if one machine had done it all. Several processors are allowed, since schedulers assign any
//! machine, and the report notes them. Any other mismatch is an error that names the files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::results::{Machine, Measured, Outcome, Report, Row, SceneReport, VERSION};

/// Reason why a report cannot be read, or parts cannot be joined.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The system refused to read the file.
    #[error("{path}: cannot be read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: std::io::Error },
    /// The file is no JSON.
    #[error("{path}: is no JSON, or was cut off: {reason}", path = .path.display())]
    Json { path: PathBuf, reason: String },
    /// The file is JSON, and no report.
    #[error("{path}: is no report of glumbra: {reason}", path = .path.display())]
    NoReport { path: PathBuf, reason: String },
    /// The report was written by another version of glumbra.
    #[error("{path}: has layout {found}, this glumbra reads {VERSION}: measure again", path = .path.display())]
    Version { path: PathBuf, found: u64 },
    /// A report contradicts itself.
    #[error("{path}: scene {scene}: {reason}: the file is damaged", path = .path.display(), scene = .scene.display())]
    Damaged { path: PathBuf, scene: PathBuf, reason: String },
    /// No report is named.
    #[error("there is nothing to merge: name the folders of at least one report")]
    Nothing,
    /// Two parts were drawn by different drivers.
    #[error(
        "{second} was drawn by another {what} than {first}: \"{second_value}\", not \"{first_value}\"; their errors and \
         times cannot be combined in one report",
        first = .first.display(), second = .second.display()
    )]
    Driver { first: PathBuf, second: PathBuf, what: &'static str, first_value: String, second_value: String },
    /// A part has a scene that the others do not have.
    #[error(
        "{second} holds scene {scene}, which is not in {first}: parts of one sweep have the same scenes, light, size and \
         grid",
        first = .first.display(), second = .second.display(), scene = .scene.display()
    )]
    Scenes { first: PathBuf, second: PathBuf, scene: PathBuf },
    /// Two parts have different facts about one scene.
    #[error(
        "{first} and {second} disagree on {what} of scene {scene}",
        first = .first.display(), second = .second.display(), scene = .scene.display()
    )]
    Differ { first: PathBuf, second: PathBuf, scene: PathBuf, what: &'static str },
    /// Two parts have one row, with different errors.
    #[error(
        "{first} and {second} both hold row {row} of scene {scene} ({settings}), and not only their times differ",
        first = .first.display(), second = .second.display(), scene = .scene.display()
    )]
    Row { first: PathBuf, second: PathBuf, scene: PathBuf, row: usize, settings: String },
}

/// Reads the report that `path` is, or `report.json` in the folder that it is.
///
/// # Errors
///
/// A file that cannot be read, is cut off, is of another layout, or contradicts itself.
pub fn load(path: &Path) -> Result<Report, Error> {
    let path = if path.is_dir() { path.join("report.json") } else { path.to_owned() };
    let bytes = std::fs::read(&path).map_err(|reason| Error::Read { path: path.clone(), reason })?;
    let json = |reason: serde_json::Error| Error::Json { path: path.clone(), reason: reason.to_string() };
    let value: serde_json::Value = serde_json::from_slice(&bytes).map_err(json)?;
    let no_report = |reason: String| Error::NoReport { path: path.clone(), reason };
    let version = value.get("version").ok_or_else(|| no_report("it has no `version`".to_owned()))?;
    let found = version.as_u64().ok_or_else(|| no_report("its `version` is no number".to_owned()))?;
    if found != u64::from(VERSION) {
        return Err(Error::Version { path, found });
    }
    let mut report: Report = serde_json::from_value(value).map_err(|reason| no_report(reason.to_string()))?;
    for scene in &report.scenes {
        let damaged = |reason| Error::Damaged { path: path.clone(), scene: scene.path.clone(), reason };
        check_rows(scene).map_err(damaged)?;
    }
    report.complete = report.has_all_rows();
    Ok(report)
}

/// Rows in ascending order, inside the grid.
fn check_rows(scene: &SceneReport) -> Result<(), String> {
    let mut least = 0;
    for row in &scene.rows {
        if row.index < least {
            return Err(format!("row {} stands twice or out of order", row.index));
        }
        if row.index >= scene.grid_rows {
            return Err(format!("row {} lies outside its grid of {} rows", row.index, scene.grid_rows));
        }
        least = row.index + 1;
    }
    Ok(())
}

/// Joins parts, each with the name to call it by in an error.
///
/// # Errors
///
/// Parts of different scenes or drivers, or a row that two parts have with different answers.
pub fn merge(parts: Vec<(PathBuf, Report)>) -> Result<Report, Error> {
    for (path, part) in &parts {
        for scene in &part.scenes {
            let damaged = |reason| Error::Damaged { path: path.clone(), scene: scene.path.clone(), reason };
            check_rows(scene).map_err(damaged)?;
        }
    }
    // The one with most scenes goes first: a part that was cut short has the first of them only.
    let most = parts.iter().map(|(_, part)| part.scenes.len()).max().ok_or(Error::Nothing)?;
    let (first, reference) = parts.iter().find(|(_, part)| part.scenes.len() == most).ok_or(Error::Nothing)?;
    for (second, part) in &parts {
        check_driver([first, second], &reference.machine, &part.machine)?;
        let has = |scene: &SceneReport| reference.scenes.iter().any(|s| s.fingerprint == scene.fingerprint);
        if let Some(scene) = part.scenes.iter().find(|scene| !has(scene)) {
            return Err(Error::Scenes { first: first.clone(), second: second.clone(), scene: scene.path.clone() });
        }
    }
    let scenes = reference.scenes.iter().map(|scene| join_scene(scene, &parts)).collect::<Result<_, _>>()?;
    let mut report = Report {
        version: VERSION,
        complete: false,
        machine: Machine {
            jobs: parts.iter().map(|(_, part)| part.machine.jobs).max().unwrap_or(1),
            ..parts[0].1.machine.clone()
        },
        notes: join_notes(&parts),
        asked_scenes: parts.iter().map(|(_, part)| part.asked_scenes).max().unwrap_or(0),
        scenes,
    };
    report.complete = report.has_all_rows();
    Ok(report)
}

fn check_driver(paths: [&PathBuf; 2], first: &Machine, second: &Machine) -> Result<(), Error> {
    let fields = [
        ("renderer", &first.renderer, &second.renderer),
        ("GL version", &first.gl_version, &second.gl_version),
        ("kind of context", &first.backend, &second.backend),
        ("glumbra", &first.glumbra, &second.glumbra),
    ];
    match fields.into_iter().find(|(_, first, second)| first != second) {
        None => Ok(()),
        Some((what, first_value, second_value)) => Err(Error::Driver {
            first: paths[0].clone(),
            second: paths[1].clone(),
            what,
            first_value: first_value.clone(),
            second_value: second_value.clone(),
        }),
    }
}

/// The notes of all parts, each once; and the machines, where there are several.
fn join_notes(parts: &[(PathBuf, Report)]) -> Vec<String> {
    let mut notes: Vec<String> = Vec::new();
    let mut machines: BTreeMap<String, usize> = BTreeMap::new();
    for (_, part) in parts {
        for note in &part.notes {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
        let name = format!("{}, {} cores", part.machine.processor, part.machine.cores);
        *machines.entry(name).or_default() += 1;
    }
    if machines.len() > 1 {
        let list = machines.iter().map(|(name, parts)| format!("{name} ({parts} of the parts)"));
        let list = list.collect::<Vec<_>>().join("; ");
        notes.push(format!("Measured on several machines, so that times of different rows may not compare: {list}."));
    }
    notes
}

/// All rows of one scene, by index.
fn join_scene(scene: &SceneReport, parts: &[(PathBuf, Report)]) -> Result<SceneReport, Error> {
    let same = |other: &&SceneReport| other.fingerprint == scene.fingerprint;
    let mut joined: Option<(&PathBuf, SceneReport)> = None;
    let mut rows: BTreeMap<usize, (&PathBuf, &Row)> = BTreeMap::new();
    for (path, part) in parts {
        for other in part.scenes.iter().filter(same) {
            match &mut joined {
                None => joined = Some((path, SceneReport { rows: Vec::new(), ..other.clone() })),
                Some((first, known)) => {
                    check_scene(first, known, path, other)?;
                    // The first part alone measures them.
                    if known.claims.is_empty() {
                        known.claims.clone_from(&other.claims);
                        known.claim_sweeps.clone_from(&other.claim_sweeps);
                    }
                    if known.sweeps.is_empty() {
                        known.sweeps.clone_from(&other.sweeps);
                    }
                }
            }
            for row in &other.rows {
                let (first, known) = rows.entry(row.index).or_insert((path, row));
                if !equal_but_for_times(known, row) {
                    return Err(Error::Row {
                        first: (*first).clone(),
                        second: path.clone(),
                        scene: other.path.clone(),
                        row: row.index,
                        settings: format!("{} {}", row.technique, row.settings_text()).trim().to_owned(),
                    });
                }
            }
        }
    }
    let mut scene = joined.map_or_else(|| scene.clone(), |(_, scene)| scene);
    scene.rows = rows.into_values().map(|(_, row)| row.clone()).collect();
    Ok(scene)
}

/// Checks what the fingerprint promises, because a report may have been edited by hand.
fn check_scene(first: &Path, known: &SceneReport, second: &Path, other: &SceneReport) -> Result<(), Error> {
    let truth = |scene: &SceneReport| {
        let truth = &scene.truth;
        [truth.drawn, truth.lit, truth.shadowed, truth.ambiguous]
    };
    let checks = [
        ("the light", known.light == other.light),
        ("the size", known.size == other.size),
        ("the triangles", known.triangles == other.triangles),
        ("the number of rows", known.grid_rows == other.grid_rows),
        ("the truth", truth(known) == truth(other)),
    ];
    match checks.into_iter().find(|(_, is_equal)| !is_equal) {
        None => Ok(()),
        Some((what, _)) => {
            Err(Error::Differ { first: first.to_owned(), second: second.to_owned(), scene: other.path.clone(), what })
        }
    }
}

/// Tests whether two rows say the same, however long they took.
pub fn equal_but_for_times(a: &Row, b: &Row) -> bool {
    let outcome = match (&a.outcome, &b.outcome) {
        (Outcome::Measured(a), Outcome::Measured(b)) => without_times(a) == without_times(b),
        (Outcome::Failed(a), Outcome::Failed(b)) => a == b,
        _ => false,
    };
    outcome && a.index == b.index && a.technique == b.technique && a.settings == b.settings
}

fn without_times(measured: &Measured) -> Measured {
    let mut timeless = measured.clone();
    (timeless.frame_redrawn, timeless.frame_kept) = Default::default();
    for pass in &mut timeless.passes {
        (pass.wall, pass.gpu) = Default::default();
    }
    timeless
}

#[cfg(test)]
#[path = "merge_tests.rs"]
mod tests;
