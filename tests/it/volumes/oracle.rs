//! The ray tracer's counts: against known scenes, against its own visibility, against volumes that were built.

use glam::{DMat4, DVec3};
use glumbra::geometry::volume::{CappedVolume, Caps, Caster, Extent, Landing, LightSource, Outline, Volume};
use glumbra::math::spaces::view_from_world;
use glumbra::scene::{Object, Scene};
use glumbra::truth::{Answer, Count, Options, trace, volume_count, volume_count_at};

use super::homogeneous::{Random, corners, entries, exits, triangles};
use super::shapes::{Case, cases, dense, placements, turned};
use crate::oracle::scenes::{cuboid, floor, frustum_of, light, mesh, object, point_light, scene, sphere, square, sun};

fn placed(mesh: glumbra::geometry::Mesh, world_from_model: DMat4) -> Object {
    let mut object = object("caster", mesh);
    object.world_from_model = world_from_model;
    object
}

/// Moves the near plane to 0: surfaces nearer than it do not cast, and volumes made without a light have no near plane.
fn near_nothing(mut light: glumbra::scene::Light) -> glumbra::scene::Light {
    frustum_of(&mut light).near = 1e-12;
    light
}

fn with(objects: Vec<Object>, position: DVec3) -> Scene {
    scene(objects, near_nothing(light(position, if position == DVec3::ZERO { DVec3::X } else { DVec3::ZERO })))
}

/// Volumes of every object, at points of the cube of half 2.
fn compare(case: &str, mesh: &glumbra::geometry::Mesh, place: DMat4, source: LightSource, points: usize) -> u32 {
    let mut random = Random::new(points as u64);
    let points: Vec<DVec3> = (0..points).map(|_| random.vector(2.0)).collect();
    let light = match source {
        LightSource::Point(position) => {
            near_nothing(light(position, if position == DVec3::ZERO { DVec3::X } else { DVec3::ZERO }))
        }
        LightSource::Direction(towards) => sun(towards),
    };
    let scene = scene(vec![placed(mesh.clone(), place)], light);
    let expected = volume_count_at(&scene, 0, &points, 1e-5, &Options::default()).unwrap();
    let model_from_world = place.inverse();
    let caster = Caster::of_mesh(mesh);
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    outline.find(&caster, source.transformed(&model_from_world));
    volume.extrude(&caster, &outline, Extent::Infinite, Caps::BOTH);
    let volume = triangles(&volume);
    let (mut told, mut sum) = (0usize, 0);
    for (point, expected) in points.iter().zip(expected) {
        let Some(expected) = expected else { continue };
        let way = random.vector(1.0);
        let [at, along] = [model_from_world.transform_point3(*point), model_from_world.transform_vector3(way)];
        assert_eq!(exits(&volume, at, along), expected as i32, "{case} {source:?} {point}");
        (told, sum) = (told + 1, sum + expected);
    }
    // Where the light is within the error of a face, what that face shades (up to three quarters at a corner) is not told.
    assert!(told > points.len() / 4, "{case}: {told} of {} told", points.len());
    sum
}

#[test]
fn built_volumes_hold_what_the_oracle_says() {
    for Case { name, mesh, .. } in cases() {
        let points = if mesh.triangle_count() > 500 { 100 } else { 200 };
        for (place_name, place) in placements() {
            let mut sum = 0;
            for position in [DVec3::new(2.1, 4.3, 3.2), DVec3::new(-0.3, 2.6, 0.2), DVec3::new(0.0213, 0.0727, -0.0411)]
            {
                sum += compare(&format!("{name} {place_name}"), &mesh, place, LightSource::Point(position), points);
            }
            let towards = LightSource::Direction(DVec3::new(0.3, 1.1, -0.4));
            sum += compare(&format!("{name} {place_name}"), &mesh, place, towards, points);
            assert!(sum > 0, "{name}");
        }
    }
    assert!(compare("dense", &dense(), DMat4::IDENTITY, LightSource::Point(DVec3::new(2.1, 4.3, 3.2)), 60) > 0);
}

#[test]
fn a_millionth_from_a_corner_the_count_is_still_told() {
    for Case { name, mesh, .. } in cases().into_iter().filter(|case| case.mesh.triangle_count() < 500) {
        for k in [0, 1, 2] {
            let corner = DVec3::from_array(mesh.positions[k % mesh.positions.len()].map(f64::from));
            let source = LightSource::Point(corner + DVec3::new(7e-7, 1e-6, -4e-7));
            compare(name, &mesh, DMat4::IDENTITY, source, 100);
        }
    }
}

