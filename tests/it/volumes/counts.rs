//! Counts: ways out of a volume along any ray are the triangles that stand between light and point.

use glam::DVec3;
use glumbra::geometry::Mesh;
use glumbra::geometry::volume::{Caps, Caster, CountedFaces, Extent, LightSource, Outline, Volume};
use proptest::prelude::*;

use super::closure::runner;
use super::homogeneous::{Random, blockers, exits, to_world, triangles};
use super::shapes::{Case, cases, lights_outside, placements, soup, source};
use crate::oracle::scenes::{cuboid, mesh};

/// Compares at random points of the cube of half 2; returns how many points were told, and the sum of their counts.
fn compare(case: &str, mesh: &Mesh, source: LightSource, facing_only: bool, points: u32) -> (u32, i32) {
    let caster = Caster::of_mesh(mesh);
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    outline.find(&caster, source);
    volume.extrude(&caster, &outline, Extent::Infinite, Caps::BOTH);
    let volume = triangles(&volume);
    let mut random = Random::new(u64::from(points));
    let (mut told, mut sum) = (0, 0);
    for _ in 0..points {
        let (point, way) = (random.vector(2.0), random.vector(1.0));
        let Some(expected) = blockers(mesh, source, point, facing_only) else { continue };
        let found = exits(&volume, point, way);
        assert_eq!(found, expected, "{case} {source:?} at {point} along {way}");
        (told, sum) = (told + 1, sum + expected);
    }
    (told, sum)
}

#[test]
fn ways_out_are_blockers_for_every_kind_of_mesh() {
    for Case { name, mesh, facing_only } in cases() {
        let points = if mesh.triangle_count() > 500 { 150 } else { 400 };
        let mut sum = 0;
        for source in lights_outside() {
            let (told, found) = compare(name, &mesh, source, facing_only, points);
            assert!(told > points / 2, "{name}: {told}");
            sum += found;
        }
        assert!(sum > 0, "{name}: nothing in shadow");
    }
}

#[test]
fn ways_out_are_blockers_for_random_soups() {
    let strategy = (soup(), source());
    let run = runner(400).run(&strategy, |(mesh, source)| {
        let caster = Caster::of_mesh(&mesh);
        // What is closed by chance has another rule.
        prop_assume!(!caster.shells().iter().any(|shell| shell.kind == glumbra::geometry::volume::SurfaceKind::Closed));
        compare("soup", &mesh, source, false, 20);
        Ok(())
    });
    run.unwrap();
}

#[test]
fn a_mirrored_instance_is_worked_out_in_its_own_space() {
    for Case { name, mesh, facing_only } in cases().into_iter().filter(|case| case.mesh.triangle_count() < 500) {
        for (place, world_from_model) in placements() {
            let world = to_world(&mesh, &world_from_model);
            for source in lights_outside() {
                let model_from_world = world_from_model.inverse();
                let (mut outline, mut volume) = (Outline::default(), Volume::default());
                let caster = Caster::of_mesh(&mesh);
                outline.find(&caster, source.transformed(&model_from_world));
                volume.extrude(&caster, &outline, Extent::Infinite, Caps::BOTH);
                let triangles = triangles(&volume);
                let mut random = Random::new(3);
                for _ in 0..100 {
                    let (point, way) = (random.vector(2.0), random.vector(1.0));
                    let Some(expected) = blockers(&world, source, point, facing_only) else { continue };
                    let [at, along] =
                        [model_from_world.transform_point3(point), model_from_world.transform_vector3(way)];
                    assert_eq!(exits(&triangles, at, along), expected, "{name} {place} {source:?} {point}");
                }
            }
        }
    }
}

#[test]
fn a_light_inside_is_shut_in() {
    // One mesh of three shells: the light in the middle one, outside the innermost and in an open one's shade.
    let mut shape = cuboid(DVec3::splat(-1.5), DVec3::splat(1.5));
    for (min, max) in [(-0.2, 0.2), (0.6, 0.9)] {
        let (points, triangles) = cuboid(DVec3::splat(min), DVec3::splat(max));
        let first = shape.0.len() as u32;
        shape.0.extend(points);
        shape.1.extend(triangles.into_iter().map(|triangle| triangle.map(|k| first + k)));
    }
    let mesh = mesh(&shape);
    let caster = Caster::of_mesh(&mesh);
    let mut outline = Outline::default();
    for (light, expected) in [
        (DVec3::new(0.0, 0.5, 0.1), [CountedFaces::All, CountedFaces::Facing, CountedFaces::Facing]),
        (DVec3::new(0.0, 0.1, 0.1), [CountedFaces::All, CountedFaces::All, CountedFaces::Facing]),
        (DVec3::new(0.0, 1.6, 0.1), [CountedFaces::Facing; 3]),
    ] {
        outline.find(&caster, LightSource::Point(light));
        assert_eq!(outline.countings(), expected, "{light}");
        // All triangles and facing ones agree on what is in shadow.
        let mut volume = Volume::default();
        volume.extrude(&caster, &outline, Extent::Infinite, Caps::BOTH);
        let triangles = triangles(&volume);
        let mut random = Random::new(9);
        let mut shadowed = 0;
        for _ in 0..1000 {
            let (point, way) = (random.vector(2.5), random.vector(1.0));
            let Some(all) = blockers(&mesh, LightSource::Point(light), point, false) else { continue };
            let found = exits(&triangles, point, way);
            assert_eq!(found > 0, all > 0, "{light} {point}");
            shadowed += u32::from(found > 0);
        }
        assert!(shadowed > 100);
    }
}

#[test]
fn truncated_volumes_count_only_so_far() {
    let quad = glumbra::geometry::primitive("quad").unwrap();
    let caster = Caster::of_mesh(&quad);
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    outline.find(&caster, LightSource::Direction(DVec3::Y));
    volume.extrude(&caster, &outline, Extent::Truncated(2.0), Caps::BOTH);
    let triangles = triangles(&volume);
    for (y, expected) in [(0.5, 0), (-0.5, 1), (-1.9, 1), (-2.1, 0)] {
        assert_eq!(exits(&triangles, DVec3::new(0.3, y, 0.2), DVec3::new(0.01, 1.0, 0.02)), expected, "{y}");
    }
}

#[test]
fn the_light_cap_is_the_mesh_itself_in_its_own_order() {
    for Case { name, mesh, .. } in cases() {
        let caster = Caster::of_mesh(&mesh);
        let (mut outline, mut volume) = (Outline::default(), Volume::default());
        outline.find(&caster, lights_outside()[0]);
        volume.extrude(&caster, &outline, Extent::Infinite, Caps { light: true, far: false });
        assert!(volume.far_cap().is_empty());
        let own: std::collections::HashSet<[[u32; 3]; 3]> = mesh
            .indices
            .as_chunks::<3>()
            .0
            .iter()
            .map(|triangle| triangle.map(|k| mesh.positions[k as usize].map(|x| (x + 0.0).to_bits())))
            .collect();
        for range in [volume.light_cap(), volume.light_cap_reversed()] {
            for triangle in volume.indices()[range.start as usize..range.end as usize].as_chunks::<3>().0 {
                let corners = triangle.map(|k| volume.vertices()[k as usize]);
                assert!(corners.iter().all(|corner| corner[3] == 1.0));
                let bits = corners.map(|[x, y, z, _]| [x, y, z].map(|value| (value + 0.0).to_bits()));
                assert!(own.contains(&bits), "{name}");
            }
        }
    }
}
