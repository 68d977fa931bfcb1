//! A case on the bench: its pictures, each drawn once, and what is left of a failure.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::draw::{self, Drawn, Wanted};
use super::file::Case;
use super::picture::Picture;

/// Inputs of a picture: the scene's file, its overrides, the number of frames, and what is read.
type Key = (PathBuf, Vec<String>, u32, Wanted);

pub struct Bench<'a> {
    pub case: &'a Case,
    drawn: RefCell<HashMap<Key, Rc<Drawn>>>,
}

impl<'a> Bench<'a> {
    pub fn new(case: &'a Case) -> Self {
        Self { case, drawn: RefCell::default() }
    }

    /// The case's overrides, then `sets`.
    pub fn all(&self, sets: &[&[String]]) -> Vec<String> {
        self.case.checks.set.iter().chain(sets.iter().copied().flatten()).cloned().collect()
    }

    /// The case's scene with `sets`, one frame of it.
    pub fn draw(&self, sets: &[&[String]], wanted: Wanted) -> Result<Rc<Drawn>, String> {
        self.draw_frames(None, sets, 1, wanted)
    }

    /// A scene of the case's folder, or its own, as [`draw::draw`] draws it; one that was drawn before is not drawn again.
    pub fn draw_frames(
        &self,
        scene: Option<&Path>,
        sets: &[&[String]],
        frames: u32,
        wanted: Wanted,
    ) -> Result<Rc<Drawn>, String> {
        let scene = scene.map_or_else(|| self.case.scene(), |scene| self.case.folder.join(scene));
        let key = (scene, self.all(sets), frames, wanted);
        if let Some(known) = self.drawn.borrow().get(&key) {
            return Ok(known.clone());
        }
        let drawn = Rc::new(draw::draw(&key.0, &key.1, frames, wanted)?);
        self.drawn.borrow_mut().insert(key, drawn.clone());
        Ok(drawn)
    }

    /// Writes the pictures of a failure and adds their place to its message.
    pub fn failure(&self, message: String, actual: &Picture, expected: Option<&Picture>) -> String {
        let folder = failures().join(&self.case.name);
        let mut written = Vec::new();
        let mut write = |name: &str, picture: &Picture| {
            let path = folder.join(name);
            match picture.write_png(&path) {
                Ok(()) => written.push(path.display().to_string()),
                Err(error) => written.push(error),
            }
        };
        // Without the folder, writing the first picture says so.
        let _ = std::fs::remove_dir_all(&folder);
        let _ = std::fs::create_dir_all(&folder);
        write("actual.png", actual);
        if let Some(expected) = expected {
            write("expected.png", expected);
            if let Some(difference) = actual.difference(expected) {
                write("difference.png", &difference);
            }
        }
        format!("{message}\n  see {}", written.join("\n      "))
    }
}

fn failures() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("target")).join("case-failures")
}
