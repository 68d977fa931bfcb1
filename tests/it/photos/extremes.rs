//! Extremes: eyes in the plane of what they photograph, or behind it; pictures of one texel; frames a thousand times as high
//! as wide; mirrored objects; and the width of what a depth map gets wrong.

use glumbra::truth::{self, Surroundings};

use super::*;

const SIZE: [u32; 2] = [120, 96];

/// A wall, a box before it and a mirrored ball; each text lacks the end of its material.
fn room() -> Vec<String> {
    let wall = "mesh = \"quad\"\nlit = false\nrotate = { axis = [1, 0, 0], angle = 90.0 }\nscale = [3.0, 1.0, 3.0]\n";
    let floor = "mesh = \"quad\"\nlit = false\ntranslate = [0.0, -1.5, 2.0]\nscale = [3.0, 1.0, 2.0]\n";
    let solid = "mesh = \"box\"\nlit = false\ntranslate = [0.4, -0.8, 1.2]\nrotate = { axis = [0, 1, 0], angle = 30.0 }\nscale = 0.6\n";
    let ball = "mesh = \"sphere\"\nlit = false\ntranslate = [-0.9, -0.6, 1.0]\nscale = [-0.7, 0.5, 0.6]\n";
    [wall, floor, solid, ball].map(|object| format!("{object}material = {{ diffuse = [0.8, 0.4, 0.2], ")).into()
}

fn front() -> Pose {
    Pose { eye: DVec3::new(1.2, 0.8, 6.0), target: DVec3::new(0.0, -0.3, 0.5), fov_y: 45.0 }
}

/// A picture of random texels.
fn noise(studio: &Studio, size: [u32; 2]) -> PathBuf {
    let mut random = Random::new(u64::from(size[0]));
    let picture = RgbImage::from_fn(size[0], size[1], |_, _| Rgb([(); 3].map(|()| random.within(0.0, 255.0) as u8)));
    let path = studio.path("noise.png");
    picture.save(&path).unwrap();
    path
}

#[test]
fn extreme_photographs_are_those_of_the_ray_tracer() {
    let mut studio = Studio::new();
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let pose = |eye, target, fov_y| Pose { eye, target, fov_y };
    let middle = at(0.0, -0.4, 0.5);
    let cases = [
        ("grazes the wall", pose(at(-6.0, 0.2, 0.05), at(0.0, 0.0, 0.0), 40.0), [64, 48], ""),
        ("in the wall's plane", pose(at(-6.0, 0.2, 0.0), at(0.0, 0.0, 0.0), 40.0), [64, 48], ""),
        ("in the middle of the room", pose(at(0.1, -0.9, 2.4), at(0.4, -0.8, 0.0), 70.0), [64, 48], ""),
        ("behind the wall", pose(at(0.0, 0.0, -4.0), middle, 50.0), [64, 48], ""),
        ("looks away", pose(at(0.0, 0.0, 4.0), at(0.0, 0.0, 9.0), 50.0), [64, 48], ""),
        ("one texel", pose(at(2.0, 1.0, 5.0), middle, 40.0), [1, 1], ""),
        ("one column", pose(at(2.0, 1.0, 5.0), middle, 40.0), [1, 64], "aspect = 1.0, "),
        ("one row", pose(at(2.0, 1.0, 5.0), middle, 40.0), [64, 1], "aspect = 1.0, "),
        ("narrow", pose(at(2.0, 1.0, 5.0), middle, 40.0), [64, 48], "aspect = 0.001, "),
        ("wide", pose(at(2.0, 1.0, 5.0), middle, 2.0), [64, 48], "aspect = 100.0, "),
        ("wide angle", pose(at(0.5, 0.2, 2.4), middle, 150.0), [64, 48], ""),
        ("the camera's own eye", front(), [64, 48], ""),
        ("close to the camera's eye", pose(front().eye + at(0.0, 1e-4, 0.0), middle, 45.0), [64, 48], ""),
        ("rolled", pose(at(2.0, 1.0, 5.0), middle, 40.0), [64, 48], "up = [1.0, 0.3, 0.2], "),
    ];
    for (name, from, size, more) in cases {
        let path = noise(&studio, size);
        for (filter, hidden) in [("nearest", "smear"), ("linear", "grey"), ("trilinear", "leave"), ("linear", "smear")]
        {
            let more = format!("{more}filter = \"{filter}\", hidden = \"{hidden}\", map = {{ size = 2048 }}");
            let scene = studio.load(&scene_text(SIZE, &front(), &room(), &from.photo(&path, &more)));
            let picture = studio.draw(&scene);
            let truth = colors(&scene, Some(2048));
            let (known, wrong) = beyond(&truth, &picture, 2.0);
            println!("{name}, {filter}, {hidden}: {known} known, {} beyond the bounds", wrong.len());
            assert!(known > 9_000, "{name}: {known}");
            assert!(wrong.is_empty(), "{name}, {filter}, {hidden}: {:?}", &wrong[..wrong.len().min(20)]);
            // Nothing that the photograph's eye looks away from shows it.
            if name == "looks away" && hidden == "grey" {
                assert!(picture.iter().all(|pixel| *pixel == GREY || *pixel == [0, 51, 102]));
            }
        }
    }
}

