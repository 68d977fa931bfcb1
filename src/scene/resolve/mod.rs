//! [`Settings`] to a [`Scene`]: the keys of a scene, their allowed values, and their defaults.

mod beam;
mod bump;
mod camera;
mod falloff;
mod instances;
mod light;
mod material;
pub(super) mod object;
mod photo;
mod placement;
pub(super) mod pose;

use super::assets::Assets;
use super::include;
use super::settings::{Plain, Reader, Settings, SettingsError};
use super::{Background, BumpMethod, BumpShading, Error, Image, PicturePasses, ReadShadow, Scene, Shading};

/// The longest side of a picture, in pixels.
pub const MAX_IMAGE_SIDE: i64 = 16384;

pub(super) const DEFAULT_SIZE: [u32; 2] = [512, 512];
pub(super) const DEFAULT_BACKGROUND: [f32; 3] = [0.30, 0.40, 0.60];

/// GL_LIGHT_MODEL_AMBIENT's initial value.
const DEFAULT_AMBIENT: [f32; 3] = [0.2; 3];

const PASSES: [(&str, PicturePasses); 3] =
    [("one", PicturePasses::One), ("slide", PicturePasses::Slide), ("shadow", PicturePasses::Shadow)];

const BACKGROUNDS: [(&str, Background); 2] = [("scene", Background::Scene), ("ambient", Background::Ambient)];

/// Resolves a scene's root table. Cheap checks come first, so that a wrong key does not wait for a large mesh.
pub(super) fn scene(root: &Settings, assets: &mut Assets, shadows: &dyn ReadShadow) -> Result<Scene, Error> {
    let mut reader = root.read();
    let image = image(reader.table("image")?)?;
    let shading = shading(reader.table("shading")?)?;
    let camera = camera::read_first(&mut reader)?;
    let lights = reader.tables("light")?;
    let objects = reader.tables("object")?;
    check_counts(&reader, objects.len())?;
    if reader.entry(include::KEY).is_some() {
        return Err(reader.error(include::KEY, "can stand in a scene file alone").into());
    }
    reader.finish()?;

    let lights =
        lights.iter().enumerate().map(|(i, table)| light::read(table, i, assets)).collect::<Result<Vec<_>, _>>()?;
    let (mut all, mut photos) = (Vec::with_capacity(objects.len()), Vec::with_capacity(objects.len()));
    for table in objects {
        let (instances, photo) = object::read(table, &shading, assets)?;
        photos.push((photo, instances.len()));
        all.extend(instances);
    }
    let mut objects = all;
    photo::complete(&photos, &mut objects, shadows)?;
    if lights.is_empty() && objects.iter().any(|object| object.photo.is_none()) {
        assets.warnings.push(format!("{}: the scene has no [[light]]: only ambient light is drawn", root.origin));
    }
    let complete = |light: light::LightKeys| light.complete(&objects, shadows);
    let lights = lights.into_iter().map(complete).collect::<Result<Vec<_>, _>>()?;
    let camera = camera.complete(&objects, &image, &mut assets.warnings)?;
    Ok(Scene { image, camera, shading, lights, objects })
}

/// `[image]`.
pub(super) fn image(table: Option<&Settings>) -> Result<Image, SettingsError> {
    let mut image = Image { size: DEFAULT_SIZE, background: DEFAULT_BACKGROUND };
    let Some(table) = table else {
        return Ok(image);
    };
    let mut reader = table.read();
    if let Some(size) = size(&mut reader)? {
        image.size = size;
    }
    if let Some(background) = reader.colour("background", 1.0)? {
        image.background = background;
    }
    reader.finish()?;
    Ok(image)
}

fn size(reader: &mut Reader<'_>) -> Result<Option<[u32; 2]>, SettingsError> {
    let Some(size) = reader.numbers::<2>("size", f64::MIN..=f64::MAX)? else {
        return Ok(None);
    };
    let allowed = |side: f64| side.fract() == 0.0 && (1.0..=MAX_IMAGE_SIDE as f64).contains(&side);
    if !size.into_iter().all(allowed) {
        let [width, height] = size.map(Plain);
        let message = format!("must be two whole numbers in 1..={MAX_IMAGE_SIDE}, not [{width}, {height}]");
        return Err(reader.error("size", message));
    }
    Ok(Some(size.map(|side| side as u32)))
}

fn shading(table: Option<&Settings>) -> Result<Shading, Error> {
    let (passes, background) = Default::default();
    let mut shading =
        Shading { ambient: DEFAULT_AMBIENT, per_vertex: false, passes, bumps: BumpShading::default(), background };
    let Some(table) = table else {
        return Ok(shading);
    };
    let mut reader = table.read();
    if let Some(ambient) = reader.colour("ambient", 1.0)? {
        shading.ambient = ambient;
    }
    if let Some(per_vertex) = reader.choice("lighting", &[("per-fragment", false), ("per-vertex", true)])? {
        shading.per_vertex = per_vertex;
    }
    shading.bumps = bump::shading(&mut reader)?;
    shading.passes = reader.choice("passes", &PASSES)?.unwrap_or_default();
    if matches!(shading.bumps.method, BumpMethod::ThreePass { .. }) && shading.passes != PicturePasses::One {
        return Err(reader
            .error("bump", "cannot be \"three-pass\" beside `passes`: both name the picture's passes")
            .into());
    }
    shading.background = reader.choice("background", &BACKGROUNDS)?.unwrap_or_default();
    reader.finish()?;
    Ok(shading)
}

fn check_counts(reader: &Reader<'_>, objects: usize) -> Result<(), SettingsError> {
    if objects == 0 {
        return Err(reader.missing("object", "a scene needs at least one [[object]]"));
    }
    Ok(())
}
