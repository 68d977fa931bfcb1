//! Key-framed models in motion: tangent planes and face planes between key frames against those of the blended positions.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;
use glumbra::geometry::Mesh;
use glumbra::geometry::md2::{Animation, KeyTangents, Model, NormalSource, Pose};
use glumbra::geometry::tangents::{BasisFit, TangentBasis, Tangents};
use glumbra::geometry::volume::{Caps, Caster, Extent, KeyPlanes, LightSource, Outline, PlaneBlend, Volume};
use glumbra::math::exact;

use super::md2::random_model;

fn knight() -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/knight.md2");
    Model::load(&path).unwrap().0
}

/// The knight and twenty random models.
fn models(random: &mut fastrand::Rng) -> Vec<Model> {
    let random = (0..20).map(|_| Model::new(random_model(random), "random.md2", |_| ()));
    std::iter::once(knight()).chain(random).collect()
}

fn pose(model: &Model, random: &mut fastrand::Rng) -> Pose {
    Pose { frames: [(); 2].map(|()| random.usize(0..model.frame_count())), blend: random.f64() }
}

fn vector(random: &mut fastrand::Rng) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| 2.0 * random.f64() - 1.0))
}

/// A light around a mesh, near or far, or a direction.
fn source(mesh: &Mesh, random: &mut fastrand::Rng) -> LightSource {
    let size = mesh.bounds.max.distance(mesh.bounds.min);
    let reach = size * [0.3, 1.0, 20.0][random.usize(0..3)];
    match random.usize(0..4) {
        0 => LightSource::Direction(vector(random)),
        _ => LightSource::Point(mesh.bounds.center() + reach * vector(random)),
    }
}

/// Places of a triangle's corners in a pose, blended in f64.
fn corners(model: &Model, pose: &Pose, triangle: usize) -> [DVec3; 3] {
    let vertices: Vec<usize> = model.vertices().collect();
    [0, 1, 2].map(|corner| model.position(pose, vertices[model.indices()[3 * triangle + corner] as usize]))
}

/// Bases of two kinds, compared: the greatest distance of two of their vectors.
fn apart(a: &TangentBasis, b: &TangentBasis) -> f64 {
    [(a.tangent, b.tangent), (a.bitangent, b.bitangent), (a.normal, b.normal)]
        .into_iter()
        .map(|(a, b)| a.distance(b))
        .fold(0.0, f64::max)
}

/// An edge is Δs P_s + Δt P_t: each triangle's derivatives give both edges of the blended positions, to 1e-12 of the lengths
/// that are summed.
#[test]
fn tangent_planes_between_frames_are_those_of_blended_positions() {
    let mut random = fastrand::Rng::with_seed(692);
    let mut worst = 0.0_f64;
    for model in models(&mut random) {
        let tangents = KeyTangents::new(&model);
        let skin: Vec<[f64; 2]> = model.texcoords().map(|texcoord| texcoord.map(f64::from)).collect();
        for _ in 0..10 {
            let pose = pose(&model, &mut random);
            for (triangle, indices) in model.indices().as_chunks::<3>().0.iter().enumerate() {
                let [a, b, c] = corners(&model, &pose, triangle);
                let [by_s, by_t] = tangents.derivatives(&pose, triangle);
                assert!(by_s.length() > 0.0 && by_t.length() > 0.0);
                let [first, others @ ..] = indices.map(|index| skin[index as usize]);
                for (edge, [s, t]) in [b - a, c - a].into_iter().zip(others) {
                    let [s, t] = [s - first[0], t - first[1]];
                    // Sums of parts that cancel: relative to the parts, and to the positions' own rounding.
                    let size = s.abs() * by_s.length() + t.abs() * by_t.length() + a.length();
                    worst = worst.max(edge.distance(s * by_s + t * by_t) / size);
                }
            }
        }
    }
    println!("edges by blended P_s and P_t: at most {worst:.1e} of their size off");
    assert!(worst < 1e-12, "{worst:e}");
}

