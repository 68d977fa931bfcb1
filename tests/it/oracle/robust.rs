//! Changes that must not change the answer, and changes that must: leaks, holes, sides, size, place, and the ambiguous band
//! itself.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use glumbra::geometry::{Material, Texture};
use glumbra::scene::{Light, LightKind, Object, Point, Scene, Spot};
use glumbra::truth::{Answer, Error, Options, Pixel, Reason, Truth, trace};

use super::scenes::*;

fn is_ambiguous(answer: Answer) -> bool {
    matches!(answer, Answer::Ambiguous(_))
}

/// Torus over sphere over floor, with much self-shadow.
fn busy_scene() -> Scene {
    let torus = object("torus", mesh(&torus(DVec3::new(0.0, 1.2, 0.0), 1.2, 0.35, 48, 24)));
    let sphere = object("sphere", mesh(&sphere(DVec3::new(0.2, 0.6, 0.1), 0.6, 24)));
    scene(vec![floor(), torus, sphere], light(DVec3::new(1.5, 4.5, -1.0), DVec3::ZERO))
}

/// The same scene in a light of each kind.
fn in_each_light(scene: &Scene, position: DVec3) -> [Scene; 3] {
    kinds(position).map(|light| Scene { lights: vec![light], ..scene.clone() })
}

/// A square with a round hole of alpha 0 and radius 0.5 in its middle, at y = 2.
fn square_with_hole(texels: u32) -> Object {
    let center = 0.5 * f64::from(texels);
    let alpha = |x: u32, y: u32| {
        let distance = (f64::from(x) + 0.5 - center).hypot(f64::from(y) + 0.5 - center) / f64::from(texels);
        // Crosses 0.5 at a radius of a quarter of the square.
        (127.5 + 255.0 * 4.0 * (distance - 0.25)).clamp(0.0, 255.0).round() as u8
    };
    let rgba = (0..texels).flat_map(|y| (0..texels).flat_map(move |x| [255, 255, 255, alpha(x, y)])).collect();
    let texture = Texture { name: String::from("hole"), width: texels, height: texels, rgba, has_alpha: true };
    let mut mesh = mesh(&square(1.0, 2.0));
    mesh.texcoords = Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    with_material(object("hole", mesh), Material { decal: Some(Arc::new(texture)), ..Material::default() })
}

#[test]
fn light_falls_through_a_hole_of_the_alpha_test() {
    let scene = scene(vec![floor(), square_with_hole(256)], light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO));
    let scenes = in_each_light(&scene, DVec3::new(0.0, 5.0, 0.0));
    for (scene, scale) in scenes.iter().zip([5.0 / 3.0, 5.0 / 3.0, 1.0]) {
        check_hole(&trace_scene(scene), scale);
    }
}

/// `scale`: of the shadow against its caster.
fn check_hole(truth: &Truth, scale: f64) {
    let mut through = 0;
    check_floor("hole", truth, |at| {
        let (radius, square) = (at.x.hypot(at.z) / scale, at.x.abs().max(at.z.abs()) / scale);
        // The filter flattens the circle by far less than a texel of 2/256.
        ((radius - 0.5).abs() > 2.0 / 256.0).then_some(square > 1.0 || radius < 0.5)
    });
    for pixel in &truth.pixels {
        let Some(hit) = pixel.hit.filter(|hit| hit.object == 0) else { continue };
        through += usize::from(pixel.answer == Answer::Lit && hit.position.x.hypot(hit.position.z) < 0.48 * scale);
    }
    assert!(through > 100, "{through}");
    // The camera sees the floor through the hole, never the square inside it.
    let square = truth.pixels.iter().filter_map(|pixel| pixel.hit).filter(|hit| hit.object == 1);
    assert!(square.map(|hit| hit.position.x.hypot(hit.position.z)).all(|radius| radius > 0.49));
}

