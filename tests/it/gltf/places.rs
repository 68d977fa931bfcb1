//! Things that a file places: nodes, names, cameras and lights.

use std::process::Command;

use glam::{DMat4, DQuat, DVec3};
use glumbra::scene::LightKind;
use serde_json::json;

use super::glb::{CORNERS, Glb, wedge};
use super::{assert_same, drawn, load, refusal, scene};

/// Three nodes below each other: moved and scaled, turned, sheared by a matrix.
fn nested() -> Glb {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let shear = [1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.25, 1.0, 0.0, 0.5, 0.0, -1.0, 1.0];
    let leaf = glb.push("nodes", json!({ "name": "leaf", "mesh": mesh, "matrix": shear }));
    let turned = glb.push("nodes", json!({ "name": "turned", "rotation": [0.0, 0.6, 0.0, 0.8], "children": [leaf] }));
    glb.root(json!({
        "name": "top", "translation": [0.5, 0.25, -2.0], "scale": [1.0, 2.0, -0.5], "children": [turned], "mesh": mesh,
    }));
    glb
}

#[test]
fn corners_are_where_the_nodes_put_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = nested().write(folder.path(), "nested.glb");
    let loaded =
        scene(folder.path(), "scene.toml", "[[object]]\nmesh = \"nested.glb\"\nscale = 2\ntranslate = [0, 1, 0]\n");
    let names: Vec<&str> = loaded.scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["quad", "nested.glb/top", "nested.glb/leaf"]);
    let [top, leaf] = [&loaded.scene.objects[1], &loaded.scene.objects[2]];
    assert!(std::sync::Arc::ptr_eq(&top.mesh, &leaf.mesh), "a mesh is there once");
    // Sine and cosine of the turn are those of twice the angle whose half has the sine 0.6.
    let turn = |p: DVec3| DVec3::new(0.28 * p.x + 0.96 * p.z, p.y, -0.96 * p.x + 0.28 * p.z);
    let of_top = |p: DVec3| p * DVec3::new(1.0, 2.0, -0.5) + DVec3::new(0.5, 0.25, -2.0);
    let shear = |p: DVec3| DVec3::new(p.x + 0.5 * p.y + 0.5, p.y + 0.25 * p.z, p.z - 1.0);
    let of_object = |p: DVec3| 2.0 * p + DVec3::Y;
    for (corner, position) in CORNERS.iter().zip(&top.mesh.positions) {
        assert_eq!(corner, position);
        let corner = DVec3::from_array(corner.map(f64::from));
        let near = |found: DVec3, expected: DVec3| {
            // Numbers of the file are 32-bit floats, of which 0.6 and 0.8 are rounded.
            assert!(found.distance(expected) < 1e-6, "{found} is not {expected}");
        };
        near(top.world_from_model.transform_point3(corner), of_object(of_top(corner)));
        near(leaf.world_from_model.transform_point3(corner), of_object(of_top(turn(shear(corner)))));
    }
    let alone = load(&path, &[]);
    assert_eq!(alone.scene.objects.len(), 3, "two meshes and a floor");
}

#[test]
fn a_name_is_a_node_with_all_below_it_or_a_mesh_in_its_own_space() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = nested();
    // A node behind them, which is not below.
    glb.root(json!({ "name": "aside", "mesh": 0 }));
    glb.root(json!({ "name": "empty" }));
    glb.write(folder.path(), "n.glb");
    let places = |name: &str| {
        let loaded = scene(folder.path(), "s.toml", &format!("[[object]]\nmesh = \"n.glb#{name}\"\nname = \"it\"\n"));
        let objects = loaded.scene.objects.into_iter().skip(1);
        objects.map(|object| (object.name, object.world_from_model)).collect::<Vec<_>>()
    };
    let whole = places("top");
    assert_eq!(whole.len(), 2);
    let leaf = places("leaf");
    assert_eq!((leaf[0].0.as_str(), leaf[0].1), ("it", whole[1].1), "placed as in the whole file");
    assert_eq!(places("turned")[0].1, leaf[0].1);
    assert_eq!(places("wedge"), [(String::from("it"), DMat4::IDENTITY)]);
    for (name, expected) in [
        ("laef", "no node and no mesh is called \"laef\": did you mean `leaf`?"),
        ("empty", "no node at or below \"empty\""),
    ] {
        let path = folder.path().join("wrong.toml");
        std::fs::write(&path, format!("[[object]]\nmesh = \"n.glb#{name}\"\n")).unwrap();
        let error = refusal(&path);
        assert!(error.contains("wrong.toml:2: ") && error.contains(expected), "{error}");
    }
}

