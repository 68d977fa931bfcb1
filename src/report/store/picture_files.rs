//! A report's pictures as files beside it, so that merged parts still have them. `pictures/` holds each as PNG under the
//! scene's fingerprint, which separates those of different sweeps.

use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};

use super::light_pictures;
use super::pictures::rows_that_matter;
use super::results::{Report, SceneReport};
use crate::report::measure::picks::Goals;
use crate::report::show::html::{DifferencePicture, ReportPictures, ScenePictures};

/// Reason why the pictures of a part cannot be used.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The system refused to read the file.
    #[error("{path}: cannot be read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: std::io::Error },
    /// The file is no PNG, or of another size than its scene.
    #[error("{path}: is no picture of this report ({reason}): the file is damaged", path = .path.display())]
    Damaged { path: PathBuf, reason: String },
}

/// The folder of the pictures in a report's folder.
pub fn folder_in(folder: &Path) -> PathBuf {
    folder.join("pictures")
}

/// Each picture with its file.
pub(super) fn files(folder: &Path, report: &Report, pictures: &ReportPictures) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for (scene, of_scene) in report.scenes.iter().zip(&pictures.scenes) {
        let mut add = |what: &str, png: &[u8]| files.push((path_of(folder, scene, what), png.to_vec()));
        of_scene.picture.iter().for_each(|png| add("picture", png));
        of_scene.truth.iter().for_each(|png| add("truth", png));
        of_scene.differences.iter().for_each(|difference| add(&row(difference.row), &difference.png));
        of_scene.light.iter().for_each(|(name, png)| add(name, png));
    }
    // A scene that occurs twice in a report has its pictures once.
    files.sort();
    files.dedup_by(|a, b| a.0 == b.0);
    files
}

/// Tests whether a file of this name is a picture that [`files`] may have named.
pub(super) fn is_picture(name: &str) -> bool {
    let Some((fingerprint, what)) = name.strip_suffix(".png").and_then(|stem| stem.split_once('-')) else {
        return false;
    };
    let is_row = what.strip_prefix("row-").is_some_and(|index| index.parse::<usize>().is_ok());
    fingerprint.chars().all(|letter| letter.is_ascii_alphanumeric())
        && (is_row || what == "picture" || what == "truth" || light_pictures::is_name(what))
}

fn row(index: usize) -> String {
    format!("row-{index}")
}

fn path_of(folder: &Path, scene: &SceneReport, what: &str) -> PathBuf {
    // The fingerprint of a damaged report may be anything; it must not name a place elsewhere.
    let fingerprint: String = scene.fingerprint.chars().filter(char::is_ascii_alphanumeric).collect();
    folder_in(folder).join(format!("{fingerprint}-{what}.png"))
}

/// The pictures of a merged report, from the folders of its `parts`: of each scene, and of the rows that matter in all of
/// it. If no part has a row's picture, because it was measured with other goals, the report gets a note.
///
/// # Errors
///
/// A picture that cannot be read or is none of its scene's size.
pub fn of_parts(parts: &[PathBuf], report: &mut Report, goals: &Goals) -> Result<ReportPictures, Error> {
    let folders: Vec<&Path> = parts.iter().map(|part| folder_of(part)).collect();
    let mut pictures = ReportPictures::default();
    for scene in &report.scenes {
        let mut of_scene = ScenePictures {
            picture: find(&folders, scene, "picture")?,
            truth: find(&folders, scene, "truth")?,
            differences: Vec::new(),
            light: Vec::new(),
        };
        for picture in light_pictures::names(scene) {
            of_scene.light.extend(find(&folders, scene, &picture.name)?.map(|png| (picture.name, png)));
        }
        let mut missing = Vec::new();
        for (measured, caption) in rows_that_matter(scene, goals) {
            match find(&folders, scene, &row(measured.index))? {
                Some(png) => of_scene.differences.push(DifferencePicture { row: measured.index, caption, png }),
                None => missing.push(measured.index.to_string()),
            }
        }
        if of_scene.truth.is_some() && !missing.is_empty() {
            let (path, rows) = (scene.path.display(), missing.join(", "));
            let note =
                format!("{path}: no part has a picture of row {rows}; parts draw those that meet their own goals.");
            report.notes.extend((!report.notes.contains(&note)).then_some(note));
        }
        pictures.scenes.push(of_scene);
    }
    Ok(pictures)
}

