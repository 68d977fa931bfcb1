//! The sample programs md2shader and md2bump: window and headless pictures are the same to the bit, keys lead where they say,
//! and the knight's pose, shadow and bumps are those of the scene.

use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::cargo::CommandCargoExt;
use glam::{DVec2, DVec3};
use glumbra::cli::sample_model::KNIGHT;
use glumbra::geometry::md2::{Model, NormalSource, Pose};
use glumbra::scene::BumpMethod;
use glumbra::viewer::{Button, ModelMode, ModelState, Reaction, Show};

use crate::support::window::{Running, until};
use crate::support::xvfb::Xvfb;

const SCENE: &str = "data/scenes/md2shader.toml";

fn state() -> ModelState {
    let (state, warnings) = ModelState::new(KNIGHT, Vec::new(), ModelMode::Scene).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    state
}

fn knight() -> Model {
    Model::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/knight.md2")).unwrap().0
}

/// Places of the knight's corners in a pose, in the order of its triangles.
fn places(state: &ModelState) -> Vec<[f32; 3]> {
    let mesh = &state.scene().objects[0].mesh;
    mesh.indices.iter().map(|index| mesh.positions[*index as usize]).collect()
}

fn expected(frames: [usize; 2], blend: f64) -> Vec<[f32; 3]> {
    let mesh = knight().mesh(&Pose { frames, blend }, NormalSource::File);
    mesh.indices.iter().map(|index| mesh.positions[*index as usize]).collect()
}

#[test]
fn animations_go_round_at_three_key_frames_a_second() {
    let mut state = state();
    // The scene's own frame.
    assert_eq!(state.key_frame(), 8.0);
    assert_eq!(places(&state), expected([8, 8], 0.0));
    for (frame, frames, blend) in
        [(0.0, [0, 0], 0.0), (3.25, [3, 4], 0.25), (7.5, [7, 0], 0.5), (8.0, [8, 8], 0.0), (15.75, [15, 8], 0.75)]
    {
        state.pose_at(frame);
        assert_eq!(places(&state), expected(frames, blend), "{frame}");
    }
    assert!(!state.moves());
    state.key("space");
    assert!(state.moves());
    // 15.75 and a quarter of a second: 16.5, which is 8.5.
    state.advance(0.25);
    assert!((state.key_frame() - 8.5).abs() < 1e-12, "{}", state.key_frame());
    assert_eq!(places(&state), expected([8, 9], 0.5));
    state.key("+");
    state.advance(1.0 / 3.0);
    assert!((state.key_frame() - 9.9).abs() < 1e-12, "{}", state.key_frame());
    state.key("-");
    state.key("a");
    assert_eq!(state.key_frame(), 0.0);
    state.advance(2.0);
    assert!((state.key_frame() - 6.0).abs() < 1e-9, "{}", state.key_frame());
    state.key("a");
    assert_eq!(state.key_frame(), 8.0);
    state.key("space");
    assert!(!state.moves());
}

#[test]
fn keys_do_what_they_say() {
    let mut state = state();
    let names = |state: &mut ModelState, key: &str, count: usize| -> Vec<&'static str> {
        let step = |_| {
            assert_eq!(state.key(key), Some(Reaction::Redraw));
            state.mode().name()
        };
        (0..count).map(step).collect()
    };
    assert_eq!(names(&mut state, "r", 4), ["normal-map", "decal", "gloss", "scene"]);
    assert_eq!(names(&mut state, "s", 2), ["stencil", "scene"]);
    assert_eq!(names(&mut state, "V", 2), ["volume", "scene"]);
    // Volumes are added light by light: three passes cannot have them, and the key says so and goes on.
    state.key("p");
    assert_eq!(state.scene().shading.bumps.method, BumpMethod::Reference);
    assert!(state.status().contains("three-pass"), "{}", state.status());
    state.key("p");
    assert!(matches!(state.scene().shading.bumps.method, BumpMethod::OnePass(_)));
    state.key("2");
    assert!(state.status().contains("shadows: shadow-map"), "{}", state.status());
    state.key("p");
    assert!(matches!(state.scene().shading.bumps.method, BumpMethod::ThreePass { .. }));
    // No count without volumes, and none with these passes.
    state.key("s");
    assert!(state.mode() == ModelMode::Scene && state.status().contains("shadow-volume"), "{}", state.status());
    state.key("1");
    assert!(state.status().contains("shadows: shadow-map"), "{}", state.status());
    state.key("0");
    assert!(state.status().contains("shadows: none"), "{}", state.status());
    let objects = |state: &ModelState| state.frame().0.objects.len();
    let all = objects(&state);
    state.key("b");
    assert_eq!(objects(&state), all - 6);
    state.key("b");
    assert_eq!(objects(&state), all);
    let gloss = |state: &ModelState| state.scene().objects[0].material.as_ref().unwrap().gloss.is_some();
    assert!(gloss(&state));
    state.key("g");
    assert!(!gloss(&state));
    state.key("g");
    assert!(gloss(&state));
    let normals = |state: &ModelState| state.scene().objects[0].mesh.normals.clone();
    let of_file = normals(&state);
    state.key("n");
    assert_ne!(normals(&state), of_file);
    assert_eq!(state.frame().1.wire, None);
    state.key("w");
    assert_eq!(state.frame().1.wire, Some(0));
    assert_eq!((state.key("x"), state.key("q"), state.key("Esc")), (None, Some(Reaction::Quit), Some(Reaction::Quit)));
}