/// A file with two cameras, of which one looks from above, and a light of each kind.
fn furnished() -> Glb {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    glb.root(json!({ "mesh": mesh }));
    let yfov = 0.8;
    let camera = glb.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": yfov, "znear": 0.25 } }));
    let wide = json!({ "yfov": 1.0, "znear": 0.5, "zfar": 64.0, "aspectRatio": 1.5 });
    let wide = glb.push("cameras", json!({ "type": "perspective", "perspective": wide }));
    let flat = json!({ "xmag": 1.0, "ymag": 1.0, "znear": 0.5, "zfar": 64.0 });
    let flat = glb.push("cameras", json!({ "type": "orthographic", "orthographic": flat }));
    glb.root(json!({ "name": "front", "camera": camera, "translation": [0.25, 0.5, 6.0] }));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // Turned by -90 degrees about x: it looks down, and up is -z.
    glb.root(
        json!({ "name": "above", "camera": wide, "translation": [0.0, 8.0, 0.0], "rotation": [-half, 0.0, 0.0, half] }),
    );
    glb.root(json!({ "name": "flat", "camera": flat }));
    glb.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "color": [1.0, 0.5, 0.25], "intensity": 2.0 },
        { "type": "point", "intensity": 40.0, "range": 9.0 },
        { "type": "spot", "intensity": 60.0, "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } },
    ] } });
    let lit = |light: usize| json!({ "KHR_lights_punctual": { "light": light } });
    glb.root(json!({ "name": "sun", "rotation": [-half, 0.0, 0.0, half], "extensions": lit(0) }));
    glb.root(json!({ "name": "lamp", "translation": [3.0, 3.0, 1.0], "extensions": lit(1) }));
    glb.root(json!({ "name": "beam", "translation": [0.0, 1.0, 5.0], "extensions": lit(2) }));
    glb
}

#[test]
fn cameras_and_lights_of_the_file_are_the_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let path = furnished().write(folder.path(), "f.glb");
    let front = load(&path, &[]);
    let camera = &front.scene.camera;
    assert_eq!((camera.eye, camera.up, camera.near), (DVec3::new(0.25, 0.5, 6.0), DVec3::Y, 0.25));
    assert_eq!(camera.target - camera.eye, DVec3::NEG_Z);
    assert!((camera.fov_y_radians - f64::from(0.8_f32)).abs() < 1e-12);
    assert_eq!(front.scene.objects.len(), 1, "no floor is supplied");
    let above = load(&path, &["camera=above"]).scene.camera;
    assert!((above.target - above.eye).distance(DVec3::NEG_Y) < 1e-6 && above.up.distance(DVec3::NEG_Z) < 1e-6);
    assert_eq!((above.near, above.far), (0.5, 64.0));
    let [sun, lamp, beam] = &front.scene.lights[..] else { panic!("three lights") };
    let white = |intensity: f64| [(intensity / std::f64::consts::PI) as f32; 3];
    let [red, ..] = white(2.0);
    assert_eq!((sun.name.as_str(), sun.diffuse), ("sun", [red, red * 0.5, red * 0.25]));
    assert_eq!((lamp.diffuse, beam.diffuse), (white(40.0), white(60.0)));
    let LightKind::Directional { direction } = &sun.kind else { panic!("{sun:?}") };
    assert!(direction.distance(DVec3::NEG_Y) < 1e-6);
    let LightKind::Point(point) = &lamp.kind else { panic!("{lamp:?}") };
    assert_eq!((point.position, point.attenuation), (DVec3::new(3.0, 3.0, 1.0), [0.0, 0.0, 1.0]));
    let LightKind::Spot(spot) = &beam.kind else { panic!("{beam:?}") };
    assert_eq!((spot.frustum.position, spot.attenuation), (DVec3::new(0.0, 1.0, 5.0), [0.0, 0.0, 1.0]));
    assert_eq!(spot.frustum.target - spot.frustum.position, DVec3::NEG_Z);
    assert!((spot.frustum.cone_radians - 1.0).abs() < 1e-12);
    for expected in ["cameras[2]: is orthographic", "lights[1]: its range is left out", "lights[2]: does not fade"] {
        assert!(front.warnings.iter().any(|warning| warning.contains(expected)), "{expected}: {:?}", front.warnings);
    }
}

#[test]
fn the_picture_is_as_wide_as_the_first_camera_says() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = furnished();
    glb.json["cameras"][0]["perspective"]["aspectRatio"] = json!(1.5);
    let path = glb.write(folder.path(), "f.glb");
    assert_eq!(load(&path, &[]).scene.image.size, [768, 512]);
    assert_eq!(load(&path, &["image.size=[64, 64]"]).scene.image.size, [64, 64]);
}