/// The folder of a part, which is named by its folder or by the report in it.
fn folder_of(part: &Path) -> &Path {
    if part.is_dir() { part } else { part.parent().unwrap_or(part) }
}

fn find(folders: &[&Path], scene: &SceneReport, what: &str) -> Result<Option<Vec<u8>>, Error> {
    for folder in folders {
        let path = path_of(folder, scene, what);
        match std::fs::read(&path) {
            Ok(png) => return check(&png, scene).map(|()| Some(png)).map_err(|reason| Error::Damaged { path, reason }),
            Err(reason) if reason.kind() == ErrorKind::NotFound => {}
            Err(reason) => return Err(Error::Read { path, reason }),
        }
    }
    Ok(None)
}

fn check(png: &[u8], scene: &SceneReport) -> Result<(), String> {
    let reader = image::ImageReader::with_format(Cursor::new(png), image::ImageFormat::Png);
    let picture = reader.decode().map_err(|error| error.to_string())?;
    let (found, [width, height]) = ([picture.width(), picture.height()], scene.size);
    if found == scene.size { Ok(()) } else { Err(format!("it has {found:?} pixels, not {width} x {height}")) }
}

#[cfg(test)]
mod tests {
    use super::super::{merge, write};
    use super::*;
    use crate::png_file::{PngTexts, of_rgb};
    use crate::report::samples;

    fn png(size: [u32; 2]) -> Vec<u8> {
        of_rgb(&image::RgbImage::new(size[0], size[1]), &PngTexts::default()).unwrap()
    }

    /// A part's folder with the pictures of the scene, and of `rows`.
    fn part(folder: &Path, rows: &[usize]) -> Report {
        let report = samples::report();
        let size = report.scenes[0].size;
        let difference = |row: &usize| DifferencePicture { row: *row, caption: String::new(), png: png(size) };
        let differences = rows.iter().map(difference).collect();
        let of_scene =
            ScenePictures { picture: Some(png(size)), truth: Some(png(size)), differences, light: Vec::new() };
        let pictures = ReportPictures { scenes: vec![of_scene] };
        write::write_all(folder, &report, &pictures, &Goals::default()).unwrap();
        report
    }

    #[test]
    fn parts_give_the_pictures_of_the_rows_that_matter_in_the_whole() {
        let [a, b] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let goals = Goals::default();
        let wanted: Vec<usize> =
            rows_that_matter(&samples::report().scenes[0], &goals).iter().map(|(row, _)| row.index).collect();
        assert!(wanted.len() > 2);
        let mut report = part(a.path(), &wanted[..1]);
        part(b.path(), &wanted[1..]);
        // One named by its folder, one by its report.
        let parts = [a.path().to_owned(), b.path().join("report.json")];
        let pictures = of_parts(&parts, &mut report, &goals).unwrap();
        let of_scene = &pictures.scenes[0];
        assert_eq!(of_scene.differences.iter().map(|d| d.row).collect::<Vec<_>>(), wanted);
        assert!(of_scene.picture.is_some() && of_scene.truth.is_some() && report.notes.is_empty());
        let alone = of_parts(&parts[..1], &mut report, &goals).unwrap();
        assert_eq!(alone.scenes[0].differences.len(), 1);
        assert!(report.notes[0].contains("no part has a picture of row"), "{:?}", report.notes);
    }

    #[test]
    fn damaged_pictures_and_those_of_other_sweeps_are_not_taken() {
        let folder = tempfile::tempdir().unwrap();
        let mut report = part(folder.path(), &[0]);
        let parts = [folder.path().to_owned()];
        let mut other = merge::load(folder.path()).unwrap();
        other.scenes[0].fingerprint = String::from("../../elsewhere");
        let pictures = of_parts(&parts, &mut other, &Goals::default()).unwrap();
        assert_eq!(pictures.scenes[0], ScenePictures::default());
        let truth = path_of(folder.path(), &report.scenes[0], "truth");
        for (bytes, expected) in [(png([3, 4]), "[3, 4] pixels"), (b"no picture".to_vec(), "damaged")] {
            std::fs::write(&truth, bytes).unwrap();
            let error = of_parts(&parts, &mut report, &Goals::default()).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("truth.png"), "{error}");
        }
    }
}
