//! `[[light]]`.

use crate::scene::assets::Assets;
use crate::scene::ranges::LARGEST;
use crate::scene::settings::{Origin, Reader, Settings, SettingsError, suggest};
use crate::scene::{Error, Light, LightKind, LightShape};

/// Lights may be brighter than a surface can be white, by this much.
const BRIGHTEST: f64 = 1e6;

const SHAPES: [(&str, LightShape); 2] = [("cone", LightShape::Cone), ("frustum", LightShape::Frustum)];

/// Resolves the light that stands at `index`, from 0.
pub(super) fn read(table: &Settings, index: usize, assets: &mut Assets) -> Result<Light, Error> {
    let mut reader = table.read();
    let kind = kind(&mut reader)?;
    let position = reader.vector("position")?.ok_or_else(|| reader.missing("position", "where the light stands"))?;
    let target = reader.vector("target")?.ok_or_else(|| reader.missing("target", "what the light points at"))?;
    let up = reader.up(["position", "target"], position, target)?;
    let [near, far] = reader.near_and_far()?;
    let near = near.ok_or_else(|| reader.missing("near", "the near plane of the light's frustum"))?;
    let far = far.ok_or_else(|| reader.missing("far", "the far plane of the light's frustum"))?;
    let name = reader.string("name")?.map_or_else(|| format!("light {index}"), str::to_owned);
    let color = reader.colour("color", BRIGHTEST)?.unwrap_or([1.0; 3]);
    let ambient = reader.colour("ambient", BRIGHTEST)?.unwrap_or([0.0; 3]);
    let diffuse = reader.colour("diffuse", BRIGHTEST)?.unwrap_or(color);
    let specular = reader.colour("specular", BRIGHTEST)?.unwrap_or(color);
    let attenuation = attenuation(&mut reader)?;
    let shadow = shadow(&mut reader)?;
    let image = reader.file("image")?;
    let frustum_shown = reader.choice("frustum", &[("hidden", false), ("shown", true)])?.unwrap_or(false);
    reader.finish()?;
    let image = image.map(|(name, origin)| assets.texture(name, origin)).transpose()?;
    Ok(Light {
        kind,
        position,
        target,
        up,
        near,
        far,
        ambient,
        diffuse,
        specular,
        attenuation,
        image,
        frustum_shown,
        name,
        shadow,
    })
}

fn kind(reader: &mut Reader<'_>) -> Result<LightKind, SettingsError> {
    match reader.string("kind")? {
        None | Some("spot") => {}
        Some(later @ ("point" | "directional")) => {
            let message = format!("cannot be \"{later}\" yet: this version has \"spot\"; \"{later}\" is planned");
            return Err(reader.error("kind", message));
        }
        Some(other) => {
            let message = format!("cannot be \"{other}\": {}", suggest(other, ["spot"].into_iter()));
            return Err(reader.error("kind", message));
        }
    }
    let cone_radians = reader
        .angle_between("cone", 1.0, 179.0)?
        .ok_or_else(|| reader.missing("cone", "the full angle of the light's frustum, in degrees"))?;
    let shape = reader.choice("shape", &SHAPES)?.unwrap_or(LightShape::Cone);
    Ok(LightKind::Spot { cone_radians, shape })
}

fn attenuation(reader: &mut Reader<'_>) -> Result<[f32; 3], SettingsError> {
    let factors: [f64; 3] = reader.numbers("attenuation", 0.0..=LARGEST)?.unwrap_or([1.0, 0.0, 0.0]);
    let factors = factors.map(|factor| factor as f32);
    if factors.iter().all(|factor| *factor == 0.0) {
        return Err(reader.error("attenuation", "must not be all zero: light is divided by it"));
    }
    Ok(factors)
}

/// `[light.shadow]` as written; empty, at the light's place, where it is absent.
fn shadow(reader: &mut Reader<'_>) -> Result<Settings, SettingsError> {
    let origin: Origin = reader.origin().clone();
    let absent = || Settings { path: String::from("light.shadow"), origin, entries: Vec::new() };
    Ok(reader.table("shadow")?.cloned().unwrap_or_else(absent))
}