/// A surface that faces a directional light of intensity 1.5 reflects its colour times 1.5 / pi, and its ambient light.
#[test]
fn a_directional_light_lights_by_its_intensity_over_pi() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let position = glb.floats(&[[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let pbr = json!({ "baseColorFactor": [0.75, 0.5, 1.0, 1.0], "metallicFactor": 0.0 });
    let material = glb.push("materials", json!({ "pbrMetallicRoughness": pbr, "doubleSided": true }));
    let primitive = json!({ "attributes": { "POSITION": position }, "indices": indices, "material": material });
    let mesh = glb.push("meshes", json!({ "primitives": [primitive] }));
    glb.root(json!({ "mesh": mesh }));
    let camera = glb.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.5 } }));
    glb.root(json!({ "camera": camera, "translation": [0.0, 0.0, 4.0] }));
    glb.json["extensions"] =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": 1.5 }] } });
    glb.root(json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    let loaded = load(&glb.write(folder.path(), "l.glb"), &["image.size=[9, 9]"]);
    assert_eq!(loaded.warnings, Vec::<String>::new());
    let [picture] = drawn([&loaded]);
    let pixel = &picture.at([4, 4]).unwrap()[..3];
    for (channel, color) in pixel.iter().zip([0.75, 0.5, 1.0]) {
        let expected = 255.0 * color * (0.2 + 1.5 / std::f64::consts::PI);
        // A code is rounded, from floats.
        assert!((255.0 * f64::from(*channel) - expected).abs() <= 0.51, "{pixel:?}: {expected}");
    }
}

/// The scene that is printed draws the same picture, to the bit.
#[test]
fn a_printed_scene_draws_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut turned = nested();
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7).to_array();
    turned.json["nodes"][1]["rotation"] = json!(turn);
    for (name, glb) in [("furnished.glb", furnished()), ("nested.glb", turned)] {
        let path = glb.write(folder.path(), name);
        let options = ["--size", "96x72"];
        let mut command = Command::new(env!("CARGO_BIN_EXE_glumbra"));
        let output = command.arg("plan").arg(&path).args(options).arg("--print-scene").output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let printed = folder.path().join("printed.toml");
        std::fs::write(&printed, &output.stdout).unwrap();
        let found = load(&printed, &[]);
        let expected = load(&path, &["image.size=[96, 72]"]);
        let [found, expected] = drawn([&found, &expected]);
        assert!(found == expected, "{name}: the pictures differ");
    }
}

#[test]
fn a_node_without_a_turn_is_what_a_scene_file_places() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    glb.root(json!({ "mesh": mesh, "translation": [0.5, 0.0, 0.25], "scale": [1.5, 1.0, 0.5] }));
    glb.write(folder.path(), "w.glb");
    std::fs::write(folder.path().join("w.obj"), super::glb::wedge_obj(None)).unwrap();
    let found = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"w.glb\"\n");
    // A primitive without a material is white.
    let objects = "[[object]]\nmesh = \"w.obj\"\ntranslate = [0.5, 0, 0.25]\nscale = [1.5, 1, 0.5]\n\
                   material = { diffuse = [1, 1, 1] }\n";
    assert_same(&found, &scene(folder.path(), "b.toml", objects));
}

/// A line of nodes, each below the one before it: as long as this, a list of those above each would fill gigabytes.
#[test]
fn a_long_line_of_nodes_is_placed_node_by_node() {
    const COUNT: usize = 30_000;
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    let node = |at: usize| match at + 1 {
        COUNT => json!({ "name": "last", "mesh": mesh, "translation": [0.5, 0.0, 0.0] }),
        next => json!({ "name": format!("n{at}"), "children": [next], "translation": [0.5, 0.0, 0.0] }),
    };
    glb.json["nodes"] = json!((0..COUNT).map(node).collect::<Vec<_>>());
    glb.json["scenes"] = json!([{ "nodes": [0] }]);
    let folder = tempfile::tempdir().unwrap();
    glb.write(folder.path(), "line.glb");
    for name in ["line.glb", "line.glb#n0", "line.glb#n17000", "line.glb#last"] {
        let loaded = scene(folder.path(), "a.toml", &format!("[[object]]\nmesh = \"{name}\"\n"));
        let [_, object] = &loaded.scene.objects[..] else { panic!("{name}: {}", loaded.scene.objects.len()) };
        assert_eq!(object.world_from_model.w_axis.x, 0.5 * COUNT as f64, "{name}");
    }
}