/// The bases that an animation finds, of every fit, are those of the mesh in the same pose, whose positions are rounded to f32.
#[test]
fn bases_between_frames_are_those_of_the_mesh() {
    let mut random = fastrand::Rng::with_seed(693);
    let mut worst = 0.0_f64;
    for model in models(&mut random) {
        let mut animation = Animation::new(&model);
        for _ in 0..6 {
            let pose = pose(&model, &mut random);
            animation.move_to(&pose);
            let mesh = model.mesh(&pose, NormalSource::File);
            assert_eq!(*animation.mesh(), mesh);
            for fit in [BasisFit::PerPolygon, BasisFit::Orthogonal, BasisFit::Skewed] {
                let expected = Tangents::of_skin(&mesh, fit).unwrap();
                let found = animation.tangents(fit);
                assert_eq!((found.mirrored, found.without), (expected.mirrored, expected.without));
                for (index, (a, b)) in found.corners.iter().zip(&expected.corners).enumerate() {
                    let [p, q, r] = corners(&model, &pose, index / 3);
                    let longest = p.distance(q).max(q.distance(r)).max(r.distance(p));
                    // The share of a corner's rounding in the triangle's height; T's part in the vertex's plane may be short.
                    let height = (q - p).cross(r - p).length() / longest;
                    let rounding = f64::from(f32::EPSILON) * p.abs().max(q.abs()).max(r.abs()).max_element();
                    let short = a.normal.cross((q - p).cross(r - p).normalize()).length();
                    let bound = 8.0 * rounding / height / (1.0 - short).max(1e-3) + 1e-6;
                    assert!(apart(a, b) < bound, "{fit:?} {index}: {a:?}, not {b:?}: {bound:e}");
                    worst = worst.max(apart(a, b));
                }
            }
        }
    }
    println!("bases by key frames against those of f32 meshes: at most {worst:.1e} apart");
}

/// Normals are quadratic in the blend, distances cubic: both as found from blended positions, to 1e-12.
#[test]
fn planes_between_frames_are_those_of_blended_positions() {
    let mut random = fastrand::Rng::with_seed(694);
    let (mut normals, mut distances) = (0.0_f64, 0.0_f64);
    for model in models(&mut random) {
        for _ in 0..10 {
            let pose = pose(&model, &mut random);
            let mut animation = Animation::new(&model);
            animation.move_to(&pose);
            let (places, _) = model.places();
            for (triangle, indices) in animation.caster().triangles().iter().enumerate() {
                let [a, b, c] = indices.map(|place| model.position(&pose, places[place as usize]));
                let expected = (b - a).cross(c - a);
                let (normal, distance) = animation.planes().plane(triangle, pose.blend, PlaneBlend::Exact);
                let ends = pose.frames.map(|frame| {
                    let pose = Pose { frames: [frame; 2], blend: 0.0 };
                    indices.map(|place| model.position(&pose, places[place as usize]))
                });
                let longest = |[a, b, c]: [DVec3; 3]| a.distance(b).max(b.distance(c)).max(c.distance(a));
                let edge = longest(ends[0]).max(longest(ends[1]));
                let reach = ends.iter().flatten().map(|corner| corner.length()).fold(0.0, f64::max);
                // Positions of their own are rounded too: edges are off by their share.
                let size = edge * (edge + reach);
                normals = normals.max(normal.distance(expected) / size);
                distances = distances.max((distance - expected.dot(a)).abs() / (size * reach));
            }
        }
    }
    println!("normals at most {normals:.1e} off, distances {distances:.1e}, of the products that are summed");
    assert!(normals < 1e-12 && distances < 1e-12, "{normals:e} {distances:e}");
}

/// Weights of a caster's triangles by their corners' positions, in an order that does not depend on the triangles' own.
fn weights_by_corners(caster: &Caster, outline: &Outline) -> HashMap<Vec<[u32; 3]>, Vec<i8>> {
    let mut found: HashMap<Vec<[u32; 3]>, Vec<i8>> = HashMap::new();
    for (places, weight) in caster.triangles().iter().zip(outline.weights()) {
        let mut corners: Vec<[u32; 3]> =
            places.iter().map(|place| caster.positions()[*place as usize].map(|part| (part + 0.0).to_bits())).collect();
        // Turned to begin with the least: the order around stays.
        let least = (0..3).min_by_key(|corner| corners[*corner]).unwrap();
        corners.rotate_left(least);
        found.entry(corners).or_default().push(*weight);
    }
    found.values_mut().for_each(|weights| weights.sort_unstable());
    found
}

