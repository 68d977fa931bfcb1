//! Every kind of mesh, by every method that claims to be right.

use glam::{DMat4, DVec3};
use glumbra::geometry::Mesh;
use glumbra::scene::Scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestRunner};

use super::count::{Bench, Held, RIGHT, truth};
use crate::oracle::scenes::{Shape, floor, light, mesh, object, scene};
use crate::volumes::shapes::{cases, dense, placements, soup};

fn over_floor(mesh: Mesh, place: DMat4, size: u32) -> Scene {
    let mut caster = object("caster", mesh);
    caster.world_from_model = DMat4::from_translation(DVec3::new(0.0, 1.3, 0.0)) * place;
    let mut scene = scene(vec![floor(), caster], light(DVec3::new(2.3, 5.1, 1.9), DVec3::new(0.0, 0.5, 0.0)));
    scene.image.size = [size, size];
    scene
}

/// Holds each method; returns what the first said.
fn hold_all(bench: &mut Bench, case: &str, scene: &Scene) -> Held {
    let truth = truth(scene);
    let helds = RIGHT.map(|method| (method, bench.hold(scene, &truth, &format!("method = \"{method}\""))));
    println!("{case}: {:?}, {:.2} % ambiguous", helds[0].1, 100.0 * truth.ambiguous_share());
    for (method, held) in helds {
        assert_eq!(held.different, 0, "{case} by {method}: {held:?}");
    }
    helds[0].1
}

#[test]
fn hard_meshes_are_counted_exactly() {
    let mut bench = Bench::new();
    for case in cases() {
        for (name, place) in placements() {
            let held =
                hold_all(&mut bench, &format!("{} {name}", case.name), &over_floor(case.mesh.clone(), place, 96));
            assert!(held.told > 3000 && held.inside > 10, "{} {name}: too little to see: {held:?}", case.name);
        }
    }
}

#[test]
fn a_dense_model_is_counted_exactly() {
    let held = hold_all(&mut Bench::new(), "dense", &over_floor(dense(), DMat4::from_scale(DVec3::splat(0.9)), 256));
    assert!(held.inside > 1000, "{held:?}");
}

#[test]
fn random_soups_are_counted_exactly() {
    let mut bench = Bench::new();
    let seed = RngSeed::Fixed(2001);
    let mut runner = TestRunner::new(Config { rng_seed: seed, ..Config::default() });
    let mut inside = 0;
    for index in 0..100 {
        let mesh = soup().new_tree(&mut runner).unwrap().current();
        let turn = DMat4::from_rotation_y(0.31 * f64::from(index)) * DMat4::from_rotation_x(0.17 * f64::from(index));
        inside += hold_all(&mut bench, &format!("soup {index}"), &over_floor(mesh, turn, 48)).inside;
    }
    assert!(inside > 2000, "{inside}");
}

#[test]
fn counts_beyond_255_wrap_or_saturate() {
    let nested = cases().into_iter().find(|case| case.name == "nested boxes").unwrap();
    // Small enough that the eye sees the middle of their shadow on the floor.
    let scene = over_floor(nested.mesh, DMat4::from_scale(DVec3::splat(0.3)), 96);
    let truth = truth(&scene);
    let deepest = truth.pixels.iter().filter_map(|pixel| pixel.at_center).max().unwrap();
    assert!(deepest > 255, "{deepest} volumes at most");
    let mut bench = Bench::new();
    for method in ["z-pass-two-sided", "z-fail"] {
        let wrapping = bench.hold(&scene, &truth, &format!("method = \"{method}\""));
        assert_eq!(wrapping.different, 0, "{method}: {wrapping:?}");
        // Stops at 255 on the way up, and comes down from there: what is left is not the count. How often depends on the
        // order of the faces.
        let saturating = bench.hold(&scene, &truth, &format!("method = \"{method}\", count = \"saturate\""));
        assert!(saturating.different > 0, "{method}: {saturating:?}");
    }
}

/// A column of sides a thousand times as tall as they are wide, with ends of slices as thin.
fn reeded_column(sides: u32) -> Shape {
    let corner = |k: u32, height: f64| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k % sides) / f64::from(sides)).sin_cos();
        DVec3::new(0.3 * cos, height, 0.3 * sin)
    };
    let mut points: Vec<DVec3> = (0..sides).flat_map(|k| [corner(k, -0.8), corner(k, 0.8)]).collect();
    points.extend([DVec3::Y * -0.8, DVec3::Y * 0.8]);
    let (low, high) = (2 * sides, 2 * sides + 1);
    let triangles = (0..sides).flat_map(|k| {
        let ([a, b], [c, d]) = ([2 * k, 2 * k + 1], [2 * ((k + 1) % sides), 2 * ((k + 1) % sides) + 1]);
        [[a, b, c], [b, d, c], [low, a, c], [high, d, b]]
    });
    (points, triangles.collect())
}

/// The visible parts of a lit sliver and of its neighbours are bounded by caps that are slivers, too.
#[test]
fn slivers_are_counted_exactly() {
    let mut bench = Bench::new();
    let column = reeded_column(1200);
    let opened = (column.0.clone(), column.1.iter().skip(700).copied().collect());
    for (name, shape) in [("closed", &column), ("open", &opened)] {
        for (turned, place) in placements() {
            let held = hold_all(&mut bench, &format!("{name} column {turned}"), &over_floor(mesh(shape), place, 128));
            assert!(held.told > 5000 && held.inside > 200, "{name} {turned}: {held:?}");
        }
    }
}
