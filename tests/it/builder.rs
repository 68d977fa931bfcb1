//! Scenes in code and in text: the same scene as a file's, the same errors with another place, and where points are seen.

use std::path::Path;

use glumbra::glam::{DVec2, DVec3};
use glumbra::plan::{self, Request};
use glumbra::prelude::{Camera, LightBuilder, ObjectBuilder, Scene, SceneBuilder, load_str};

const TEXT: &str = r#"
[image]
size = [96, 64]
[camera]
eye = [2.5, 4.5, 5.0]
target = [0.2, 0.2, 0.0]
fov_y = 40.0
[[light]]
kind = "spot"
position = [-2.0, 5.0, 1.5]
target = [0.0, 0.0, 0.0]
cone = 50.0
shadow = { technique = "shadow-map", size = 256, offset = { factor = 2.0, units = 4.0 } }
[[light]]
kind = "directional"
direction = [0.0, -1.0, 0.2]
[[object]]
name = "floor"
mesh = "quad"
scale = [8.0, 1.0, 8.0]
[[object]]
mesh = "box"
translate = [0.0, 0.5, 0.0]
scale = [0.5, 0.5, 0.5]
rotate = { axis = [0.0, 1.0, 0.0], angle = 30.0 }
material = { diffuse = [0.8, 0.5, 0.3] }
"#;

fn in_code() -> SceneBuilder {
    let spot = LightBuilder::spot([-2.0, 5.0, 1.5], DVec3::ZERO, 50.0).shadow("shadow-map");
    let cube = ObjectBuilder::mesh("box").at([0.0, 0.5, 0.0]).scale([0.5; 3]).rotate(DVec3::Y, 30.0);
    Scene::builder()
        .size([96, 64])
        .camera([2.5, 4.5, 5.0], [0.2, 0.2, 0.0], 40.0)
        .light(spot.set("shadow.offset.factor", 2.0).set("shadow.offset.units", 4.0))
        .light(LightBuilder::directional([0.0, -1.0, 0.2]))
        .set("light.0.shadow.size", 256)
        .object(ObjectBuilder::mesh("quad").name("floor").scale([8.0, 1.0, 8.0]))
        .object(cube.color([0.8, 0.5, 0.3]))
}

/// All that a plan says of a scene: images, passes, uniforms, draws.
fn planned(scene: &Scene) -> String {
    let plan = plan::make(scene, &Request::default()).unwrap();
    format!("{}\n{}", plan.summary(), plan.matrices_text())
}

#[test]
fn code_text_and_file_make_the_same_scene() {
    let code = in_code().build().unwrap();
    let text = load_str(TEXT, Path::new(""), &[]).unwrap();
    let again = load_str(&in_code().to_toml(), Path::new(""), &[]).unwrap();
    for other in [&text, &again] {
        assert_eq!(code.warnings, other.warnings);
        assert_eq!(planned(&code.scene), planned(&other.scene));
        assert_eq!(code.scene.camera, other.scene.camera);
    }
    let changed = load_str(TEXT, Path::new(""), &["light.0.shadow.size=128".to_owned()]).unwrap();
    assert_ne!(planned(&changed.scene), planned(&text.scene));
}

#[test]
fn errors_name_the_line_of_code() {
    let error = |builder: SceneBuilder| builder.build().unwrap_err().to_string();
    let line = line!() + 1;
    let wrong = in_code().set("image.sise", [1, 1]);
    let place = format!("{}:{line}: ", file!());
    let found = error(wrong);
    assert!(found.starts_with(&place) && found.contains("did you mean `size`?"), "{found}");
    for (builder, expected) in [
        (in_code().set("camera.fov_y", 0.0), "`camera.fov_y` must be"),
        (in_code().set("camera.eye.x", 1), "`camera.eye` holds"),
        (in_code().set("a..b", 1), "`a..b`: a key is names joined by dots"),
        (in_code().light(LightBuilder::point([0.0; 3]).set("cone", 3.0)), "`light.cone` is no key of a point light"),
        (in_code().light(LightBuilder::point([0.0; 3]).shadow("woo")), "`light.shadow.technique` cannot be \"woo\""),
        (in_code().object(ObjectBuilder::mesh("bax")), "no mesh \"bax\""),
        (in_code().object(ObjectBuilder::obj("box", "v 0 0 0")), "a mesh cannot be named \"box\", which is built in"),
        (in_code().object(ObjectBuilder::triangles("t", &[[0.0; 3]], &[[0, 0, 7]])), "t:2: "),
        (Scene::builder(), "`object` is missing"),
    ] {
        let found = error(builder);
        assert!(found.contains(expected) && found.starts_with(file!()), "{expected}:\n{found}");
    }
}

#[test]
fn meshes_in_memory_are_drawn_as_those_of_files() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let solid = ObjectBuilder::triangles("tetrahedron", &corners, &faces).set("closed", true);
    let scene = in_code().object(solid.clone()).object(solid.at([2.0, 0.0, 0.0])).build().unwrap().scene;
    let [.., first, second] = scene.objects.as_slice() else { panic!("no objects") };
    assert_eq!((first.mesh.triangle_count(), &*first.name), (4, "tetrahedron"));
    assert!((first.mesh.signed_volume() - 1.0 / 6.0).abs() < 1e-7, "{}", first.mesh.signed_volume());
    assert_eq!(second.world_bounds().max.x, 3.0);
}

#[test]
fn files_of_a_text_are_relative_to_its_folder() {
    let text = std::fs::read_to_string("data/scenes/hw_shadowmaps_simple.toml").unwrap();
    assert!(load_str(&text, Path::new("data/scenes"), &[]).is_ok());
    let error = load_str(&text, Path::new("data"), &[]).unwrap_err().to_string();
    assert!(error.starts_with("data/<text>:"), "{error}");
    let error = load_str("[image]\nsize = 3\n", Path::new(""), &[]).unwrap_err().to_string();
    assert!(error.starts_with("<text>:2: `image.size`"), "{error}");
}

/// By similar triangles, not by a matrix. To 1e-9 of a pixel: f64 loses a thousandth of that in either way.
#[test]
fn points_are_seen_where_similar_triangles_say() {
    let scene = in_code().build().unwrap().scene;
    let Camera { eye, target, fov_y_radians, .. } = scene.camera.clone();
    let ahead = (target - eye).normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let above = right.cross(ahead);
    let per_unit = 32.0 / (0.5 * fov_y_radians).tan();
    for point in [[0.5, 1.0, -0.5], [0.0, 0.0, 0.0], [-3.0, 0.2, 1.0], [2.4, 4.4, 4.0]].map(DVec3::from_array) {
        let (way, seen) = (point - eye, scene.camera.project(point, [96, 64]).unwrap());
        let place = DVec2::new(way.dot(right), -way.dot(above)) / way.dot(ahead) * per_unit + DVec2::new(48.0, 32.0);
        assert!(seen.distance(place) < 1e-9, "{point}: {seen} {place}");
        let inside = place.cmpge(DVec2::ZERO).all() && place.cmplt(DVec2::new(96.0, 64.0)).all();
        assert_eq!(scene.pixel(point), inside.then_some([place.x as u32, place.y as u32]));
    }
    assert_eq!(scene.camera.project(eye - ahead, [96, 64]), None);
}
