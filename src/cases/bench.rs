//! A case at work: its pictures, each drawn once, by glumbra or by the case's command, and what is left of a failure.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Instant;

use super::command;
use super::draw::{Drawer, DrawnScene, Wanted};
use super::outcome::{Failure, FailureFiles};
use super::read::PixelCase;
use crate::pictures::Raster;
use crate::png_file::PngTexts;

/// Inputs of a picture: the scene's file, its overrides, the number of frames, and what is read.
type Key = (PathBuf, Vec<String>, u32, Wanted);

/// Names of a failure's pictures.
const PICTURES: [&str; 3] = ["actual.png", "expected.png", "difference.png"];

/// Removes the pictures that an earlier run has left of a case, where it has.
pub(super) fn remove_pictures(failures: &Path, case: &PixelCase) {
    for name in PICTURES {
        let _ = std::fs::remove_file(failures.join(&case.name).join(name));
    }
}

/// Inputs that all variants of a case share, and what they measure.
pub(super) struct Shared<'a> {
    pub drawer: RefCell<&'a mut Drawer>,
    /// Measurements of checks that hold.
    pub measured: RefCell<Vec<String>>,
    /// Commands end by then.
    pub deadline: Instant,
    /// Folder for pictures of failures.
    pub failures: &'a Path,
    /// Goldens are written, and fail.
    pub bless: bool,
}

/// One variant of a case.
pub(super) struct CaseBench<'a> {
    pub case: &'a PixelCase,
    pub shared: &'a Shared<'a>,
    drawn: RefCell<HashMap<Key, Rc<DrawnScene>>>,
}

impl<'a> CaseBench<'a> {
    pub fn new(case: &'a PixelCase, shared: &'a Shared<'a>) -> Self {
        Self { case, shared, drawn: RefCell::default() }
    }

    /// The case's overrides, then `sets`.
    pub fn all(&self, sets: &[&[String]]) -> Vec<String> {
        self.case.checks.set.iter().chain(sets.iter().copied().flatten()).cloned().collect()
    }

    /// The case's scene with `sets`, one frame of it.
    pub fn draw(&self, sets: &[&[String]], wanted: Wanted) -> Result<Rc<DrawnScene>, Failure> {
        self.draw_frames(None, sets, 1, wanted)
    }

    /// A scene of the case's folder, or its own, as [`Drawer::draw`] draws it; one that was drawn before is not drawn again.
    pub fn draw_frames(
        &self,
        scene: Option<&Path>,
        sets: &[&[String]],
        frames: u32,
        wanted: Wanted,
    ) -> Result<Rc<DrawnScene>, Failure> {
        let scene = scene.map_or_else(|| self.case.scene(), |scene| self.case.folder.join(scene));
        let key = (scene, self.all(sets), frames, wanted);
        if let Some(known) = self.drawn.borrow().get(&key) {
            return Ok(known.clone());
        }
        let drawn = Rc::new(match &self.case.checks.render {
            Some(words) => {
                let show = |failure: Failure, picture: &Raster| self.failure(failure, picture, None);
                command::draw(words, self.case, wanted, self.shared.deadline, show)?
            }
            None => self.shared.drawer.borrow_mut().draw(&key.0, &key.1, frames, wanted)?,
        });
        self.drawn.borrow_mut().insert(key, drawn.clone());
        Ok(drawn)
    }

    /// The case's own picture by a renderer that has drawn it with `first` just before.
    pub fn draw_after(&self, first: &[String], wanted: Wanted) -> Result<DrawnScene, Failure> {
        let mut drawer = self.shared.drawer.borrow_mut();
        drawer.draw_after(&self.case.scene(), &self.all(&[first]), &self.all(&[]), wanted)
    }

    /// The renderer of the pictures in words, as a golden records it.
    pub fn driver(&self) -> Result<String, Failure> {
        match &self.case.checks.render {
            Some(words) => Ok(format!("the command {}", words.join(" ").replace('\n', " "))),
            None => self.shared.drawer.borrow_mut().driver(),
        }
    }

    /// Texts of the PNG file `name` that shows something of this case.
    pub fn texts(&self, name: &str) -> PngTexts {
        let driver = match &self.case.checks.render {
            Some(_) => self.driver().ok(),
            None => self.shared.drawer.borrow().used_driver().map(str::to_owned),
        };
        let what = name.trim_end_matches(".png");
        PngTexts::titled(format!("{what} picture of the pixel test {}", self.case.name))
            .with(PngTexts::SCENE, self.case.scene().display().to_string())
            .with(PngTexts::DRIVER, driver.unwrap_or_default())
    }

    /// Notes what a check has measured that holds.
    pub fn note(&self, measured: String) {
        self.shared.measured.borrow_mut().push(measured);
    }

    /// Writes the pictures of a failure and adds their place to its message.
    pub fn failure(&self, message: impl Into<Failure>, actual: &Raster, expected: Option<&Raster>) -> Failure {
        let difference = expected.and_then(|expected| actual.difference(expected));
        self.failure_with(message, actual, expected, difference.as_ref())
    }

    /// As [`CaseBench::failure`], with a difference of its own kind.
    pub fn failure_with(
        &self,
        message: impl Into<Failure>,
        actual: &Raster,
        expected: Option<&Raster>,
        difference: Option<&Raster>,
    ) -> Failure {
        let folder = self.shared.failures.join(&self.case.name);
        let mut files = FailureFiles::default();
        // Without the folder, writing the first picture says so.
        let _ = std::fs::create_dir_all(&folder);
        let mut write = |name: &str, picture: Option<&Raster>| {
            let path = folder.join(name);
            match picture?.write_described_png(&path, &self.texts(name)) {
                Ok(()) => Some(path),
                Err(error) => {
                    files.errors.push(error);
                    None
                }
            }
        };
        let [actual, expected, difference] =
            [(PICTURES[0], Some(actual)), (PICTURES[1], expected), (PICTURES[2], difference)]
                .map(|(name, picture)| write(name, picture));
        let files = Box::new(FailureFiles { actual, expected, difference, ..files });
        Failure { files, ..message.into() }
    }
}
