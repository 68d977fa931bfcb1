//! From a file to a resolved [`Scene`]: TOML, OBJ, MD2 or glTF in, plain values out. Errors carry file and line, unknown keys
//! are refused. Knows geometry and math; no technique and no GL.

mod assets;
mod builder;
mod bumps;
mod camera_framing;
mod default_scene;
mod error;
mod files;
mod furnish;
mod hidden;
mod include;
mod json;
mod model;
mod overrides;
mod parse;
mod photo;
mod pixels;
mod plain;
mod print;
mod projected;
mod ranges;
mod read_shadow;
mod record;
mod resolve;
mod settings;
mod shadow;
mod sight;
mod suggest;
mod views;

use std::fs;
use std::path::Path;
use std::sync::Arc;

pub use builder::{LightBuilder, ObjectBuilder, SceneBuilder};
#[doc(hidden)]
pub use bumps::Normalize;
pub use bumps::{BumpMethod, BumpShading};
#[doc(hidden)]
pub use default_scene::{Floor, framing};
pub use error::Error;
pub use model::{
    Background, Camera, Dust, DustBlend, Focus, Frustum, Hidden, Image, Law, Light, LightKind, LightShape, ModelSkin,
    Object, Photo, PicturePasses, Point, Scene, Shading, Spot,
};
#[doc(hidden)]
pub use photo::photos_of;
#[doc(hidden)]
pub use projected::{BeamProfile, DistanceTable, TableSteps};
pub use projected::{Falloff, FalloffLaw, ImageFilter, Interpolation, LightBeam};
#[doc(hidden)]
pub use ranges::{LARGEST, SMALLEST};
#[doc(hidden)]
pub use read_shadow::ReadShadow;
#[doc(hidden)]
pub use record::{ValueForm, record};
#[doc(hidden)]
pub use resolve::MAX_IMAGE_SIDE;
#[doc(hidden)]
pub use settings::{Entry, Place, Reader, Settings, suggest};
pub use settings::{Origin, SettingsError, Value};
pub use shadow::Shadow;
#[doc(hidden)]
pub use views::with_shadow;

use crate::geometry::ModelWorld;
use crate::math::Aabb;
#[doc(hidden)]
pub use assets::is_model;
use assets::{Assets, has_extension};
use settings::Plain;

/// Greatest size of a scene file, in bytes.
const LONGEST_FILE: u64 = 4 << 20;

/// A scene and its warnings.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Loaded {
    /// The resolved scene.
    pub scene: Scene,
    /// One line each, with the place that it is about.
    pub warnings: Vec<String>,
}

/// A scene file and the pictures and meshes that it names, compiled into a program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// The file's name, for messages.
    pub path: &'static str,
    /// Text of the scene file.
    pub text: &'static str,
    /// Pictures, each with its name in the file.
    pub pictures: &'static [(&'static str, &'static [u8])],
    /// MD2 files, and OBJ files without material libraries, each with its name in the file.
    pub meshes: &'static [(&'static str, &'static [u8])],
}

/// Loads a scene that is part of the program; otherwise as [`load`].
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn load_embedded(embedded: &Embedded, overrides: &[String], shadows: &dyn ReadShadow) -> Result<Loaded, Error> {
    let mut assets = Assets::with_files(embedded.pictures, embedded.meshes);
    let mut root = parse::document(Path::new(embedded.path), embedded.text)?;
    overrides::apply(&mut root, overrides)?;
    let scene = resolve::scene(&root, &mut assets, shadows)?;
    Ok(Loaded { scene, warnings: assets.warnings })
}

