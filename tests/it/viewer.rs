//! The viewer's state without a window: where mouse and keys lead, and that only what changed is drawn again.

use std::f64::consts::FRAC_PI_4;
use std::path::Path;

use glam::{DVec2, DVec3, dvec2};
use glumbra::context::{self, ContextRequest};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::scene::{Frustum, Scene};
use glumbra::viewer::{Command, Handle, Mode, Reaction, State};

fn load() -> Scene {
    glumbra::load(Path::new("data/scenes/hw_shadowmaps_simple.toml"), &[]).unwrap().scene
}

fn state() -> State {
    State::new(load(), Mode::Shadowed)
}

/// The drag that turns by a quarter of a half turn.
const EIGHTH: f64 = 128.0;

#[test]
fn the_camera_s_orbit_follows_the_mouse() {
    let mut state = state();
    let (middle, eye) = (state.scene().camera.target, state.scene().camera.eye);
    // From 45 degrees around to straight ahead: the scene turns to the right with the mouse.
    state.drag(dvec2(EIGHTH, 0.0));
    let offset = state.scene().camera.eye - middle;
    assert!(offset.x.abs() < 1e-9 && offset.z > 0.0, "{offset}");
    assert!((offset.y - (eye - middle).y).abs() < 1e-9);
    // Down: the camera rises by as much.
    state.drag(dvec2(0.0, EIGHTH / 3.0));
    let risen = state.scene().camera.eye - middle;
    assert!((risen.normalize().y - (FRAC_PI_4 / 3.0 + 15.0_f64.to_radians()).sin()).abs() < 1e-9, "{risen}");
    assert!((risen.length() - offset.length()).abs() < 1e-9);
    state.apply(Command::Reset);
    assert_eq!(state.scene().camera.eye, eye);
}

#[test]
fn light_and_object_turn_about_their_own_middles() {
    let mut state = state();
    assert_eq!(state.apply(Command::Hold(Handle::Light)), Reaction::Retitle);
    state.drag(dvec2(EIGHTH, 0.0));
    let (first, now) = (load(), state.scene().clone());
    let arm = |light: &Frustum| light.position - light.target;
    let [before, after] = [&first, &now].map(|scene| arm(scene.lights[0].frustum().unwrap()));
    assert!((before.length() - after.length()).abs() < 1e-9 && after.x > before.x + 1.0, "{after}");
    assert_eq!(now.camera, first.camera);

    state.apply(Command::Hold(Handle::Object));
    state.drag(dvec2(EIGHTH, 0.0));
    let middle = |scene: &Scene, index: usize| {
        let object = &scene.objects[index];
        object.world_from_model.transform_point3(object.mesh.bounds.center())
    };
    let turned = state.scene();
    assert!(middle(turned, 1).abs_diff_eq(middle(&first, 1), 1e-9));
    let spout = turned.objects[1].world_from_model.transform_vector3(DVec3::X).normalize();
    let expected = DVec3::new(1.0, 0.0, -1.0).normalize();
    assert!(spout.abs_diff_eq(expected, 1e-9), "{spout}");
    assert_eq!(turned.objects[0].world_from_model, first.objects[0].world_from_model);
    assert_eq!(turned.lights[0].position(), now.lights[0].position());
}

#[test]
fn nothing_is_dollied_through_what_it_looks_at() {
    for handle in [Handle::Camera, Handle::Light, Handle::Object] {
        for steps in [1000.0, -1000.0] {
            let mut state = state();
            state.apply(Command::Hold(handle));
            state.dolly(steps);
            let (scene, request) = state.frame();
            let light = scene.lights[0].frustum().unwrap();
            assert!(scene.camera.eye.is_finite() && light.position.is_finite());
            assert!(scene.camera.eye.distance(scene.camera.target) >= 2.0 * scene.camera.near);
            assert!(light.position.distance(light.target) >= 2.0 * light.near);
            glumbra::plan::make(&scene, &request).unwrap();
        }
    }
}

#[test]
fn view_all_sees_all() {
    for size in [[512, 512], [800, 200], [200, 800]] {
        let mut state = state();
        state.resize(size);
        state.drag(dvec2(77.0, 30.0));
        assert_eq!(state.apply(Command::ViewAll), Reaction::Redraw);
        let (scene, _) = state.frame();
        let clip_from_world = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world();
        for corner in scene.world_bounds().corners().into_iter().chain(scene.lights[0].position()) {
            let seen = clip_from_world.project_point3(corner);
            assert!(seen.abs().max_element() <= 1.0, "{size:?}: {corner} is seen at {seen}");
        }
    }
}