#[test]
fn what_a_depth_map_gets_wrong_is_a_fringe_of_two_texels() {
    let mut studio = Studio::new();
    let path = noise(&studio, [64, 64]);
    let (mut wrong_pixels, mut widest) = (0, 0.0_f64);
    for (seed, size) in (0..10).flat_map(|seed| [(seed, 256_u32), (seed, 1024)]) {
        let mut random = Random::new(seed);
        let objects = generated_objects(&studio, &mut random);
        let (from, elsewhere) = (generated_pose(&mut random), generated_pose(&mut random));
        let more = format!("filter = \"nearest\", map = {{ size = {size} }}");
        let scene = studio.load(&scene_text([160, 120], &elsewhere, &objects, &from.photo(&path, &more)));
        let picture = studio.draw(&scene);
        // The exact rays, without a doubt for the map.
        let (known, wrong) = beyond(&colors(&scene, None), &picture, 2.0);
        let mut with_light = scene.clone();
        with_light.lights = vec![scene.photos()[0].projector.clone()];
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let around = Surroundings::new(&with_light, 0, &options).unwrap();
        let texel = 2.0 * (0.5 * from.fov_y.to_radians()).tan() / f64::from(size);
        for pixel in &wrong {
            let (x, y) = (*pixel as u32 % 160, *pixel as u32 / 160);
            let reaches = |texels: f64| {
                around.around(x, y, texels * texel).is_none_or(|around| {
                    let allowed = |slope: f64| texels * texel * around.scale * (1.0 + around.slope + slope);
                    let rises = picture[*pixel] == GREY && around.rise > 0.25 * texels * texel * around.scale;
                    let folds = picture[*pixel] == GREY
                        && around
                            .nearer
                            .iter()
                            .any(|near| near.by > texels * texel * around.scale * (1.5 * near.slope + 0.1));
                    around.edge || rises || folds || around.blockers.iter().any(|near| near.gap < allowed(near.slope))
                })
            };
            let width = (1..=16).map(|step| 0.25 * f64::from(step)).find(|texels| reaches(*texels));
            if width.is_none() {
                println!("  pixel ({x}, {y}): {:?}, {:?}", picture[*pixel], around.around(x, y, 2.0 * texel));
            }
            widest = widest.max(width.unwrap_or(f64::INFINITY));
        }
        println!("seed {seed}, {size} texels: {} of {known} pixels are wrong", wrong.len());
        wrong_pixels += wrong.len();
    }
    println!("{wrong_pixels} wrong pixels, at most {widest} texels from an edge");
    // At edges, inner corners, and folds where a flat face meets a steep one. Half a texel by the sample, half by the filter,
    // the rest by the offset that keeps surfaces from hiding themselves.
    assert!(wrong_pixels > 0 && widest <= 2.0, "{widest}");
}
