//! Scenes whose colours can be known, and how often a picture of them is rounded.

use crate::scene::{PicturePasses, Scene};

/// Reason why the colours of a scene cannot be known, as a sentence without a full stop; `None`: they can.
pub fn why_no_colors(scene: &Scene) -> Option<String> {
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
    0.5 * (passes + lenses + dusty)
}
