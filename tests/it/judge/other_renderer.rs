//! A teapot drawn by another renderer: its picture is right within the bounds, and its planted faults are found.

use std::path::Path;

use glumbra::frame::ShadeImage;
use glumbra::judge::{Bound, Judge, Judgement};

use renderer::Faults;

#[path = "../../other_renderer/renderer.rs"]
mod renderer;

/// Pixels on each side of a true shadow edge that a map of 2048 texels, sampled once, may move it. A texel is 1.3 pixels of
/// this picture at most, and a sample picks the nearest one: half of that, and as much again on surfaces that rise from it.
const BAND: Bound = Bound::Band { pixels: 2.0 };

fn judged(faults: Faults) -> Judgement {
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
    let found = Judge::new(&scene, 0).unwrap().shade(&image, &BAND).unwrap();
    let percent = |count: usize| 100.0 * found.share(count);
    println!(
        "no bias {}, turned by {} degrees: {} compared, false shadow {:.3} %, leak {:.3} %, {} outside the band, {} surfaces",
        faults.no_bias,
        faults.turned_degrees,
        found.compared,
        percent(found.false_shadow),
        percent(found.leak),
        found.outside_band,
        found.surface
    );
    found
}

#[test]
fn the_picture_of_another_renderer_is_right() {
    let found = judged(Faults::default());
    assert!(found.compared > 50_000, "{}", found.compared);
    assert!(found.share(found.false_shadow) < 0.001 && found.share(found.leak) < 0.002);
    assert!(found.outside_band <= 5, "{}", found.outside_band);
}

#[test]
fn a_map_without_bias_is_found() {
    let found = judged(Faults { no_bias: true, ..Faults::default() });
    assert!(found.share(found.false_shadow) > 0.05, "acne");
    assert!(found.share(found.leak) < 0.002, "nothing else is wrong");
    assert!(found.outside_band > 1000);
}

#[test]
fn a_light_that_stands_a_degree_aside_is_found() {
    let found = judged(Faults { turned_degrees: 1.0, ..Faults::default() });
    assert!(found.outside_band > 100, "{}", found.outside_band);
    assert!(found.share(found.wrong()) > 0.002);
}
