//! Scenes by the dozen from a generator, each held against ray-traced truth: casters before the light's near plane and
//! around the light, receivers that cast nothing or lie beyond its far plane, floors without end, cut-outs of any texture,
//! closed and open casters of far sides alone.

use std::fmt::Write as _;

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::pass::Work;
use glumbra::plan::{Plan, Request};
use glumbra::stress;
use glumbra::techniques;
use glumbra::truth::{self, Answer};

/// Reach of a filter of two texels, and one more for surfaces askew to the map.
const BAND_TEXELS: f64 = 3.0;

/// xorshift64.
struct Random(u64);

impl Random {
    fn new(seed: usize) -> Self {
        let mut random = Self(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed as u64 + 1) | 1);
        (0..5).for_each(|_| {
            random.next();
        });
        random
    }

    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.next() * list.len() as f64) as usize % list.len()]
    }

    fn rotation(&mut self) -> String {
        let axis = [self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(0.1, 1.0)];
        format!("rotate = {{ axis = {axis:?}, angle = {:?} }}\n", self.within(0.0, 180.0))
    }

    fn object(&mut self) -> String {
        let mesh = self.pick(&["box", "sphere", "torus", "box"]);
        let (place, scale) = (self.place(1.5, 0.4, 1.6), self.within(0.2, 0.6));
        format!("[[object]]\nmesh = \"{mesh}\"\ntranslate = {place:?}\nscale = {scale:?}\n{}", self.rotation())
    }

    fn place(&mut self, spread: f64, low: f64, high: f64) -> [f64; 3] {
        [self.within(-spread, spread), self.within(low, high), self.within(-spread, spread)]
    }

    /// A camera around the middle and a light above it, whose place this returns.
    fn head(&mut self, kind: &str, near: f64, far: f64) -> (String, [f64; 3]) {
        let (turn, height) = (self.within(0.0, std::f64::consts::TAU), self.within(1.0, 5.0));
        let light = self.place(2.0, 2.5, 4.0);
        let (target, cone) = (self.place(0.5, 0.2, 0.4), self.within(40.0, 85.0));
        let aim = if kind == "point" { String::new() } else { format!("target = {target:?}\n") };
        let ends = match kind {
            "spot" => format!("cone = {cone:?}\nnear = {near:?}\nfar = {far:?}\n"),
            "point" => format!("near = {near:?}\nfar = {far:?}\n"),
            _ => String::new(),
        };
        let eye = [6.0 * turn.cos(), height, 6.0 * turn.sin()];
        let text = format!(
            "[image]\nsize = [120, 90]\n[camera]\neye = {eye:?}\ntarget = [0.0, 0.5, 0.0]\nfov_y = 45.0\nnear = 0.1\nfar = 60.0\n\
             [[light]]\nkind = \"{kind}\"\nposition = {light:?}\n{aim}{ends}"
        );
        (text, light)
    }
}

const FLOOR: &str = "[[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\n";

/// Draws a scene under each of the keys in turn.
struct Judge {
    renderer: Renderer,
    /// True if picture and ray tracer must see the same surfaces. They round endless floors differently.
    same_surfaces: bool,
}

impl Judge {
    fn new() -> Self {
        let context = context::open(&ContextRequest::default()).unwrap();
        Self { renderer: Renderer::new(&context), same_surfaces: false }
    }

    fn judge(&mut self, text: &str, techniques: &[&str], mut check: impl FnMut(&str, &Plan, &Metrics)) {
        let scene = scene_of(text);
        // Floors without end and cut-outs leave much in doubt; what is certain is compared.
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let truth = truth::trace(&scene, 0, &options).unwrap();
        for keys in techniques {
            let scene = techniques::with_keys(&scene, 0, keys).unwrap();
            let plan = self.renderer.plan(&scene, &Request::default()).unwrap();
            let shade = draw_shade(&scene, 0, &mut self.renderer).unwrap();
            let band = Band { texels: BAND_TEXELS, map_size: [1024; 2] };
            let found = compare(&truth, &shade, &band).unwrap();
            check(keys, &plan, &found);
            let lost = truth.pixels.iter().zip(&shade.covered);
            let lost =
                lost.filter(|(pixel, covered)| matches!(pixel.answer, Answer::Lit | Answer::Shadowed) && !**covered);
            assert_eq!(
                if self.same_surfaces { lost.count() + found.left_out.only_drawn } else { 0 },
                0,
                "{keys}: other surfaces are seen\n{text}"
            );
        }
    }
}

