//! Scenes whose colours can be known, and how often a picture of them is rounded.

use crate::combiners;
use crate::scene::{BumpMethod, BumpShading, PicturePasses, Scene};

/// How bumps are lit, of ways whose formula is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// Vectors computed per fragment.
    Reference,
    /// Register combiners. `reads_light`: highlights end with the light; `rounds`: nine bits.
    Combined { reads_light: bool, rounds: bool },
}

impl Method {
    pub fn of(shading: &BumpShading) -> Self {
        let rounds = shading.precision == combiners::Precision::NineBits;
        match &shading.method {
            BumpMethod::Reference => Self::Reference,
            BumpMethod::OnePass(_) => Self::Combined { reads_light: true, rounds },
            BumpMethod::ThreePass { specular, .. } => {
                let two_units = include_str!("../../../data/combiners/gdc2001-specular-two-units.rc");
                let two_units = combiners::parse(two_units).is_ok_and(|known| known == **specular);
                Self::Combined { reads_light: !two_units, rounds }
            }
        }
    }
}

/// Tests whether any object is bump-mapped and lit.
fn has_bumps(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| object.bases.is_some() && object.lit)
}

/// Tests whether the picture's light is clamped before surfaces' colours are multiplied in.
pub(super) fn is_in_three_passes(scene: &Scene) -> bool {
    let three = matches!(scene.shading.bumps.method, BumpMethod::ThreePass { .. });
    three && scene.shading.passes == PicturePasses::One && has_bumps(scene)
}

/// Tests whether bumps are lit by register combiners, which clamp each pass: the colours of a picture in floats cannot be
/// known then.
pub fn has_combined_bumps(scene: &Scene) -> bool {
    has_bumps(scene) && scene.shading.bumps.method != BumpMethod::Reference
}

/// Tests whether bumps are lit by a program of register combiners that the scene brings.
fn has_own_program(scene: &Scene) -> bool {
    let BumpMethod::OnePass(program) = &scene.shading.bumps.method else { return false };
    let known = combiners::parse(include_str!("../../../data/combiners/gdc2001.rc"));
    has_bumps(scene) && !known.is_ok_and(|known| known == **program)
}

/// Reason why the colours of a scene cannot be known, as a sentence without a full stop; `None`: they can.
pub fn why_no_colors(scene: &Scene) -> Option<String> {
    if has_own_program(scene) {
        return Some(String::from(
            "`combiners` of [shading] is a program of the scene's own, whose formula is not known",
        ));
    }
    scene.lights.iter().enumerate().find_map(|(index, light)| {
        let has_noise = light.dust.is_some_and(|dust| dust.jitter && dust.density > 0.0);
        let has_lines = light.spot().is_some_and(|spot| spot.frustum_shown);
        let why = match (has_noise, has_lines) {
            (true, _) => "its dust has `jitter`, and noise has no one colour for a pixel",
            (_, true) => "the lines of its frustum are drawn over the surfaces' colours",
            _ => return None,
        };
        Some(format!("light {index}: {why}"))
    })
}

/// Codes of 1/255 by which the roundings between the passes of a picture of 8 bits may add up: half of one each time that a
/// pass reads what another has stored.
pub(super) fn between_passes_codes(scene: &Scene) -> f64 {
    let count = scene.lights.len() as f64;
    let passes = match scene.shading.passes {
        // Diffuse light by light; the decal and the gloss; highlights light by light.
        PicturePasses::One if is_in_three_passes(scene) => 2.0 * count + 2.0,
        // More lights than one pass holds, or lights that are counted, are added group by group.
        PicturePasses::One => (count - 1.0).max(0.0),
        // Ambient light, then each image; then the product.
        PicturePasses::Slide => count + 1.0,
        // Each light is rounded, and weighed by its shade.
        PicturePasses::Shadow => 2.0 * count + 1.0,
    };
    let is_added = |light: &&crate::scene::Light| light.spot().is_some_and(|spot| spot.lens().is_some());
    let lenses = scene.lights.iter().filter(is_added).count().min(1) as f64;
    let dusty = scene.lights.iter().filter(|light| light.dust.is_some()).count() as f64;
    let rounds = matches!(Method::of(&scene.shading.bumps), Method::Combined { rounds: true, .. });
    // Nine bits: products of a light with decal, ambient light and material are rounded, four of them each.
    let nine_bits = if rounds && has_bumps(scene) { 4.0 * count } else { 0.0 };
    0.5 * (passes + lenses + dusty + nine_bits)
}
