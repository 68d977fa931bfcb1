//! Back projection: every guard shows the picture of the test per fragment, over all kinds of spotlights and of
//! places that things can have; without any guard the picture is wrong; and the plan's own choice leaves out what it says.

use std::path::Path;

use glumbra::context::{self, ContextRequest};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::pass::{Pass, Work};
use glumbra::plan::{Plan, Request};
use glumbra::scene::Scene;

const SCENE: &str = "data/cases/scenes/guards.toml";
const GUARDS: [&str; 6] = ["auto", "spot-cutoff", "texture-1d", "cull", "clip-plane", "stencil"];

const IMAGE: &str = concat!("light.image=", env!("CARGO_MANIFEST_DIR"), "/data/textures/spot.png");

/// A second light, which looks the other way and lights what is behind the first; and a third, askew.
const LIGHTS: &str = "light=[{ position = [0, 2, 0], target = [3, 1.4, 0], cone = 100, near = 0.2, far = 12, shadow = { technique = \"shadow-map\", size = 256 } }, { position = [0.5, 2.2, 1], target = [-3, 0.5, 0], color = [0.3, 0.4, 0.2], ambient = [0.02, 0, 0.05], cone = 70, near = 0.2, far = 12, shadow = { technique = \"shadow-map\", size = 128, dimming = 0.3 } }, { position = [-1, 3, -1], target = [0, 0, 2], color = [0.2, 0.1, 0.3], cone = 120, near = 0.2, far = 12, shadow = { technique = \"midpoint\", size = 128 } }]";

/// Scenes with something before, behind and across: what varies, and how.
const VARIANTS: &[(&str, &[&str])] = &[
    ("as it is", &[]),
    ("shape = frustum", &["light.shape=frustum"]),
    ("a cone of 170 degrees", &["light.cone=170"]),
    ("a cone of 4 degrees", &["light.cone=4"]),
    ("straight down, across every wall", &["light.target=[0.0, 0.0, 0.001]", "light.cone=150"]),
    // The floor's corners at x = 5 lie in the plane to the bit: q = 0.
    (
        "vertices in the plane",
        &["light.position=[5.0, 2.0, 0.0]", "light.target=[4.0, 2.0, 0.0]", "object.casts_shadow=false"],
    ),
    ("a wall in the plane", &["light.position=[-4.0, 2.0, 0.0]", "light.target=[0.0, 2.0, 0.0]", "light.cone=170"]),
    ("the light in the floor", &["light.position=[0.0, 0.0, 0.0]", "light.target=[1.0, 0.0, 0.0]"]),
    ("the light a hair above the floor", &["light.position=[0.0, 1e-4, 0.0]", "light.target=[1.0, 1e-4, 0.0]"]),
    ("the light in the torus", &["light.position=[1.0, 1.2, -1.0]", "light.target=[-3.0, 1.3, 0.0]"]),
    ("a spot image", &[IMAGE]),
    ("ambient light and dimming", &["light.ambient=[0.1, 0.05, 0.0]", "light.shadow.dimming=0.4"]),
    ("attenuated", &["light.attenuation=[1.0, 0.1, 0.02]", "light.ambient=[0.1, 0.05, 0.0]"]),
    ("per vertex", &["shading.lighting=per-vertex"]),
    ("unlit", &["object.0.lit=false", "object.2.lit=false"]),
    ("depth32f", &["light.shadow.format=depth32f"]),
    ("gequal, 3x3", &["light.shadow.compare=gequal", "light.shadow.kernel=3x3"]),
    ("direct3d", &["light.shadow.addressing=direct3d", "light.shadow.fit=view"]),
    ("texture_matrix = projection", &["light.shadow.texture_matrix=projection"]),
    ("texture_matrix = scale-bias", &["light.shadow.texture_matrix=scale-bias"]),
    ("midpoint", &["light.shadow.technique=midpoint"]),
    ("second-depth", &["light.shadow.technique=second-depth", "light.shadow.closed=assume"]),
    ("no casters", &["object.casts_shadow=false"]),
    (
        "waves",
        &[
            "object.5.wave={ direction = [0, 1, 0], amplitude = 0.2, axis = [1, 0, 0.2], wavelength = 0.9, phase = 0.1 }",
        ],
    ),
    ("a far eye", &["camera.eye=[0.6, 3.4, 350.0]", "camera.fov_y=1.1", "camera.near=300", "camera.far=400"]),
    ("three lights", &[LIGHTS]),
    ("tags", &["light.shadow.into=stencil"]),
    ("tags per vertex", &["light.shadow.into=stencil", "shading.lighting=per-vertex", "light.ambient=[0.1, 0.0, 0.1]"]),
    ("volumes per vertex", &["light.shadow.technique=shadow-volume", "shading.lighting=per-vertex"]),
];