#[test]
fn the_mouse_leads_eye_and_light_around() {
    let mut state = state();
    let around = |place: DVec3| (place.x.hypot(place.z), place.y);
    let (eye, light) = (state.scene().camera.eye, state.scene().lights[0].position().unwrap());
    assert!((around(eye).0 - 70.0).abs() < 1e-9 && (around(light).0 - 40.0).abs() < 0.01 && light.y == 13.3);
    for _ in 0..50 {
        state.drag(Button::Left, DVec2::new(31.0, -7.0));
        state.drag(Button::Middle, DVec2::new(-17.0, -9.0));
        let (eye, light) = (state.scene().camera.eye, state.scene().lights[0].position().unwrap());
        for (place, radius) in [(eye, 70.0), (light, around(light).0)] {
            assert!((around(place).0 - radius).abs() < 1e-9 && (-20.0..=60.0).contains(&place.y), "{place}");
        }
        let lamp = state.scene().objects.iter().find(|object| object.name == "lamp").unwrap();
        assert_eq!(lamp.world_from_model.w_axis.truncate(), light);
    }
    assert_ne!(state.scene().camera.eye, eye);
    state.dolly(3.0);
    let near = around(state.scene().camera.eye).0;
    assert!((near - 70.0 * 0.9_f64.powi(3)).abs() < 1e-9, "{near}");
    state.dolly(-100.0);
    assert!((around(state.scene().camera.eye).0 - 72.0).abs() < 1e-9, "inside the room");
    state.key("Home");
    assert_eq!((state.scene().camera.eye, state.scene().lights[0].position().unwrap()), (eye, light));
}

/// A finished run: exit status, standard output, standard error.
fn run(program: &str, arguments: &[&str], display: Option<&str>) -> (i32, String, String) {
    let output = command(program, display).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

/// The program on this display only, if on any.
fn command(program: &str, display: Option<&str>) -> Command {
    let mut command = Command::cargo_bin(program).unwrap();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.envs(display.map(|display| ("DISPLAY", display)));
    command
}

/// Pictures that the programs write.
struct Pictures(tempfile::TempDir);

impl Pictures {
    fn path(&self) -> PathBuf {
        self.0.path().join("picture.png")
    }

    fn write(&self, program: &str, output: &[&str], arguments: &[&str], display: Option<&str>) -> image::RgbImage {
        let path = self.path();
        let arguments = [output, &[path.to_str().unwrap()], arguments].concat();
        let (code, _, errors) = run(program, &arguments, display);
        // `glumbra render` names what it wrote.
        let errors: Vec<&str> = errors.lines().filter(|line| !line.starts_with("wrote ")).collect();
        assert!(code == 0 && errors.is_empty(), "{arguments:?}: {errors:?}");
        image::open(&path).unwrap().into_rgb8()
    }

    fn headless(&self, program: &str, arguments: &[&str]) -> image::RgbImage {
        self.write(program, &["--headless", "-o"], arguments, None)
    }
}

fn pictures() -> Pictures {
    Pictures(tempfile::tempdir().unwrap())
}

#[test]
fn window_and_headless_pictures_of_the_knight_are_the_same_pixels() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let pictures = pictures();
    let mut seen: Vec<image::RgbImage> = Vec::new();
    let modes = ModelMode::names().map(|mode| ["--mode", mode, "--size", "301x207", "--frame", "9.5"].to_vec());
    let others = [vec!["--frame", "3"], vec!["--wireframe"], vec!["--no-shadows", "--set", "shading.bump=three-pass"]];
    for arguments in modes.chain(others) {
        let headless = pictures.headless("md2shader", &arguments);
        let window = pictures.write("md2shader", &["--capture"], &arguments, Some(server.display()));
        assert_eq!(headless.dimensions(), if arguments.len() > 4 { (301, 207) } else { (600, 600) }, "{arguments:?}");
        assert!(headless == window, "{arguments:?}: the pictures differ");
        assert!(!seen.contains(&headless), "{arguments:?}: a picture for the second time");
        seen.push(headless);
    }
    let bump = pictures.headless("md2bump", &[]);
    assert!(bump == pictures.write("md2bump", &["--capture"], &[], Some(server.display())));
    assert!(bump == pictures.headless("md2shader", &["--no-shadows"]));
}

