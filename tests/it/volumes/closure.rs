//! Closure: the boundary of all of a volume's triangles together is nothing, edge by edge, as integers.

use std::collections::HashMap;

use glam::DVec3;
use glumbra::geometry::Mesh;
use glumbra::geometry::volume::{Caps, Caster, Extent, LightSource, Outline, Volume};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::shapes::{ball, cases, dense, lights_outside, soup, source};

/// Seeded, so that a failure comes again.
pub fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[5; 32]))
}

/// Edges that do not cancel.
fn open_edges(volume: &Volume) -> usize {
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    let reversed = volume.light_cap_reversed();
    for (first, triangle) in (0u32..).step_by(3).zip(volume.indices().as_chunks::<3>().0) {
        let sign = if reversed.contains(&first) { -1 } else { 1 };
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            let way = if from < to { sign } else { -sign };
            *edges.entry((from.min(to), from.max(to))).or_default() += way;
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

fn check(case: &str, mesh: &Mesh, source: LightSource, outline: &mut Outline, volume: &mut Volume) {
    let caster = Caster::of_mesh(mesh);
    outline.find(&caster, source);
    for extent in [Extent::Infinite, Extent::Truncated(3.0)] {
        volume.extrude(&caster, outline, extent, Caps::BOTH);
        assert_eq!(open_edges(volume), 0, "{case} {source:?} {extent:?}");
        assert!(volume.vertices().iter().flatten().all(|value| value.is_finite()), "{case} {source:?}");
    }
    // Loops use each edge as often as it counts.
    let walked: usize = outline.loops().iter().map(Vec::len).sum();
    assert_eq!(walked as u32, outline.edges().iter().map(|edge| edge.multiplicity).sum::<u32>(), "{case}");
}

/// Lights in places where something is degenerate, for meshes within a radius of 2.
fn hard_lights(mesh: &Mesh) -> Vec<LightSource> {
    let corner = |k: usize| DVec3::from_array(mesh.positions[k % mesh.positions.len()].map(f64::from));
    let mut lights = lights_outside();
    for k in [0, 7, 31] {
        let [a, b, c] = [0, 1, 2].map(|i| corner(mesh.indices[(3 * k + i) % mesh.indices.len()] as usize));
        lights.extend([
            // At a corner, a millionth beside it, as near as f64 can say; in the plane, far and near; within.
            LightSource::Point(a),
            LightSource::Point(a + DVec3::new(1e-6, -7e-7, 3e-7)),
            LightSource::Point(a * (1.0 + 1e-16) + 1e-300),
            LightSource::Point(a + 3.0 * (b - a) - 2.0 * (c - a)),
            LightSource::Point((a + b + c) / 3.0),
            LightSource::Point(0.5 * (a + b)),
            LightSource::Point(mesh.bounds.center()),
            LightSource::Direction(b - a),
            LightSource::Direction((b - a) - 3.0 * (c - b)),
        ]);
    }
    lights.retain(|light| light.homogeneous() != glam::DVec4::ZERO);
    lights
}

#[test]
fn every_edge_cancels_for_every_kind_of_mesh() {
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    for case in cases() {
        let caster = Caster::of_mesh(&case.mesh);
        for source in hard_lights(&case.mesh) {
            check(case.name, &case.mesh, source, &mut outline, &mut volume);
        }
        assert!(!caster.shells().is_empty());
    }
    let dense = dense();
    for source in lights_outside() {
        check("dense", &dense, source, &mut outline, &mut volume);
        assert!(outline.edges().len() > 100);
    }
}

#[test]
fn every_edge_cancels_for_random_soups() {
    let run = runner(1000).run(&(soup(), prop::collection::vec(source(), 3)), |(mesh, sources)| {
        let (mut outline, mut volume) = (Outline::default(), Volume::default());
        sources.into_iter().for_each(|source| check("soup", &mesh, source, &mut outline, &mut volume));
        Ok(())
    });
    run.unwrap();
}

#[test]
fn an_open_edge_is_seen_by_this_test() {
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    let caster = Caster::of_mesh(&ball());
    outline.find(&caster, lights_outside()[0]);
    volume.extrude(&caster, &outline, Extent::Infinite, Caps { light: true, far: false });
    assert_eq!(open_edges(&volume), outline.edges().len());
}

#[test]
fn a_light_in_a_plane_is_on_neither_side_of_it() {
    // Two triangles of one plane, wound against each other: the same answer for both.
    let mesh = crate::oracle::scenes::mesh(&(
        vec![DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.3, 0.7, 0.4), DVec3::new(0.2, 1.9, 0.8)],
        vec![[0, 1, 2], [0, 2, 1]],
    ));
    let caster = Caster::of_mesh(&mesh);
    let corners = [0, 1, 2].map(|k| DVec3::from_array(mesh.positions[k].map(f64::from)));
    let [a, b, c] = corners;
    let mut outline = Outline::default();
    let mut told = [0; 2];
    for k in 0..200 {
        // Points that f64 rounds to just beside the plane, or onto it.
        let (s, t) = (f64::from(k) * 0.137 - 9.0, f64::from(k % 17) * 0.31 - 2.0);
        outline.find(&caster, LightSource::Point(a + s * (b - a) + t * (c - a)));
        assert_eq!(outline.weights()[0], -outline.weights()[1]);
        assert_eq!(outline.exact_tests(), 2);
        told[usize::from(outline.weights()[0] != 0)] += 1;
    }
    // Both happen: the predicate decides where no error bound could.
    assert!(told[0] > 0 && told[1] > 100, "{told:?}");
}
