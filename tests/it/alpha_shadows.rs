//! Shadows by destination alpha against the same lights in one pass: scenes by the dozen from a generator, of every map
//! technique and kind of light.

use std::fmt::Write as _;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::pass::{Blend, Channels, Work};
use glumbra::plan::{Plan, Request};
use glumbra::scene::{PicturePasses, Scene};

use crate::support::random::Random;
use crate::support::scene_of;

fn draw(scene: &Scene, float_picture: bool, renderer: &mut Renderer) -> (Vec<f64>, Plan) {
    let plan = renderer.plan(scene, &Request { float_picture, ..Request::default() }).unwrap();
    renderer.draw(&plan).unwrap();
    let data = match renderer.read(&plan).unwrap().picture {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f64::from(*code) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } => data.iter().map(|value| f64::from(*value)).collect(),
        other => panic!("{:?}", other.size()),
    };
    (data, plan)
}

/// Greatest difference in RGB, in codes.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let pixels = a.chunks_exact(4).zip(b.chunks_exact(4));
    pixels.flat_map(|(a, b)| (0..3).map(|k| 255.0 * (a[k] - b[k]).abs())).fold(0.0, f64::max)
}

const SPOT: &[&str] = &[
    "technique = \"shadow-map\", size = 128",
    "technique = \"shadow-map\", size = 256, kernel = \"3x3\", dimming = 0.3",
    "technique = \"shadow-map\", size = 128, bias = \"receiver-plane\"",
    "technique = \"shadow-map\", size = 128, bias = \"normal-offset\", guard = \"texture-1d\"",
    "technique = \"shadow-map\", size = 64, bias = \"adaptive\", format = \"depth32f\"",
    "technique = \"midpoint\", size = 256",
    "technique = \"second-depth\", closed = \"assume\", size = 256",
    "technique = \"none\"",
];
const POINT: &[&str] = &["technique = \"shadow-map\", size = 128", "technique = \"none\""];
const SUN: &[&str] =
    &["technique = \"shadow-map\", size = 128, filter = \"nearest\"", "technique = \"midpoint\", size = 128"];

fn light(random: &mut Random, strength: f64) -> String {
    let kind = random.pick(&["spot", "spot", "point", "directional"]);
    let color = [(); 3].map(|()| random.within(0.1, strength));
    let specular = random.within(0.0, 0.2);
    let position = [random.within(-3.0, 3.0), random.within(2.0, 4.0), random.within(-3.0, 3.0)];
    let (more, shadow) = match kind {
        "spot" => {
            let shape = random.pick(&["cone", "frustum"]);
            let cone = random.within(40.0, 80.0);
            (format!("target = [0.0, 0.3, 0.0]\ncone = {cone:?}\nshape = \"{shape}\"\n"), random.pick(SPOT))
        }
        "point" => (String::from("attenuation = [1.0, 0.02, 0.01]\n"), random.pick(POINT)),
        _ => (String::from("target = [0.0, 0.3, 0.0]\n"), random.pick(SUN)),
    };
    format!(
        "[[light]]\nkind = \"{kind}\"\nposition = {position:?}\n{more}diffuse = {color:?}\nspecular = [{specular:?}, 0.1, 0.1]\nambient = [0.01, 0.0, 0.02]\nshadow = {{ {shadow} }}\n"
    )
}

/// A floor, a fence with holes by alpha, things on it, and a box that is listed twice.
fn objects(random: &mut Random) -> String {
    let fence = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/fence.png");
    let mut text = format!(
        "[[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\nmaterial = {{ diffuse = [0.8, 0.8, 0.7] }}\n\
         [[object]]\nmesh = \"quad\"\ntranslate = [0.0, 0.6, -1.0]\nrotate = {{ axis = [1, 0, 0], angle = 90.0 }}\nscale = [1.5, 1.0, 0.6]\n\
         material = {{ alpha = {fence:?}, texgen = {{ s = [0.5, 0, 0, 0.5], t = [0, 0, 0.5, 0.5], scale = 2.0 }} }}\n"
    );
    for mesh in ["sphere", "box", "torus"] {
        let place = [random.within(-1.2, 1.2), random.within(0.4, 1.0), random.within(-0.4, 1.4)];
        let color = [(); 3].map(|()| random.within(0.3, 0.9));
        let specular = random.pick(&[0.0, 0.5]);
        let lit = random.pick(&["", "", "lit = false\n"]);
        let one = format!(
            "[[object]]\nmesh = \"{mesh}\"\ntranslate = {place:?}\nscale = 0.4\n{lit}material = {{ diffuse = {color:?}, specular = [{specular:?}, {specular:?}, {specular:?}], shininess = 12.0 }}\n"
        );
        text += &one;
        if mesh == "box" {
            text += &one;
        }
    }
    text
}