/// Loads a scene from text that is made while the program runs, whose pictures and meshes are part of the program; otherwise
/// as [`load`]. `path`: the file's name, for messages.
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn load_with_files(
    path: &Path,
    text: &str,
    [pictures, meshes]: [&'static [(&'static str, &'static [u8])]; 2],
    shadows: &dyn ReadShadow,
) -> Result<Loaded, Error> {
    let mut assets = Assets::with_files(pictures, meshes);
    let root = parse::document(path, text)?;
    let scene = resolve::scene(&root, &mut assets, shadows)?;
    Ok(Loaded { scene, warnings: assets.warnings })
}

/// Loads a scene (.toml) or a model (.obj, .md2, .gltf, .glb, .ply, .stl). A model is supplied with what its file lacks: a floor,
/// a camera, a light. `overrides` are the texts of `--set`, `a.b.c=value`, applied in order. `shadows` reads each light's `[light.shadow]`; [`crate::load`] has glumbra's own
/// techniques read it.
///
/// # Errors
///
/// A file that cannot be read, or a key or value that is wrong, with file and line.
#[doc(hidden)]
pub fn load(path: &Path, overrides: &[String], shadows: &dyn ReadShadow) -> Result<Loaded, Error> {
    let mut assets = Assets::default();
    let root = settings_of(path, overrides, &mut assets)?;
    let scene = resolve::scene(&root, &mut assets, shadows)?;
    Ok(Loaded { scene, warnings: assets.warnings })
}

/// Loads a scene from the `text` of a scene file; the files that it names are relative to `folder`. Otherwise as [`load`].
/// Messages call it `<text>`.
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn load_str(text: &str, folder: &Path, overrides: &[String], shadows: &dyn ReadShadow) -> Result<Loaded, Error> {
    let mut assets = Assets::default();
    let root = settings_of_text(text, folder, overrides)?;
    let scene = resolve::scene(&root, &mut assets, shadows)?;
    Ok(Loaded { scene, warnings: assets.warnings })
}

/// As [`settings`], from the text of a scene file: see [`load_str`].
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn settings_of_text(text: &str, folder: &Path, overrides: &[String]) -> Result<Settings, Error> {
    let path = folder.join("<text>");
    let mut root = include::complete(parse::document(&path, text)?, &path)?;
    overrides::apply(&mut root, overrides)?;
    Ok(root)
}

/// As [`portable_settings`], from the text of a scene file: see [`load_str`].
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn portable_settings_of_text(text: &str, folder: &Path, overrides: &[String]) -> Result<Settings, Error> {
    let mut root = settings_of_text(text, folder, overrides)?;
    files::make_absolute(&mut root, None)?;
    Ok(root)
}

/// The files that a scene file includes, and those that they do.
///
/// # Errors
///
/// As [`load`].
#[doc(hidden)]
pub fn included_files(path: &Path) -> Result<Vec<std::path::PathBuf>, Error> {
    include::files(path)
}

/// The scene as [`load`] reads it, before it is resolved: for [`Settings::to_toml`].
#[doc(hidden)]
pub fn settings(path: &Path, overrides: &[String]) -> Result<Settings, Error> {
    settings_of(path, overrides, &mut Assets::default())
}

/// Length in seconds of the first animation of a model's file; 0: it has none.
///
/// # Errors
///
/// A file that cannot be read, with its name.
#[doc(hidden)]
pub fn model_seconds(path: &Path) -> Result<f64, Error> {
    match is_model(path) {
        true => Ok(Assets::default().model(path)?.world().map_or(0.0, |world| world.seconds)),
        false => Ok(0.0),
    }
}

/// A TOML file that is no scene, as a table whose entries know their lines.
///
/// # Errors
///
/// A file that cannot be read, is too long, or is no TOML.
#[doc(hidden)]
pub fn table(path: &Path) -> Result<Settings, Error> {
    parse::document(path, &read_text(path, LONGEST_FILE)?)
}

/// The scene as [`settings`] has it, but with absolute paths to its files: to be saved in any folder.
#[doc(hidden)]
pub fn portable_settings(path: &Path, overrides: &[String]) -> Result<Settings, Error> {
    let mut root = settings(path, overrides)?;
    files::make_absolute(&mut root, is_model(path).then_some(path))?;
    Ok(root)
}

/// Reads a `[light.shadow]` from the inside of an inline table: `technique = "shadow-map", size = 512`.
#[doc(hidden)]
pub fn shadow_settings(inside: &str) -> Result<Settings, Error> {
    let origin = Origin::CommandLine(format!("[light.shadow] with {inside}").into());
    let text = format!("{{ {inside} }}");
    let entry = parse::value("light.shadow", &text, &origin)?;
    match entry.map(|entry| entry.value) {
        Some(Value::Table(table)) => Ok(table),
        _ => Err(Error::Settings(SettingsError::new(&origin, "expected an inline table: { key = value, … }"))),
    }
}

fn settings_of(path: &Path, overrides: &[String], assets: &mut Assets) -> Result<Settings, Error> {
    if path.is_dir() {
        return Err(Error::Folder { path: path.to_owned() });
    }
    if is_model(path) {
        return around_model(path, overrides, assets);
    }
    if !has_extension(path, "toml") {
        return Err(Error::UnknownKind { path: path.to_owned() });
    }
    let mut root = include::document(path)?;
    overrides::apply(&mut root, overrides)?;
    Ok(root)
}

/// The key that leaves out the floor of a supplied scene.
const FLOOR: &str = "floor";

/// The supplied scene around a model's file. Overrides can move the model and reshape the picture, so the framing is repeated
/// after them.
fn around_model(path: &Path, overrides: &[String], assets: &mut Assets) -> Result<Settings, Error> {
    let model = assets.model(path)?;
    let name = path.to_string_lossy();
    assets.also_known_as(&name, &model);
    let mut world = model.world().cloned();
    let framed = |world: &Option<Arc<ModelWorld>>, bounds: &Aabb, aspect: f64, floor: Floor| {
        let mut root = framing(&name, bounds, aspect, floor);
        world.iter().for_each(|world| furnish::with_world(&mut root, world));
        root
    };
    let is_furnished = world.as_ref().is_some_and(|world| !world.cameras.is_empty() || !world.lights.is_empty());
    let bounds = model.bounds();
    let mut first = framed(&world, &bounds, 1.0, if is_furnished { Floor::Absent } else { Floor::Touching });
    overrides::apply(&mut first, overrides)?;

    let mut reader = first.read();
    let is_floor_wanted = reader.boolean(FLOOR)?.unwrap_or(true);
    let aspect = resolve::image(reader.table("image")?)?.aspect();
    let tables = reader.tables("object")?;
    // Cameras and lights move, too.
    if let (Some(world), Some(object)) = (&mut world, tables.first())
        && let Some(moment) = resolve::object::moment(&mut object.read())?
    {
        *world = assets.at(path, &moment)?;
    }
    let object = tables.first().map(|object| resolve::object::read(object, &Shading::default(), assets)).transpose()?;
    let objects = object.map(|(objects, _)| objects).unwrap_or_default();
    let bounds = objects.iter().map(Object::world_bounds).reduce(Aabb::union).unwrap_or(bounds);
    check_size(path, &bounds)?;
    let floor = match () {
        () if is_furnished || !is_floor_wanted => Floor::Absent,
        () if objects.iter().any(default_scene::has_floor) => {
            let hair = default_scene::hair(&bounds);
            let below = Plain(format!("{hair:.1e}").parse().unwrap_or(hair));
            let what = "has a floor of its own: the supplied one lies";
            assets.warn(format!("{}: {what} {below} below it; --no-floor leaves it out", path.display()));
            Floor::Below
        }
        () => Floor::Touching,
    };
    let mut root = framed(&world, &bounds, aspect, floor);
    overrides::apply(&mut root, overrides)?;
    root.entries.retain(|(key, _)| key != FLOOR);
    Ok(root)
}

/// Refuses a model too large or too small for a camera and a light around it.
fn check_size(path: &Path, bounds: &Aabb) -> Result<(), Error> {
    let radius = camera_framing::working_radius(bounds);
    let [least, most] = default_scene::RADII;
    if (least..=most).contains(&radius) {
        return Ok(());
    }
    let scale = 10_f64.powf(-radius.log10().round()).clamp(1.0 / LARGEST, LARGEST);
    Err(Error::Size { path: path.to_owned(), size: 2.0 * radius, least: 2.0 * least, most: 2.0 * most, scale })
}

/// The text of a file of at most `limit` bytes.
fn read_text(path: &Path, limit: u64) -> Result<String, Error> {
    let unreadable = |reason| Error::Read { path: path.to_owned(), reason };
    let bytes = fs::metadata(path).map_err(unreadable)?.len();
    if bytes > limit {
        return Err(Error::TooLong { path: path.to_owned(), bytes, limit });
    }
    String::from_utf8(fs::read(path).map_err(unreadable)?).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
        Error::NotUtf8 { path: path.to_owned(), line }
    })
}
