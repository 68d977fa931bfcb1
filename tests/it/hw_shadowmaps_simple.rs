//! The sample program: its window shows what its headless pictures show, to the bit; what is where in them follows from
//! the scene's numbers; only what changed is drawn again.

use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::cargo::CommandCargoExt;
use glam::{DVec3, DVec4, dvec3};
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::math::frustum;
use glumbra::pass::Work;
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::viewer::Mode;
use glumbra::views::View;

use crate::support::xvfb::Xvfb;

const SCENE: &str = "data/scenes/hw_shadowmaps_simple.toml";

/// In the window, in the light's frustum and clear of the teapot's shadow.
const LIT_FLOOR: DVec3 = dvec3(0.3, 0.0, 2.7);
/// In the window and past the frustum's side.
const FLOOR_PAST_THE_LIGHT: DVec3 = dvec3(2.0, 0.0, 2.8);

fn load() -> Scene {
    glumbra::load(Path::new(SCENE), &[]).unwrap().scene
}

/// Point of the floor that the ray from the light through the middle of the teapot meets.
fn shadowed_floor(scene: &Scene) -> DVec3 {
    let light = scene.lights[0].position().unwrap();
    let along = dvec3(0.0, 0.7, 1.8) - light;
    light - along * (light.y / along.y)
}

/// A mode's picture, and the camera's depth.
struct Drawn {
    scene: Scene,
    colors: Vec<u8>,
    depths: Vec<f32>,
}

fn draw(mode: Mode) -> Drawn {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = load();
    let (scene, request) = mode.frame(&scene, scene.image.size);
    let views = vec![ViewRequest { view: View::Depth, light: 0 }];
    let plan = renderer.plan(&scene, &Request { views, ..request }).unwrap();
    renderer.draw(&plan).unwrap();
    let frame = renderer.read(&plan).unwrap();
    let (Pixels::Rgba8 { data: colors, .. }, Pixels::Depth { data: depths, .. }) = (frame.picture, &frame.views[0])
    else {
        panic!("colours of 8 bits and depths")
    };
    Drawn { scene, colors, depths: depths.clone() }
}

impl Drawn {
    /// The pixel of a point in the world and its window-space depth; `None` outside of the picture.
    fn project(&self, point: DVec3) -> Option<(usize, usize, f64)> {
        let camera = &self.scene.camera;
        let clip = camera.clip_from_view(1.0) * camera.view_from_world() * point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let at = |ndc: f64| ((0.5 + 0.5 * ndc) * 512.0).floor();
        let (x, y) = (at(ndc.x), 511.0 - at(ndc.y));
        let inside = clip.w > 0.0 && (1.0..511.0).contains(&x) && (1.0..511.0).contains(&y);
        inside.then_some((x as usize, y as usize, 0.5 + 0.5 * ndc.z))
    }

    fn color(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 4 * (512 * y + x);
        [self.colors[at], self.colors[at + 1], self.colors[at + 2]]
    }

    /// The colour of a point of the floor, which must be what its pixel shows.
    fn pick(&self, point: DVec3) -> [u8; 3] {
        let (x, y, depth) = self.project(point).expect("the point is in the picture");
        let found = f64::from(self.depths[512 * y + x]);
        assert!((found - depth).abs() < 1e-3, "{point} is hidden: {found} before {depth}");
        self.color(x, y)
    }
}