#[test]
fn the_scene_file_renders_to_the_knight_s_picture_and_shadows_only_darken() {
    let pictures = pictures();
    let by_sample = pictures.headless("md2shader", &[]);
    let by_file = pictures.write("glumbra", &["render", SCENE, "-o"], &[], None);
    assert!(by_file == by_sample);
    assert!(by_sample == pictures.headless("md2shader", &["--frame", "8"]));
    let plain = pictures.headless("md2bump", &[]);
    let darker = plain.pixels().zip(by_sample.pixels()).filter(|(plain, shadowed)| shadowed.0[0] < plain.0[0]).count();
    // Light that is added in a pass of its own is rounded twice, to half a code each time: a code brighter at most.
    let brighter =
        plain.pixels().zip(by_sample.pixels()).filter(|(a, b)| (0..3).any(|k| b.0[k] > a.0[k].saturating_add(1)));
    assert_eq!(brighter.count(), 0);
    println!("{darker} of 360000 pixels darker");
    assert!(darker > 20_000, "{darker}");
    // Bumps and gloss are to be seen: the other two ways of lighting them give nearly the same picture, none another one.
    let far = |other: &image::RgbImage| {
        let apart = plain.pixels().zip(other.pixels()).filter(|(a, b)| (0..3).any(|k| a.0[k].abs_diff(b.0[k]) > 8));
        apart.count()
    };
    let others = ["three-pass", "reference"].map(|method| format!("shading.bump={method}"));
    let [three, reference] = others.map(|method| far(&pictures.headless("md2bump", &["--set", &method])));
    let flat = far(&pictures.headless("md2bump", &["--set", "object.0.material.bump.scale=0"]));
    println!("pixels more than 8 codes apart: three passes {three}, reference {reference}, flat {flat}");
    // Vectors to a near light and to a near eye bend over the knight's large triangles; combiners interpolate them.
    assert!(10 * three < flat && 4 * reference < flat && flat > 5_000, "{three} {reference} {flat}");
}

#[test]
fn the_knight_runs_in_its_window() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let pictures = pictures();
    let size = ["--size", "200x200"];
    let still = pictures.headless("md2shader", &size).into_raw();
    let mut program = command("md2shader", Some(server.display()));
    program.args(size);
    let mut running = Running::start("md2shader", program, server.display(), [200, 200]);
    running.shows(&still, "the first pose");
    running.press(b' ');
    running.hear("3.0 a second |");
    until("another pose", || (running.screen() != still).then_some(()));
    running.press(b' ');
    running.hear("stopped");
    // Nothing moves any more.
    let after = until("a picture that stays", || {
        let before = running.screen();
        std::thread::sleep(std::time::Duration::from_millis(500));
        (running.screen() == before).then_some(before)
    });
    assert_ne!(after, still);
    running.press(b'r');
    running.hear("normal-map |");
    until("the normal map", || (running.screen() != after).then_some(()));
    running.press(b'q');
    let ended = running.ended();
    assert!(ended.success(), "{ended}");
}

#[test]
fn wrong_uses_of_the_knight_s_samples_are_told() {
    let picture = pictures();
    let path = picture.path();
    let path = path.to_str().unwrap();
    for (program, arguments, code, part) in [
        ("md2shader", &["-o", path][..], 2, "--headless"),
        ("md2shader", &["--headless"], 2, "--output"),
        ("md2shader", &["--device", "0"], 2, "--headless -o FILE"),
        ("md2shader", &["--mode", "eye"], 2, "normal-map"),
        ("md2shader", &["--headless", "-o", path, "--frame", "16"], 2, "from 0 to below 16"),
        ("md2shader", &["--headless", "-o", path, "--frame", "NaN"], 2, "from 0 to below 16"),
        ("md2shader", &["--headless", "-o", path, "--set", "shading.bump=three-pass"], 1, "one-pass"),
        ("md2bump", &["--headless", "-o", path, "--mode", "stencil"], 1, "shadow-volume"),
        ("md2bump", &[], 1, "--headless -o FILE"),
    ] {
        let (found, _, errors) = run(program, arguments, None);
        assert_eq!(found, code, "{arguments:?}: {errors}");
        assert!(errors.contains(part), "{arguments:?}: no `{part}` in {errors}");
    }
    assert!(!picture.path().exists());
    let (_, help, _) = run("md2shader", &["--help"], None);
    for part in ["space", "middle drag", "w  ", "stencil shadow volumes", "--frame", "tangent-half"] {
        assert!(help.contains(part), "no `{part}` in {help}");
    }
}
