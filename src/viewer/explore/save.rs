//! Saves the scene as it now stands: its files' table with what keys and mouse have changed, and the picture of that.

use std::path::PathBuf;

use glam::DVec3;

use super::Explorer;
use crate::frame::Renderer;
use crate::output::{self, SheetFile, to_canvas};
use crate::plan::Request;
use crate::png_file::PngTexts;
use crate::scene::{Camera, Entry, Light, LightKind, Origin, Settings, Value};
use crate::techniques;
use crate::viewer::Error;

/// Greatest number of saved pictures of a scene in a folder.
const MOST_FILES: usize = 10_000;

impl Explorer {
    /// Writes NAME-view-N.png and NAME-view-N.toml, and returns what to say of that.
    pub(super) fn save_both(&self, renderer: &mut Renderer) -> Result<String, Error> {
        let text = self.to_toml()?;
        let picture = self.next_name()?;
        let toml = picture.with_extension("toml");
        // As `glumbra render` reads the file that is written: the picture is that file's to the bit.
        let scene = techniques::load_str(&text, &self.folder, &[])?.scene;
        let frame = renderer.render(&scene, &Request { sampled_warnings: false, ..Request::default() })?;
        let texts = PngTexts::default()
            .with(PngTexts::SCENE, toml.display().to_string())
            .with(PngTexts::DRIVER, renderer.driver());
        let said = format!("saved {} and {}", picture.display(), toml.display());
        let sheet = SheetFile { path: picture, canvas: to_canvas(&frame.picture, None), texts };
        output::write_sheets(&[sheet], &[(toml, text)])?;
        Ok(said)
    }

    /// The scene as it now stands, as the text of a scene file. Names of files in it are absolute.
    pub fn to_toml(&self) -> Result<String, crate::scene::Error> {
        let mut root = self.sources.settings()?;
        let [width, height] = self.size.map(|side| entry(Value::Integer(i64::from(side))));
        if let Some(image) = table(&mut root, "image") {
            image.set("size", entry(Value::Array(vec![width, height])));
        }
        let camera = &self.scene.camera;
        let chosen = chosen_camera(&mut root, self.camera);
        // What the file does not say of the camera follows from the picture's size, too.
        if let Some(table) = chosen.filter(|_| *camera != self.base.camera || self.size != self.base.image.size) {
            write_camera(table, camera);
        }
        let lights = self.scene.lights.iter().zip(&self.base.lights).enumerate();
        for (index, (now, before)) in lights {
            let Some(table) = light(&mut root, index) else { continue };
            if place(now) != place(before) {
                write_light(table, now);
            }
            if now.shadow.written().to_toml() != before.shadow.written().to_toml() {
                table.set("shadow", entry(Value::Table(now.shadow.written().clone())));
            }
        }
        Ok(root.to_toml())
    }

    /// The first name for a picture that neither a picture nor a scene has.
    fn next_name(&self) -> Result<PathBuf, Error> {
        let stem = self.sources.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = self.folder.strip_prefix(".").unwrap_or(&self.folder);
        let mut names = (1..=MOST_FILES).map(|number| folder.join(format!("{stem}-view-{number}.png")));
        let is_free = |path: &PathBuf| !path.exists() && !path.with_extension("toml").exists();
        names.find(is_free).ok_or_else(|| Error::Full { folder: self.folder.clone() })
    }
}

/// Numbers of a light's place and direction.
pub(super) fn place(light: &Light) -> Vec<DVec3> {
    match &light.kind {
        LightKind::Spot(spot) => vec![spot.frustum.position, spot.frustum.target],
        LightKind::Point(point) => vec![point.position],
        LightKind::Directional { direction } => vec![*direction],
    }
}

fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}

fn number(value: f64) -> Entry {
    entry(Value::Float(value))
}

fn vector(value: DVec3) -> Entry {
    entry(Value::Array(value.to_array().map(number).to_vec()))
}

/// The table of a key, which is made if it is not there.
fn table<'a>(root: &'a mut Settings, key: &str) -> Option<&'a mut Settings> {
    if root.get(key).is_none() {
        root.set(key, entry(Value::Table(Settings { path: key.to_owned(), ..Settings::default() })));
    }
    as_table(&mut root.entries.iter_mut().find(|(name, _)| name == key)?.1)
}

fn as_table(entry: &mut Entry) -> Option<&mut Settings> {
    if let Value::Table(table) = &mut entry.value { Some(table) } else { None }
}

/// The table of the chosen camera, which is made the first of several: `glumbra render` draws through that.
fn chosen_camera(root: &mut Settings, index: usize) -> Option<&mut Settings> {
    match root.entries.iter().find(|(name, _)| name == "camera").map(|(_, entry)| &entry.value) {
        Some(Value::Array(_)) => {}
        _ => return table(root, "camera"),
    }
    match &mut root.entries.iter_mut().find(|(name, _)| name == "camera")?.1.value {
        Value::Array(cameras) => {
            cameras.get_mut(..=index)?.rotate_right(1);
            as_table(cameras.first_mut()?)
        }
        _ => None,
    }
}

fn write_camera(table: &mut Settings, camera: &Camera) {
    table.set("eye", vector(camera.eye));
    table.set("target", vector(camera.target));
    table.set("up", vector(camera.up));
    table.set("near", number(camera.near));
    table.set("far", number(camera.far));
}

fn light(root: &mut Settings, index: usize) -> Option<&mut Settings> {
    match &mut root.entries.iter_mut().find(|(name, _)| name == "light")?.1.value {
        Value::Array(lights) => as_table(lights.get_mut(index)?),
        _ => None,
    }
}

fn write_light(table: &mut Settings, light: &Light) {
    match &light.kind {
        LightKind::Spot(spot) => {
            let frustum = &spot.frustum;
            table.set("position", vector(frustum.position));
            table.set("target", vector(frustum.target));
            table.set("up", vector(frustum.up));
            table.set("near", number(frustum.near));
            table.set("far", number(frustum.far));
        }
        LightKind::Point(point) => {
            table.set("position", vector(point.position));
            table.set("near", number(point.near));
            table.set("far", number(point.far));
        }
        LightKind::Directional { direction } => {
            table.entries.retain(|(key, _)| key != "position" && key != "target");
            table.set("direction", vector(*direction));
        }
    }
}