#[test]
fn the_teapot_shadows_the_floor_and_the_dark_stays_dark() {
    let (plain, shadowed) = (draw(Mode::Camera), draw(Mode::Shadowed));
    let bright = |color: [u8; 3]| color.iter().map(|channel| u32::from(*channel)).sum::<u32>() > 90;
    let shadow = shadowed_floor(&plain.scene);
    assert!(bright(plain.pick(shadow)), "{:?}", plain.pick(shadow));
    assert_eq!(shadowed.pick(shadow), [0; 3]);
    assert!(bright(plain.pick(LIT_FLOOR)), "{:?}", plain.pick(LIT_FLOOR));
    assert_eq!(shadowed.pick(LIT_FLOOR), plain.pick(LIT_FLOOR));
    let light = &plain.scene.lights[0];
    let past = light.frustum().unwrap().clip_from_world().project_point3(FLOOR_PAST_THE_LIGHT);
    assert!(past.x > 1.0 && past.z.abs() < 1.0, "{past}");
    assert_eq!([plain.pick(FLOOR_PAST_THE_LIGHT), shadowed.pick(FLOOR_PAST_THE_LIGHT)], [[0; 3]; 2]);
    // 0.5 is halfway between two codes.
    assert!([[127; 3], [128; 3]].contains(&plain.color(500, 10)), "{:?}", plain.color(500, 10));
}

/// Published facts of the sample: the decal repeats 8 times over a quad of 8, the teapot has GL's default material, the map
/// is copied.
#[test]
fn the_scene_is_the_sample_s() {
    let scene = load();
    let [floor, teapot] = [0, 1].map(|index| scene.objects[index].clone());
    let decal = |x: f64, z: f64| {
        let model = floor.world_from_model.inverse().transform_point3(dvec3(x, 0.0, z)).extend(1.0);
        let texgen = floor.material.as_ref().unwrap().texgen.unwrap();
        [texgen.s, texgen.t].map(|plane| f64::from(texgen.scale) * DVec4::from(plane.map(f64::from)).dot(model))
    };
    let [corner, opposite] = [decal(-4.0, 4.0), decal(4.0, -4.0)];
    for axis in [0, 1] {
        assert!((opposite[axis] - corner[axis] - 8.0).abs() < 1e-9, "{corner:?} {opposite:?}");
    }
    let material = teapot.material.as_ref().unwrap();
    assert_eq!((material.ambient, material.diffuse, material.specular), ([0.2; 3], [0.8; 3], [0.0; 3]));
    let plan = glumbra::plan::make(&scene, &Request::default()).unwrap();
    assert!(plan.list.passes.iter().any(|pass| matches!(pass.work, Work::CopyDepth { .. })));
}

/// A count's scissor, which the last pass has, does not cut what is copied into the window.
#[test]
fn a_counted_shadow_fills_the_window() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let files = Files::new();
    let set = ["--set", "light.shadow.technique=shadow-volume", "--set", "light.frustum=hidden"];
    assert!(files.picture(&["--capture"], &set, Some(server.display())) == files.headless(&set));
}

#[test]
fn shadows_only_darken() {
    let (plain, shadowed) = (draw(Mode::Camera), draw(Mode::Shadowed));
    let darker = plain.colors.iter().zip(&shadowed.colors).filter(|(plain, shadowed)| shadowed < plain).count();
    assert!(plain.colors.iter().zip(&shadowed.colors).all(|(plain, shadowed)| shadowed <= plain));
    assert!(darker > 512 * 512 * 3 / 50, "{darker}");
    assert_eq!(plain.depths, shadowed.depths);
}

#[test]
fn the_light_stands_in_a_yellow_wire_frame_where_nothing_hides_it() {
    let yellow = |color: [u8; 3]| color == [255, 255, 0];
    for mode in [Mode::Camera, Mode::Shadowed] {
        let drawn = draw(mode);
        let light = &drawn.scene.lights[0];
        let corners = frustum::corners(&light.frustum().unwrap().clip_from_world().inverse());
        let (mut shown, mut hidden) = (0, 0);
        let edges = (0..8_usize).flat_map(|a| [1, 2, 4].map(|bit| (a, a | bit))).filter(|(a, b)| a != b);
        for (a, b) in edges {
            for step in 1..40 {
                let point = corners[a].lerp(corners[b], f64::from(step) / 40.0);
                let Some((x, y, depth)) = drawn.project(point) else { continue };
                let found = f64::from(drawn.depths[512 * y + x]);
                let near = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
                let is_yellow = near.into_iter().any(|(x, y)| yellow(drawn.color(x, y)));
                // Neither is said of points that all but touch a surface.
                if depth < found - 2e-3 {
                    assert!(is_yellow, "{point} at {x}, {y}");
                    shown += 1;
                } else if depth > found + 2e-3 {
                    hidden += usize::from(!is_yellow);
                }
            }
        }
        assert!(shown > 60 && hidden > 10, "{shown} shown, {hidden} hidden");
    }
    let from_the_light = draw(Mode::Light);
    assert!((0..512 * 512).all(|i| !yellow(from_the_light.color(i % 512, i / 512))));
}

