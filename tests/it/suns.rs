//! Random scenes under a sun and above floors of any size, drawn with every kind of lookup, against ray-traced truth.

use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Errors, compare};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth::{self, Truth};

use crate::support::random::Random;
use crate::support::scene_of;

fn list(point: [f64; 3]) -> String {
    format!("{point:?}")
}

/// Up to eight quads, boxes, spheres and tori about the origin.
fn objects(random: &mut Random) -> String {
    let count = 1 + random.below(8);
    let object = |_| {
        let mesh = ["quad", "box", "box", "sphere", "torus"][random.below(5)];
        let size = random.within(-2.7, 0.6).exp2();
        let scale = [(); 3].map(|()| size * random.within(-1.6, 1.6).exp2());
        let height = match random.below(4) {
            0 => 0.0,
            1 => scale[1],
            // Just below the floor, as scenes have it against coplanar faces: the floor is then no last layer.
            2 => 0.998 * scale[1],
            _ => random.within(-0.5, 2.5),
        };
        let place = [random.within(-2.0, 2.0), height, random.within(-2.0, 2.0)];
        let axis = if random.below(2) == 0 { [0.0, 1.0, 0.0] } else { (random.vector() + 1e-3).to_array() };
        format!(
            "[[object]]\nmesh = \"{mesh}\"\nscale = {}\ntranslate = {}\nrotate = {{ axis = {}, angle = {:?} }}\n",
            list(scale),
            list(place),
            list(axis),
            random.within(0.0, 360.0)
        )
    };
    (0..count).map(object).collect()
}

fn camera(random: &mut Random) -> String {
    let (around, distance) = (random.within(0.0, std::f64::consts::TAU), random.within(2.5, 8.0));
    let eye = [distance * around.cos(), random.within(0.3, 5.0), distance * around.sin()];
    let target = [random.within(-0.5, 0.5), random.within(0.0, 1.0), random.within(-0.5, 0.5)];
    format!(
        "[image]\nsize = [160, 120]\n[camera]\neye = {}\ntarget = {}\nfov_y = {:?}\nnear = 0.1\nfar = 500.0\n",
        list(eye),
        list(target),
        random.within(30.0, 75.0)
    )
}

fn sun(random: &mut Random) -> String {
    let down = if random.below(4) == 0 { random.within(0.02, 0.2) } else { random.within(0.2, 1.5) };
    let direction = [random.within(-1.0, 1.0), -down, random.within(-1.0, 1.0)];
    format!("[[light]]\nkind = \"directional\"\ndirection = {}\n", list(direction))
}

/// The errors on surfaces that face the light; `None`: too few to count.
fn errors(scene: &Scene, truth: &Truth, keys: &str, renderer: &mut Renderer) -> Option<Errors> {
    let keys = format!("technique = \"shadow-map\", size = 1024, {keys}");
    let scene = techniques::with_keys(scene, 0, &keys).unwrap();
    let shade = draw_shade(&scene, 0, renderer).unwrap();
    let errors = compare(truth, &shade, &Band { texels: 2.0, map_size: [1024; 2] }).unwrap().facing;
    (errors.compared > 500).then_some(errors)
}

fn warnings(scene: &Scene, keys: &str) -> Vec<String> {
    let keys = format!("technique = \"shadow-map\", size = 1024, {keys}");
    let scene = techniques::with_keys(scene, 0, &keys).unwrap();
    glumbra::plan::make(&scene, &glumbra::plan::Request::default()).unwrap().warnings
}

fn truth(scene: &Scene) -> Option<Truth> {
    truth::trace(scene, 0, &truth::Options { most_ambiguous: 0.2, ..Default::default() }).ok()
}

const LOOKUPS: &[&str] = &[
    "bias = \"offset\"",
    "filter = \"nearest\"",
    "kernel = \"5x5\"",
    "bias = \"receiver-plane\", kernel = \"3x3\"",
    "bias = \"normal-offset\"",
    "bias = \"adaptive\"",
    "mipmaps = \"8-tap\"",
    "fit = \"casters\"",
    "fit = \"view\", compare = \"gequal\"",
    "addressing = \"direct3d\", transfer = \"copy\"",
    "compare = \"gequal\", format = \"depth32f\"",
    "into = \"stencil\"",
];