fn try_load(set: &[&str]) -> Result<Scene, String> {
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    let loaded = glumbra::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENE), &set);
    loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

fn load(set: &[&str]) -> Scene {
    try_load(set).unwrap()
}

fn guarded(set: &[&str], guard: &str) -> Scene {
    load(&[set, &[&format!("light.shadow.guard={guard}")]].concat())
}

fn plan(renderer: &mut Renderer, scene: &Scene, keep_all: bool) -> Plan {
    renderer.plan(scene, &Request { keep_all, ..Request::default() }).unwrap()
}

fn picture(renderer: &mut Renderer, plan: &Plan) -> Vec<u8> {
    renderer.draw(plan).unwrap();
    match renderer.read(plan).unwrap().picture {
        Pixels::Rgba8 { data, .. } => data,
        _ => panic!("no RGBA8"),
    }
}

/// Pixels that differ by more than `codes`.
fn differing(a: &[u8], b: &[u8], codes: u8) -> usize {
    let differ = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > codes);
    a.chunks_exact(4).zip(b.chunks_exact(4)).filter(differ).count()
}

/// Codes and pixels by which a guard may miss the test per fragment.
fn tolerance(guard: &str, scene: &Scene) -> (u8, usize) {
    match guard {
        // What is cut has new vertices, which are rounded to the raster's grid and have depths of their own: where it
        // ends, and where it meets another surface, single pixels go to the other side (measured: 2).
        "clip-plane" => (1, 4),
        // Each light is rounded to 8 bits when it is added to what is there.
        "stencil" => (scene.lights.len() as u8, 0),
        // The same vertices, interpolated alike; of a product with 0 or 1 nothing is rounded.
        _ => (0, 0),
    }
}

