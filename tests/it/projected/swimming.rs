//! Interpolation of a light's coordinates [Segal 1992, 2]: two ways with perspective are the same, the affine one swims.

use glam::DVec3;
use glumbra::pass::Work;
use glumbra::plan::{Plan, Request};
use image::{Rgb, RgbImage};

use super::{WHITE, draw, load, renderer, unlit_scene};
use crate::support::random::Random;

/// A scene of large triangles, which reach behind the eye and before the light.
fn scene(random: &mut Random, technique: &str) -> String {
    let light = format!(
        "position = {:?}\ntarget = {:?}\ncone = {:?}\nshape = \"frustum\"\nimage = \"slide.png\"\nnear = 0.2\nfar = 30.0",
        (DVec3::new(0.0, 3.0, 0.0) + 1.5 * random.vector()).to_array(),
        (0.5 * random.vector()).to_array(),
        random.within(30.0, 100.0)
    );
    let away = random.pick(&[1.0, 4.0, 4.0]);
    let eye = DVec3::new(0.0, 1.2 * away, 9.0 * (away - 1.0) / 3.0) + DVec3::new(4.0, 1.0, 4.0) * random.vector();
    let camera = format!(
        "eye = {:?}\ntarget = {:?}\nfov_y = 60.0\nnear = 0.1\nfar = 60.0",
        eye.to_array(),
        (0.5 * random.vector()).to_array()
    );
    let objects = format!(
        "[[object]]\nmesh = \"quad\"\nscale = [2.0, 1.0, 2.0]\n{WHITE}\
         [[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = {:?}\nrotate = {{ axis = [1.0, 0.4, 0.2], angle = {:?} }}\n{WHITE}",
        (DVec3::Y + 0.8 * random.vector()).to_array(),
        random.within(0.0, 90.0)
    );
    unlit_scene(&camera, &light, &objects).replace("technique = \"none\"", technique)
}

/// Smooth, so that a shift shows as much as it is large.
fn slide() -> RgbImage {
    RgbImage::from_fn(128, 128, |x, y| {
        let wave = |at: u32, turns: f64| 127.5 + 127.5 * (f64::from(at) / 128.0 * turns * std::f64::consts::TAU).sin();
        Rgb([wave(x, 2.0) as u8, wave(y, 2.0) as u8, wave(x + y, 1.0) as u8])
    })
}

/// Tests whether some surface is drawn by Segal's division.
fn divides(plan: &Plan) -> bool {
    let batches = plan.list.passes.iter().filter_map(|pass| match &pass.work {
        Work::Draw(pass) => Some(&pass.batches),
        Work::CopyDepth { .. } => None,
    });
    batches.flatten().any(|batch| batch.program.defines.iter().any(|define| define.name() == "OVER_W"))
}

/// Surfaces that are not all in view are interpolated with perspective in either case; from afar all are in view.
#[test]
fn all_interpolations_but_the_affine_are_the_same_within_two_codes() {
    let (_context, mut renderer) = renderer();
    let mut random = Random::new(40);
    let (mut compared, mut swimming, mut divided) = (0, 0, 0);
    for round in 0..40 {
        let technique = random.pick(&["technique = \"none\"", "technique = \"shadow-volume\"", "technique = \"none\""]);
        let text = scene(&mut random, technique);
        let mut pictures = ["perspective", "segal", "affine"].map(|way| {
            let text = text.replace("cone =", &format!("interpolate = \"{way}\"\ncone ="));
            let scene = load(&text, &[("slide.png", &slide())]).scene;
            let plan = renderer.plan(&scene, &Request::default()).unwrap();
            assert_eq!(plan.warnings.iter().any(|text| text.contains("swim")), way == "affine", "{:?}", plan.warnings);
            divided += usize::from(divides(&plan));
            draw(&scene, &mut renderer)
        });
        let affine = pictures[2].split_off(0);
        let off = |a: &[[i32; 3]], b: &[[i32; 3]], most: i32| {
            let pairs = a.iter().zip(b);
            pairs.filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > most)).count()
        };
        // At the image's border a rounding decides between light and none: one pixel of a hundred of its outline, of
        // which there are some 400.
        let apart = off(&pictures[0], &pictures[1], 2);
        assert!(apart <= 4, "round {round}: {apart} pixels of the two with perspective differ\n{text}");
        compared += pictures[0].iter().filter(|codes| **codes != [0; 3]).count();
        swimming += off(&pictures[0], &affine, 30);
    }
    assert!(divided >= 20, "{divided} of 40 scenes have surfaces that are divided");
    assert!(compared > 40_000, "{compared}");
    assert!(swimming > 10_000, "the affine picture differs in {swimming} pixels alone");
}