/// Two of the pixels that face the light, beyond the band, or 0.3 % of them, may be wrong. A caster a thousandth of a unit
/// beside the light has a shadow edge so magnified that some texels are left.
fn assert_right(keys: &str, found: &Metrics, text: &str) {
    let wrong = found.facing.false_shadow.outside + found.facing.leak.outside;
    let most = (0.003 * found.facing.compared as f64).max(2.0);
    assert!(wrong as f64 <= most, "{keys}: {wrong} wrong of {}\n{text}", found.facing.compared);
}

/// The last object of `near`: small and near the light; around it; a thousandth of a unit beside it, which is then outside
/// of it or inside.
fn around_light(random: &mut Random, kind: usize, light: [f64; 3]) -> String {
    let size = random.within(0.1, 0.6);
    let mesh = random.pick(&["box", "sphere"]);
    let (mesh, place) = match kind {
        0 => (mesh, light.map(|x| x * random.within(0.7, 0.9))),
        1 => (mesh, light.map(|x| x + 0.3 * size * random.within(-1.0, 1.0))),
        _ => {
            let gap = if kind == 2 { 1e-3 } else { -1e-3 };
            let (axis, side) = (random.pick(&[0, 1, 2]), random.pick(&[1.0, -1.0]));
            let mut place = light.map(|x| x + size * random.within(-0.7, 0.7));
            place[axis] = light[axis] - side * (size + gap);
            ("box", place)
        }
    };
    format!("[[object]]\nmesh = \"{mesh}\"\nscale = {size:?}\ntranslate = {place:?}\n")
}

#[test]
fn casters_before_the_near_plane_and_around_the_light_cast() {
    let mut judge = Judge::new();
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let near = if seed % 4 == 0 { random.within(1.0, 3.0) } else { random.within(0.05, 1.0) };
        let is_point = seed % 8 >= 4;
        let (mut text, light) = random.head(if is_point { "point" } else { "spot" }, near, 20.0);
        text += FLOOR;
        (0..3).for_each(|_| text += &random.object());
        text += &around_light(&mut random, seed % 4, light);
        let one_map: &[&str] = &[
            "technique = \"shadow-map\"",
            "technique = \"shadow-map\", compare = \"gequal\", format = \"depth32f\", fit = \"view\"",
            "technique = \"midpoint\"",
            "technique = \"second-depth\", closed = \"assume\"",
            "technique = \"shadow-volume\"",
        ];
        let six: &[&str] = &[
            "technique = \"shadow-map\"",
            "technique = \"shadow-map\", compare = \"gequal\"",
            "technique = \"shadow-volume\"",
        ];
        judge.judge(&text, if is_point { six } else { one_map }, |keys, plan, found| {
            assert_right(keys, found, &text);
            // Depth is clamped where the plan says why, and nowhere else.
            let clamped = |pass: &glumbra::pass::Pass| {
                matches!(&pass.work, Work::Draw(draw) if draw.state.depth_clamp && draw.target.color.is_none())
            };
            let is_said = plan.chosen.iter().any(|chosen| chosen.choice == "GL_DEPTH_CLAMP");
            let is_map = !keys.contains("volume");
            assert!(!is_map || plan.list.passes.iter().any(clamped) == is_said, "{keys}: {:?}", plan.chosen);
        });
    }
}

#[test]
fn midpoint_maps_need_no_offset_whatever_casts_nothing_or_lies_beyond_far() {
    let mut judge = Judge::new();
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let (kind, far) = (["spot", "spot", "directional"][seed % 3], [30.0, random.within(3.0, 5.0)][seed % 2]);
        let (mut text, _) = random.head(kind, 0.4, far);
        let half = if seed % 4 == 3 { 10_f64.powf(random.within(3.5, 5.5)) } else { 4.0 };
        let _ = write!(text, "[[object]]\nmesh = \"quad\"\nscale = [{half:?}, 1.0, {half:?}]\n");
        text += random.pick(&["", "casts_shadow = false\n"]);
        for _ in 0..5 {
            text += &random.object();
            text += random.pick(&["", "", "casts_shadow = false\n"]);
        }
        let techniques = [
            "technique = \"midpoint\"",
            "technique = \"midpoint\", average = \"eye-linear\", compare = \"gequal\", format = \"depth32f\"",
            "technique = \"midpoint\", cull = \"back\"",
        ];
        judge.judge(&text, &techniques, |keys, plan, found| {
            assert_right(keys, found, &text);
            let offset = |pass: &glumbra::pass::Pass| {
                matches!(&pass.work, Work::Draw(draw) if draw.state.polygon_offset.is_some())
            };
            assert!(!plan.list.passes.iter().any(offset), "{keys}\n{text}");
        });
    }
}

