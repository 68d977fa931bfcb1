//! Photographs on the objects of random scenes: a quarter of them has some. They are judged with the scene's other colours.

use fastrand::Rng;

use super::case::vector;

/// Share of the objects without a material that get a photograph, in scenes with photographs.
const SHARE: f64 = 0.7;

/// The scene's text, where chance gives its objects photographs from places beside the camera's.
pub fn with_photos(seed: u64, index: u64, toml: &str) -> String {
    let mut rng = Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index ^ 0x7068_6f74_6f00);
    let camera = [vector(toml, "eye"), vector(toml, "target")].map(|found| found.map(|place| place.to_array()));
    let ([Some(eye), Some(target)], true) = (camera, rng.f64() < 0.25) else { return toml.to_owned() };
    let photos: Vec<String> = (0..rng.usize(1..=2)).map(|_| photo(&mut rng, eye, target)).collect();
    let mut blocks = toml.split("\n[[object]]\n");
    let mut out = blocks.next().unwrap_or_default().to_owned();
    for block in blocks {
        out.push_str("\n[[object]]\n");
        out.push_str(block);
        if !block.contains("material = ") && rng.f64() < SHARE {
            let photo = &photos[rng.usize(0..photos.len())];
            out.push_str(if block.ends_with('\n') { "" } else { "\n" });
            out.push_str(&format!("material = {{ {photo} }}"));
        }
    }
    out
}

/// `photo = { … }`, seen from around `target`, as far away as the camera or nearer.
fn photo(rng: &mut Rng, eye: [f64; 3], target: [f64; 3]) -> String {
    let away = [0, 1, 2].map(|k: usize| eye[k] - target[k]);
    let (sin, cos) = (rng.f64() * std::f64::consts::TAU).sin_cos();
    let near = 0.4 + rng.f64();
    let turned = [cos * away[0] + sin * away[2], away[1], cos * away[2] - sin * away[0]];
    let from = [0, 1, 2].map(|k: usize| target[k] + near * turned[k]);
    let hidden = ["smear", "grey", "leave"][rng.usize(0..3)];
    let filter = ["nearest", "linear", "trilinear"][rng.usize(0..3)];
    let aspect = ["", ", aspect = 0.6", ", aspect = 2.0"][rng.usize(0..3)];
    format!(
        "photo = {{ image = \"floor.png\", eye = {from:?}, target = {target:?}, fov_y = {:?}, filter = \"{filter}\", \
         hidden = \"{hidden}\"{aspect} }}",
        20.0 + rng.f64() * 50.0
    )
}
