//! Scenes that load: each value as the file says, and what stands in where the file is silent.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat4, DVec3, dvec3};
use glumbra::scene::{self, Error, Frustum, LightKind, LightShape, Loaded, Origin, Point, Scene, Value};

use crate::support::load_file;

/// The example scene with the model of [`folder`].
fn example() -> String {
    include_str!("../../data/scenes/example.toml").replace("../meshes/dense.obj", "model.obj")
}

/// A tetrahedron from (0, 0, 0) to (1, 2, 1).
const MODEL: &str = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 2 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("model.obj"), MODEL).unwrap();
    folder
}

fn load(text: &str, overrides: &[&str]) -> Result<Loaded, Error> {
    let folder = folder();
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    load_file(&path, overrides)
}

fn scene_of(text: &str, overrides: &[&str]) -> Scene {
    load(text, overrides).unwrap_or_else(|error| panic!("{error}")).scene
}

#[test]
fn the_example_has_every_value_as_written() {
    let loaded = load(&example(), &[]).unwrap();
    assert_eq!(loaded.warnings, [""; 0]);
    let scene = loaded.scene;
    assert_eq!(scene.image.size, [512, 512]);
    assert_eq!(scene.image.background, [0.3, 0.4, 0.6]);
    assert_eq!((scene.shading.ambient, scene.shading.per_vertex), ([0.2; 3], false));

    let camera = &scene.camera;
    assert_eq!((camera.eye, camera.target, camera.up), (dvec3(3.0, 2.5, 4.0), dvec3(0.0, 0.6, 0.0), DVec3::Y));
    assert_eq!((camera.fov_y_radians, camera.near, camera.far), (40.0_f64.to_radians(), 0.1, 50.0));

    let [light] = scene.lights.as_slice() else { panic!("one light") };
    let spot = light.spot().unwrap();
    let (position, target) = (dvec3(2.0, 4.0, 3.0), dvec3(0.0, 0.5, 0.0));
    let cone_radians = 60.0_f64.to_radians();
    let frustum = Frustum {
        position,
        target,
        up: DVec3::Y,
        cone_radians,
        aspect: 1.0,
        near: 0.5,
        far: 20.0,
        lean: glam::DVec2::ZERO,
    };
    assert_eq!((&spot.frustum, spot.shape, light.name.as_str()), (&frustum, LightShape::Cone, "light 0"));
    assert_eq!((light.ambient, light.diffuse, light.specular), ([0.0; 3], [1.0; 3], [1.0; 3]));
    assert_eq!(spot.attenuation, [1.0, 0.0, 0.0]);
    assert!(spot.image.is_none());
    let shadow = light.shadow.written();
    assert_eq!(shadow.path, "light.shadow");
    assert!(matches!(shadow.origin, Origin::File { line: 20, .. }), "{:?}", shadow.origin);
    let keys: Vec<&str> = shadow.entries.iter().map(|(key, _)| key.as_str()).collect();
    assert_eq!(keys, ["technique", "size", "format", "transfer", "filter", "compare", "offset", "texgen"]);

    let [floor, model] = scene.objects.as_slice() else { panic!("two objects") };
    assert_eq!((floor.name.as_str(), model.name.as_str()), ("quad", "model.obj"));
    assert_eq!(floor.world_from_model, DMat4::from_scale(dvec3(4.0, 1.0, 4.0)));
    let material = floor.material.as_ref().unwrap();
    assert_eq!((material.diffuse, material.ambient, material.specular), ([0.7; 3], [0.7; 3], [0.0; 3]));
    assert_eq!(model.world_from_model, DMat4::IDENTITY);
    assert!(model.material.is_none() && model.lit && model.casts_shadow);
    assert_eq!((model.world_bounds().min, model.world_bounds().max), (DVec3::ZERO, dvec3(1.0, 2.0, 1.0)));
}

