//! Animations, morph targets and skins: positions by formulas of their own.

use glam::{DMat4, DQuat, DVec3};
use glumbra::scene::{LightKind, Loaded};
use serde_json::{Value, json};

use super::glb::{CORNERS, Glb, NORMALS, wedge};
use super::{load, scene};

/// An animation's channel with these keys; `values`: numbers a key, or three times as many.
fn animate<const N: usize>(
    glb: &mut Glb,
    node: usize,
    path: &str,
    interpolation: &str,
    times: &[f32],
    values: &[[f32; N]],
) {
    let times: Vec<[f32; 1]> = times.iter().map(|time| [*time]).collect();
    let (input, output) = (glb.floats(&times), glb.floats(values));
    if glb.json.get("animations").is_none() {
        glb.push("animations", json!({ "name": "first", "channels": [], "samplers": [] }));
    }
    let animation = &mut glb.json["animations"][0];
    let samplers = animation["samplers"].as_array_mut().unwrap();
    samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
    let sampler = samplers.len() - 1;
    let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    animation["channels"].as_array_mut().unwrap().push(channel);
}

fn placement(loaded: &Loaded) -> DMat4 {
    loaded.scene.objects[0].world_from_model
}

fn at(path: &std::path::Path, seconds: f64) -> Loaded {
    load(path, &[&format!("at={seconds:?}")])
}

#[track_caller]
fn assert_near(found: DVec3, expected: DVec3) {
    // Numbers of the file are 32-bit floats.
    assert!(found.distance(expected) < 2e-6, "{found} is not {expected}");
}

#[test]
fn keys_step_run_straight_and_curve() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = ([1.0, 2.0, 3.0], [3.0, -2.0, 4.0]);
    for interpolation in ["STEP", "LINEAR", "CUBICSPLINE"] {
        let mut glb = Glb::new();
        let mesh = wedge(&mut glb, None);
        let node = glb.root(json!({ "mesh": mesh }));
        let (leaving, coming) = ([0.5, 0.0, -1.0], [2.0, 1.0, 0.0]);
        let zero = [0.0; 3];
        match interpolation {
            "CUBICSPLINE" => {
                animate(
                    &mut glb,
                    node,
                    "translation",
                    interpolation,
                    &[1.0, 3.0],
                    &[zero, from, leaving, coming, to, zero],
                );
            }
            _ => animate(&mut glb, node, "translation", interpolation, &[1.0, 3.0], &[from, to]),
        }
        let path = glb.write(folder.path(), "a.glb");
        let [from, to, leaving, coming] =
            [from, to, leaving, coming].map(|point: [f32; 3]| DVec3::from_array(point.map(f64::from)));
        for seconds in [0.0, 1.0, 1.5, 2.75, 3.0, 9.0] {
            let place = placement(&at(&path, seconds)).w_axis.truncate();
            let t = ((seconds - 1.0) / 2.0).clamp(0.0, 1.0);
            let expected = match interpolation {
                "STEP" => {
                    if seconds < 3.0 {
                        from
                    } else {
                        to
                    }
                }
                "LINEAR" => from.lerp(to, t),
                // The cubic polynomial with these ends and these slopes, by Horner's scheme.
                _ => {
                    let (a, b) = (2.0 * leaving, 2.0 * coming);
                    let (c2, c3) = (3.0 * (to - from) - 2.0 * a - b, 2.0 * (from - to) + a + b);
                    from + t * (a + t * (c2 + t * c3))
                }
            };
            assert_near(place, expected);
        }
    }
}

