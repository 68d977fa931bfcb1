//! The files of a scene: loading them, and seeing that one has changed. Times of change are looked at now and then: for a few
//! files that costs microseconds, and needs no help from the system.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::scene::{self, Camera, Entry, Loaded, Origin, Scene, Settings, Value};
use crate::techniques;

/// Time between two looks.
pub(super) const INTERVAL: Duration = Duration::from_millis(300);

/// Ends of the names of models that read other files, and those of these files.
const WITH_OTHERS: [&str; 2] = ["obj", "gltf"];
const BESIDE: [&str; 2] = ["mtl", "bin"];

/// Time of change and length; `None`: the file is not there.
type Stamp = Option<(SystemTime, u64)>;

/// A scene's file or text, the changes by the command line, and the files that are read.
#[derive(Clone, Debug)]
pub struct Sources {
    path: PathBuf,
    /// Text that was read once: its files are not watched, and are relative to the current folder. `None`: there is a file.
    text: Option<String>,
    overrides: Vec<String>,
    stamps: BTreeMap<PathBuf, Stamp>,
}

impl Sources {
    /// Loads a scene and notes its files.
    ///
    /// # Errors
    ///
    /// As [`crate::load`].
    pub fn load(path: &Path, overrides: Vec<String>) -> Result<(Self, Loaded), scene::Error> {
        let mut sources = Self { path: path.to_owned(), text: None, overrides, stamps: BTreeMap::new() };
        sources.stamps = stamps([path.to_owned()].into_iter().collect());
        let loaded = sources.loaded(&sources.overrides)?;
        sources.note(&loaded.scene);
        Ok((sources, loaded))
    }

    /// Loads a scene from the text of a scene file, called `name` where it is saved.
    ///
    /// # Errors
    ///
    /// As [`crate::load_str`].
    pub fn of_text(name: &str, text: String, overrides: Vec<String>) -> Result<(Self, Loaded), scene::Error> {
        let sources = Self { path: name.into(), text: Some(text), overrides, stamps: BTreeMap::new() };
        let loaded = sources.loaded(&sources.overrides)?;
        Ok((sources, loaded))
    }