#[test]
fn every_guard_shows_the_same() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut wrong = Vec::new();
    for (name, set) in VARIANTS {
        let tested = plan(&mut renderer, &guarded(set, "fragment"), true);
        let expected = picture(&mut renderer, &tested);
        for guard in GUARDS {
            // A count of the shadow fills the stencil buffer, and its pass meets depths again.
            let counts = name.starts_with("tags") || name.starts_with("volumes");
            let loaded = try_load(&[*set, &[&format!("light.shadow.guard={guard}")]].concat());
            let planned = loaded.and_then(|scene| match renderer.plan(&scene, &Request::default()) {
                Ok(plan) => Ok((scene, plan)),
                Err(error) => Err(error.to_string()),
            });
            let (scene, plan) = match planned {
                Ok(planned) => planned,
                Err(_) if counts && ["clip-plane", "stencil"].contains(&guard) => continue,
                Err(error) => {
                    wrong.push(format!("{name}, {guard}: {error}"));
                    continue;
                }
            };
            let actual = picture(&mut renderer, &plan);
            let (codes, pixels) = tolerance(guard, &scene);
            let beyond = differing(&expected, &actual, codes);
            println!("{name}, {guard}: {} differ, {beyond} by more than {codes}", differing(&expected, &actual, 0));
            if beyond > pixels {
                wrong.push(format!("{name}, {guard}: {beyond} pixels differ by more than {codes} codes"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The test per fragment taken out of every shader: what lies behind the light is lit.
#[test]
fn without_a_guard_the_picture_is_wrong() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for set in [&[][..], &["light.shape=frustum"], &[IMAGE], &["light.cone=170"]] {
        let right = plan(&mut renderer, &guarded(set, "fragment"), false);
        let mut unguarded = right.clone();
        let mut changed = 0;
        for pass in &mut unguarded.list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            for chunk in draw.batches.iter_mut().flat_map(|batch| &mut batch.program.fragment) {
                let text = chunk.text.replace("coord.z > 0.0 && inside", "inside");
                changed += usize::from(text != *chunk.text);
                chunk.text = text.into();
            }
        }
        assert!(changed > 0, "no shader has the test");
        let (right, wrong) = (picture(&mut renderer, &right), picture(&mut renderer, &unguarded));
        let none = plan(&mut renderer, &guarded(set, "none"), false);
        assert!(none.warnings.iter().any(|warning| warning.contains("surfaces behind it are lit by mistake")));
        assert!(wrong == picture(&mut renderer, &none), "{set:?}: guard = none is another picture");
        let differ = differing(&right, &wrong, 20);
        println!("{set:?}: {differ} pixels of {}", right.len() / 4);
        assert!(differ > 300, "{set:?}: only {differ} pixels are lit by mistake");
    }
}

/// Both sides of a clip plane together cover what the whole covers: along the cut no pixel is missing, none drawn twice
/// [GL 4.6, 13.7].
#[test]
fn a_cut_floor_misses_no_pixel() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (target, eye) in
        [([3.0, 1.4, 0.0], 3.4), ([0.3, 1.9, 1.7], 3.4), ([-0.9, 2.0, -0.31], 0.2), ([2.0, 1.7, 5.0], 9.0)]
    {
        let set = [
            format!("light.target={target:?}"),
            format!("camera.eye=[0.6, {eye:?}, 9.0]"),
            String::from("object=[{ mesh = \"quad\", scale = [5.0, 1.0, 3.0] }]"),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let mut fragments = |guard: &str| {
            let plan = plan(&mut renderer, &guarded(&set, guard), false);
            let draws = |pass: &Pass| match &pass.work {
                Work::Draw(draw) => draw.batches.iter().map(|batch| batch.draws.len()).sum(),
                Work::CopyDepth { .. } => 0,
            };
            let draws: usize = plan.list.passes.iter().filter(|pass| pass.label == "lit").map(draws).sum();
            renderer.device().forget();
            let times = renderer.device().run(&plan.list, Measure::Fragments).unwrap();
            (draws, times.iter().find(|time| time.label == "lit").unwrap().fragments.unwrap())
        };
        let (whole, cut) = (fragments("fragment"), fragments("clip-plane"));
        println!("{target:?}: {whole:?} {cut:?}");
        assert!(whole.1 > 500 && whole.0 == 1 && cut.0 == 2, "{target:?}: {whole:?} {cut:?}");
        // The cut is some fifty pixels long; where it ends, the floor's edge has a vertex that is rounded to the raster's
        // grid, which can win or lose a pixel.
        assert!(whole.1.abs_diff(cut.1) <= 2, "{target:?}: {whole:?} {cut:?}");
    }
}

/// The plan's own choice of a guard, and its reasons, word by word. The choice changes no pixel.
#[test]
fn the_plan_chooses_what_the_scene_needs() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let only = |names: &[&str]| {
        let all = ["floor", "right wall", "left wall", "before", "behind", "across"];
        let away = all.iter().enumerate().filter(|(_, name)| !names.contains(name));
        away.map(|(index, _)| format!("object.{index}.translate=[0.0, -500.0, 0.0]")).collect::<Vec<_>>()
    };
    let table: &[(&[&str], &str, &str, usize)] = &[
        (&["right wall", "before"], "none", "nothing visible lies behind the light", 0),
        (&["right wall", "left wall", "before", "behind"], "leave-out", "2 of 4 items that are seen lie behind", 2),
        (&["left wall"], "leave-out", "1 of 1 items", 1),
        (
            &["floor", "right wall", "behind"],
            "fragment",
            "1 of 3 items that are seen cross the light's plane: floor",
            1,
        ),
    ];
    for (names, choice, why, left_out) in table {
        let set = only(names);
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        for more in [&[][..], &["light.ambient=[0.1, 0.0, 0.2]", "light.shape=frustum"]] {
            let scene = load(&[&set, more].concat());
            let pruned = plan(&mut renderer, &scene, false);
            let chosen = pruned.chosen.iter().find(|chosen| chosen.of.contains("against back projection"));
            // A light that reaches nothing is left out before its guard is asked for.
            let Some(chosen) = chosen else {
                assert!(names == &["left wall"] && more.is_empty(), "{names:?}: nothing is chosen");
                continue;
            };
            assert!(chosen.choice == *choice && chosen.why.contains(why), "{names:?}: {chosen:?}");
            let left = pruned.left_out.iter().filter(|left| left.why == "it lies behind the light").count();
            assert_eq!(left, *left_out, "{names:?}: {:?}", pruned.left_out);
            let whole = plan(&mut renderer, &scene, true);
            assert!(picture(&mut renderer, &pruned) == picture(&mut renderer, &whole), "{names:?}, {more:?}");
        }
    }
}