#[test]
fn turns_take_the_shorter_way_evenly_and_scales_follow() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let child = glb.push("nodes", json!({ "mesh": mesh, "translation": [1.0, 0.0, 0.0] }));
    let node = glb.root(json!({ "children": [child] }));
    // By 90 degrees about y, and written with the other sign: the long way round.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    animate(&mut glb, node, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], [0.0, -half, 0.0, -half]]);
    animate(&mut glb, node, "scale", "LINEAR", &[0.0, 2.0], &[[1.0, 1.0, 1.0], [3.0, 1.0, 5.0]]);
    let path = glb.write(folder.path(), "a.glb");
    for seconds in [0.25, 0.5, 1.0] {
        let angle = 90.0 * seconds;
        let scale = DVec3::new(1.0 + seconds, 1.0, 1.0 + 2.0 * seconds);
        let point = DVec3::new(1.25, 0.5, -0.75);
        let scaled = scale * (point + DVec3::X);
        let (sine, cosine) = f64::sin_cos(f64::to_radians(angle));
        let expected = DVec3::new(cosine * scaled.x + sine * scaled.z, scaled.y, cosine * scaled.z - sine * scaled.x);
        assert_near(placement(&at(&path, seconds)).transform_point3(point), expected);
    }
    // A key of the object does what the flag does.
    let objects = "[[object]]\nmesh = \"a.glb\"\nat = 0.5\nanimation = \"first\"\n";
    let found = scene(folder.path(), "s.toml", objects).scene.objects[1].world_from_model;
    assert_eq!(found, placement(&at(&path, 0.5)));
}

/// A wedge with two morph targets, of which the second moves one corner alone.
fn morphed() -> (Glb, usize) {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let up = glb.floats(&[[0.0, 2.0, 0.0]; 5]);
    let mut one = [[0.0; 3]; 5];
    one[4] = [1.0, 0.0, -1.0];
    let one = glb.floats(&one);
    let targets = json!([{ "POSITION": up }, { "POSITION": one }]);
    glb.json["meshes"][mesh]["primitives"][0]["targets"] = targets;
    glb.json["meshes"][mesh]["weights"] = json!([0.25, 0.0]);
    let node = glb.root(json!({ "mesh": mesh }));
    (glb, node)
}

#[test]
fn weights_of_the_file_of_the_node_and_of_a_time_morph_it() {
    let folder = tempfile::tempdir().unwrap();
    let (mut glb, node) = morphed();
    let corners = |loaded: &Loaded| loaded.scene.objects[0].mesh.positions.clone();
    let expected = |weights: [f32; 2]| -> Vec<[f32; 3]> {
        let moved = |(at, [x, y, z]): (usize, [f32; 3])| {
            let (up, one) = (2.0 * weights[0], if at == 4 { weights[1] } else { 0.0 });
            [x + one, y + up, z - one]
        };
        CORNERS.into_iter().enumerate().map(moved).collect()
    };
    assert_eq!(corners(&load(&glb.write(folder.path(), "mesh.glb"), &[])), expected([0.25, 0.0]));
    glb.json["nodes"][node]["weights"] = json!([0.5, 0.75]);
    assert_eq!(corners(&load(&glb.write(folder.path(), "node.glb"), &[])), expected([0.5, 0.75]));
    animate(&mut glb, node, "weights", "LINEAR", &[0.0, 2.0], &[[0.0], [0.0], [1.0], [0.5]].map(|[x]| [x]));
    let path = glb.write(folder.path(), "time.glb");
    assert_eq!(corners(&at(&path, 1.0)), expected([0.5, 0.25]));
    assert_eq!(corners(&load(&path, &[])), expected([0.5, 0.75]));
}