#[test]
fn overrides_reach_file_and_missing_tables() {
    let scene =
        scene_of(&example(), &["light.shadow.transfer=copy", "shading.lighting=per-vertex", "object.1.scale=-2"]);
    assert!(scene.shading.per_vertex);
    let transfer = scene.lights[0].shadow.written().get("transfer").unwrap();
    assert!(matches!(&transfer.value, Value::String(text) if text == "copy"));
    assert_eq!(transfer.origin.to_string(), "--set light.shadow.transfer=copy");
    assert_eq!(scene.objects[1].world_from_model, DMat4::from_scale(DVec3::splat(-2.0)));

    for (text, expected) in [
        ("light.cone=200", "--set light.cone=200: `light.cone` must be above 1"),
        ("camera.fow_y=5", "--set camera.fow_y=5: unknown key `fow_y` in [camera]: did you mean `fov_y`?"),
        ("imag.size=5", "--set imag.size=5: unknown key `imag` in the scene: did you mean `image`?"),
        ("object.material.decal=none.png", "--set object.material.decal=none.png: none.png: "),
    ] {
        let error = load(&example(), &[text]).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn a_file_is_loaded_once_however_it_is_named() {
    let text = "[[object]]\nmesh = \"model.obj\"\n[[object]]\nmesh = \"./model.obj\"\n\
                [[object]]\nmesh = \"box\"\n[[object]]\nmesh = \"box\"\n";
    let objects = scene_of(text, &[]).objects;
    assert!(Arc::ptr_eq(&objects[0].mesh, &objects[1].mesh));
    assert!(Arc::ptr_eq(&objects[2].mesh, &objects[3].mesh));
    assert!(!Arc::ptr_eq(&objects[0].mesh, &objects[2].mesh));
}

#[test]
fn placement_scales_then_rotates_in_order_then_translates() {
    let text = "[[object]]\nmesh = \"box\"\nscale = [2, 1, -1]\ntranslate = [10, 20, 30]\n\
                rotate = [{ axis = [0, 0, 3], angle = 90 }, { axis = [1, 0, 0], angle = 450 }]\n";
    let world_from_model = scene_of(text, &[]).objects[0].world_from_model;
    // x: scaled to 2, turned about z to +y, turned about x to +z.
    for (model, world) in
        [(DVec3::X, dvec3(10.0, 20.0, 32.0)), (DVec3::Y, dvec3(9.0, 20.0, 30.0)), (DVec3::Z, dvec3(10.0, 21.0, 30.0))]
    {
        let found = world_from_model.transform_point3(model);
        assert!(found.distance(world) < 1e-12, "{model} to {found}, not {world}");
    }
}

#[test]
fn colours_have_shorthands() {
    let light = "[[light]]\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\ncone = 50\nnear = 1\nfar = 9\n";
    let text = format!(
        "{light}color = [3, 2, 1]\nspecular = [0, 0, 0]\nshape = \"frustum\"\nname = \"key\"\n\
         [[object]]\nmesh = \"box\"\nname = \"crate\"\nlit = false\ncasts_shadow = false\n\
         material = {{ diffuse = [1, 0, 0], ambient = [0, 1, 0], opacity = 0.5, shininess = 10 }}\n"
    );
    let scene = scene_of(&text, &[]);
    let light = &scene.lights[0];
    assert_eq!((light.diffuse, light.specular, light.name.as_str()), ([3.0, 2.0, 1.0], [0.0; 3], "key"));
    let spot = light.spot().unwrap();
    assert_eq!(spot.shape, LightShape::Frustum);
    assert!(light.shadow.written().is_empty() && matches!(light.shadow.written().origin, Origin::File { line: 1, .. }));
    // Straight down: up is -z, which keeps +x to the right.
    assert_eq!(spot.frustum.up, DVec3::NEG_Z);
    let right = spot.frustum.view_from_world().transform_vector3(DVec3::X);
    assert!(right.distance(DVec3::X) < 1e-12);
    let object = &scene.objects[0];
    let material = object.material.as_ref().unwrap();
    assert_eq!((material.diffuse, material.ambient), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert_eq!((material.opacity, material.shininess), (0.5, 10.0));
    assert!(!object.lit && !object.casts_shadow && object.name == "crate");
}

#[test]
fn a_scene_without_camera_is_framed() {
    let text = "[[object]]\nmesh = \"box\"\ntranslate = [100, 0, 0]\n[[object]]\nmesh = \"box\"\nscale = 0.1\n";
    for overrides in
        [&[][..], &["camera.fov_y=90"], &["image.size=[900, 100]"], &["camera.target=[50, 0, 0]", "camera.fov_y=70"]]
    {
        let loaded = load(text, overrides).unwrap();
        assert!(loaded.warnings[0].contains("no [[light]]"), "{:?}", loaded.warnings);
        let scene = loaded.scene;
        let clip_from_world = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world();
        for corner in scene.objects.iter().flat_map(|object| object.world_bounds().corners()) {
            let seen = clip_from_world.project_point3(corner);
            assert!(seen.abs().max_element() < 1.0, "{overrides:?}: {corner} is seen at {seen}");
        }
    }
}

#[test]
fn lights_and_cameras_look_where_they_should() {
    let scene = scene_of(&example(), &["image.size=[200, 100]"]);
    assert_eq!(scene.aspect(), 2.0);
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-9, "{a} is not {b}");
    let light = scene.lights[0].frustum().unwrap();
    let forward = (light.target - light.position).normalize();
    let clip_from_world = light.clip_from_world();
    near(clip_from_world.project_point3(light.position + forward * 0.5), dvec3(0.0, 0.0, -1.0));
    near(clip_from_world.project_point3(light.position + forward * 20.0), dvec3(0.0, 0.0, 1.0));
    // 30 degrees off the axis is the frustum's side.
    let side = forward.cross(DVec3::Y).normalize();
    let off = light.position + forward * (3.0_f64.sqrt() * 0.5) + side * 0.5;
    assert!((clip_from_world.project_point3(off).x - 1.0).abs() < 1e-12);
    let camera = &scene.camera;
    let clip_from_world = camera.clip_from_view(2.0) * camera.view_from_world();
    let ahead = (camera.target - camera.eye).normalize();
    near(clip_from_world.project_point3(camera.eye + ahead * 50.0), dvec3(0.0, 0.0, 1.0));
}

#[test]
fn a_bare_model_gets_floor_light_and_camera() {
    let folder = folder();
    let path = folder.path().join("model.obj");
    let scene = load_file(&path, &[]).unwrap().scene;
    assert_eq!((scene.objects.len(), scene.lights.len()), (2, 1));
    let overrides = ["light.shadow.size=2048", "camera.fov_y=50", "object.0.rotate={axis=[1,0,0],angle=90}"];
    let turned = load_file(&path, &overrides).unwrap().scene;
    assert!((turned.camera.fov_y_radians - 50.0_f64.to_radians()).abs() < 1e-12);
    assert!(matches!(turned.lights[0].shadow.written().get("size").unwrap().value, Value::Integer(2048)));
    // Turned, the model reaches down to -1, hence the floor.
    let floor = turned.objects[1].world_bounds().max.y;
    assert!((floor + 1.0).abs() < 1e-6, "{floor}");
}

#[test]
fn models_of_any_size_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    for (size, at) in [(1e-13, 0.0), (1e-12, 0.0), (1e-3, 0.0), (1.0, 1e4), (1e3, -1e6), (1e12, 0.0), (1e14, 0.0)] {
        let vertex = |x: f64, y: f64, z: f64| format!("v {} {} {}\n", x * size + at, y * size + at, z * size + at);
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, 1.0, 0.5]];
        let vertices: String = vertices.map(|[x, y, z]| vertex(x, y, z)).concat();
        fs::write(&path, format!("{vertices}f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")).unwrap();
        let scene = load_file(&path, &[]).unwrap_or_else(|error| panic!("{size} at {at}: {error}")).scene;
        let clip_from_world = scene.camera.clip_from_view(1.0) * scene.camera.view_from_world();
        for corner in scene.objects[0].world_bounds().corners() {
            let seen = clip_from_world.project_point3(corner);
            assert!(seen.abs().max_element() < 1.0, "{size} at {at}: {corner} is seen at {seen}");
        }
    }
    for (size, scale) in [(1e-30, "1e18"), (9e17, "1e-18")] {
        fs::write(&path, format!("v 0 0 0\nv {size} 0 0\nv 0 0 {size}\nv 0 {size} 0\nf 1 2 3\nf 1 4 2\n")).unwrap();
        let error = load_file(&path, &[]).unwrap_err().to_string();
        assert!(error.contains("model.obj: is ") && error.contains("across"), "{error}");
        let remedy = format!("object.0.scale={scale}");
        assert!(error.ends_with(&format!("--set {remedy}")), "{error}");
        load_file(&path, &[&remedy]).unwrap_or_else(|error| panic!("{size}: {error}"));
    }
    fs::write(&path, "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n").unwrap();
    let error = load_file(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("reaches out to") || error.contains("model.obj"), "{error}");
}