/// With exact planes, an animation's outline has the triangles of a caster made anew from the mesh in that pose, by exact
/// predicates: wherever the quadratic planes decide, they are right.
#[test]
fn exact_planes_count_what_exact_predicates_count() {
    let mut random = fastrand::Rng::with_seed(695);
    let (mut counted, mut exact_tests, mut fresh) = (0, 0, Outline::default());
    for model in models(&mut random) {
        let mut animation = Animation::new(&model);
        for round in 0..40 {
            let pose = pose(&model, &mut random);
            animation.move_to(&pose);
            let mesh = model.mesh(&pose, NormalSource::File);
            let caster = Caster::of_mesh(&mesh);
            let mut source = source(&mesh, &mut random);
            if round % 4 == 0 {
                // In the plane of a triangle, or as near as f64 has it.
                let [a, b, c] = corners(&model, &pose, random.usize(0..mesh.triangle_count()));
                source = LightSource::Point(a + 5.0 * random.f64() * (b - a) - 3.0 * random.f64() * (c - a));
            }
            fresh.find(&caster, source);
            let outline = animation.outline(source, PlaneBlend::Exact);
            counted += outline.weights().iter().filter(|weight| **weight != 0).count();
            exact_tests += outline.exact_tests();
            let (found, edges) = (outline.clone(), outline.edges().len());
            assert_eq!(
                weights_by_corners(animation.caster(), &found),
                weights_by_corners(&caster, &fresh),
                "{source:?} {pose:?}"
            );
            assert_eq!(edges, fresh.edges().len());
            // Moved with its planes, the caster counts the same.
            let mut moved = animation.caster().clone();
            let positions = moved.positions().to_vec();
            moved.move_to(|place| positions[place]);
            let mut by_find = Outline::default();
            by_find.find(&moved, source);
            assert_eq!(by_find.weights(), found.weights());
            // Without them, too: by exact arithmetic alone.
            by_find.find(animation.caster(), source);
            assert_eq!(by_find.weights(), found.weights());
        }
    }
    println!("{counted} triangles counted, {exact_tests} exact tests");
    assert!(counted > 20_000 && (100..counted / 50).contains(&exact_tests), "{counted} {exact_tests}");
}

/// The talk's blended planes beside the planes of blended positions: how far they lean, and how many triangles they take for
/// the wrong side of a light. At key frames they are right.
#[test]
fn blended_planes_are_wrong_between_key_frames() {
    let model = knight();
    let mut random = fastrand::Rng::with_seed(1999);
    let mut animation = Animation::new(&model);
    for (what, step) in [("neighbouring frames", 1), ("every second frame", 2), ("any two frames", 0)] {
        let (mut angles, mut wrong, mut told, mut near) = (Vec::new(), 0, 0, 0);
        for _ in 0..300 {
            // The run's frames, 8 to 15, in a circle.
            let first = random.usize(0..8);
            let second = if step == 0 { random.usize(0..8) } else { (first + step) % 8 };
            let pose = Pose { frames: [8 + first, 8 + second], blend: random.f64() };
            animation.move_to(&pose);
            let source = source(animation.mesh(), &mut random);
            let count = animation.planes().len();
            let mut lerped = vec![0; count];
            animation.planes().sides(pose.blend, PlaneBlend::Lerped, source, &mut lerped);
            for (triangle, side) in lerped.iter().enumerate() {
                let caster = animation.caster();
                let corners = caster.triangles()[triangle]
                    .map(|place| DVec3::from_array(caster.positions()[place as usize].map(f64::from)));
                let right = match source {
                    LightSource::Point(light) => exact::side_of_point(&corners, light),
                    LightSource::Direction(direction) => exact::side_of_direction(&corners, direction),
                };
                let plane = |by| animation.planes().plane(triangle, pose.blend, by).0;
                let [exact, lerped] = [PlaneBlend::Exact, PlaneBlend::Lerped].map(plane);
                let angle = exact.angle_between(lerped).to_degrees();
                angles.push(angle);
                told += 1;
                if *side != right {
                    wrong += 1;
                    // The light is about as near to the plane, seen from the triangle, as the plane leans.
                    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                    let towards = match source {
                        LightSource::Point(light) => light - middle,
                        LightSource::Direction(direction) => direction,
                    };
                    let above = 90.0 - exact.angle_between(towards).to_degrees();
                    near += usize::from(above.abs() < 2.0 * angle + 5.0);
                }
            }
            for blend in [0.0, 1.0] {
                let [mut by_both, mut exact] = [vec![0; count], vec![0; count]];
                animation.planes().sides(blend, PlaneBlend::Lerped, source, &mut by_both);
                animation.planes().sides(blend, PlaneBlend::Exact, source, &mut exact);
                // Where the exact planes leave no doubt.
                assert!(exact.iter().zip(&by_both).all(|(exact, lerped)| *exact == 0 || exact == lerped), "{blend}");
            }
        }
        angles.sort_by(f64::total_cmp);
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        let share = 100.0 * wrong as f64 / f64::from(told);
        println!(
            "{what}: planes lean by {mean:.3} degrees in the mean, 99 % by less than {:.3}, at most {:.2}; {wrong} of {told} \
             triangles ({share:.3} %) on the wrong side, {near} of them near to the silhouette",
            angles[angles.len() * 99 / 100],
            angles[angles.len() - 1]
        );
        assert!(wrong > 0 && share < 5.0, "{wrong} of {told}");
        assert!(mean > 1e-3, "blended planes are no exact ones: {mean}");
    }
}

