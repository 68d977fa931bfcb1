//! Numerical stability on stiff and extreme scenes: each is held against ray-traced truth, and each claim has its number.
//!
//! The same scene (a box and a sphere on a floor) is made tiny, huge, far from the origin, lit through stiff frusta, from
//! grazing angles, through narrow and wide cones. What must hold is stated beside each; what GL cannot do is pinned.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::rc::Rc;

use glumbra::context::{self, Context, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth;

/// A box and a sphere on a floor, `scale` times as large and moved by `shift`.
struct Case {
    scale: f64,
    shift: [f64; 3],
    light: [f64; 3],
    target: [f64; 3],
    cone: f64,
    near: f64,
    far: f64,
    shadow: &'static str,
}

const ORDINARY: Case = Case {
    scale: 1.0,
    shift: [0.0; 3],
    light: [2.0, 4.0, 3.0],
    target: [0.0, 0.5, 0.0],
    cone: 60.0,
    near: 0.5,
    far: 20.0,
    shadow: "",
};

impl Case {
    fn text(&self) -> String {
        let point = |p: [f64; 3]| {
            let [x, y, z] = std::array::from_fn(|i| self.scale * p[i] + self.shift[i]);
            format!("[{x:?}, {y:?}, {z:?}]")
        };
        let s = self.scale;
        let mut text = format!(
            "[image]\nsize = [256, 256]\n[camera]\neye = {}\ntarget = {}\nfov_y = 40.0\nnear = {:?}\nfar = {:?}\n",
            point([3.0, 2.5, 4.0]),
            point([0.0, 0.6, 0.0]),
            0.5 * s,
            30.0 * s
        );
        let (position, target) = (point(self.light), point(self.target));
        let (cone, near, far) = (self.cone, self.near * s, self.far * s);
        let light =
            format!("position = {position}\ntarget = {target}\ncone = {cone:?}\nnear = {near:?}\nfar = {far:?}\n");
        write!(
            text,
            "[[light]]\nkind = \"spot\"\n{light}[light.shadow]\ntechnique = \"shadow-map\"\n{}\n",
            self.shadow
        )
        .unwrap();
        for (mesh, place, size) in [
            ("quad", [0.0, 0.0, 0.0], format!("[{:?}, 1.0, {:?}]", 4.0 * s, 4.0 * s)),
            ("box", [-0.7, 0.4, 0.2], format!("{:?}", 0.4 * s)),
            ("sphere", [0.6, 0.5, -0.3], format!("{:?}", 0.5 * s)),
        ] {
            write!(text, "[[object]]\nmesh = \"{mesh}\"\ntranslate = {}\nscale = {size}\n", point(place)).unwrap();
        }
        text
    }

    fn scene(&self) -> Scene {
        let folder = tempfile::tempdir().unwrap();
        let path: PathBuf = folder.path().join("case.toml");
        std::fs::write(&path, self.text()).unwrap();
        glumbra::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", self.text())).scene
    }
}

fn open() -> Rc<dyn Context> {
    context::open(&ContextRequest::default()).unwrap()
}

/// The errors of a case, and that its shade is a number in [0, 1] everywhere.
fn measure(name: &str, case: &Case, renderer: &mut Renderer) -> Metrics {
    let scene = case.scene();
    let truth = truth::trace(&scene, 0, &truth::Options::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let shade = draw_shade(&scene, 0, renderer).unwrap();
    assert!(shade.shade.iter().all(|value| (0.0..=1.0).contains(value)), "{name}");
    let found = compare(&truth, &shade, &Band { texels: 2.0, map_size: [1024; 2] }).unwrap();
    println!(
        "{name:<28} compared {:>6}  facing: false {:>8.4} % (beyond the band {:>8.4} %), leak {:>8.4} %; wrong in all {:>8.4} %; ambiguous {:.2} %",
        found.facing.compared,
        found.facing.false_shadow_percent,
        found.facing.false_shadow.outside_percent,
        found.facing.leak_percent,
        found.all.wrong_percent,
        100.0 * truth.ambiguous_share(),
    );
    found
}

/// Size and place alone do not change a picture: f32 holds 24 bits wherever the camera and the light are near.
#[test]
fn size_and_place() {
    let context = open();
    let mut renderer = Renderer::new(&context);
    let ordinary = measure("ordinary", &ORDINARY, &mut renderer);
    assert!(ordinary.facing.compared > 15_000 && ordinary.all.wrong_percent < 0.6, "{ordinary:?}");
    for (name, scale, shift) in [
        ("a thousandth", 1e-3, [0.0; 3]),
        ("a thousand times", 1e3, [0.0; 3]),
        ("a millionth", 1e-6, [0.0; 3]),
        ("a million times", 1e6, [0.0; 3]),
        ("moved by 10,000", 1.0, [1e4, -2e4, 3e4]),
        ("moved by 1,000,000", 1.0, [1e6, 1e6, -1e6]),
        ("tiny and far", 1e-3, [50.0, 0.0, -20.0]),
    ] {
        let found = measure(name, &Case { scale, shift, ..ORDINARY }, &mut renderer);
        // A handful of pixels at edges may fall to the other side.
        let change = (found.all.wrong_percent - ordinary.all.wrong_percent).abs();
        assert!(change < 0.05, "{name}: {} % against {} %", found.all.wrong_percent, ordinary.all.wrong_percent);
    }
}

/// A stiff light frustum squeezes all of the scene into the last codes of depth. With far/near up to 10⁴ 24 bits and
/// float still tell the surfaces apart; 16 bits do not, which is pinned.
#[test]
fn stiff_frusta() {
    let context = open();
    let mut renderer = Renderer::new(&context);
    for (name, near, far, shadow, most_false, most_leak) in [
        ("far/near 40, 16 bits", 0.5, 20.0, "format = \"depth16\"", 0.5, 1.0),
        ("far/near 1e4, 24 bits", 0.01, 100.0, "format = \"depth24\"", 0.5, 1.0),
        ("far/near 1e4, float", 0.01, 100.0, "format = \"depth32f\"", 0.5, 1.0),
        ("far/near 1e6, 24 bits", 1e-3, 1e3, "format = \"depth24\"", 1.0, 2.0),
    ] {
        let found = measure(name, &Case { near, far, shadow, ..ORDINARY }, &mut renderer).facing;
        assert!(found.false_shadow.outside_percent < most_false, "{name}: {found:?}");
        assert!(found.leak_percent < most_leak, "{name}: {found:?}");
    }
    let coarse = Case { near: 1e-3, far: 1e3, shadow: "format = \"depth16\"", ..ORDINARY };
    let found = measure("far/near 1e6, 16 bits", &coarse, &mut renderer).facing;
    // Two thirds of all shadows, which are 1.2 % of the picture, are gone: nothing is left between occluder and receiver.
    assert!(found.leak_percent > 0.5, "16 bits cannot hold this: {found:?}");
}

/// Grazing light, and cones from a needle to nearly a half space.
#[test]
fn grazing_light_and_odd_cones() {
    let context = open();
    let mut renderer = Renderer::new(&context);
    for (name, case, most_false) in [
        ("grazing, 4 degrees", Case { light: [6.0, 0.45, 1.0], far: 40.0, target: [0.0, 0.3, 0.0], ..ORDINARY }, 1.0),
        ("needle, 2 degrees", Case { light: [20.0, 40.0, 30.0], cone: 2.0, near: 40.0, far: 70.0, ..ORDINARY }, 0.1),
        ("wide, 150 degrees", Case { light: [0.3, 2.5, 0.75], cone: 150.0, near: 0.1, ..ORDINARY }, 2.0),
    ] {
        let found = measure(name, &case, &mut renderer).facing;
        assert!(found.compared > 1000, "{name}: {found:?}");
        assert!(found.false_shadow.outside_percent < most_false, "{name}: {found:?}");
    }
}

/// The four set-ups stay the same to the bit where inverting the projection in f64 would lose half of its digits.
#[test]
fn set_ups_agree_however_stiff() {
    let context = open();
    let mut renderer = Renderer::new(&context);
    for (near, far) in [(0.5, 20.0), (1e-3, 1e3), (1e-6, 1e6)] {
        let mut shades = ["eye", "world", "light", "identity"].map(|set_up| {
            let case = Case { near, far, ..ORDINARY };
            let keys = format!("technique = \"shadow-map\", texgen = \"{set_up}\"");
            let scene = techniques::with_keys(&case.scene(), 0, &keys).unwrap();
            draw_shade(&scene, 0, &mut renderer).unwrap()
        });
        let first = shades[0].clone();
        assert!(first.shade.contains(&0.0) && first.shade.contains(&1.0));
        assert!(shades.iter_mut().all(|shade| *shade == first), "near {near}, far {far}");
    }
}