/// A skin of two joints, of which the second turns: corners lie between both by their weights, normals turn with them.
#[test]
fn a_skin_moves_its_vertices_by_their_joints() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let joints = glb.accessor(&[0, 1, 0, 0].repeat(5), 5121, "VEC4", 5);
    let shares = [1.0, 0.75, 0.5, 0.25, 0.0];
    let weights = glb.floats(&shares.map(|share: f32| [share, 1.0 - share, 0.0, 0.0]));
    let attributes = &mut glb.json["meshes"][mesh]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    // Of a normal along an axis a scale is not seen.
    let mut normals = NORMALS;
    normals[4] = [0.6, 0.8, 0.0];
    let normals = glb.floats(&normals);
    glb.json["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    let second = glb.push("nodes", json!({ "translation": [0.0, 1.0, 0.0], "scale": [1.0, 2.0, 1.0] }));
    let first = glb.root(json!({ "translation": [0.5, 0.0, 0.0], "children": [second] }));
    let binds: Vec<f32> = [DMat4::IDENTITY, DMat4::from_translation(DVec3::NEG_Y)]
        .iter()
        .flat_map(|bind| bind.to_cols_array().map(|number| number as f32))
        .collect();
    let binds = glb.accessor(bytemuck::cast_slice(&binds), 5126, "MAT4", 2);
    glb.push("skins", json!({ "joints": [first, second], "inverseBindMatrices": binds }));
    // The node's own place counts for nothing.
    glb.root(json!({ "mesh": mesh, "skin": 0, "translation": [7.0, 7.0, 7.0] }));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    animate(&mut glb, second, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half]]);
    let path = glb.write(folder.path(), "skin.glb");
    let loaded = at(&path, 1.0);
    let mesh = &loaded.scene.objects[0].mesh;
    assert_eq!(placement(&loaded), DMat4::IDENTITY);
    let turn = DQuat::from_rotation_x(90_f64.to_radians());
    for (at, share) in shares.into_iter().map(f64::from).enumerate() {
        let corner = DVec3::from_array(CORNERS[at].map(f64::from));
        let of_first = corner + 0.5 * DVec3::X;
        // Bound, scaled, turned about x by 90 degrees (y to z, z to -y), moved.
        let scaled = (corner - DVec3::Y) * DVec3::new(1.0, 2.0, 1.0);
        let of_second = DVec3::new(scaled.x, -scaled.z, scaled.y) + DVec3::new(0.5, 1.0, 0.0);
        let expected = share * of_first + (1.0 - share) * of_second;
        assert_near(DVec3::from_array(mesh.positions[at].map(f64::from)), expected);
    }
    // The last vertex belongs to the second joint alone. Normals are divided by the scale.
    let normal = turn * DVec3::new(0.6, 0.8 / 2.0, 0.0).normalize();
    assert_near(DVec3::from_array(mesh.normals[4].map(f64::from)), normal);
}

#[test]
fn lights_move_with_their_nodes() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    glb.root(json!({ "mesh": mesh }));
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    let lamp = glb.root(json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    animate(&mut glb, lamp, "translation", "LINEAR", &[0.0, 4.0], &[[0.0, 2.0, 0.0], [4.0, 6.0, 0.0]]);
    let path = glb.write(folder.path(), "lamp.glb");
    let LightKind::Point(point) = at(&path, 1.0).scene.lights.swap_remove(0).kind else { panic!("a point light") };
    assert_eq!(point.position, DVec3::new(1.0, 3.0, 0.0));
}

#[test]
fn wrong_times_and_wrong_keys_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (mut still, node) = morphed();
    let without = still.write(folder.path(), "still.glb");
    animate(&mut still, node, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [1.0; 3]]);
    let moved = still.write(folder.path(), "moved.glb");
    let wrong = |name: &str, change: &dyn Fn(&mut Value)| {
        let (mut glb, node) = morphed();
        animate(&mut glb, node, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [1.0; 3]]);
        change(&mut glb.json);
        glb.write(folder.path(), name)
    };
    let backwards = {
        let (mut glb, node) = morphed();
        animate(&mut glb, node, "translation", "LINEAR", &[1.0, 1.0], &[[0.0; 3], [1.0; 3]]);
        glb.write(folder.path(), "backwards.glb")
    };
    let matrix = wrong("matrix.glb", &|json| {
        json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    });
    let sampler = wrong("sampler.glb", &|json| json["animations"][0]["channels"][0]["sampler"] = json!(5));
    for (path, overrides, expected) in [
        (&without, vec!["at=1"], "still.glb: animations: there is none"),
        (&moved, vec!["at=-1"], "must be in [0, 1e18]"),
        (&moved, vec!["at=1", "object.0.animation=walk"], "none is called \"walk\": first"),
        (&moved, vec!["object.0.animation=first"], "`object.animation` needs `at`"),
        (&moved, vec!["object.1.at=1"], "`object.at` belongs to animated models"),
        (&backwards, vec!["at=1"], "animations[0].channels[0]: needs keys whose times grow"),
        (&matrix, vec!["at=1"], "nodes[0]: has a matrix, and an animation that moves it"),
        (&sampler, vec!["at=1"], "animations[0].channels[0]: names samplers[5]"),
    ] {
        let overrides: Vec<String> = overrides.into_iter().map(str::to_owned).collect();
        let error = match glumbra::load(path, &overrides) {
            Ok(_) => panic!("{} loads: {expected}", path.display()),
            Err(error) => error.to_string(),
        };
        assert!(error.contains(expected), "{error}");
    }
}
