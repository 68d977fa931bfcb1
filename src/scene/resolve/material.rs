//! `material = { … }` of an object.

use std::sync::Arc;

use crate::geometry::Material;
use crate::scene::Error;
use crate::scene::assets::Assets;
use crate::scene::settings::Settings;

/// Resolves the material of the object `owner`.
pub(super) fn read(table: &Settings, owner: &str, assets: &mut Assets) -> Result<Arc<Material>, Error> {
    let fallback = Material::default();
    let mut reader = table.read();
    let diffuse = reader.colour("diffuse", 1.0)?.unwrap_or(fallback.diffuse);
    let ambient = reader.colour("ambient", 1.0)?.unwrap_or(diffuse);
    let specular = reader.colour("specular", 1.0)?.unwrap_or(fallback.specular);
    let shininess = reader.number("shininess", 0.0..=1000.0)?.map_or(fallback.shininess, |value| value as f32);
    let opacity = reader.number("opacity", 0.0..=1.0)?.map_or(fallback.opacity, |value| value as f32);
    let (decal, alpha) = (reader.file("decal")?, reader.file("alpha")?);
    reader.finish()?;
    let mut load = |file: Option<(&str, &_)>| file.map(|(name, origin)| assets.texture(name, origin)).transpose();
    let (decal, alpha) = (load(decal)?, load(alpha)?);
    let name = format!("material of {owner}");
    Ok(Arc::new(Material { name, ambient, diffuse, specular, shininess, opacity, decal, alpha }))
}
