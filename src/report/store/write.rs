//! A report as files in a folder: `report.json`, `report.csv`, `sweeps.csv` where there are sweeps of projected light,
//! `claims.csv` and `claim-sweeps.csv` where claims were measured, `report.html`, `plots/*.svg` and `pictures/*.png`.
//!
//! Each is made in memory, written under another name, synced and renamed, so that a full disk or a kill leaves the older
//! report or the newer one, never half of one.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::results::{Report, SceneReport};
use super::{csv, picture_files};
use crate::output::atomic_write;
use crate::report::measure::picks::Goals;
use crate::report::show::html::{ReportPictures, to_html};
use crate::report::show::plots::{self, Links, Measure};

/// Reason why a report could not be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The system refused to make the folder.
    #[error("{path}: the folder cannot be made: {reason}", path = .path.display())]
    Folder { path: PathBuf, reason: io::Error },
    /// The system refused to write a file.
    #[error("{path}: cannot be written: {reason}", path = .path.display())]
    Write { path: PathBuf, reason: io::Error },
    /// A plot or picture of an older report cannot be removed.
    #[error("{path}: is of an older report and cannot be removed: {reason}", path = .path.display())]
    Stale { path: PathBuf, reason: io::Error },
    /// The report cannot be put in JSON.
    #[error("the report of {path} cannot be put in JSON: {reason}", path = .path.display())]
    Json { path: PathBuf, reason: String },
    /// A scene's plot cannot be drawn.
    #[error("{scene}: {reason}", scene = .scene.display())]
    Plot { scene: PathBuf, reason: plots::Error },
}

/// Writes all files of a report, makes the folder where it is missing, and removes the plots and pictures that an older
/// report left there.
///
/// # Errors
///
/// The first file that could not be written; then none of them is new, unless a rename itself failed.
pub fn write_all(folder: &Path, report: &Report, pictures: &ReportPictures, goals: &Goals) -> Result<(), Error> {
    let mut files = vec![
        (folder.join("report.json"), to_json(folder, report)?),
        (folder.join("report.csv"), csv::to_csv(report).into_bytes()),
        (folder.join("report.html"), to_html(report, pictures, goals).into_bytes()),
    ];
    for (index, scene) in report.scenes.iter().enumerate() {
        let plot = |reason| Error::Plot { scene: scene.path.clone(), reason };
        let links = Links { page: "../report.html", scene: index + 1 };
        let both = [
            (KINDS[0], plots::error_against_time(scene, &report.machine, links).map_err(plot)?),
            (KINDS[1], plots::error_against_map_size(scene, &report.machine, links).map_err(plot)?),
        ];
        for (kind, svg) in both {
            let path = folder.join("plots").join(plot_name(index + 1, scene, kind));
            files.extend(svg.map(|svg| (path, svg.into_bytes())));
        }
        for sweep in &scene.claim_sweeps {
            let svg = plots::claim_sweep(scene, &report.machine, sweep).map_err(plot)?;
            let path = folder.join("plots").join(plot_name(index + 1, scene, &format!("{}-{}", sweep.name, KINDS[4])));
            files.extend(svg.map(|svg| (path, svg.into_bytes())));
        }
        for sweep in &scene.sweeps {
            for (measure, kind) in [(Measure::Rmse, KINDS[2]), (Measure::Flip, KINDS[3])] {
                let svg = plots::sweep(scene, &report.machine, sweep, measure).map_err(plot)?;
                let kind = format!("{}-{kind}", sweep.name);
                let path = folder.join("plots").join(plot_name(index + 1, scene, &kind));
                files.extend(svg.map(|svg| (path, svg.into_bytes())));
            }
        }
    }
    let tables = [csv::sweeps_to_csv(report), csv::claims_to_csv(report), csv::claim_sweeps_to_csv(report)];
    for (name, text) in TABLES.iter().zip(tables) {
        files.extend(text.map(|text| (folder.join(name), text.into_bytes())));
    }
    let kept_pictures = picture_files::files(folder, report, pictures);
    make_folder(&folder.join("plots"))?;
    if !kept_pictures.is_empty() {
        make_folder(&picture_files::folder_in(folder))?;
    }
    files.extend(kept_pictures);
    write_files(&files)?;
    let written: HashSet<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    remove_stale(folder, &written, |name| TABLES.contains(&name))?;
    remove_stale(&folder.join("plots"), &written, is_plot)?;
    remove_stale(&picture_files::folder_in(folder), &written, picture_files::is_picture)
}

