//! Volumes of a key-framed model, at random poses between two frames.

use std::path::Path;

use glam::{DMat4, DVec3};
use glumbra::geometry::md2::{Model, NormalSource, Pose};

use super::count::{Bench, RIGHT, truth};
use crate::oracle::scenes::{floor, light, object, point_light, scene, sun};
use crate::volumes::homogeneous::Random;

#[test]
fn a_hundred_blends_are_counted_exactly() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/knight.md2");
    let (model, _) = Model::load(&path).unwrap();
    let (mut bench, mut random) = (Bench::new(), Random::new(1995));
    let mut blends = fastrand::Rng::with_seed(133_400);
    let (mut told, mut inside) = (0, 0);
    for index in 0..100 {
        let frames = [(); 2].map(|()| blends.usize(0..model.frame_count()));
        let pose = Pose { frames, blend: blends.f64() };
        let mut knight = object("knight", model.mesh(&pose, NormalSource::File));
        // Two units tall, on the floor.
        knight.world_from_model = DMat4::from_translation(DVec3::Y) * DMat4::from_scale(DVec3::splat(1.0 / 25.0));
        let position = 3.0 * random.vector(1.0) + DVec3::new(0.0, 3.5, 0.0);
        let light = match index % 3 {
            0 => light(position, DVec3::Y),
            1 => point_light(position),
            _ => sun(position),
        };
        let mut scene = scene(vec![floor(), knight], light);
        scene.image.size = [40, 40];
        scene.camera.eye = 3.5 * random.vector(1.0) + DVec3::new(0.0, 3.7, 0.0);
        scene.camera.target = DVec3::Y + 0.5 * random.vector(1.0);
        let truth = truth(&scene);
        let method = RIGHT[index % RIGHT.len()];
        let held = bench.hold(&scene, &truth, &format!("method = \"{method}\""));
        assert_eq!(held.different, 0, "{index}, {method}, {pose:?}: {held:?}; light {position}");
        (told, inside) = (told + held.told, inside + held.inside);
    }
    println!("{told} pixels told, {inside} in volumes");
    assert!(told > 50_000 && inside > 5_000, "{told} {inside}");
}