/// A finished run.
struct Run {
    code: i32,
    stdout: String,
    stderr: String,
}

/// The program without a display, whatever this machine has; `display` gives it one.
fn sample(arguments: &[&str], display: Option<&str>) -> Run {
    run("hw_shadowmaps_simple", arguments, display)
}

fn run(program: &str, arguments: &[&str], display: Option<&str>) -> Run {
    let mut command = Command::cargo_bin(program).unwrap();
    command.args(arguments);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.envs(display.map(|display| ("DISPLAY", display)));
    let output = command.output().unwrap();
    Run {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Files of one test.
struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs the program, which must write the file that `output` names, and reads that.
    fn picture(&self, output: &[&str], arguments: &[&str], display: Option<&str>) -> image::RgbImage {
        let path = self.path("picture.png");
        let arguments = [output, &[path.to_str().unwrap()], arguments].concat();
        let run = sample(&arguments, display);
        assert_eq!((run.code, run.stderr.as_str()), (0, ""), "{arguments:?}");
        let picture = image::open(&path).unwrap().into_rgb8();
        std::fs::remove_file(path).unwrap();
        picture
    }

    fn headless(&self, arguments: &[&str]) -> image::RgbImage {
        self.picture(&["--headless", "-o"], arguments, None)
    }
}

#[test]
fn window_and_headless_pictures_are_the_same_pixels() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let files = Files::new();
    for mode in ["camera", "shadowed", "light"] {
        for size in [&[][..], &["--size", "301x207"]] {
            let arguments = [&["--mode", mode], size].concat();
            let headless = files.headless(&arguments);
            let window = files.picture(&["--capture"], &arguments, Some(server.display()));
            assert_eq!(headless.dimensions(), if size.is_empty() { (512, 512) } else { (301, 207) });
            assert!(headless == window, "{arguments:?}: the pictures differ");
        }
    }
}

#[test]
fn the_lights_view_fills_the_largest_square_of_a_power_of_two() {
    let files = Files::new();
    let square = files.headless(&["--mode", "light", "--size", "256x256"]);
    let wide = files.headless(&["--mode", "light", "--size", "400x300"]);
    let background = *wide.get_pixel(399, 0);
    for (x, y, pixel) in wide.enumerate_pixels() {
        // In the lower left corner.
        let inside = x < 256 && y >= 44;
        let expected = if inside { square.get_pixel(x, y - 44) } else { &background };
        assert_eq!(pixel, expected, "{x} {y}");
    }
}

#[test]
fn the_scene_file_renders_to_the_sample_s_picture() {
    let files = Files::new();
    let path = files.path("scene.png");
    let mut command = Command::cargo_bin("glumbra").unwrap();
    assert!(command.args(["render", SCENE, "-o"]).arg(&path).status().unwrap().success());
    assert!(image::open(path).unwrap().into_rgb8() == files.headless(&[]));
}

