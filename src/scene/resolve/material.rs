//! `material = { … }` of an object.

use std::sync::Arc;

use super::bump;
use super::photo::{self, PhotoKeys};
use crate::geometry::{Material, ObjectLinear};
use crate::scene::Error;
use crate::scene::assets::Assets;
use crate::scene::settings::{Settings, SettingsError};

/// Resolves the material of the object `owner`, and reads its photograph.
pub(super) fn read(
    table: &Settings,
    owner: &str,
    assets: &mut Assets,
) -> Result<(Arc<Material>, Option<PhotoKeys>), Error> {
    let fallback = Material::default();
    let mut reader = table.read();
    let diffuse = reader.colour("diffuse", 1.0)?.unwrap_or(fallback.diffuse);
    let ambient = reader.colour("ambient", 1.0)?.unwrap_or(diffuse);
    let specular = reader.colour("specular", 1.0)?.unwrap_or(fallback.specular);
    let shininess = reader.number("shininess", 0.0..=1000.0)?.map_or(fallback.shininess, |value| value as f32);
    let opacity = reader.number("opacity", 0.0..=1.0)?.map_or(fallback.opacity, |value| value as f32);
    let (decal, alpha) = (reader.file("decal")?, reader.file("alpha")?);
    let texgen = reader.table("texgen")?.map(object_linear).transpose()?;
    let photo = reader.table("photo")?;
    let bump = reader.table("bump")?;
    let gloss = bump::gloss(&mut reader)?;
    reader.finish()?;
    let mut load = |file: Option<(&str, &_)>| file.map(|(name, origin)| assets.texture(name, origin)).transpose();
    let (decal, alpha) = (load(decal)?, load(alpha)?);
    let gloss = gloss.map(|written| written.load(assets)).transpose()?;
    let bump = bump.map(|table| bump::read(table, assets)).transpose()?;
    let photo = photo.map(|table| photo::read(table, assets)).transpose()?;
    let name = format!("material of {owner}");
    let material = Material {
        name,
        ambient,
        diffuse,
        specular,
        shininess,
        opacity,
        decal,
        alpha,
        texgen,
        bump,
        gloss,
        ..fallback
    };
    Ok((Arc::new(material), photo))
}

/// `texgen = { s, t, scale }`: GL_OBJECT_LINEAR planes in the mesh's own space and a texture matrix that scales.
fn object_linear(table: &Settings) -> Result<ObjectLinear, SettingsError> {
    let mut reader = table.read();
    let mut plane = |key, fallback: [f32; 4]| {
        let numbers = reader.numbers::<4>(key, -1e6..=1e6)?;
        Ok::<_, SettingsError>(numbers.map_or(fallback, |plane| plane.map(|number| number as f32)))
    };
    let s = plane("s", [1.0, 0.0, 0.0, 0.0])?;
    let t = plane("t", [0.0, 1.0, 0.0, 0.0])?;
    let scale = reader.number("scale", -1e6..=1e6)?.map_or(1.0, |scale| scale as f32);
    reader.finish()?;
    Ok(ObjectLinear { s, t, scale })
}