/// The scene of the sample program with Woo's map.
#[test]
fn the_sample_program_has_no_acne_without_offset() {
    let mut judge = Judge::new();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/hw_shadowmaps_simple.toml");
    let scene = glumbra::load(path.as_ref(), &[]).unwrap().scene;
    let truth = truth::trace(&scene, 0, &truth::Options::default()).unwrap();
    let keys = "technique = \"midpoint\", size = 1024, offset = { factor = 0.0 }";
    let scene = techniques::with_keys(&scene, 0, keys).unwrap();
    let shade = draw_shade(&scene, 0, &mut judge.renderer).unwrap();
    let found = compare(&truth, &shade, &Band { texels: BAND_TEXELS, map_size: [1024; 2] }).unwrap();
    // At the rims of the teapot's parts, where both layers meet; acne on the floor would be ten thousands.
    assert!(found.facing.false_shadow_percent < 0.1, "{}", found.facing.false_shadow_percent);
}

/// A texture's alpha: checks, noise, waves or stripes.
fn alpha(random: &mut Random, kind: u32, x: f64, y: f64, count: f64) -> f64 {
    let stripe = |x: f64| ((2.0 * count * x) as u32).is_multiple_of(2);
    match kind {
        0 => f64::from(u8::from(stripe(x) != stripe(y))),
        1 => random.next(),
        2 => {
            0.5 + 0.5
                * (std::f64::consts::TAU * count.floor() * x).sin()
                * (std::f64::consts::TAU * count.floor() * y).cos()
        }
        _ => {
            if stripe(x) {
                1.0
            } else {
                0.2
            }
        }
    }
}

/// Holes are where the ray tracer has them, for the eye and for the light, however small or large a texel is on either's
/// picture. What is smaller than the map's texels it can only show by chance: that is in the band of the true edges.
#[test]
fn holes_of_any_texture_are_the_same_to_eye_light_and_oracle() {
    let folder = tempfile::tempdir().unwrap();
    let mut judge = Judge { same_surfaces: true, ..Judge::new() };
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let (size, kind, count) = (random.pick(&[4_u32, 8, 16, 64, 256]), seed as u32 % 4, random.within(1.0, 6.0));
        let picture = image::RgbaImage::from_fn(size, size, |x, y| {
            let [x, y] = [x, y].map(|texel| f64::from(texel) / f64::from(size));
            image::Rgba([255, 200, 100, (255.0 * alpha(&mut random, kind, x, y, count)) as u8])
        });
        let path = folder.path().join(format!("{seed}.png"));
        picture.save(&path).unwrap();
        let (mut text, _) = random.head("spot", 0.4, 30.0);
        text += FLOOR;
        for x in [-1.2, 0.0, 1.2] {
            let scale = random.pick(&[0.3, 1.0, 7.0, 40.0]);
            let slot = random.pick(&["alpha", "decal"]);
            let place = [x, random.within(0.8, 1.6), random.within(-1.0, 1.0)];
            let (half, turned) = (random.within(0.4, 1.0), random.rotation());
            let planes = "s = [0.5, 0.0, 0.0, 0.5], t = [0.0, 0.0, -0.5, 0.5]";
            let _ = write!(
                text,
                "[[object]]\nmesh = \"quad\"\nscale = {half:?}\ntranslate = {place:?}\n{turned}\
                 material = {{ {slot} = {path:?}, texgen = {{ {planes}, scale = {scale:?} }} }}\n"
            );
        }
        judge.judge(&text, &["technique = \"shadow-map\", size = 4096"], |keys, _, found| {
            assert_right(keys, found, &text)
        });
    }
}

