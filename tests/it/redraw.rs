//! Passes that the device may leave out of a frame because their target holds the result already, and passes that it may
//! not.

use glumbra::context::{self, ContextRequest};
use glumbra::device::Measure;
use glumbra::frame::{Renderer, draw_shade};
use glumbra::pass::{MeshRef, Redraw, Work};
use glumbra::plan::{self, Plan, Request};
use glumbra::scene::Scene;

fn scene(shadow: &str) -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/teapot.toml");
    let scene = glumbra::load(path.as_ref(), &[String::from("image.size=[160, 120]")]).unwrap().scene;
    glumbra::techniques::with_keys(&scene, 0, shadow).unwrap()
}

/// GL may give a deleted image's number to the next one (Mesa 22.3 does not, other drivers do): a map of another scene must
/// not be taken for this one's.
#[test]
fn scenes_in_turn_do_not_take_over_each_others_maps() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let settings = [
        "technique = \"shadow-map\", size = 256",
        "technique = \"shadow-map\", size = 64, transfer = \"copy\"",
        "technique = \"none\"",
    ];
    let first = settings.map(|shadow| draw_shade(&scene(shadow), 0, &mut renderer).unwrap());
    assert!(first[0] != first[1] && first[1] != first[2]);
    for order in [[2, 0, 1], [0, 2, 1], [1, 0, 2], [0, 1, 0]] {
        for index in order {
            let again = draw_shade(&scene(settings[index]), 0, &mut renderer).unwrap();
            assert!(again == first[index], "{}", settings[index]);
        }
    }
}

/// The map stays as long as nothing of its pass changes; a caster that moves is drawn again.
#[test]
fn a_map_is_drawn_again_when_its_pass_changes() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut moved = scene("technique = \"shadow-map\", size = 256");
    let still = moved.clone();
    moved.objects[1].world_from_model =
        glam::DMat4::from_translation(glam::DVec3::new(0.4, 0.0, 0.0)) * moved.objects[1].world_from_model;
    let mut picture = |scene: &Scene| {
        let plan = renderer.plan(scene, &Request::default()).unwrap();
        renderer.draw(&plan).unwrap();
        renderer.read(&plan).unwrap().picture
    };
    let [before, after, back] = [&still, &moved, &still].map(&mut picture);
    assert!(before != after && before == back);
    let fresh_context = context::open(&ContextRequest::default()).unwrap();
    let mut fresh = Renderer::new(&fresh_context);
    let plan = fresh.plan(&moved, &Request::default()).unwrap();
    fresh.draw(&plan).unwrap();
    assert!(fresh.read(&plan).unwrap().picture == after);
}

/// Meshes that the passes with `label` in their names draw.
fn meshes(plan: &Plan, label: &str) -> Vec<MeshRef> {
    let passes = plan.list.passes.iter().filter(|pass| pass.label.contains(label));
    let draws = passes.flat_map(|pass| match &pass.work {
        Work::Draw(draw) => draw.batches.iter().flat_map(|batch| &batch.draws).collect(),
        _ => Vec::new(),
    });
    draws.map(|draw| draw.mesh.clone()).collect()
}

/// Facts of meshes are found once: the renderer's next plan draws the very same meshes, so that passes of them
/// are kept. A plan of its own finds other ones.
#[test]
fn the_next_plan_draws_the_same_derived_meshes() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for (what, pass, file, set) in [
        ("simplified", "light 0: depth", "data/scenes/teapot.toml", "light.0.shadow.casters=texel"),
        ("parted", "lit", "data/cases/scenes/guards.toml", "light.shadow.guard=cull"),
        ("cut", "lit", "data/scenes/teapot.toml", "object.0.scale=[1e6, 1, 1e6]"),
        ("moved", "uncounted", "data/cases/shadow-map/wave/scene.toml", "light.shadow.technique=shadow-volume"),
    ] {
        let set = [set, "image.size=[64, 48]"].map(String::from);
        let scene = glumbra::load(&root.join(file), &set).unwrap().scene;
        let request = Request { sampled_warnings: false, ..Request::default() };
        let mut renderer = Renderer::new(&context);
        let [first, second] = [(); 2].map(|()| meshes(&renderer.plan(&scene, &request).unwrap(), pass));
        assert!(!first.is_empty() && first == second, "{what}: the second plan draws other meshes");
        let own = meshes(&plan::make(&scene, &request).unwrap(), pass);
        assert!(first != own && first.len() == own.len(), "{what}: nothing is derived");
    }
}

/// The second frame of a still scene draws only what every frame draws, whether it is planned again or not. Volumes are
/// extruded again by each plan.
#[test]
fn the_second_frame_of_a_still_scene_draws_no_map() {
    let context = context::open(&ContextRequest::default()).unwrap();
    for (shadow, planned_again) in [
        ("technique = \"shadow-map\", size = 64", true),
        ("technique = \"shadow-map\", size = 64, transfer = \"copy\"", true),
        ("technique = \"midpoint\", size = 64", true),
        ("technique = \"second-depth\", size = 64, closed = \"assume\"", true),
        ("technique = \"shadow-volume\"", false),
    ] {
        let (scene, request) = (scene(shadow), Request { frames: 3, ..Request::default() });
        let mut renderer = Renderer::new(&context);
        let mut plan = renderer.plan(&scene, &request).unwrap();
        let mut drawn = |plan: &Plan| -> Vec<String> {
            let passes = renderer.device().run(&plan.list, Measure::Fragments).unwrap();
            passes.into_iter().map(|pass| pass.label).collect()
        };
        let labels = |always: bool| -> Vec<String> {
            let passes = plan.list.passes.iter().filter(|pass| !always || pass.redraw == Redraw::Always);
            passes.map(|pass| pass.label.clone()).collect()
        };
        let (all, always) = (labels(false), labels(true));
        assert!(always.len() < all.len(), "{shadow}: nothing is kept of {all:?}");
        assert_eq!(drawn(&plan), all, "{shadow}: the first frame");
        assert_eq!(drawn(&plan), always, "{shadow}: the second frame");
        if planned_again {
            plan = renderer.plan(&scene, &request).unwrap();
            let passes = renderer.device().run(&plan.list, Measure::Fragments).unwrap();
            assert_eq!(
                passes.into_iter().map(|pass| pass.label).collect::<Vec<_>>(),
                always,
                "{shadow}: planned again"
            );
        }
    }
}
