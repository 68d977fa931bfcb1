//! Passes of scenes with photographs: a depth map for each photograph, drawn once; what is not needed is left out and said.

use glumbra::pass::Redraw;

use super::*;

const SIZE: [u32; 2] = [96, 72];

fn boxes(places: &[f64]) -> Vec<String> {
    let object = |x: &f64| format!("mesh = \"box\"\ntranslate = [{x:?}, 0.5, 0.0]\nscale = 0.4\nmaterial = {{ ");
    places.iter().map(object).collect()
}

fn camera() -> Pose {
    Pose { eye: DVec3::new(1.0, 2.0, 6.0), target: DVec3::new(0.0, 0.4, 0.0), fov_y: 45.0 }
}

fn from(x: f64) -> Pose {
    Pose { eye: DVec3::new(x, 1.5, 5.0), target: DVec3::new(0.0, 0.4, 0.0), fov_y: 40.0 }
}

fn photo(studio: &Studio, name: &str) -> PathBuf {
    let path = studio.path(name);
    smooth_decal(&mut Random::new(8)).save(&path).unwrap();
    path
}

fn labels(plan: &Plan) -> Vec<&str> {
    plan.list.passes.iter().map(|pass| pass.label.as_str()).collect()
}

fn is_left_out(plan: &Plan, what: &str, why: &str) -> bool {
    plan.left_out.iter().any(|left| left.what == what && left.why == why)
}

#[test]
fn each_photograph_has_one_map_that_is_drawn_once() {
    let mut studio = Studio::new();
    let path = photo(&studio, "photo.png");
    let mut objects = boxes(&[-1.2, 0.0, 1.2]);
    for (object, x) in objects.iter_mut().zip([-1.0, -1.0, 1.0]) {
        *object += &from(x).photo(&path, "hidden = \"grey\"");
    }
    let scene = studio.load(&scene_text(SIZE, &camera(), &objects, ""));
    assert_eq!(scene.photos().len(), 2);
    let plan = studio.plan(&scene, &Request::default());
    assert_eq!(labels(&plan), ["photograph 0: depth", "photograph 1: depth", "lit"]);
    let once = |label: &str| plan.list.passes.iter().find(|pass| pass.label == label).map(|pass| pass.redraw);
    assert_eq!(once("photograph 0: depth"), Some(Redraw::WhenChanged));
    assert!(plan.matrices_text().contains("Photograph 1"), "{}", plan.matrices_text());
}

#[test]
fn maps_and_lights_that_nothing_shows_are_left_out() {
    let mut studio = Studio::new();
    let path = photo(&studio, "photo.png");
    let objects = boxes(&[-1.2, 0.0, 1.2]);
    let text = |hidden: &str| {
        scene_text(SIZE, &camera(), &objects, &from(-1.0).photo(&path, &format!("hidden = \"{hidden}\"")))
    };
    let light = "[[light]]\nposition = [1.0, 4.0, 3.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 60.0\n[light.shadow]\n\
                 technique = \"shadow-map\"\n[[light]]\nkind = \"directional\"\ndirection = [0.1, -1.0, 0.2]\n";
    for (hidden, passes, lights) in [
        ("smear", vec!["lit"], 0),
        ("grey", vec!["photograph 0: depth", "lit"], 0),
        ("leave", vec!["light 0: depth", "photograph 0: depth", "lit"], 2),
    ] {
        let scene = studio.load(&(text(hidden) + light));
        let plan = studio.plan(&scene, &Request::default());
        assert_eq!(labels(&plan), passes, "{hidden}");
        assert_eq!(
            is_left_out(&plan, "the map of photograph 0", "hidden = \"smear\" tests no depth"),
            hidden == "smear"
        );
        for light in ["light 0", "light 1"] {
            let why = if light == "light 0" {
                "what its cone reaches shows photographs alone"
            } else {
                "all that is seen shows photographs alone"
            };
            assert_eq!(is_left_out(&plan, light, why), lights == 0, "{hidden}: {:?}", plan.left_out);
        }
    }
    // Behind the camera.
    let mut objects = boxes(&[0.0]);
    objects.push(format!("mesh = \"box\"\ntranslate = [0.0, 0.0, 30.0]\nmaterial = {{ {}", from(1.0).photo(&path, "")));
    let scene = studio.load(&scene_text(SIZE, &camera(), &objects, ""));
    let plan = studio.plan(&scene, &Request::default());
    assert_eq!(labels(&plan), ["lit"]);
    assert!(is_left_out(&plan, "photograph 0", "nothing that has it is seen"), "{:?}", plan.left_out);
}

#[test]
fn a_scene_far_from_the_origin_shows_the_same_photograph() {
    let mut studio = Studio::new();
    let mut random = Random::new(1);
    let objects = generated_objects(&studio, &mut random);
    let (from, camera) = (generated_pose(&mut random), generated_pose(&mut random));
    let path = photo(&studio, "photo.png");
    let near = studio.load(&scene_text(SIZE, &camera, &objects, &from.photo(&path, "filter = \"nearest\"")));
    let mut far = near.clone();
    let by = DVec3::new(4096.0, 0.0, -8192.0);
    far.camera.eye += by;
    far.camera.target += by;
    let mut photo = (*near.photos()[0]).as_ref().clone();
    if let scene::LightKind::Spot(spot) = &mut photo.projector.kind {
        spot.frustum.position += by;
        spot.frustum.target += by;
    }
    let photo = std::sync::Arc::new(photo);
    for object in &mut far.objects {
        object.world_from_model.w_axis += by.extend(0.0);
        object.photo = Some(photo.clone());
    }
    let (near, far) = (studio.draw(&near), studio.draw(&far));
    let differ = near.iter().zip(&far).filter(|(near, far)| near != far).count();
    assert!(differ < near.len() / 200, "{differ}");
}