#[test]
fn tweaks_are_the_scene_s_keys() {
    let files = Files::new();
    let plain = files.headless(&[]);
    for (flags, keys) in [
        (["--r-scale", "0.49"], "r.scale=0.49"),
        (["--r-bias", "0.52"], "r.bias=0.52"),
        (["--offset-factor", "-2"], "offset.factor=-2"),
        (["--offset-units", "-3000"], "offset.units=-3000"),
    ] {
        let by_flag = files.headless(&flags);
        assert!(by_flag == files.headless(&["--set", &format!("light.shadow.{keys}")]), "{keys}");
        assert!(by_flag != plain, "{keys} changes nothing");
    }
    let defaults = ["--r-scale", "0.5", "--r-bias", "0.5", "--offset-factor", "2.5", "--offset-units", "10"];
    assert!(files.headless(&defaults) == plain);
    assert!(files.headless(&["--mode", "camera", "--r-bias", "9"]) == files.headless(&["--mode", "camera"]));
}

#[test]
fn without_a_display_one_message_names_the_other_way() {
    for display in [None, Some(":65000")] {
        let run = sample(&[], display);
        assert_eq!((run.code, run.stdout.as_str()), (1, ""));
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        for part in ["error: no window can be opened: ", "--headless -o FILE"] {
            assert!(run.stderr.contains(part), "no `{part}` in {}", run.stderr);
        }
        assert!(!run.stderr.contains("winit-"), "{}", run.stderr);
    }
}

#[test]
fn wrong_uses_are_told() {
    for (arguments, code, part) in [
        (&["-o", "x.png"][..], 2, "--headless"),
        (&["--headless"], 2, "--output"),
        (&["--headless", "-o", "x.png", "--capture", "y.png"], 2, "--capture"),
        (&["--device", "0"], 2, "--headless -o FILE"),
        (&["--mode", "eye"], 2, "camera"),
        (&["--headless", "-o", "x.jpg"], 1, ".png"),
        (&["--headless", "-o", "x.png", "--r-scale", "99"], 1, "light.shadow.r.scale"),
        (&["--headless", "-o", "x.png", "--mode", "camera", "--r-bias", "-99"], 1, "light.shadow.r.bias"),
        (&["--headless", "-o", "x.png", "--set", "light.frustum=on"], 1, "hidden"),
        (&["--headless", "-o", "x.png", "--size", "0x4"], 1, "image.size"),
    ] {
        let run = sample(arguments, None);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(part), "{arguments:?}: no `{part}` in {}", run.stderr);
    }
    assert!(!Path::new("x.png").exists() && !Path::new("y.png").exists());
}

#[test]
fn help_teaches_the_keys() {
    let run = sample(&["--help"], None);
    for part in [
        "space",
        "with shadows, from the light, without shadows",
        "view all",
        "q Esc",
        "left drag",
        "polygon offset bias",
        "--headless",
    ] {
        assert!(run.stdout.contains(part), "no `{part}` in {}", run.stdout);
    }
}

/// hw_woo_shadowmaps is the same scene: with the midpoint map at first, with polygon offset by a key.
#[test]
fn the_woo_sample_is_the_same_scene_with_a_midpoint_map() {
    let files = Files::new();
    let path = files.path("woo.png");
    let woo = |set: &[&str]| {
        let arguments = [&["--headless", "-o", path.to_str().unwrap()], set].concat();
        let done = run("hw_woo_shadowmaps", &arguments, None);
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{set:?}");
        image::open(&path).unwrap().into_rgb8()
    };
    let (midpoint, offset) = (woo(&[]), woo(&["--set", "light.shadow.technique=shadow-map"]));
    assert!(offset == files.headless(&[]) && midpoint != offset);
    assert!(midpoint == files.headless(&["--set", "light.shadow.technique=midpoint"]));
    // Both show the same shadow but for its rim.
    let unequal = midpoint.pixels().zip(offset.pixels()).filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > 8));
    let unequal = unequal.count();
    println!("{unequal} of 262144 pixels differ");
    assert!(unequal > 0 && unequal < 2600, "{unequal}");
    assert!(run("hw_woo_shadowmaps", &["--help"], None).stdout.contains("m               next shadow technique"));
    assert!(!sample(&["--help"], None).stdout.contains("next shadow technique"));
}