    fn loaded(&self, overrides: &[String]) -> Result<Loaded, scene::Error> {
        match &self.text {
            None => techniques::load(&self.path, overrides),
            Some(text) => techniques::load_str(text, Path::new(""), overrides),
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The scene again, through the camera of a name.
    pub(super) fn reload(&mut self, camera: Option<&str>) -> Result<Loaded, scene::Error> {
        let before = stamps(self.stamps.keys().cloned().collect());
        let loaded = self.loaded(&self.overrides_with(camera));
        self.stamps = before;
        if let Ok(loaded) = &loaded {
            self.note(&loaded.scene);
        }
        loaded
    }

    /// Tests whether a file has changed, and notes that.
    pub(super) fn have_changed(&mut self) -> bool {
        let now = stamps(self.stamps.keys().cloned().collect());
        let changed = now != self.stamps;
        self.stamps = now;
        changed
    }

    /// Names of the scene's cameras, if it has several.
    pub(super) fn cameras(&self) -> Result<Vec<String>, scene::Error> {
        if !self.is_toml() {
            return Ok(Vec::new());
        }
        let overrides: Vec<String> = self.overrides.iter().filter(|text| !text.starts_with(CHOICE)).cloned().collect();
        let root = match &self.text {
            None => scene::settings(&self.path, &overrides)?,
            Some(text) => scene::settings_of_text(text, Path::new(""), &overrides)?,
        };
        let Some(Entry { value: Value::Array(items), .. }) = root.get("camera") else { return Ok(Vec::new()) };
        let name = |item: &Entry| match &item.value {
            Value::Table(table) => match &table.get("name")?.value {
                Value::String(name) => Some(name.clone()),
                _ => None,
            },
            _ => None,
        };
        Ok(items.iter().filter_map(name).collect())
    }

    /// The camera that the command line chooses, by its place in `cameras`; else the first.
    pub(super) fn first_camera(&self, cameras: &[String]) -> usize {
        let chosen = self.overrides.iter().rev().find_map(|text| text.strip_prefix(CHOICE));
        let is_chosen = |name: &String| chosen == Some(name) || chosen == Some(&Value::String(name.clone()).to_toml());
        cameras.iter().position(is_chosen).unwrap_or(0)
    }

    /// The camera of a name.
    pub(super) fn camera(&self, name: &str) -> Result<Camera, scene::Error> {
        Ok(self.loaded(&self.overrides_with(Some(name)))?.scene.camera)
    }

    /// The scene's table with absolute paths and every camera, through which to save it.
    pub(super) fn settings(&self) -> Result<Settings, scene::Error> {
        let overrides: Vec<String> = self.overrides.iter().filter(|text| !text.starts_with(CHOICE)).cloned().collect();
        match &self.text {
            None => scene::portable_settings(&self.path, &overrides),
            Some(text) => scene::portable_settings_of_text(text, Path::new(""), &overrides),
        }
    }

    fn overrides_with(&self, camera: Option<&str>) -> Vec<String> {
        match camera {
            None => self.overrides.clone(),
            Some(name) => {
                let others = self.overrides.iter().filter(|text| !text.starts_with(CHOICE)).cloned();
                others.chain([format!("{CHOICE}{}", Value::String(name.to_owned()).to_toml())]).collect()
            }
        }
    }

    fn is_toml(&self) -> bool {
        self.text.is_some() || ends_in(&self.path, "toml")
    }

    /// Notes the files that the scene was read from. A file that has changed since it was noted keeps its stamp.
    fn note(&mut self, scene: &Scene) {
        let mut files = vec![self.path.clone()];
        if self.is_toml() {
            // Names of files are absolute there, and entries know the file that they stand in.
            if let Ok(root) = scene::portable_settings(&self.path, &self.overrides) {
                walk(&root, &mut files);
            }
            // One of them may have no key.
            files.extend(scene::included_files(&self.path).unwrap_or_default());
        }
        files.extend(scene.textures().map(|texture| PathBuf::from(&texture.name)).filter(|path| path.is_file()));
        let models = files.iter().filter(|path| WITH_OTHERS.iter().any(|end| ends_in(path, end)));
        let folders: Vec<PathBuf> = models.filter_map(|path| path.parent()).map(Path::to_owned).collect();
        files.extend(folders.iter().flat_map(|folder| beside(folder)));
        let known = std::mem::take(&mut self.stamps);
        self.stamps = stamps(files);
        for (path, stamp) in known {
            if let Some(own) = self.stamps.get_mut(&path) {
                *own = stamp;
            }
        }
    }
}

/// Beginning of the override that chooses a camera.
const CHOICE: &str = "camera=";

fn stamps(files: Vec<PathBuf>) -> BTreeMap<PathBuf, Stamp> {
    let stamp = |path: &PathBuf| {
        let found = fs::metadata(path).ok()?;
        Some((found.modified().unwrap_or(SystemTime::UNIX_EPOCH), found.len()))
    };
    files.into_iter().map(|path| (path.clone(), stamp(&path))).collect()
}

fn ends_in(path: &Path, end: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(end))
}

/// Files of a folder that a model there may read.
fn beside(folder: &Path) -> Vec<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    entries.filter(|path| BESIDE.iter().any(|end| ends_in(path, end))).collect()
}

/// Adds the files that a table names, and those that its entries stand in.
fn walk(table: &Settings, files: &mut Vec<PathBuf>) {
    for (_, entry) in &table.entries {
        walk_entry(entry, files);
    }
}

fn walk_entry(entry: &Entry, files: &mut Vec<PathBuf>) {
    if let Origin::File { path, .. } = &entry.origin
        && !files.iter().any(|known| **known == **path)
    {
        files.push(path.to_path_buf());
    }
    match &entry.value {
        Value::String(name) if Path::new(name).is_absolute() && Path::new(name).is_file() => files.push(name.into()),
        Value::Array(items) => items.iter().for_each(|item| walk_entry(item, files)),
        Value::Table(inner) => walk(inner, files),
        _ => {}
    }
}
