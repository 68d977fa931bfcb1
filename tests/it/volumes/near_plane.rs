//! Volumes cut at the near plane, on random casters, lights and eyes: z-pass counts from a point of the near plane
//! are the triangles between the light and what is seen.

use glam::{DMat4, DVec3};
use glumbra::geometry::Mesh;
use glumbra::geometry::volume::{CappedVolume, Caster, Landing, LightSource, Outline};
use glumbra::math::spaces::view_from_world;

use super::homogeneous::{Random, Triangle, blockers, corners, entries, to_world};
use super::shapes::{Case, cases, placements};
use crate::oracle::scenes::{cuboid, mesh, torus};

const NEAR: f64 = 0.2;

fn triangles(volume: &CappedVolume) -> Vec<Triangle> {
    let all = 0..volume.indices().len() as u32;
    corners(volume.vertices(), volume.indices(), all).into_iter().map(|corners| (corners, 1)).collect()
}

struct Tally {
    told: [u32; 3],
    in_shadow: [u32; 3],
}

/// Rays from the near plane towards random points in front of it. What the light cap (which z-pass does not draw) would
/// count is left to the caller: targets lie before the first surface on their ray.
fn check(case: &str, mesh: &Mesh, facing_only: bool, world_from_model: &DMat4, seed: u64, tally: &mut Tally) {
    let mut random = Random::new(seed);
    let eye = random.vector(1.6);
    let view_from_world = view_from_world(eye, eye + random.vector(1.0), DVec3::Y);
    let source = match seed % 4 {
        0 => LightSource::Direction(random.vector(1.0)),
        // In the near plane itself.
        1 if seed % 8 == 1 => {
            LightSource::Point(view_from_world.inverse().transform_point3(random.vector(2.0).with_z(-NEAR)))
        }
        _ => LightSource::Point(random.vector(3.0)),
    };
    let view_from_model = view_from_world * *world_from_model;
    let caster = Caster::of_mesh(mesh);
    let (mut outline, mut volume) = (Outline::default(), CappedVolume::default());
    outline.find(&caster, source.transformed(&world_from_model.inverse()));
    if outline.countings().iter().any(|counting| *counting != outline.countings()[0]) {
        return;
    }
    let facing_only = facing_only && outline.countings()[0] == glumbra::geometry::volume::CountedFaces::Facing;
    volume.cut(&caster, &outline, &view_from_model, NEAR);
    let triangles = triangles(&volume);
    let seen = to_world(mesh, &view_from_model);
    let light = source.transformed(&view_from_world);
    let landing = match volume.landing() {
        Landing::None => 0,
        Landing::All => 1,
        Landing::Some => 2,
    };
    for _ in 0..30 {
        let start = (random.vector(0.4)).with_z(-NEAR * 0.999_99);
        let target = start + random.vector(2.0) * DVec3::new(1.0, 1.0, 0.0) - DVec3::Z * (1.0 + random.unit()) * 2.0;
        let way = target - start;
        // The surface in front of which the count is asked for: the first on the ray.
        let first = first_hit(&seen, start, way).unwrap_or(1.0).min(1.0);
        let way = way * (first * (0.3 + 0.3 * (1.0 + random.unit())));
        let Some(expected) = blockers(&seen, light, start + way, facing_only) else { continue };
        let found = entries(&triangles, start, way);
        assert_eq!(found, expected, "{case} seed {seed} {source:?} {:?} from {start} by {way}", volume.landing());
        tally.told[landing] += 1;
        tally.in_shadow[landing] += u32::from(expected > 0);
    }
}

fn first_hit(mesh: &Mesh, start: DVec3, way: DVec3) -> Option<f64> {
    let hits = mesh.indices.as_chunks::<3>().0.iter().filter_map(|triangle| {
        let [a, b, c] = triangle.map(|k| DVec3::from_array(mesh.positions[k as usize].map(f64::from)) - start);
        let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|n| n.dot(way));
        let inside = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
        let normal = (b - a).cross(c - a);
        let t = normal.dot(a) / normal.dot(way);
        (inside && t > 0.0).then_some(t)
    });
    hits.min_by(f64::total_cmp)
}

#[test]
fn z_pass_from_the_near_plane_counts_blockers() {
    let mut tally = Tally { told: [0; 3], in_shadow: [0; 3] };
    let small: Vec<Case> = cases().into_iter().filter(|case| case.mesh.triangle_count() < 500).collect();
    for seed in 0..1200 {
        let case = &small[seed as usize % small.len()];
        let (_, place) = placements()[seed as usize / small.len() % 3];
        check(case.name, &case.mesh, case.facing_only, &place, seed, &mut tally);
    }
    let ring = mesh(&torus(DVec3::ZERO, 1.0, 0.3, 10, 6));
    let block = mesh(&cuboid(DVec3::new(-1.0, -0.2, -0.6), DVec3::new(0.4, 0.9, 0.3)));
    for seed in 2000..2800 {
        check("ring", &ring, true, &DMat4::IDENTITY, seed, &mut tally);
        check("block", &block, true, &DMat4::IDENTITY, seed, &mut tally);
    }
    println!("told {:?}, of which in shadow {:?} (nothing, all, some landed)", tally.told, tally.in_shadow);
    assert!(tally.told.iter().all(|told| *told > 500) && tally.in_shadow[1..].iter().all(|count| *count > 200));
}

#[test]
fn cap_triangles_lie_in_the_near_plane_and_face_the_eye() {
    let ring = mesh(&torus(DVec3::ZERO, 1.0, 0.3, 10, 6));
    let caster = Caster::of_mesh(&ring);
    let mut seen = 0;
    for seed in 0..200 {
        let mut random = Random::new(seed);
        let view = view_from_world(random.vector(2.0), random.vector(1.0), DVec3::Y);
        let view = if seed % 2 == 0 { view } else { view * DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) };
        let (mut outline, mut volume) = (Outline::default(), CappedVolume::default());
        outline.find(&caster, LightSource::Point(random.vector(3.0)));
        volume.cut(&caster, &outline, &view, NEAR);
        for [a, b, c] in corners(volume.vertices(), volume.indices(), volume.near_cap()) {
            for corner in [a, b, c] {
                assert_eq!(corner.z, f64::from(-NEAR as f32) * corner.w);
            }
            // In the plane (x, y, w) is homogeneous: positive where it runs counter-clockwise seen from the eye. The
            // slack: slivers whose corners f32 moves.
            let [a, b, c] = [a, b, c].map(|corner| DVec3::new(corner.x, corner.y, corner.w));
            let size = a.length() * b.length() * c.length();
            assert!(a.dot(b.cross(c)) > -1e-6 * size, "{seed}");
            seen += 1;
        }
    }
    assert!(seen > 1000);
}