#[test]
fn a_thin_surface_seen_from_its_dark_side_is_shadowed_and_turned_away() {
    let wall = (
        vec![DVec3::new(-1.0, 0.2, 0.0), DVec3::new(1.0, 0.2, 0.0), DVec3::new(0.0, 2.0, 0.1)],
        vec![[0, 1, 2], [0, 2, 1]],
    );
    for winding in 0..2 {
        let shape = (wall.0.clone(), vec![wall.1[winding]]);
        for (z, expected) in [(-4.0, Answer::Shadowed), (4.0, Answer::Lit)] {
            let scene = scene(vec![floor(), object("wall", mesh(&shape))], light(DVec3::Y, DVec3::ZERO));
            for lit_scene in in_each_light(&scene, DVec3::new(0.0, 3.0, z)) {
                let truth = trace_scene(&lit_scene);
                let seen = truth.pixels.iter().filter(|pixel| pixel.hit.is_some_and(|hit| hit.object == 1));
                let sure: Vec<_> = seen.filter(|pixel| !is_ambiguous(pixel.answer)).collect();
                assert!(sure.len() > 500);
                for pixel in sure {
                    assert_eq!(pixel.answer, expected);
                    assert_eq!(pixel.hit.unwrap().faces_light(), expected == Answer::Lit);
                }
            }
        }
    }
}

#[test]
fn an_object_that_casts_no_shadow_leaves_the_floor_lit() {
    let mut square = object("square", mesh(&square(0.75, 2.0)));
    square.casts_shadow = false;
    let truth = trace_scene(&scene(vec![floor(), square], light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO)));
    assert_eq!(truth.count(|answer| answer == Answer::Shadowed), 0);
}

#[test]
fn a_blocker_before_the_lights_near_plane_casts_as_any_other() {
    let place = DVec3::new(0.0, 5.0, 0.0);
    for mut lamp in [light(place, DVec3::ZERO), point_light(place)] {
        // The square is 3 before the light, the floor 5.
        let mut shadowed = |distance: f64| {
            match &mut lamp.kind {
                LightKind::Spot(spot) => spot.frustum.near = distance,
                LightKind::Point(Point { near, .. }) => *near = distance,
                LightKind::Directional { .. } => panic!("no near plane"),
            }
            let truth = trace_scene(&scene(vec![floor(), object("square", mesh(&square(0.75, 2.0)))], lamp.clone()));
            truth.count(|answer| answer == Answer::Shadowed)
        };
        let (before, beyond) = (shadowed(3.5), shadowed(0.1));
        assert!(before > 100 && before == beyond, "{before}, {beyond}");
    }
}

/// Eye in a closed body whose corners and edges the symmetric rays meet exactly.
fn inside(shape: &Shape, eye: DVec3, lamp: Light) -> Truth {
    let mut scene = scene(vec![object("closed", mesh(shape))], lamp);
    scene.image.size = [129, 129];
    (scene.camera.eye, scene.camera.target) = (eye, eye + DVec3::X);
    (scene.camera.near, scene.camera.fov_y_radians) = (1e-3, 90f64.to_radians());
    trace_scene(&scene)
}

/// Parallel light along a wall lights all of it or nothing, by the last bit: too much doubt for a truth.
const ASLANT: DVec3 = DVec3::new(0.1, 0.2, 0.3);

#[test]
fn no_light_leaks_into_closed_bodies_and_no_sight_out() {
    let bodies = [
        (sphere(DVec3::ZERO, 1.0, 32), DVec3::ZERO),
        (sphere(DVec3::ZERO, 1.0, 7), DVec3::ZERO),
        (torus(DVec3::new(-2.0, 0.0, 0.0), 2.0, 1.0, 64, 32), DVec3::ZERO),
        (cuboid(-DVec3::ONE, DVec3::ONE), DVec3::ZERO),
    ];
    for (body, eye) in bodies {
        let positions = [DVec3::new(0.0, 7.0, 0.0), DVec3::new(6.0, 0.0, 0.0), DVec3::new(3.0, 4.0, 5.0)];
        for lamp in positions.into_iter().flat_map(|from| [light(from, eye), point_light(from), sun(from + ASLANT)]) {
            let truth = inside(&body, eye, lamp);
            assert!(truth.pixels.iter().all(|pixel| pixel.hit.is_some()), "sight leaks");
            // A point exactly on an edge behind which the body turns away is dark on one side alone: never sure.
            let is_dark = |pixel: &Pixel| {
                pixel.lit_at_center != Some(true) || pixel.answer == Answer::Ambiguous(Reason::ShadowEdge)
            };
            assert!(truth.pixels.iter().all(is_dark), "light leaks");
        }
        let mut lamp = light(eye - DVec3::X * 0.25, eye);
        frustum_of(&mut lamp).near = 1e-4;
        let truth = inside(&body, eye, lamp);
        assert!(truth.count(|answer| answer == Answer::Lit) > 1000);
    }
}

