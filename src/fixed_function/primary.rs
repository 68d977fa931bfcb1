//! The primary colour of a light's layer: glColor or GL_LIGHTING, with what each clamps. Knows no GL.

use glam::Vec3;

use super::layer::{LayerLighting, PointLight, Primary};
use super::stack::Weight;
use crate::pass::{FixedFunctionLight, Lit, Shade};

/// Tests whether the angle between a light and the surface's normal counts.
pub fn is_lit(lit: &Lit, light: &FixedFunctionLight) -> bool {
    lit.lit && light.cosine
}

/// Products of the channels.
pub fn product(a: [f32; 3], b: [f32; 3]) -> Vec3 {
    Vec3::from(a) * Vec3::from(b)
}

/// Ambient colour of a light, bounded by what the scene's ambient light leaves below 1.
pub fn own_ambient(lit: &Lit, light: &FixedFunctionLight) -> Vec3 {
    let room = (Vec3::ONE - Vec3::from(lit.scene_ambient)).max(Vec3::ZERO);
    let most = product(light.ambient, lit.ambient);
    if lit.per_vertex { most.min(room) } else { most }
}

/// Tests whether it differs with the distance, or by a constant factor.
pub fn is_attenuated(light: &FixedFunctionLight) -> bool {
    light.attenuation != [1.0, 0.0, 0.0]
}

/// A source in the light's place, without light.
pub fn unlit_source(light: &FixedFunctionLight) -> PointLight {
    let (position, attenuation) = (light.position, light.attenuation);
    PointLight { position, attenuation, ambient: [0.0; 3], diffuse: [0.0; 3], specular: [0.0; 3] }
}

/// Colours of a light that a layer adds, and their weights.
#[derive(Clone, Copy, PartialEq)]
pub struct Parts {
    pub diffuse: bool,
    pub specular: bool,
    pub weight: Weight,
}

/// The light's colour on bumps: it is clamped before anything is multiplied by it.
pub fn primary_of_bumps(lit: &Lit, light: &FixedFunctionLight, parts: Parts) -> Result<Primary, String> {
    let color = match parts.specular {
        true => product(light.specular, lit.specular),
        false => product(light.diffuse, lit.diffuse),
    };
    let why = match () {
        () if parts.diffuse && parts.specular => "highlights on bumps beside diffuse light",
        () if is_attenuated(light) => "its light on bumps is attenuated, for each fragment",
        () if parts.weight != Weight::Shade && light.shade != Shade::Lit => {
            "a dimmed shadow on bumps: no combiner is left for it"
        }
        () if light.projection.as_ref().is_some_and(|projection| projection.cone) => {
            "bumps in a cone: both need alpha; choose shape = \"frustum\""
        }
        () if color.max_element() > 1.0 => "its light on bumps exceeds 1, where fixed function clamps it",
        () => return Ok(Primary::Color(color.extend(1.0).to_array())),
    };
    Err(String::from(why))
}

/// The primary colour of a light's layer, and what of it is ambient light that is there already: GL clamps the sum of
/// both to 1, and so a light alone would come out too bright where the sum saturates.
pub fn primary(lit: &Lit, light: &FixedFunctionLight, parts: Parts) -> Result<(Primary, Option<Vec3>), String> {
    let ambient = Vec3::from(lit.scene_ambient) + own_ambient(lit, light);
    let strength = if light.attenuation[0] > 0.0 { 1.0 / light.attenuation[0] } else { f32::INFINITY };
    let diffuse = product(light.diffuse, lit.diffuse);
    let specular = product(light.specular, lit.specular);
    let has_normal = is_lit(lit, light);
    if !has_normal && !is_attenuated(light) {
        let room = if lit.per_vertex { (Vec3::ONE - ambient).max(Vec3::ZERO) } else { Vec3::INFINITY };
        let color = diffuse.min(room);
        if color.max_element() > 1.0 {
            return Err(String::from("its unlit colour exceeds 1, where fixed function clamps it"));
        }
        return Ok((Primary::Color(color.extend(1.0).to_array()), None));
    }
    let sum = ambient + strength * (diffuse + if has_normal { specular } else { Vec3::ZERO });
    let relevant = if parts.specular { sum } else { ambient + strength * diffuse };
    let saturates = relevant.max_element() > 1.0 && ambient != Vec3::ZERO;
    if !parts.diffuse && sum.max_element() > 1.0 {
        return Err(String::from(
            "its specular light may saturate beside the diffuse, and fixed function clamps the sum",
        ));
    }
    if saturates && is_attenuated(light) && own_ambient(lit, light) != Vec3::ZERO {
        return Err(String::from(
            "its light saturates beside ambient light that is attenuated, and fixed function clamps the sum",
        ));
    }
    let mut source = unlit_source(light);
    let mut lighting = LayerLighting { opacity: 1.0, shininess: lit.shininess, ..LayerLighting::default() };
    if !has_normal {
        // Ambient light needs no normal.
        (source.ambient, lighting.ambient) = (light.diffuse, lit.diffuse);
    } else if parts.diffuse {
        (source.diffuse, lighting.diffuse) = (light.diffuse, lit.diffuse);
    }
    if parts.specular {
        (source.specular, lighting.specular) = (light.specular, lit.specular);
    }
    if saturates {
        lighting.emission = ambient.to_array();
    }
    lighting.sources.push(source);
    Ok((Primary::Lighting(lighting), saturates.then_some(ambient)))
}