/// Closed casters, apart, stacked face on face and through one another: right as they are. Open ones that lose a shadow that
/// is seen are named.
#[test]
fn far_sides_are_right_or_named() {
    let mut judge = Judge::new();
    let (mut wrong, mut named) = (0, 0);
    for seed in 0..30 {
        let mut random = Random::new(seed);
        let (mut text, _) = random.head("spot", 0.4, 30.0);
        text += FLOOR;
        text += random.pick(&["", "casts_shadow = false\n"]);
        for i in 0..4 {
            let (x, half) = (-2.1 + 1.4 * f64::from(i), random.within(0.2, 0.7));
            match seed % 3 {
                0 => text += &random.object(),
                1 => {
                    let place = [random.within(-0.3, 0.3), 0.2 + 0.4 * f64::from(i), random.within(-0.3, 0.3)];
                    let _ = write!(
                        text,
                        "[[object]]\nmesh = \"box\"\nscale = [{half:?}, 0.2, 0.5]\ntranslate = {place:?}\n"
                    );
                }
                _ => {
                    let mesh = random.pick(&["quad", "box", "sphere"]);
                    let place = [x, random.within(0.9, 1.4), random.within(-1.0, 1.0)];
                    let (angle, half) = (random.within(-40.0, 40.0), 0.7 * half);
                    let _ = write!(
                        text,
                        "[[object]]\nmesh = \"{mesh}\"\nscale = {half:?}\ntranslate = {place:?}\nrotate = {{ axis = [1, 0, 1], angle = {angle:?} }}\n"
                    );
                }
            }
        }
        judge.judge(&text, &["technique = \"second-depth\", closed = \"assume\""], |keys, plan, found| {
            let is_named = plan.warnings.iter().any(|warning| warning.contains("has no far side"));
            let percent = found.facing.wrong_percent;
            assert!(percent < 1.5 || is_named, "{keys}: {percent:.2} % wrong\n{text}");
            wrong += usize::from(percent >= 1.5);
            named += usize::from(is_named);
        });
    }
    assert!(wrong > 2 && named <= 10, "{wrong} wrong, {named} named: only a third have open casters");
}

/// Random scenes and named cases, drawn by every setting of the technique: right, or warned of.
fn assert_nothing_silently_wrong(technique: &str, named: &[&str]) {
    let named = stress::named::cases().unwrap().into_iter().filter(|case| named.contains(&case.name.as_str()));
    let cases: Vec<_> = (10..30).map(|index| stress::random::case(1, index)).chain(named).collect();
    let options = stress::StressOptions {
        jobs: 2,
        technique: Some(technique.to_owned()),
        one_in: 1,
        pictures: false,
        context: ContextRequest::default(),
    };
    let mut wrong = Vec::new();
    stress::run(&cases, &options, &Default::default(), |_, result| {
        let rows = result.rows.iter().filter(|row| row.verdict == stress::Verdict::SilentlyWrong);
        wrong.extend(rows.map(|row| format!("{}, light {}: {}", result.name, row.light, row.settings.to_inline())));
    })
    .unwrap();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Wound both ways, inwards, given in both windings, open: what a map of far sides loses is found by rays.
#[test]
fn far_sides_are_never_silently_wrong() {
    assert_nothing_silently_wrong("second-depth", &["mesh-mixed-box-spot", "mesh-both-sides-spot", "cone-1.789e2"]);
}

/// A square given in both windings is one layer in float maps, too; too few codes or texels are said.
#[test]
fn midpoints_are_never_silently_wrong() {
    assert_nothing_silently_wrong(
        "midpoint",
        &["mesh-both-sides-spot", "cone-1.789e2", "map-size-1e0", "light-near-1e8"],
    );
}

/// A floor behind which nothing lies needs no far side, and closed casters are not refused for it.
#[test]
fn floors_need_no_far_side() {
    let mut judge = Judge::new();
    for seed in 0..4 {
        let mut random = Random::new(seed);
        let (mut text, _) = random.head("spot", 0.4, 30.0);
        text += FLOOR;
        text += "[[object]]\nmesh = \"box\"\nscale = 0.4\ntranslate = [0.0, 0.8, 0.0]\n";
        judge.judge(&text, &["technique = \"second-depth\""], |keys, _, found| assert_right(keys, found, &text));
    }
}
