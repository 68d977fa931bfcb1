//! Passes that the device may leave out of a frame because their target holds the result already, and passes that it may
//! not.

use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::plan::Request;
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