fn scaled(scene: &Scene, scale: f64, moved: DVec3) -> Scene {
    let mut scaled = scene.clone();
    let world = DMat4::from_translation(moved) * DMat4::from_scale(DVec3::splat(scale));
    for object in &mut scaled.objects {
        object.world_from_model = world * object.world_from_model;
    }
    let camera = &mut scaled.camera;
    (camera.eye, camera.target) = (world.transform_point3(camera.eye), world.transform_point3(camera.target));
    (camera.near, camera.far) = (camera.near * scale, camera.far * scale);
    match &mut scaled.lights[0].kind {
        LightKind::Spot(Spot { frustum: lamp, .. }) => {
            (lamp.position, lamp.target) = (world.transform_point3(lamp.position), world.transform_point3(lamp.target));
            (lamp.near, lamp.far) = (lamp.near * scale, lamp.far * scale);
        }
        LightKind::Point(lamp) => {
            lamp.position = world.transform_point3(lamp.position);
            (lamp.near, lamp.far) = (lamp.near * scale, lamp.far * scale);
        }
        LightKind::Directional { .. } => {}
    }
    scaled
}

#[test]
fn size_and_place_change_no_answer() {
    for scene in in_each_light(&busy_scene(), DVec3::new(1.5, 4.5, -1.0)) {
        check_sizes_and_places(&scene);
    }
}

fn check_sizes_and_places(scene: &Scene) {
    let truth = trace_scene(scene);
    let kind = scene.lights[0].kind.name();
    println!("busy, {kind}: {:.3} % ambiguous {:?}", 100.0 * truth.ambiguous_share(), truth.reasons());
    let far = DVec3::new(1e4, -1e4, 1e4);
    for (scale, moved) in [(1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, far), (1e-3, DVec3::splat(10.0))] {
        let other = trace_scene(&scaled(scene, scale, moved));
        let (mut only_one, mut wrong) = (0, 0);
        for (a, b) in truth.pixels.iter().zip(&other.pixels) {
            match (is_ambiguous(a.answer), is_ambiguous(b.answer)) {
                (false, false) => wrong += usize::from(a.answer != b.answer),
                (true, true) => {}
                _ => only_one += 1,
            }
        }
        println!("x {scale}, moved {moved}: {:.3} % ambiguous", 100.0 * other.ambiguous_share());
        assert_eq!(wrong, 0);
        assert!(only_one < 5, "{only_one}");
    }
}

/// The picture with three times the samples a side holds nine samples of each pixel, at most 1/3 pixel from its
/// centre. With half a pixel of doubt granted, each of them must agree with the pixel's sure answer.
fn check_nine(case: &str, scene: &Scene) {
    let wide = Options { subpixel_bits: 1, most_ambiguous: 1.0, ..Options::default() };
    let truth = trace(scene, 0, &wide).unwrap();
    let mut fine = scene.clone();
    fine.image.size = scene.image.size.map(|side| 3 * side);
    let fine = trace(&fine, 0, &Options::default()).unwrap();
    let (mut needless, mut ambiguous) = (0, 0);
    for y in 0..truth.height {
        for x in 0..truth.width {
            let answer = truth.at(x, y).unwrap().answer;
            let samples = (0..9).map(|i| fine.at(3 * x + i % 3, 3 * y + i / 3).unwrap().answer);
            let mut samples = samples.filter(|&sample| !is_ambiguous(sample));
            if is_ambiguous(answer) {
                ambiguous += 1;
                let first = samples.next();
                needless += usize::from(samples.all(|sample| Some(sample) == first));
            } else {
                assert!(samples.all(|sample| sample == answer), "{case}: ({x}, {y}) {answer:?}");
            }
        }
    }
    println!(
        "{case}: half a pixel: {:.2} % ambiguous, {needless} of {ambiguous} needlessly by nine samples, {:?}",
        100.0 * truth.ambiguous_share(),
        truth.reasons()
    );
}