#[test]
fn a_supplied_scene_printed_and_saved_is_the_same_scene() {
    let folder = folder();
    let path = folder.path().join("model.obj");
    let toml = scene::settings(&path, &["image.size=[300, 200]".into()]).unwrap().to_toml();
    let saved = folder.path().join("saved.toml");
    fs::write(&saved, &toml).unwrap();
    let (direct, saved) =
        (load_file(&path, &["image.size=[300, 200]"]).unwrap().scene, load_file(&saved, &[]).unwrap().scene);
    assert_eq!((&direct.image, &direct.camera), (&saved.image, &saved.camera), "{toml}");
    assert_eq!(direct.lights[0].frustum().unwrap(), saved.lights[0].frustum().unwrap());
    assert_eq!(direct.objects[1].world_from_model, saved.objects[1].world_from_model);
}

#[test]
fn point_lights_take_their_range_from_the_objects() {
    // The box is 3 below and reaches out to 5 along x; the diagonal does not count.
    let text = "[[light]]\nkind = \"point\"\nposition = [0, 4, 0]\n[[object]]\nmesh = \"box\"\nscale = [5, 1, 1]\n";
    let point = |overrides: &[&str]| match &scene_of(text, overrides).lights[0].kind {
        LightKind::Point(point) => point.clone(),
        other => panic!("{other:?}"),
    };
    let Point { position, near, far, attenuation } = point(&[]);
    assert_eq!((position, attenuation), (dvec3(0.0, 4.0, 0.0), [1.0, 0.0, 0.0]));
    assert!((near - 2.4).abs() < 1e-12 && (far - 5.5).abs() < 1e-12, "{near} {far}");
    for (overrides, expected) in [
        (&["light.near=0.25", "light.far=9"][..], [0.25, 9.0]),
        (&["light.far=2"], [1.0, 2.0]),
        (&["light.near=4"], [4.0, 8.0]),
        // In the box, whose sides are 1 away.
        (&["light.position=[0, 0, 0]"], [0.8, 5.5]),
        // In its top: the planes are as far apart as a map bears.
        (&["light.position=[0, 1, 0]"], [5.5 / 16384.0, 5.5]),
    ] {
        let Point { near, far, .. } = point(overrides);
        assert!((near - expected[0]).abs() < 1e-12 && (far - expected[1]).abs() < 1e-12, "{overrides:?}: {near} {far}");
    }
}