/// Tables that a report may have beside its rows.
const TABLES: [&str; 3] = ["sweeps.csv", "claims.csv", "claim-sweeps.csv"];

/// The plots of a scene.
const KINDS: [&str; 5] =
    ["error-against-time", "error-against-map-size", "rmse-against-time", "flip-against-time", "claim"];

fn is_plot(name: &str) -> bool {
    let is_numbered = name.split_once('-').is_some_and(|(number, _)| number.parse::<usize>().is_ok());
    is_numbered && KINDS.iter().any(|kind| name.ends_with(&format!("-{kind}.svg")))
}

/// Removes what an older report left in a folder: files whose names `is_ours`, but for those just `written`.
fn remove_stale(folder: &Path, written: &HashSet<&Path>, is_ours: fn(&str) -> bool) -> Result<(), Error> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(()) };
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if is_ours(&name) && !written.contains(path.as_path()) {
            fs::remove_file(&path).map_err(|reason| Error::Stale { path, reason })?;
        }
    }
    Ok(())
}

/// Writes `report.json` only, after each row of a sweep, which can continue from it.
///
/// # Errors
///
/// The file could not be written; an older one is then as it was.
pub fn write_json(folder: &Path, report: &Report) -> Result<(), Error> {
    make_folder(folder)?;
    write_files(&[(folder.join("report.json"), to_json(folder, report)?)])
}

fn to_json(folder: &Path, report: &Report) -> Result<Vec<u8>, Error> {
    let failed = |error: serde_json::Error| Error::Json { path: folder.to_owned(), reason: error.to_string() };
    let mut bytes = serde_json::to_vec_pretty(report).map_err(failed)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Makes the folder and its parents, where they are missing.
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|reason| Error::Folder { path: folder.to_owned(), reason })
}

