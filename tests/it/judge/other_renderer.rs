//! A teapot drawn by another renderer: its picture is right within the bounds, and its planted faults are found.

use std::path::Path;

use glumbra::frame::ShadeImage;
use glumbra::judge::{Bound, Judge, Judgement};

use renderer::Faults;

#[path = "../../other_renderer/renderer.rs"]
pub mod renderer;

/// Pixels on each side of a true shadow edge that a map of 2048 texels, sampled once, may move it: a texel is less than one
/// pixel of this picture on the floor, half of it is what the nearest one may be off, and surfaces that rise stretch it.
const BAND: Bound = Bound::Band { pixels: 2.0 };

/// Figures of a picture, and the mean distance of true shadow edges from those it shows, in pixels.
fn judged(faults: Faults) -> (Judgement, f64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shade.png");
    renderer::draw(faults, &path).unwrap();
    let picture = glumbra::pictures::read(&path).unwrap().raster;
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/other_renderer/teapot.toml");
    let scene = glumbra::load(&scene, &[]).unwrap().scene;
    let [width, height] = picture.size;
    let image = ShadeImage {
        width,
        height,
        shade: picture.pixels().map(|p| p[0]).collect(),
        covered: picture.pixels().map(|p| p[1] > 0.0).collect(),
    };
    let mut judge = Judge::new(&scene, 0).unwrap();
    let found = judge.shade(&image, &BAND).unwrap();
    let edge = judge.edge_distances(&image).unwrap()[1].unwrap().mean_pixels;
    let percent = |count: usize| 100.0 * found.share(count);
    println!(
        "no bias {}, turned by {} degrees: {} compared, false shadow {:.3} %, leak {:.3} %, {} outside the band, {} surfaces, \
         edges {edge:.3} pixels",
        faults.no_bias,
        faults.turned_degrees,
        found.compared,
        percent(found.false_shadow),
        percent(found.leak),
        found.outside_band,
        found.surface
    );
    (found, edge)
}

/// The limits are twice what is found.
#[test]
fn the_picture_of_another_renderer_is_right() {
    let (found, edge) = judged(Faults::default());
    assert!(found.compared > 50_000, "{}", found.compared);
    assert!(found.share(found.false_shadow) < 0.0006 && found.share(found.leak) < 0.0004);
    assert!(found.outside_band <= 5 && edge < 0.1, "{} {edge}", found.outside_band);
}

#[test]
fn a_map_without_bias_is_found() {
    let (found, _) = judged(Faults { no_bias: true, ..Faults::default() });
    assert!(found.share(found.false_shadow) > 0.2, "acne");
    assert!(found.share(found.leak) < 0.0004, "nothing else is wrong");
    assert!(found.outside_band > 10_000);
}

#[test]
fn a_light_that_stands_a_degree_aside_is_found() {
    let (found, edge) = judged(Faults { turned_degrees: 1.0, ..Faults::default() });
    assert!(found.share(found.leak) > 0.002);
    assert!(edge > 0.3, "a third of a pixel, where nothing else is seen: {edge}");
}
