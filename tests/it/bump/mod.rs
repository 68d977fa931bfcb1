//! Bump-mapped surfaces against judges that share no formula with the renderer: colours in f64, meshes that are really
//! displaced, and the picture of the same surface without bumps.

mod broken;
mod displaced;
mod flat;
mod passes;
mod random;
mod scenes;
mod torus;

use std::path::{Path, PathBuf};
use std::rc::Rc;

use glumbra::context::{self, Context, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::judge::colors::{color_options, draw_colors, shadow_of};
use glumbra::scene::Scene;
use glumbra::truth::{self, ColorPixel, ColorTruth};

/// Codes that a picture may be off where nothing jumps: its own rounding, and the arithmetic of shaders in floats and of a
/// texture filter.
const ALLOWED: f64 = 2.0;

fn renderer() -> (Rc<dyn Context>, Renderer) {
    let context = context::open(&ContextRequest::default()).unwrap();
    let renderer = Renderer::new(&context);
    (context, renderer)
}

fn data(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(path)
}

fn load(path: &Path, changes: &[String]) -> Scene {
    glumbra::load(path, changes).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Loads a scene's text in a folder that has these files.
fn load_text(text: &str, files: &[(&str, Vec<u8>)]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    glumbra::load(&path, &[]).map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

fn picture(scene: &Scene, renderer: &mut Renderer) -> Vec<[f64; 3]> {
    draw_colors(scene, false, renderer).unwrap().codes
}

/// Fraction of its diffuse light that each light's shadow leaves, as its technique says.
fn own_shadows(scene: &Scene) -> Vec<Option<f64>> {
    scene.lights.iter().map(|light| shadow_of(&light.shadow, false)).collect()
}

fn colors(scene: &Scene, shadows: &[Option<f64>]) -> ColorTruth {
    truth::color(scene, shadows, &color_options(scene)).unwrap_or_else(|error| panic!("{error}"))
}

/// Tests whether a colour's bounds lie within so many codes of its value.
fn is_strict(pixel: &ColorPixel, codes: f64) -> bool {
    pixel.is_known
        && pixel.rgb.iter().all(|channel| {
            255.0 * (channel.most - channel.value) <= codes && 255.0 * (channel.value - channel.least) <= codes
        })
}

/// Pixels of a picture against the truth.
#[derive(Debug, Default)]
struct Tally {
    /// Pixels that show a bump-mapped object.
    bumped: usize,
    /// Pixels of the picture whose colour is known.
    compared: usize,
    /// Those of bump-mapped objects whose colour is known.
    known: usize,
    /// Those among them whose bounds lie within two codes of the value.
    strict: usize,
    /// Pixels further beyond their bounds than allowed.
    wrong: usize,
    /// Greatest distance beyond bounds, in codes.
    worst: f64,
    /// Greatest distance from the value of strict pixels.
    worst_strict: f64,
    /// The first wrong pixel, for messages.
    first: Option<String>,
}

impl Tally {
    fn share(&self, count: usize) -> f64 {
        100.0 * count as f64 / self.bumped.max(1) as f64
    }
}

/// Pixels of the scene that show a bump-mapped object.
fn bumped_pixels(scene: &Scene) -> Vec<bool> {
    let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
    let mut scene = scene.clone();
    if scene.lights.is_empty() {
        return vec![true; (scene.image.size[0] * scene.image.size[1]) as usize];
    }
    scene.lights.truncate(1);
    let truth = truth::trace(&scene, 0, &options).unwrap();
    let is_bumped = |object: u32| scene.objects[object as usize].bases.is_some();
    truth.pixels.iter().map(|pixel| pixel.hit.is_some_and(|hit| is_bumped(hit.object))).collect()
}

/// Compares a picture with the truth; of several truths with bounds that hold them all.
fn tally(scene: &Scene, truths: &[&ColorTruth], picture: &[[f64; 3]]) -> Tally {
    let mut found = Tally::default();
    let bumped = bumped_pixels(scene);
    let allowed = ALLOWED + truths[0].between_passes_codes;
    for (index, codes) in picture.iter().enumerate() {
        let mut pixel = truths[0].pixels[index];
        for truth in &truths[1..] {
            let other = &truth.pixels[index];
            for (channel, other) in pixel.rgb.iter_mut().zip(&other.rgb) {
                (channel.least, channel.most) = (channel.least.min(other.least), channel.most.max(other.most));
            }
            pixel.is_known &= other.is_known;
        }
        if bumped[index] {
            found.bumped += 1;
            found.known += usize::from(pixel.is_known);
            found.strict += usize::from(is_strict(&pixel, 2.0));
        }
        if !pixel.is_known {
            continue;
        }
        let excess = pixel.excess_codes(*codes);
        found.compared += 1;
        found.worst = found.worst.max(excess);
        if is_strict(&pixel, 2.0) && !pixel.rgb.iter().any(|channel| channel.jumps) {
            found.worst_strict = found.worst_strict.max(pixel.error_codes(*codes));
        }
        if excess > allowed {
            found.wrong += 1;
            let width = scene.image.size[0] as usize;
            let due = pixel.rgb.map(|channel| [channel.least, channel.value, channel.most].map(|part| 255.0 * part));
            let message = || format!("pixel {} {}: {codes:?}, not {due:.1?}", index % width, index / width);
            found.first.get_or_insert_with(message);
        }
    }
    found
}