#[test]
fn the_near_plane_is_capped_where_the_oracle_says_it_is_in_shadow() {
    const NEAR: f64 = 0.2;
    let small: Vec<Case> = cases().into_iter().filter(|case| case.mesh.triangle_count() < 500).collect();
    let (mut hard, mut told, mut sum) = (0, 0, 0);
    for seed in 0..2500 {
        let Case { name, mesh, .. } = &small[seed as usize % small.len()];
        let (_, place) = placements()[seed as usize / small.len() % 3];
        let mut random = Random::new(seed);
        let (eye, position) = (random.vector(1.4), random.vector(2.5));
        let view = view_from_world(eye, eye + random.vector(1.0), DVec3::Y);
        let caster = Caster::of_mesh(mesh);
        let (mut outline, mut volume) = (Outline::default(), CappedVolume::default());
        outline.find(&caster, LightSource::Point(position).transformed(&place.inverse()));
        volume.cut(&caster, &outline, &(view * place), NEAR);
        hard += u32::from(volume.landing() == Landing::Some);
        let cap: Vec<_> = corners(volume.vertices(), volume.indices(), 0..volume.indices().len() as u32);
        let cap: Vec<_> = cap.into_iter().map(|corners| (corners, 1)).collect();
        let points: Vec<DVec3> = (0..12).map(|_| random.vector(1.0).with_z(-NEAR)).collect();
        let world: Vec<DVec3> = points.iter().map(|point| view.inverse().transform_point3(*point)).collect();
        let scene = with(vec![placed(mesh.clone(), place)], position);
        let counts = volume_count_at(&scene, 0, &world, 1e-4, &Options::default()).unwrap();
        for (point, expected) in points.into_iter().zip(counts) {
            let Some(expected) = expected else { continue };
            // From just before the plane to just beyond it: through the cap alone.
            let step = DVec3::new(0.0, 0.0, -1e-5);
            let found = entries(&cap, point - step, 2.0 * step);
            assert_eq!(found, expected as i32, "{name} seed {seed} {position} {point} {:?}", volume.landing());
            (told, sum) = (told + 1, sum + expected);
        }
    }
    println!("{hard} hard cases, {told} points told, counts sum to {sum}");
    assert!(hard >= 1000 && told > 10_000 && sum > 2000);
}

#[test]
fn stacked_squares_count_one_each_and_the_averted_side_counts_itself() {
    let squares = (1..=5).map(|k| object("square", mesh(&square(0.6, 0.4 * f64::from(k)))));
    let scene = with([floor()].into_iter().chain(squares).collect(), DVec3::new(0.0, 9.0, 0.0));
    for (eye, object, expected) in
        [(DVec3::new(0.0, 8.0, 0.1), 5, 0), (DVec3::new(0.0, 0.2, 0.3), 1, 5), (DVec3::new(0.0, 1.0, 0.3), 3, 3)]
    {
        let mut scene = scene.clone();
        scene.camera.eye = eye;
        scene.camera.target = if object == 5 { DVec3::ZERO } else { DVec3::new(0.0, 3.0, 0.0) };
        let counts = volume_count(&scene, 0, &Options { most_ambiguous: 1.0, ..Options::default() }).unwrap();
        let own = counts.pixels.iter().filter(|pixel| pixel.hit.is_some_and(|hit| hit.object == object));
        let own: Vec<Count> = own.map(|pixel| pixel.count).collect();
        let right = own.iter().filter(|count| **count == Count::Exactly(expected)).count();
        let sure = own.iter().filter(|count| matches!(count, Count::Exactly(_))).count();
        assert!(right == sure && right * 10 > own.len() * 9 && right > 1000, "{eye}: {right} of {sure}: {}", own.len());
    }
}

fn busy(position: DVec3) -> Scene {
    let ball = mesh(&turned(sphere(DVec3::new(1.1, 0.9, 0.2), 0.6, 16)));
    let knot = mesh(&super::shapes::torus_knot(120, 8));
    let block = mesh(&cuboid(DVec3::new(-1.9, 0.0, -0.9), DVec3::new(-1.2, 1.1, -0.2)));
    let lid = mesh(&square(0.5, 2.1));
    let lifted = DMat4::from_translation(DVec3::new(-0.2, 1.0, 0.6)) * DMat4::from_scale(DVec3::new(-0.5, 0.5, 0.5));
    let objects = vec![floor(), object("ball", ball), object("block", block), object("lid", lid), placed(knot, lifted)];
    with(objects, position)
}

#[test]
fn lit_is_a_count_of_zero() {
    for (position, eye) in [
        (DVec3::new(1.5, 4.5, -1.0), DVec3::new(1.7, 4.3, 6.1)),
        (DVec3::new(-2.2, 3.1, 1.4), DVec3::new(0.2, 1.3, 3.1)),
        // The light within the ball.
        (DVec3::new(1.2, 1.0, 0.3), DVec3::new(1.7, 4.3, 6.1)),
    ] {
        let mut scene = busy(position);
        scene.camera.eye = eye;
        frustum_of(&mut scene.lights[0]).near = 1e-3;
        check_lit_is_zero(&scene);
    }
    for light in [point_light(DVec3::new(1.5, 4.5, -1.0)), sun(DVec3::new(1.5, 4.5, -1.0))] {
        check_lit_is_zero(&Scene { lights: vec![light], ..busy(DVec3::ONE) });
    }
}

fn check_lit_is_zero(scene: &Scene) {
    let kind = &scene.lights[0].kind;
    let options = Options { most_ambiguous: 0.2, ..Options::default() };
    let (truth, counts) = (trace(scene, 0, &options).unwrap(), volume_count(scene, 0, &options).unwrap());
    let (mut lit, mut shadowed, mut wrong) = (0, 0, 0);
    for (a, b) in truth.pixels.iter().zip(&counts.pixels) {
        match (a.answer, b.count) {
            (Answer::Lit, Count::Exactly(count)) => (lit, wrong) = (lit + 1, wrong + u32::from(count > 0)),
            (Answer::Shadowed, Count::Exactly(count)) => {
                (shadowed, wrong) = (shadowed + 1, wrong + u32::from(count == 0));
            }
            _ => {}
        }
    }
    println!(
        "{kind:?}: {lit} lit, {shadowed} shadowed, {wrong} wrong; ambiguous: {:.2} % of counts, {:.2} % of shades",
        100.0 * counts.ambiguous_share(),
        100.0 * truth.ambiguous_share()
    );
    assert!(wrong == 0 && shadowed > 1000, "{kind:?}: {wrong} wrong");
    assert!(counts.ambiguous_share() < 0.03);
}