#[test]
fn a_minimised_window_has_a_pixel() {
    let mut state = state();
    state.resize([0, 0]);
    assert_eq!(state.size(), [1, 1]);
    for (_, mode) in Mode::ALL {
        let (scene, request) = mode.frame(state.scene(), state.size());
        glumbra::plan::make(&scene, &request).unwrap();
    }
}

/// Draws a state and names the passes that were drawn.
fn drawn(renderer: &mut Renderer, state: &State) -> (Vec<String>, Pixels) {
    let (scene, request) = state.frame();
    let plan = renderer.plan(&scene, &request).unwrap();
    let times = renderer.device().run(&plan.list, Measure::Passes).unwrap();
    (times.into_iter().map(|time| time.label).collect(), renderer.read(&plan).unwrap().picture)
}

#[test]
fn only_what_changed_is_drawn_again() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut state = state();
    let all = ["light 0: depth", "light 0: depth, copied", "lit", "guides"];
    let without_map = ["lit", "guides"];
    let (labels, first) = drawn(&mut renderer, &state);
    assert_eq!(labels, all);

    let mut step = |state: &State, what: &str, expected: &[&str]| {
        let (labels, picture) = drawn(&mut renderer, state);
        assert_eq!(labels, expected, "{what}");
        picture
    };
    assert_eq!(step(&state, "nothing", &without_map), first);
    state.drag(DVec2::new(40.0, 0.0));
    assert_ne!(step(&state, "camera turned", &without_map), first);
    state.dolly(2.0);
    step(&state, "camera moved", &without_map);
    state.resize([300, 200]);
    step(&state, "window resized", &without_map);
    state.apply(Command::Step(50.0));
    step(&state, "r scale", &without_map);
    for _ in 0..2 {
        state.apply(Command::NextTweak);
    }
    state.apply(Command::Step(1.0));
    step(&state, "polygon offset scale", &all);
    for handle in [Handle::Light, Handle::Object] {
        state.apply(Command::Hold(handle));
        state.drag(DVec2::new(10.0, 0.0));
        step(&state, "light or object turned", &all);
    }
    state.apply(Command::Reset);
    state.resize([512, 512]);
    assert_eq!(step(&state, "reset", &all), first);
    state.apply(Command::NextMode);
    step(&state, "from the light", &["lit"]);
    state.apply(Command::NextMode);
    assert_ne!(step(&state, "without shadows", &without_map), first);
    state.apply(Command::NextMode);
    // The map was let go when nothing needed it, and on some drivers its name goes to another.
    assert_eq!(step(&state, "with shadows again", &all), first);
}

#[test]
fn the_next_technique_is_that_of_every_light() {
    let mut state = state().with_techniques(&["midpoint", "shadow-map"]);
    assert!(state.status().contains("| shadow-map |"), "{}", state.status());
    for name in ["midpoint", "shadow-map", "midpoint"] {
        assert_eq!(state.apply(Command::NextTechnique), Reaction::Redraw);
        assert!(state.status().contains(&format!("| {name} |")), "{}", state.status());
    }
    let mut alone = self::state();
    alone.apply(Command::NextTechnique);
    assert!(!alone.status().contains("shadow-map"), "{}", alone.status());
}

#[test]
fn help_comes_into_the_window_and_goes() {
    let mut state = state();
    assert!(!state.helps());
    assert_eq!((state.apply(Command::Help), state.helps()), (Reaction::Redraw, true));
    assert_eq!((state.apply(Command::Help), state.helps()), (Reaction::Redraw, false));
}

/// `help` lists the modes as `space` goes through them.
#[test]
fn space_takes_the_order_that_help_tells() {
    let mut state = state();
    let mut modes = Vec::new();
    for _ in Mode::ALL {
        modes.push(state.status().split(" | ").next().unwrap().to_owned());
        state.apply(Command::NextMode);
    }
    assert!(glumbra::viewer::help(&[]).contains(&format!("next picture: {}\n", modes.join(", "))));
}
