//! Silhouettes, as the light sees them, that the edge band cannot know: it is found where the picture shows a shadow's
//! edge, and the edge at a hidden receiver is not shown. The oracle, looking from the light, tells them.

use std::collections::HashMap;

use glam::DVec3;
use glumbra::frame::ShadeImage;
use glumbra::judge::metrics::{Band, compare};
use glumbra::scene::{Camera, Image, LightKind, Scene};
use glumbra::truth::{self, Answer, Hit, Truth};

/// Asks one light's silhouettes of one scene.
pub struct Rims<'a> {
    scene: &'a Scene,
    known: HashMap<(usize, u32), bool>,
}

impl<'a> Rims<'a> {
    /// Prepares the first light of `scene`, which has a position.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, known: HashMap::new() }
    }

    /// Tests whether within two texels around what a pixel shows, on a map of `size`, the surface that the light sees falls
    /// by more than two texels' widths within an eighth of a texel: a silhouette, or a slope of more than 86 degrees.
    pub fn is_rim(&mut self, pixel: usize, hit: &Hit, size: u32) -> bool {
        *self.known.entry((pixel, size)).or_insert_with(|| is_rim(self.scene, hit, size))
    }
}

fn is_rim(scene: &Scene, hit: &Hit, size: u32) -> bool {
    let (eye, up, half_angle, near, far) = match &scene.lights[0].kind {
        LightKind::Spot(spot) => {
            let light = &spot.frustum;
            (light.position, light.up, 0.5 * light.cone_radians, light.near, light.far)
        }
        // A texel is widest in the middle of a face.
        LightKind::Point(light) => {
            let way = hit.position - light.position;
            let (near, far) = (light.near, 2.0 * light.far);
            (light.position, way.any_orthonormal_vector(), std::f64::consts::FRAC_PI_4, near, far)
        }
        LightKind::Directional { .. } => panic!("parallel light has no place to look from"),
    };
    let texel = 2.0 * half_angle.tan() / f64::from(size);
    let distance = hit.position.distance(eye);
    let mut seen_by_light = scene.clone();
    seen_by_light.image = Image { size: [32; 2], background: [0.0; 3] };
    let fov_y_radians = 2.0 * (2.0 * texel).atan();
    seen_by_light.camera = Camera { eye, target: hit.position, up, fov_y_radians, near, far };
    let anything = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
    let around = truth::trace(&seen_by_light, 0, &anything).unwrap();
    let depth = |x: u32, y: u32| around.at(x, y).and_then(|p| p.hit).map_or(f64::INFINITY, |hit| hit.distance);
    let falls = |a: f64, b: f64| (a - b).abs() > 2.0 * texel * distance;
    let breaks = |x, y| falls(depth(x, y), depth(x + 1, y)) || falls(depth(x, y), depth(x, y + 1));
    (0..31).any(|y| (0..31).any(|x| breaks(x, y)))
}

/// The pixels that are wrong beyond the band: whose cure leaves one fewer.
pub fn wrong_beyond(truth: &Truth, shade: &ShadeImage, band: &Band) -> Vec<usize> {
    let count = |shade: &ShadeImage| {
        let all = compare(truth, shade, band).unwrap().all;
        all.false_shadow.outside + all.leak.outside
    };
    let total = count(shade);
    let mut found = Vec::new();
    let mut cured = shade.clone();
    for (index, pixel) in truth.pixels.iter().enumerate() {
        let right = match pixel.answer {
            Answer::Lit => 1.0,
            Answer::Shadowed => 0.0,
            _ => continue,
        };
        if found.len() == total || !shade.covered[index] || (shade.shade[index] >= 0.5) == (right == 1.0) {
            continue;
        }
        cured.shade[index] = right;
        if count(&cured) < total {
            found.push(index);
        }
        cured.shade[index] = shade.shade[index];
    }
    found
}

/// Wrong pixels of [`wrong_beyond`] that no silhouette explains, in words.
pub fn without_rims(scene: &Scene, truth: &Truth, shade: &ShadeImage, band: &Band) -> Vec<String> {
    let mut rims = Rims::new(scene);
    let place = |index: usize| (index as u32 % truth.width, index as u32 / truth.width);
    let hit = |index: usize| truth.pixels[index].hit.unwrap();
    let mut left = wrong_beyond(truth, shade, band);
    left.retain(|index| !rims.is_rim(*index, &hit(*index), band.map_size[0]));
    let words = |index: &usize| {
        let (pixel, hit): (_, Hit) = (place(*index), hit(*index));
        let in_map: DVec3 = hit.in_map;
        format!("pixel {pixel:?} of object {} at {in_map} of the map, cos {:.3}", hit.object, hit.cos_light)
    };
    left.iter().map(words).collect()
}
