//! Eyes and lights in every place, and volumes that must close.

use glam::DVec3;
use glumbra::scene::{Light, Scene};

use super::count::{Bench, RIGHT, compare, truth};
use crate::oracle::scenes::{cuboid, floor, light, mesh, object, point_light, scene, square, sun, torus};
use crate::volumes::homogeneous::Random;
use crate::volumes::shapes::turned;

/// A torus, a box, and an open square that floats over both.
fn room(eye: DVec3, target: DVec3, light: Light) -> Scene {
    let objects = vec![
        floor(),
        object("torus", mesh(&turned(torus(DVec3::new(-0.8, 0.5, 0.2), 0.6, 0.25, 14, 8)))),
        object("box", mesh(&cuboid(DVec3::new(0.4, 0.0, -0.6), DVec3::new(1.3, 0.9, 0.3)))),
        object("square", mesh(&square(0.5, 1.6))),
    ];
    let mut scene = scene(objects, light);
    scene.image.size = [40, 40];
    scene.camera.eye = eye;
    scene.camera.target = target;
    scene.camera.up = if (target - eye).normalize().y.abs() > 0.95 { DVec3::Z } else { DVec3::Y };
    scene.camera.fov_y_radians = 1.2;
    scene
}

/// Half of the places are anywhere around; the others are where it is hard.
fn hard_place(random: &mut Random, index: u32) -> DVec3 {
    // One in eight or so below the floor.
    let anywhere = random.vector(2.5) + DVec3::new(0.0, 1.9, 0.0);
    match index % 8 {
        // Inside the box; on the plane of one of its faces; near a corner of it; on the floating square's plane.
        0 => DVec3::new(0.85, 0.45, -0.15) + 0.3 * random.vector(1.0),
        1 => DVec3::new(0.4, anywhere.y, anywhere.z),
        2 => DVec3::new(1.3, 0.9, 0.3) + 1e-6 * random.vector(1.0),
        3 => DVec3::new(anywhere.x, 1.6, anywhere.z),
        _ => anywhere,
    }
}

#[test]
fn a_thousand_eyes_and_lights_are_counted_exactly() {
    let (mut bench, mut random) = (Bench::new(), Random::new(1992));
    let (mut told, mut inside, mut plain_fails, mut parity_fails) = (0, 0, 0, 0);
    for index in 0..1000 {
        let [eye, position] = [hard_place(&mut random, index / 8), hard_place(&mut random, index)];
        // Among other things along the light's rays: the eye in a volume's side, the light behind the eye.
        let target = if index % 5 == 0 { 2.0 * eye - position } else { random.vector(1.0) + DVec3::Y };
        let at = random.vector(0.7) + 0.5 * DVec3::Y;
        let light = match index % 3 {
            0 => light(position, at),
            1 => point_light(position),
            _ => sun(position - at),
        };
        let scene = room(eye, target + 1e-3 * random.vector(1.0), light);
        let truth = truth(&scene);
        for method in RIGHT {
            let held = bench.hold(&scene, &truth, &format!("method = \"{method}\""));
            assert_eq!(held.different, 0, "{index}, {method}: {held:?}; eye {eye}, light {position}");
            if method == RIGHT[0] {
                (told, inside) = (told + held.told, inside + held.inside);
            }
        }
        plain_fails += u32::from(bench.hold(&scene, &truth, "method = \"z-pass\"").different > 0);
        let parity: Vec<u8> = bench.count(&scene, "method = \"parity\"");
        parity_fails += u32::from(compare(&truth, &parity).different > 0);
    }
    println!(
        "{told} pixels told, {inside} in volumes; z-pass fails in {plain_fails}, parity in {parity_fails} of 1000"
    );
    assert!(told > 300_000 && inside > 50_000);
    // The eye is in some volume in many of them, which plain z-pass does not know; and volumes overlap.
    assert!(plain_fails > 100 && parity_fails > plain_fails + 100);
}