fn write_files(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Error> {
    let paths: Vec<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    let write = |index: usize, temporary: &Path| {
        let mut file = fs::File::create(temporary)?;
        file.write_all(&files[index].1)?;
        // Some file systems report only now that they are full.
        file.sync_all()
    };
    atomic_write::write_all(&paths, write)
        .map_err(|(index, reason)| Error::Write { path: paths[index].to_owned(), reason })
}

/// `2-main-error-against-time.svg`; the number keeps scenes of one name apart.
fn plot_name(number: usize, scene: &SceneReport, kind: &str) -> String {
    let stem = scene.path.file_stem().unwrap_or_default().to_string_lossy();
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
    let plain = |text: &str| -> String {
        text.chars().take(60).map(|letter| if is_plain(letter) { letter } else { '_' }).collect()
    };
    format!("{number}-{}-{}.svg", plain(&stem), plain(kind))
}

#[cfg(test)]
mod tests {
    use super::super::merge;
    use super::*;
    use crate::report::samples;

    fn names(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    fn write(folder: &Path, report: &Report) -> Result<(), Error> {
        write_all(folder, report, &ReportPictures::default(), &Goals::default())
    }

    #[test]
    fn all_files_are_written_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("a/new one");
        let report = samples::report();
        write(&folder, &report).unwrap();
        write(&folder, &report).unwrap();
        assert_eq!(names(&folder), ["claims.csv", "plots", "report.csv", "report.html", "report.json"]);
        let plots = ["1-main-error-against-map-size.svg", "1-main-error-against-time.svg"];
        assert_eq!(names(&folder.join("plots")), plots);
        assert_eq!(merge::load(&folder).unwrap(), report);
    }

    #[test]
    fn an_older_reports_plots_and_pictures_are_removed_and_nothing_else() {
        use crate::png_file::{PngTexts, of_rgb};
        use crate::report::show::html::{DifferencePicture, ScenePictures};
        let folder = tempfile::tempdir().unwrap();
        let png = of_rgb(&image::RgbImage::new(2, 2), &PngTexts::default()).unwrap();
        let difference = |row| DifferencePicture { row, caption: String::new(), png: png.clone() };
        let write = |name: &str, fingerprint: &str, row| {
            let mut report = samples::report();
            report.scenes = vec![samples::scene(name, fingerprint)];
            let scene =
                ScenePictures { truth: Some(png.clone()), differences: vec![difference(row)], ..Default::default() };
            write_all(folder.path(), &report, &ReportPictures { scenes: vec![scene] }, &Goals::default()).unwrap();
        };
        write("old.toml", "f1", 3);
        for mine in ["plots/mine.svg", "pictures/mine.png", "pictures/f1-note.png"] {
            fs::write(folder.path().join(mine), "mine").unwrap();
        }
        write("new.toml", "f2", 4);
        let plots = ["1-new-error-against-map-size.svg", "1-new-error-against-time.svg", "mine.svg"];
        assert_eq!(names(&folder.path().join("plots")), plots);
        let pictures = ["f1-note.png", "f2-row-4.png", "f2-truth.png", "mine.png"];
        assert_eq!(names(&folder.path().join("pictures")), pictures);
    }

    #[cfg(unix)]
    #[test]
    fn a_path_that_is_no_utf_8_is_written_as_text_and_as_bytes() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let mut report = samples::report();
        report.scenes[0].path = std::ffi::OsStr::from_bytes(b"a/\xff.toml").into();
        report.scenes[0].path_bytes = crate::report::store::results::bytes_of(&report.scenes[0].path);
        write(folder.path(), &report).unwrap();
        let scene = merge::load(folder.path()).unwrap().scenes.remove(0);
        assert_eq!(scene.path, Path::new("a/\u{fffd}.toml"));
        assert_eq!(scene.path_bytes.as_deref(), Some("612fff2e746f6d6c"));
    }

    #[test]
    fn a_file_that_cannot_be_written_is_named_and_the_older_report_stays() {
        let folder = tempfile::tempdir().unwrap();
        let report = samples::report();
        write_json(folder.path(), &report).unwrap();
        fs::write(folder.path().join("plots"), "in the way").unwrap();
        let mut newer = report.clone();
        newer.notes.push("newer".to_owned());
        let error = write(folder.path(), &newer).unwrap_err().to_string();
        assert!(error.contains("plots"), "{error}");
        assert_eq!(merge::load(folder.path()).unwrap(), report);
        assert_eq!(names(folder.path()), ["plots", "report.json"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_full_disk_is_told() {
        let full = Path::new("/dev/full");
        if !full.exists() {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(full, folder.path().join("report.json")).unwrap();
        let error = write_json(folder.path(), &samples::report()).unwrap_err().to_string();
        assert!(error.contains("report.json: cannot be written") && error.contains("space"), "{error}");
        assert_eq!(names(folder.path()), ["report.json"]);
    }

    #[test]
    fn scenes_of_one_name_have_their_own_plots() {
        let scenes = [samples::scene("a/x y.toml", "1"), samples::scene("b/x y.toml", "2")];
        let [a, b] = [0, 1].map(|index| plot_name(index + 1, &scenes[index], "k"));
        assert_eq!((a.as_str(), b.as_str()), ("1-x_y-k.svg", "2-x_y-k.svg"));
    }

    /// Leaves a page to look at: `GLUMBRA_SAMPLE=/tmp/x cargo test --lib pictures_are_written`.
    #[test]
    fn pictures_are_written_into_the_page() {
        use crate::png_file::{PngTexts, of_rgb};
        use crate::report::show::html::{DifferencePicture, ScenePictures};
        let temporary = tempfile::tempdir().unwrap();
        let folder = std::env::var_os("GLUMBRA_SAMPLE").map_or(temporary.path().to_owned(), PathBuf::from);
        let png = of_rgb(
            &image::RgbImage::from_fn(512, 512, |x, y| image::Rgb([x as u8, y as u8, 90])),
            &PngTexts::default(),
        )
        .unwrap();
        let difference = DifferencePicture { row: 5, caption: "size = 256".to_owned(), png: png.clone() };
        let scene = ScenePictures {
            picture: Some(png.clone()),
            truth: Some(png),
            differences: vec![difference],
            ..ScenePictures::default()
        };
        let goals = Goals { wrong_percent: 0.3, milliseconds: 10.0 };
        write_all(&folder, &samples::report(), &ReportPictures { scenes: vec![scene] }, &goals).unwrap();
        let page = fs::read_to_string(folder.join("report.html")).unwrap();
        assert_eq!(page.matches("data:image/png;base64,iVBOR").count(), 3);
    }
}
