//! Shadows that have a formula: zero wrong outside the ambiguous pixels, which stay below 3 %.

use glam::{DMat4, DVec2, DVec3};
use glumbra::math::spaces;
use glumbra::scene::{Light, LightKind, LightShape};
use glumbra::truth::Answer;

use super::scenes::*;

/// Point of the floor that the line from the light through a point meets.
fn cast(light: &Light, point: DVec3) -> DVec2 {
    let way = way_of_light(light, point);
    let on_floor = point - way * (point.y / way.y);
    DVec2::new(on_floor.x, on_floor.z)
}

/// Tests whether a floor point lies in the convex polygon that the points cast.
fn is_in_polygon(at: DVec3, light: &Light, polygon: &[DVec3]) -> bool {
    let at = DVec2::new(at.x, at.z);
    let corners: Vec<DVec2> = polygon.iter().map(|&point| cast(light, point)).collect();
    let side = |k: usize| (corners[(k + 1) % corners.len()] - corners[k]).perp_dot(at - corners[k]) > 0.0;
    (1..corners.len()).all(|k| side(k) == side(0))
}

/// As the mesh holds it: rounded to f32.
fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

#[test]
fn primary_rays_meet_the_floor_where_the_camera_matrix_says() {
    let scene = scene(vec![floor()], light(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO));
    let truth = trace_scene(&scene);
    let camera = &scene.camera;
    let aspect = f64::from(truth.width) / f64::from(truth.height);
    let clip_from_world = spaces::perspective(camera.fov_y_radians, aspect, camera.near, camera.far)
        * spaces::view_from_world(camera.eye, camera.target, camera.up);
    let mut seen = 0;
    for y in 0..truth.height {
        for x in 0..truth.width {
            let Some(hit) = truth.at(x, y).unwrap().hit else { continue };
            let clip = clip_from_world.project_point3(hit.position);
            let column = 0.5 * (clip.x + 1.0) * f64::from(truth.width);
            let row = 0.5 * (1.0 - clip.y) * f64::from(truth.height);
            assert!((column - f64::from(x) - 0.5).abs() < 1e-9 && (row - f64::from(y) - 0.5).abs() < 1e-9);
            assert!(hit.position.y.abs() < 1e-12 && hit.normal == DVec3::Y);
            seen += 1;
        }
    }
    assert!(seen > 10_000);
}

#[test]
fn a_square_over_a_plane_casts_a_scaled_square() {
    // Heights 5 and 3 above floor and square: 0.75 * 5 / 3; from infinity the square's own size.
    for (light, half) in kinds(DVec3::new(0.0, 5.0, 0.0)).into_iter().zip([1.25, 1.25, 0.75]) {
        let case = format!("square, {} light", light.kind.name());
        let scene = scene(vec![floor(), object("square", mesh(&square(0.75, 2.0)))], light);
        check_floor(&case, &trace_scene(&scene), |at| Some(at.x.abs().max(at.z.abs()) > half));
    }
}

#[test]
fn a_triangle_casts_the_central_projection_of_itself() {
    let corners = [DVec3::new(-1.1, 0.7, 0.3), DVec3::new(0.9, 1.6, 0.8), DVec3::new(0.2, 1.1, -1.2)].map(rounded);
    for light in kinds(DVec3::new(1.2, 4.0, 0.9)) {
        let case = format!("triangle, {} light", light.kind.name());
        let caster = object("triangle", mesh(&(corners.to_vec(), vec![[0, 1, 2]])));
        let scene = scene(vec![floor(), caster], light.clone());
        check_floor(&case, &trace_scene(&scene), |at| Some(!is_in_polygon(at, &light, &corners)));
    }
}

#[test]
fn a_tilted_disc_of_nine_corners_casts_its_projection_mirrored_or_not() {
    let lights = kinds(DVec3::new(-1.0, 4.5, 1.5));
    for (light, mirror) in lights.iter().flat_map(|light| [(light, 1.0), (light, -1.0)]) {
        let rim = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 9.0).sin_cos();
            rounded(DVec3::new(0.8 * cos, 0.4 * sin, 0.8 * sin))
        };
        let rim: Vec<DVec3> = (0..9).map(rim).collect();
        let mut disc = object("disc", mesh(&(rim.clone(), (1..8).map(|k| [0, k, k + 1]).collect())));
        disc.world_from_model = DMat4::from_translation(DVec3::new(0.25, 1.0, -0.5))
            * DMat4::from_rotation_y(0.4)
            * DMat4::from_scale(DVec3::new(mirror, 1.5, 1.0));
        let corners: Vec<DVec3> = rim.iter().map(|&point| disc.world_from_model.transform_point3(point)).collect();
        let scene = scene(vec![floor(), disc], light.clone());
        let case = format!("disc, x scaled by {mirror}, {} light", light.kind.name());
        check_floor(&case, &trace_scene(&scene), |at| Some(!is_in_polygon(at, light, &corners)));
    }
}