#[test]
fn directional_lights_have_a_direction_and_no_place() {
    let sun = "[[light]]\nkind = \"directional\"\n";
    let quad = "[[object]]\nmesh = \"quad\"\n";
    for way in ["direction = [0, -3, 4]", "position = [1, 5, 0]\ntarget = [1, 2, 4]"] {
        let light = &scene_of(&format!("{sun}{way}\n{quad}"), &[]).lights[0];
        assert_eq!((light.position(), light.attenuation()), (None, [1.0, 0.0, 0.0]));
        let LightKind::Directional { direction } = light.kind else { panic!("{:?}", light.kind) };
        assert!(direction.distance(dvec3(0.0, -0.6, 0.8)) < 1e-15, "{direction}");
    }
}

#[test]
fn each_kind_of_light_prints_and_reads_back_the_same() {
    for light in ["kind = \"point\"\nposition = [0, 4, 0]\nfar = 8", "kind = \"directional\"\ndirection = [1, -2, 0.5]"]
    {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["a.toml", "b.toml"].map(|name| folder.path().join(name));
        fs::write(&first, format!("[[light]]\n{light}\n[[object]]\nmesh = \"box\"\n")).unwrap();
        fs::write(&second, scene::settings(&first, &[]).unwrap().to_toml()).unwrap();
        let [a, b] = [first, second].map(|path| format!("{:?}", load_file(&path, &[]).unwrap().scene.lights[0].kind));
        assert_eq!(a, b);
    }
}

#[test]
fn what_is_in_the_data_folder_loads() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let mut paths: Vec<PathBuf> = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(!paths.is_empty());
    for path in paths {
        let loaded = load_file(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.warnings, [""; 0], "{}", path.display());
    }
}

