//! Placement of an object, and of each of its instances: `translate`, `rotate`, `scale`.

use glam::{DMat4, DVec3};

use crate::scene::ranges::{LARGEST, SMALLEST};
use crate::scene::settings::{Reader, Settings, SettingsError, Value};

/// `world_from_model`: scaled, then rotated, then translated.
pub(super) fn read(reader: &mut Reader<'_>) -> Result<DMat4, SettingsError> {
    let translate = reader.vector("translate")?.unwrap_or(DVec3::ZERO);
    let rotate = rotations(reader)?;
    let scale = scale(reader)?;
    Ok(DMat4::from_translation(translate) * rotate * DMat4::from_scale(scale))
}

/// A number or one for each axis; negative mirrors.
fn scale(reader: &mut Reader<'_>) -> Result<DVec3, SettingsError> {
    let scale = match reader.entry("scale").map(|entry| &entry.value) {
        None => return Ok(DVec3::ONE),
        Some(Value::Array(_)) => reader.vector("scale")?,
        Some(Value::Integer(_) | Value::Float(_)) => reader.number("scale", -LARGEST..=LARGEST)?.map(DVec3::splat),
        Some(_) => return Err(reader.error("scale", "must be a number or an array of three")),
    };
    let scale = scale.unwrap_or(DVec3::ONE);
    if scale.abs().min_element() < SMALLEST {
        return Err(reader.error("scale", "must not be zero: a flattened object has no inside"));
    }
    Ok(scale)
}

/// `{ axis, angle }`, or an array of these, the first applied first.
fn rotations(reader: &mut Reader<'_>) -> Result<DMat4, SettingsError> {
    match reader.entry("rotate").map(|entry| &entry.value) {
        None => Ok(DMat4::IDENTITY),
        Some(Value::Table(table)) => rotation(table),
        Some(Value::Array(items)) => items.iter().try_fold(DMat4::IDENTITY, |done, item| match &item.value {
            Value::Table(table) => Ok(rotation(table)? * done),
            _ => Err(wrong_rotation(reader)),
        }),
        Some(_) => Err(wrong_rotation(reader)),
    }
}

fn wrong_rotation(reader: &Reader<'_>) -> SettingsError {
    reader.error("rotate", "must be { axis = [x, y, z], angle = degrees } or an array of these")
}

fn rotation(table: &Settings) -> Result<DMat4, SettingsError> {
    let mut reader = table.read();
    let axis = reader.vector("axis")?.ok_or_else(|| reader.missing("axis", "what to turn about, [x, y, z]"))?;
    let degrees =
        reader.number("angle", -LARGEST..=LARGEST)?.ok_or_else(|| reader.missing("angle", "how far, in degrees"))?;
    reader.finish()?;
    let axis = axis.try_normalize().ok_or_else(|| table.read().error("axis", "must not be of zero length"))?;
    // Whole turns are taken off in degrees, where that is exact.
    Ok(DMat4::from_axis_angle(axis, (degrees % 360.0).to_radians()))
}