/// Tests whether the way from `from` to the light meets the box.
fn meets_box(from: DVec3, light: &Light, min: DVec3, max: DVec3) -> bool {
    let way = -way_of_light(light, from);
    let end = if light.position().is_some() { 1.0 } else { f64::INFINITY };
    let (one, other) = ((min - from) / way, (max - from) / way);
    one.min(other).max_element().max(0.0) < one.max(other).min_element().min(end)
}

#[test]
fn a_box_casts_from_the_air_and_from_the_floor() {
    let lights = kinds(DVec3::new(2.0, 3.0, 1.0));
    for (light, bottom) in lights.iter().flat_map(|light| [(light, 0.0), (light, 0.5)]) {
        let (min, max) = (DVec3::new(-0.75, bottom, -0.5), DVec3::new(0.25, bottom + 1.0, 0.75));
        let scene = scene(vec![floor(), object("box", mesh(&cuboid(min, max)))], light.clone());
        let truth = trace_scene(&scene);
        let case = format!("box at {bottom}, {} light", light.kind.name());
        check_floor(&case, &truth, |at| Some(!meets_box(at, light, min, max)));
        // A convex body shades itself exactly where it is turned away.
        for pixel in &truth.pixels {
            let Some(hit) = pixel.hit.filter(|hit| hit.object == 1) else { continue };
            match pixel.answer {
                Answer::Lit => assert!(hit.faces_light()),
                Answer::Shadowed => assert!(!hit.faces_light()),
                _ => {}
            }
        }
    }
}

#[test]
fn a_tetrahedron_casts_the_union_of_its_faces() {
    let corners = [(-0.8, 0.6, -0.4), (0.9, 0.8, -0.3), (0.0, 0.7, 0.9), (0.1, 1.9, 0.1)]
        .map(|(x, y, z)| rounded(DVec3::new(x, y, z)));
    let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    for light in kinds(DVec3::new(-1.5, 4.0, 1.0)) {
        let case = format!("tetrahedron, {} light", light.kind.name());
        let caster = object("tetrahedron", mesh(&(corners.to_vec(), faces.to_vec())));
        let scene = scene(vec![floor(), caster], light.clone());
        check_floor(&case, &trace_scene(&scene), |at| {
            let face = |f: &[u32; 3]| is_in_polygon(at, &light, &f.map(|corner| corners[corner as usize]));
            Some(!faces.iter().any(face))
        });
    }
}

#[test]
fn a_sphere_casts_within_the_error_of_its_tessellation() {
    let (center, radius, rings) = (DVec3::new(0.25, 1.25, 0.0), 1.0, 100);
    // An edge's middle lies below the sphere by 1 - cos of half its angle, a quad's by that of its diagonal's half.
    let flattest = radius * (1.0 - (std::f64::consts::PI / f64::from(rings)).powi(2) / 4.0);
    for light in kinds(DVec3::new(1.5, 5.0, 0.5)) {
        let case = format!("sphere, {} light", light.kind.name());
        let scene = scene(vec![floor(), object("sphere", mesh(&sphere(center, radius, rings)))], light.clone());
        check_floor(&case, &trace_scene(&scene), |at| {
            let distance = (center - at).cross(way_of_light(&light, at).normalize()).length();
            (!(flattest - 1e-6..radius + 1e-6).contains(&distance)).then_some(distance > radius)
        });
    }
}