#[test]
fn the_scenes_of_the_readmes_can_be_planned() {
    for page in [include_str!("../../README.md"), include_str!("../../data/scenes/README.md")] {
        let (_, rest) = page.split_once("```toml\n").unwrap();
        let (text, _) = rest.split_once("```").unwrap();
        let scene = scene_of(text, &[]);
        glumbra::plan::make(&scene, &Default::default()).unwrap();
        assert!(!scene.lights.is_empty() && !scene.objects.is_empty());
    }
}

/// A floor of 4 by 4 at y = 1 with a wall on it; seen from above, from below, and as the bottom of a closed box.
#[test]
fn a_supplied_floor_lies_below_a_models_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    let vertices = "v -2 1 2\nv 2 1 2\nv 2 1 -2\nv -2 1 -2\nv -1 1 0\nv 1 1 0\nv 0 2 0\n";
    let floor_of = |text: &str, overrides: &[&str]| {
        fs::write(&path, text).unwrap();
        let loaded = load_file(&path, overrides).unwrap();
        let floor = loaded.scene.objects.get(1).map(|floor| floor.world_bounds().max.y);
        (floor, loaded.warnings.iter().any(|warning| warning.contains("model.obj: has a floor of its own")))
    };
    for face in ["1 2 3 4", "4 3 2 1"] {
        let (floor, said) = floor_of(&format!("{vertices}f {face}\nf 5 6 7\n"), &[]);
        let below = 1.0 - floor.unwrap();
        assert!(said && (1e-3..2e-2).contains(&below), "{face}: {below}");
    }
    let with_floor = format!("{vertices}f 1 2 3 4\nf 5 6 7\n");
    assert_eq!(floor_of(&with_floor, &["floor=false"]), (None, false));
    // Upside down the wall's tip is lowest.
    let turned = floor_of(&with_floor, &["object.0.scale=[1, -1, 1]"]);
    assert_eq!(turned, (Some(-2.0), false));
    // A wall alone, and a closed body with a flat bottom, stand on it.
    assert_eq!(floor_of(&format!("{vertices}f 5 6 7\n"), &[]), (Some(1.0), false));
    assert_eq!(
        floor_of("v 0 1 0\nv 1 1 0\nv 0 1 1\nv 0 2 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n", &[]),
        (Some(1.0), false)
    );
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, "[[object]]\nmesh = \"box\"\n").unwrap();
    let error = load_file(&scene, &["floor=false"]).unwrap_err().to_string();
    assert!(error.contains("unknown key `floor`"), "{error}");
}

/// Objects that the alpha test discards whole are not drawn, and a warning names them.
#[test]
fn clear_materials_are_warned_of_and_named_as_left_out() {
    let folder = folder();
    let model = MODEL.replacen("f 1 2 3", "mtllib m.mtl\nusemtl glass\nf 1 2 3", 1);
    fs::write(folder.path().join("model.obj"), model).unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl glass\nKd 1 1 1\nTr 1\nnewmtl unused\nd 0\n").unwrap();
    let path = folder.path().join("scene.toml");
    let object = "[[object]]\nmesh = \"model.obj\"\n[[object]]\nmesh = \"box\"\n[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n";
    let loaded = |text: &str| {
        fs::write(&path, text).unwrap();
        let loaded = load_file(&path, &[]).unwrap();
        let plan = glumbra::plan::make(&loaded.scene, &Default::default()).unwrap();
        let named = plan.left_out.into_iter().find(|left_out| left_out.why.contains("below 0.5"));
        (loaded.warnings, named.map(|left_out| left_out.what))
    };
    let (warnings, named) = loaded(object);
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(warning.contains("m.mtl:3: Tr 1: material \"glass\" leaves an alpha of 0 at most"), "{warning}");
    assert!(warning.contains("4 triangles of object \"model.obj\"; if Tr was meant"), "{warning}");
    assert_eq!(named.as_deref(), Some("model.obj where it has material \"glass\""));
    let (warnings, named) = loaded(&object.replacen("obj\"\n", "obj\"\nmaterial = { opacity = 0.4 }\n", 1));
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(warning.contains("scene.toml:3: `object.material` leaves an alpha of 0.4 at most"), "{warning}");
    assert!(named.is_some());
    let (warnings, named) = loaded(&object.replacen("obj\"\n", "obj\"\nmaterial = { opacity = 0.6 }\n", 1));
    assert_eq!((warnings, named), (Vec::new(), None));
}