#[test]
fn generated_scenes_are_those_of_one_pass() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (mut worst, mut alphas) = ([0.0_f64; 2], 0);
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let count = 1 + seed as usize % 4;
        let lighting = if seed % 5 == 4 { "per-vertex" } else { "per-fragment" };
        let mut text = format!(
            "[image]\nsize = [120, 90]\nbackground = [0.1, 0.2, 0.3]\n[camera]\neye = [2.6, 2.8, 4.0]\ntarget = [0.0, 0.4, 0.0]\nfov_y = 42.0\n\
             [shading]\nlighting = \"{lighting}\"\nambient = [0.1, 0.1, 0.15]\n"
        );
        text += &objects(&mut random);
        (0..count).for_each(|_| text += &light(&mut random, 0.8));
        let mut scene = scene_of(&text);
        for float in [false, true] {
            scene.shading.passes = PicturePasses::One;
            let (one, _) = draw(&scene, float, &mut renderer);
            scene.shading.passes = PicturePasses::Shadow;
            let (three, plan) = draw(&scene, float, &mut renderer);
            let codes = apart(&one, &three);
            worst[usize::from(float)] = worst[usize::from(float)].max(codes - if float { 0.0 } else { count as f64 });
            // In 8 bits the light, its shade and each sum are rounded, and the first pass; in floats nothing.
            let most = if float { 1e-3 } else { 1.01 + count as f64 };
            assert!(codes <= most, "seed {seed}, float {float}: {codes} codes\n{text}");
            let of_alpha = plan
                .list
                .passes
                .iter()
                .filter(|pass| matches!(&pass.work, Work::Draw(draw) if draw.state.color_write == Channels::Alpha));
            alphas += of_alpha.count();
        }
    }
    println!("at most {:.2} codes more than lights; in floats {:.6}; {alphas} passes of alpha", worst[0], worst[1]);
    assert!(alphas > 40);
}

/// Each light's alpha is its own, however many come before it, shadowed or not.
#[test]
fn alpha_of_one_light_never_reaches_the_next() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut text = String::from(
        "[image]\nsize = [120, 90]\n[camera]\neye = [2.6, 2.8, 4.0]\ntarget = [0.0, 0.4, 0.0]\nfov_y = 42.0\n[shading]\npasses = \"shadow\"\nambient = [0.0, 0.0, 0.0]\n",
    );
    text += &objects(&mut Random::new(3));
    for k in 0..16 {
        let angle = f64::from(k) * 2.399_963;
        let color = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]][k as usize % 3];
        // Narrow and wide, each fifth without a shadow.
        let shadow = if k % 5 == 4 { "none" } else { "shadow-map" };
        let _ = write!(
            text,
            "[[light]]\nposition = [{:?}, 3.0, {:?}]\ntarget = [0.0, 0.3, 0.0]\ncone = {:?}\ndiffuse = {color:?}\nspecular = [0.0, 0.0, 0.0]\nshadow = {{ technique = \"{shadow}\", size = 128 }}\n",
            3.0 * angle.cos(),
            3.0 * angle.sin(),
            if k % 2 == 0 { 25.0 } else { 70.0 },
        );
    }
    let mut scene = scene_of(&text);
    let (three, plan) = draw(&scene, true, &mut renderer);
    let blends: Vec<Option<Blend>> = plan
        .list
        .passes
        .iter()
        .filter_map(|pass| match &pass.work {
            Work::Draw(draw) if draw.state.color_write == Channels::Rgb => Some(draw.state.blend),
            _ => None,
        })
        .collect();
    assert_eq!(blends.len(), 16);
    assert_eq!(
        blends.iter().filter(|blend| **blend == Some(Blend::Add)).count(),
        3,
        "lights without a shadow read no alpha"
    );
    scene.shading.passes = PicturePasses::One;
    let (one, _) = draw(&scene, true, &mut renderer);
    assert!(apart(&one, &three) < 1e-3, "{}", apart(&one, &three));
    // Without a light's own alpha the one before it would be met: the test can fail.
    let mut broken = plan.clone();
    broken.list.passes.retain(|pass| pass.label != "shade of light 3");
    renderer.draw(&broken).unwrap();
    let Pixels::RgbaF32 { data, .. } = renderer.read(&broken).unwrap().picture else { panic!() };
    let leaked: Vec<f64> = data.iter().map(|value| f64::from(*value)).collect();
    assert!(apart(&one, &leaked) > 5.0);
}

/// Light above 1 is clamped before alpha weighs it: said with its value, and only where it can occur.
#[test]
fn light_above_one_is_said() {
    let clamped = |strength: f64, float_picture: bool| {
        let text = format!(
            "[shading]\npasses = \"shadow\"\n[[object]]\nmesh = \"quad\"\nscale = 3.0\nmaterial = {{ diffuse = [0.5, 0.5, 0.5] }}\n\
             [[object]]\nmesh = \"box\"\nscale = 0.3\ntranslate = [0.0, 0.8, 0.0]\nmaterial = {{ diffuse = [0.5, 0.5, 0.5] }}\n\
             [[light]]\nposition = [1.0, 3.0, 1.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 60.0\ncolor = [{strength:?}, 0.5, 0.5]\nshadow = {{ technique = \"shadow-map\" }}\n"
        );
        let plan = glumbra::plan::make(&scene_of(&text), &Request { float_picture, ..Request::default() }).unwrap();
        plan.chosen.into_iter().find(|chosen| chosen.choice == "clamped to 1 before its shade").map(|chosen| chosen.why)
    };
    assert!(clamped(3.0, false).unwrap().contains("it reaches 1.5"));
    assert_eq!([clamped(3.0, true), clamped(1.9, false)], [None, None]);
}