/// The box of a directional light ends where nothing lies behind its casters, and a floor that is a caster itself reaches
/// on: what of it lies beyond the box is lit, whatever the box's outermost texels hold.
#[test]
fn a_floor_beyond_the_box_of_a_sun_is_lit() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for height in [0.4, 0.49, 0.499, 0.5, 0.51, 0.55, 0.6] {
        for direction in [[0.4, -1.0, 0.3], [-1.0, -0.3, 0.2], [0.0, -1.0, 0.0]] {
            let scene = scene_of(&format!(
                "[image]\nsize = [160, 120]\n[camera]\neye = [3.0, 2.5, 4.0]\ntarget = [0.0, 0.6, 0.0]\nfov_y = 60.0\n\
                 [[light]]\nkind = \"directional\"\ndirection = {}\n\
                 [[object]]\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\n\
                 [[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [0.0, {height:?}, 0.0]\n",
                list(direction)
            ));
            let truth = truth(&scene).unwrap();
            for keys in LOOKUPS {
                let errors = errors(&scene, &truth, keys, &mut renderer).unwrap();
                assert!(errors.wrong_percent < 0.4, "{height}, {direction:?}, {keys}: {} %", errors.wrong_percent);
            }
        }
    }
}

#[test]
fn random_scenes_under_a_sun() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut compared = 0;
    for seed in 0..16 {
        let random = &mut Random::new(seed);
        let floor = format!("[[object]]\nmesh = \"quad\"\nscale = {}\n", list([random.within(2.0, 8.0), 1.0, 8.0]));
        let scene = scene_of(&format!("{}{}{floor}{}", camera(random), sun(random), objects(random)));
        let Some(truth) = truth(&scene) else { continue };
        for keys in LOOKUPS {
            let Some(errors) = errors(&scene, &truth, keys, &mut renderer) else { continue };
            assert!(errors.wrong_percent < 1.5, "{seed}, {keys}: {} %", errors.wrong_percent);
            compared += errors.compared;
        }
    }
    assert!(compared > 500_000, "{compared}");
}

/// The corners of these floors lie up to 10⁷ units away; light and camera as the README has them. GL clips in f32, whose
/// error there is larger than the scene.
#[test]
fn floors_as_large_as_may_be() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut wrong = Vec::new();
    let spot =
        "kind = \"spot\"\nposition = [2.0, 4.0, 3.0]\ntarget = [0.0, 0.5, 0.0]\ncone = 60.0\nnear = 0.5\nfar = 20.0\n";
    let point = "kind = \"point\"\nposition = [2.0, 4.0, 3.0]\nnear = 0.5\nfar = 200.0\n";
    let sun = "kind = \"directional\"\ndirection = [0.4, -1.0, 0.3]\n";
    for (seed, half) in [30.0, 1e3, 1e5, 2.4e5, 1e6, 1e7].into_iter().enumerate() {
        for light in [spot, point, sun] {
            let angle = Random::new(seed as u64).within(0.0, 90.0);
            // Without a far plane all of the floor is seen. Texels of a sun's map are then too coarse for the picture.
            let far = if seed % 2 == 1 && light != sun { "" } else { "far = 500.0\n" };
            let scene = scene_of(&format!(
                "[image]\nsize = [160, 120]\n[camera]\neye = [3.0, 2.5, 4.0]\ntarget = [0.0, 0.6, 0.0]\n{far}\
                 [[light]]\n{light}\
                 [[object]]\nmesh = \"quad\"\nscale = [{half:?}, 1.0, {half:?}]\nrotate = {{ axis = [0, 1, 0], angle = {angle:?} }}\n\
                 [[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [0.0, 0.5, 0.0]\n",
            ));
            // The ray tracer grants the floor the errors of GL's clipping, and is of two minds about much of it.
            let truth = truth::trace(&scene, 0, &truth::Options { most_ambiguous: 1.0, ..Default::default() }).unwrap();
            let square =
                ["bias = \"receiver-plane\"", "bias = \"normal-offset\"", "bias = \"adaptive\"", "into = \"stencil\""];
            let all = ["bias = \"offset\"", "kernel = \"5x5\"", "compare = \"gequal\", format = \"depth32f\""];
            for keys in all.iter().chain(square.iter().filter(|_| light != point)) {
                let Some(errors) = errors(&scene, &truth, keys, &mut renderer) else { continue };
                // A sun's box is at least a thousandth as wide as it is deep, and an oblique floor makes it deep: its texels
                // are then coarse, up to the share from which on the plan warns.
                let most = if light == sun { 1.5 } else { 0.3 };
                if errors.wrong_percent >= most && warnings(&scene, keys).is_empty() {
                    wrong.push(format!("{half}, {far} {light} {keys}: {} %", errors.wrong_percent));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