/// Edges of a volume that do not cancel.
fn open_edges(volume: &Volume) -> usize {
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    let reversed = volume.light_cap_reversed();
    for (first, triangle) in (0u32..).step_by(3).zip(volume.indices().as_chunks::<3>().0) {
        let sign = if reversed.contains(&first) { -1 } else { 1 };
        for (from, to) in [0, 1, 2].map(|k| (triangle[k], triangle[(k + 1) % 3])) {
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { sign } else { -sign };
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

/// Whatever side each triangle is taken for, at random or by blended planes, every edge of the volume has as many triangles one
/// way as the other.
#[test]
fn volumes_are_closed_whatever_the_sides() {
    let mut random = fastrand::Rng::with_seed(696);
    let (mut volume, mut outline, mut triangles) = (Volume::default(), Outline::default(), 0);
    for model in models(&mut random) {
        let mut animation = Animation::new(&model);
        for round in 0..20 {
            let pose = pose(&model, &mut random);
            animation.move_to(&pose);
            let source = source(animation.mesh(), &mut random);
            if round % 2 == 0 {
                let sides: Vec<i8> = animation.caster().triangles().iter().map(|_| random.i8(-1..=1)).collect();
                outline.find_by_sides(animation.caster(), source, &sides);
            } else {
                outline = animation.outline(source, PlaneBlend::Lerped).clone();
            }
            for extent in [Extent::Infinite, Extent::Truncated(30.0)] {
                volume.extrude(animation.caster(), &outline, extent, Caps::BOTH);
                triangles += volume.indices().len() / 3;
                assert_eq!(open_edges(&volume), 0, "{source:?} {pose:?}");
            }
        }
    }
    println!("{triangles} triangles of volumes: every edge cancels");
    assert!(triangles > 50_000, "{triangles}");
}

/// Planes of frames that are the same are those of one frame, and none are no triangles.
#[test]
fn planes_of_one_frame_do_not_move() {
    let corners = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 2.5, 3.0), DVec3::new(1.0, 4.0, 5.0)];
    let planes = KeyPlanes::new(&[[0, 1, 2]], &corners, &corners);
    for (blend, by) in [(0.0, PlaneBlend::Exact), (0.3, PlaneBlend::Exact), (0.3, PlaneBlend::Lerped)] {
        let (normal, distance) = planes.plane(0, blend, by);
        // (1, 0.5, 0) × (0, 2, 2) = (1, -2, 2), at (1, 2, 3): 3.
        assert!(normal.distance(DVec3::new(1.0, -2.0, 2.0)) < 1e-14 && (distance - 3.0).abs() < 1e-14);
        let mut side = [5];
        planes.sides(blend, by, LightSource::Point(DVec3::new(1.0, 2.0, 4.0)), &mut side);
        assert_eq!(side, [1]);
    }
    assert!(KeyPlanes::default().is_empty() && planes.len() == 1);
}