#[test]
fn parallel_light_makes_a_spheres_shadow_an_ellipse() {
    let (center, radius, rings) = (DVec3::new(0.0, 1.25, 0.3), 1.0, 100);
    let from = DVec3::new(1.0, 1.5, -0.5);
    let scene = scene(vec![floor(), object("sphere", mesh(&sphere(center, radius, rings)))], sun(from));
    // Semi-axes: the radius across, and the radius over the sine of the light's height along.
    let along = DVec2::new(-from.x, -from.z).normalize();
    let middle = DVec2::new(center.x, center.z) + along * (center.y * from.x.hypot(from.z) / from.y);
    let sine = from.y / from.length();
    let flattest = 1.0 - (std::f64::consts::PI / f64::from(rings)).powi(2) / 4.0;
    check_floor("ellipse", &trace_scene(&scene), |at| {
        let off = (DVec2::new(at.x, at.z) - middle) / radius;
        let reach = (sine * along.dot(off)).hypot(along.perp_dot(off));
        (!(flattest - 1e-6..1.0 + 1e-6).contains(&reach)).then_some(reach > 1.0)
    });
}

#[test]
fn a_point_light_among_walls_lights_every_way() {
    // Beside the light on four sides, each with its own plate between: what one spotlight could not hold.
    let position = DVec3::new(0.0, 1.0, 0.0);
    let plates = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z].map(|side| {
        let across = side.cross(DVec3::Y);
        let corner = |x: f64, y: f64| rounded(position + 0.5 * side + 0.125 * (x * across + y * DVec3::Y));
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
    });
    let lamp = point_light(position);
    let mut objects = vec![object("room", mesh(&cuboid(DVec3::new(-3.0, 0.0, -3.0), DVec3::new(3.0, 6.0, 3.0))))];
    objects.extend(plates.iter().map(|plate| object("plate", mesh(&(plate.to_vec(), vec![[0, 1, 2], [0, 2, 3]])))));
    let mut scene = scene(objects, lamp);
    (scene.camera.eye, scene.camera.target) = (DVec3::new(0.0, 5.9, 0.0), DVec3::new(0.0, 0.0, 0.01));
    scene.camera.fov_y_radians = 120f64.to_radians();
    // Through a plate: the way crosses its plane within its square.
    let is_dark = |at: DVec3| {
        let way = at - position;
        plates.iter().any(|plate| {
            let [right, up] = [plate[1] - plate[0], plate[3] - plate[0]];
            let normal = right.cross(up);
            let t = normal.dot(plate[0] - position) / normal.dot(way);
            let on = position + t * way - plate[0];
            let inside = |axis: DVec3| (0.0..1.0).contains(&(axis.dot(on) / axis.length_squared()));
            (0.0..1.0).contains(&t) && inside(right) && inside(up)
        })
    };
    check_floor("room", &trace_scene(&scene), |at| Some(!is_dark(at)));
}

#[test]
fn a_cone_lights_an_ellipse_and_a_frustum_a_quadrilateral() {
    let (position, target) = (DVec3::new(0.5, 3.0, 1.5), DVec3::new(-0.4, 0.0, 0.1));
    let half = 14f64.to_radians();
    for shape in [LightShape::Cone, LightShape::Frustum] {
        let mut lamp = light(position, target);
        frustum_of(&mut lamp).cone_radians = 2.0 * half;
        let LightKind::Spot(spot) = &mut lamp.kind else { panic!("no spotlight") };
        spot.shape = shape;
        let axis = (target - position).normalize();
        let right = axis.cross(spot.frustum.up).normalize();
        let scene = scene(vec![floor()], lamp);
        let truth = trace_scene(&scene);
        let (mut inside, mut outside) = (0, 0);
        for pixel in &truth.pixels {
            let Some(hit) = pixel.hit else { continue };
            let way = hit.position - position;
            // In the axis' plane the cone cuts the floor in an ellipse: (a.w)^2 > cos^2 |w|^2.
            let is_held = match shape {
                LightShape::Cone => axis.dot(way).powi(2) > (half.cos() * way.length()).powi(2),
                LightShape::Frustum => {
                    let corner = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                        .map(|(x, y)| position + axis + half.tan() * (x * right + y * right.cross(axis)));
                    is_in_polygon(hit.position, &scene.lights[0], &corner)
                }
            };
            match pixel.answer {
                Answer::Lit => assert!(is_held, "{shape:?} {hit:?}"),
                Answer::OutsideCone => assert!(!is_held, "{shape:?} {hit:?}"),
                Answer::Ambiguous(_) => continue,
                other => panic!("{other:?}"),
            }
            *(if is_held { &mut inside } else { &mut outside }) += 1;
        }
        println!("{shape:?}: {inside} inside, {outside} outside, {:.3} % ambiguous", 100.0 * truth.ambiguous_share());
        assert!(inside > 500 && outside > 500);
    }
}