#[test]
fn every_sample_within_the_granted_doubt_agrees() {
    for scene in in_each_light(&busy_scene(), DVec3::new(1.5, 4.5, -1.0)) {
        check_nine(&format!("busy, {} light", scene.lights[0].kind.name()), &scene);
    }
    let lamp = light(DVec3::new(0.3, 5.0, 0.2), DVec3::ZERO);
    check_nine("hole", &scene(vec![floor(), square_with_hole(64)], lamp.clone()));
    let mut grazing = busy_scene();
    grazing.camera.eye = DVec3::new(0.5, 0.35, 5.5);
    check_nine("grazing", &grazing);
    let crossing = cuboid(DVec3::new(-1.0, -0.5, -1.0), DVec3::new(0.5, 0.8, 0.4));
    let mut tilted = object("crossing", mesh(&crossing));
    tilted.world_from_model = DMat4::from_rotation_z(0.3) * DMat4::from_rotation_x(0.2);
    check_nine("crossing", &scene(vec![floor(), tilted], lamp));
}

/// A nearer near plane leaves a depth buffer fewer codes: what it may misplace is ambiguous to shadow volumes, and nothing
/// else changes.
#[test]
fn the_doubt_of_a_depth_buffer_grows_with_its_error() {
    for mut scene in in_each_light(&busy_scene(), DVec3::new(1.5, 4.5, -1.0)) {
        let mut last = 0;
        for (near, bits) in [(0.1, None), (0.1, Some(24)), (1e-2, Some(24)), (1e-2, Some(21))] {
            scene.camera.near = near;
            let plain = trace_scene(&scene);
            let options = Options { depth_buffer_bits: bits, most_ambiguous: 1.0, ..Options::default() };
            let truth = trace(&scene, 0, &options).unwrap();
            let mut ambiguous = 0;
            for (with, without) in truth.pixels.iter().zip(&plain.pixels) {
                assert!(with == without || is_ambiguous(with.answer));
                ambiguous += usize::from(with.answer != without.answer);
            }
            assert!(ambiguous > last || bits.is_none(), "{near} {bits:?}: {ambiguous} pixels, {last} before");
            last = ambiguous;
        }
        assert!(last < trace_scene(&scene).drawn() / 4, "{last}");
    }
}

#[test]
fn coplanar_surfaces_are_ties_and_too_many_are_an_error() {
    let scene = scene(vec![floor(), floor()], light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO));
    assert!(matches!(trace(&scene, 0, &Options::default()), Err(Error::TooAmbiguous { .. })));
    let truth = trace(&scene, 0, &Options { most_ambiguous: 1.0, ..Options::default() }).unwrap();
    assert!(truth.count(|answer| answer == Answer::Ambiguous(Reason::DepthTie)) > 10_000);
}

#[test]
fn what_cannot_be_traced_is_an_error() {
    let mut scene = scene(vec![floor()], light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO));
    assert_eq!(trace(&scene, 3, &Options::default()).unwrap_err(), Error::NoLight { index: 3, count: 1 });
    scene.objects[0].world_from_model = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert!(matches!(trace(&scene, 0, &Options::default()), Err(Error::Transform { .. })));
    let mut broken = mesh(&square(1.0, 0.0));
    broken.indices[2] = 9;
    scene.objects = vec![object("broken", broken)];
    assert!(matches!(trace(&scene, 0, &Options::default()), Err(Error::Mesh { .. })));
}

#[test]
fn an_empty_scene_is_background() {
    let truth = trace_scene(&scene(Vec::new(), light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO)));
    assert_eq!(truth.drawn(), 0);
}

/// Its time is printed, not judged: `cargo test --release --test it -- --nocapture dense_sphere`.
#[test]
fn a_dense_sphere_leaves_little_doubt() {
    let body = object("sphere", mesh(&sphere(DVec3::new(0.2, 1.0, 0.1), 1.0, 132)));
    let mut scene = scene(vec![floor(), body], light(DVec3::new(1.5, 4.5, -1.0), DVec3::ZERO));
    scene.camera.eye = DVec3::new(0.5, 2.0, 3.0);
    scene.image.size = [512, 512];
    let start = std::time::Instant::now();
    let truth = trace_scene(&scene);
    println!(
        "{} triangles, 512 x 512: {:.2?}, {:.3} % of {} ambiguous {:?}",
        scene.objects[1].mesh.triangle_count(),
        start.elapsed(),
        100.0 * truth.ambiguous_share(),
        truth.drawn(),
        truth.reasons()
    );
    assert!(truth.drawn() > 100_000 && truth.ambiguous_share() < 0.003);
}
