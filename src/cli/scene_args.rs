//! Arguments of every subcommand that draws: a scene and changes of it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Error;
use super::json::is_standard_stream;
use super::reading_bar::ReadingBar;
use super::screen::Screen;
use crate::plan::ViewRequest;
use crate::scene::{self, Loaded};
use crate::views::VIEWS;

/// Changes of a scene.
#[derive(Clone, Debug, Args)]
pub struct SceneChanges {
    /// The picture's size in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,

    /// Changes a key of the scene, e.g. light.shadow.size=2048 (every light) or light.0.cone=45 (the first)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Draws through the camera of this name, where the scene has several [[camera]]; absent: the first
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,

    /// Draws animated models (.gltf, .glb) at this time of their first animation, or of the one that `animation` of the object
    /// names; absent: as they stand
    #[arg(long, value_name = "SECONDS")]
    at: Option<f64>,

    /// Supplies no floor under a model
    #[arg(long)]
    no_floor: bool,
}

impl SceneChanges {
    /// The overrides in order: size, floor and time first, the choice of a camera last.
    pub fn overrides(&self) -> Vec<String> {
        let size = self.size.map(|[width, height]| format!("image.size=[{width}, {height}]"));
        let floor = self.no_floor.then(|| String::from("floor=false"));
        let camera =
            self.camera.as_ref().map(|name| format!("camera={}", scene::Value::String(name.clone()).to_toml()));
        let at = self.at.map(|seconds| format!("at={}", scene::Value::Float(seconds).to_toml()));
        size.into_iter().chain(floor).chain(at).chain(self.set.iter().cloned()).chain(camera).collect()
    }

    /// Loads the file `scene` with these changes, and prints its warnings; where that takes long, a bar shows how far it is.
    ///
    /// # Errors
    ///
    /// Those of the file, and of options that do not apply to it.
    pub fn load(&self, scene: &Path, screen: Screen) -> Result<Loaded, Error> {
        self.check(scene)?;
        let bar = ReadingBar::start(screen);
        let loaded = match is_standard_stream(scene) {
            true => crate::load_str(
                &std::io::read_to_string(std::io::stdin()).map_err(Error::Input)?,
                Path::new(""),
                &self.overrides(),
            )?,
            false => crate::load(scene, &self.overrides())?,
        };
        drop(bar);
        for warning in &loaded.warnings {
            super::say(format_args!("warning: {warning}"));
        }
        Ok(loaded)
    }

    /// Refuses options that do not apply to the file `scene`.
    pub fn check(&self, scene: &Path) -> Result<(), Error> {
        let is_scene = scene.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
        if self.no_floor && is_scene { Err(Error::NoFloor { scene: scene.to_owned() }) } else { Ok(()) }
    }
}

/// The scene, and changes to it.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// A scene (.toml; - is one on standard input), or a model (.obj, .md2, .gltf, .glb, .ply, .stl) around which a floor,
    /// a spotlight and a camera are supplied
    pub scene: PathBuf,

    #[command(flatten)]
    pub changes: SceneChanges,
}

impl SceneArgs {
    /// Loads the scene and prints its warnings.
    pub fn load(&self, screen: Screen) -> Result<Loaded, Error> {
        self.changes.load(&self.scene, screen)
    }
}

pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once(['x', 'X']).ok_or("write it as 640x480")?;
    let side = |text: &str| text.trim().parse().map_err(|_| format!("'{text}' is no number of pixels"));
    Ok([side(width)?, side(height)?])
}

/// Reads `NAME` or `NAME@LIGHT` of a view that is drawn; `others`: names that may stand in its place.
pub fn parse_view(text: &str, others: &[&'static str]) -> Result<ViewRequest, String> {
    let (name, light) = match text.split_once('@') {
        Some((name, light)) => (name, light.parse().map_err(|_| format!("'{light}' is no number of a light"))?),
        None => (text, 0),
    };
    match VIEWS.iter().find(|row| row.0 == name) {
        Some(row) => Ok(ViewRequest { view: row.1, light }),
        None => Err(scene::suggest(name, VIEWS.iter().map(|row| row.0).chain(others.iter().copied()))),
    }
}
