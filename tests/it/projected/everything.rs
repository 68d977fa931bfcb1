//! Pictures of slide projectors, alpha shadows, lenses, dusty air and waving objects against colours in f64, pixel by pixel:
//! random scenes of each kind, in 8 bits and in floats. The same scenes, changed by little: the difference is seen.

use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::Request;
use glumbra::scene::{LightKind, Scene};
use glumbra::truth::{self, ColorRequest, ColorTruth};

use super::colors::{ALLOWED, SMOOTH, admitted, light, objects, picture};
use super::{load, renderer};
use crate::support::random::Random;

/// Kinds of scene, by what they have beside images, beams and laws of distance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Slides,
    /// Projectors of slides among lit lights, in one pass.
    SlidesInOnePass,
    AlphaShadows,
    Lens,
    SlidesThroughLenses,
    Dust,
    DustOnSlides,
    Waves,
}

const KINDS: [Kind; 8] = [
    Kind::Slides,
    Kind::SlidesInOnePass,
    Kind::AlphaShadows,
    Kind::Lens,
    Kind::SlidesThroughLenses,
    Kind::Dust,
    Kind::DustOnSlides,
    Kind::Waves,
];

fn focus(random: &mut Random) -> String {
    let [distance, radius] = [random.size(0.5, 20.0), random.size(0.02, 0.8)];
    format!("focus = {{ distance = {distance:?}, radius = {radius:?}, samples = {} }}\n", random.pick(&[2, 3, 5, 8]))
}

fn dust(random: &mut Random) -> String {
    let blend = random.pick(&["blend = \"over\"", "blend = \"over\", extinct = \"all\"", "blend = \"add\""]);
    let thickness = random.pick(&["ray", "ray", "axis"]);
    let (density, slices) = (random.size(0.02, 2.0), random.pick(&[1, 2, 7, 24, 64]));
    format!("dust = {{ density = {density:?}, slices = {slices}, {blend}, thickness = \"{thickness}\" }}\n")
}

/// Some of the objects wave.
fn waving(random: &mut Random, objects: &str) -> String {
    let mut text = String::new();
    for part in objects.split_inclusive("[[object]]\n") {
        text += part;
        if part.ends_with("[[object]]\n") && random.share() < 0.6 {
            text += &format!(
                "wave = {{ direction = {:?}, axis = {:?}, amplitude = {:?}, wavelength = {:?}, phase = {:?} }}\n",
                random.vector().to_array(),
                random.vector().to_array(),
                random.within(0.02, 0.3),
                random.within(0.6, 3.0),
                random.share()
            );
        }
    }
    text
}

fn scene(kind: Kind, random: &mut Random) -> (Scene, String) {
    let (turn, height) = (random.within(0.0, std::f64::consts::TAU), random.pick(&[0.5, 1.5, 3.0, 5.0]));
    let eye = [5.0 * turn.cos(), height, 5.0 * turn.sin()];
    let passes = match kind {
        Kind::Slides | Kind::SlidesThroughLenses | Kind::DustOnSlides => "slide",
        Kind::AlphaShadows => "shadow",
        _ => "one",
    };
    let background = if passes == "slide" { random.pick(&["scene", "ambient"]) } else { "scene" };
    let lighting =
        if kind == Kind::AlphaShadows { random.pick(&["per-fragment", "per-vertex"]) } else { "per-fragment" };
    let mut text = format!(
        "[image]\nsize = [96, 72]\nbackground = [0.2, 0.1, 0.3]\n[camera]\neye = {eye:?}\ntarget = [0.0, 0.4, 0.0]\nfov_y = 45.0\nnear = 0.1\nfar = 60.0\n\
         [shading]\nambient = [{:?}, 0.05, 0.09]\npasses = \"{passes}\"\nbackground = \"{background}\"\nlighting = \"{lighting}\"\n",
        random.pick(&[0.06, 0.06, 0.9])
    );
    for number in 0..1 + random.below(3) {
        let more = match kind {
            Kind::Slides => String::from("law = \"slide\"\n"),
            Kind::SlidesInOnePass if number % 2 == 0 => String::from("law = \"slide\"\n"),
            Kind::SlidesInOnePass | Kind::AlphaShadows | Kind::Waves => String::new(),
            Kind::Lens => focus(random),
            // One without a lens among them.
            Kind::SlidesThroughLenses if number == 1 => String::from("law = \"slide\"\n"),
            Kind::SlidesThroughLenses => String::from("law = \"slide\"\n") + &focus(random),
            Kind::Dust => dust(random),
            Kind::DustOnSlides => String::from("law = \"slide\"\n") + &dust(random),
        };
        text += &light(random, "technique = \"none\"", &more);
    }
    let objects = objects(random);
    text += &if kind == Kind::Waves { waving(random, &objects) } else { objects };
    let pictures = [picture(random), picture(random), picture(random)];
    let named = [("slide.png", &pictures[0]), ("shield.png", &pictures[1]), ("decal.png", &pictures[2])];
    (load(&text, &named).scene, text)
}

/// The picture's codes of 1/255, which are whole in 8 bits.
fn draw(scene: &Scene, float_picture: bool, renderer: &mut Renderer) -> Vec<[f64; 3]> {
    let request = Request { float_picture, sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request).unwrap();
    renderer.draw(&plan).unwrap();
    let codes: Vec<f64> = match renderer.read(&plan).unwrap().picture {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f64::from(*code)).collect(),
        Pixels::RgbaF32 { data, .. } => data.iter().map(|value| 255.0 * f64::from(*value)).collect(),
        other => panic!("{:?}", other.size()),
    };
    codes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

#[derive(Default)]
struct Judged {
    smooth: usize,
    bounded: usize,
    /// Codes beyond what tables and passes admit.
    worst: f64,
    wrong: usize,
    /// The first wrong pixel.
    first: String,
}

fn judge(truth: &ColorTruth, codes: &[[f64; 3]], admitted: f64) -> Judged {
    let mut judged = Judged::default();
    for (index, (pixel, found)) in truth.pixels.iter().zip(codes).enumerate().filter(|(_, (pixel, _))| pixel.is_known) {
        let off = if pixel.is_smooth(SMOOTH) {
            judged.smooth += 1;
            pixel.error_codes(*found)
        } else {
            judged.bounded += 1;
            pixel.excess_codes(*found)
        };
        // What is brighter than 1, in floats, is off by as much more.
        let bright = pixel.rgb.iter().map(|channel| channel.most).fold(1.0, f64::max);
        let off = off / bright - admitted - truth.between_passes_codes;
        judged.worst = judged.worst.max(off);
        if off > ALLOWED {
            judged.wrong += 1;
            if judged.first.is_empty() {
                let bounds = pixel.rgb.map(|channel| [channel.least, channel.value, channel.most].map(|v| 255.0 * v));
                judged.first = format!("pixel {} {}: {found:?}, not {bounds:?}", index % 96, index / 96);
            }
        }
    }
    judged
}

fn true_colors(scene: &Scene, float_picture: bool) -> ColorTruth {
    let request = ColorRequest { float_picture, ..ColorRequest::default() };
    truth::color_as(scene, &vec![None; scene.lights.len()], &request, &truth::Options::default()).unwrap()
}

#[test]
fn random_scenes_of_every_kind_have_the_colours_of_f64() {
    let (_context, mut renderer) = renderer();
    let only = std::env::var("GLUMBRA_ROUND").ok();
    let mut failures = Vec::new();
    for kind in KINDS {
        let (mut smooth, mut bounded, mut worst) = (0, 0, 0.0_f64);
        for round in 0..8 {
            if only.as_ref().is_some_and(|only| *only != format!("{kind:?}-{round}")) {
                continue;
            }
            let mut random = Random::new(9000 + 100 * kind as u64 + round);
            let (scene, text) = scene(kind, &mut random);
            for float_picture in [false, true] {
                let truth = true_colors(&scene, float_picture);
                let judged = judge(&truth, &draw(&scene, float_picture, &mut renderer), admitted(&scene));
                smooth += judged.smooth;
                bounded += judged.bounded;
                worst = worst.max(judged.worst);
                if judged.wrong > 0 {
                    failures.push(format!(
                        "{kind:?}-{round}, float {float_picture}: {} wrong; {}\n{text}",
                        judged.wrong, judged.first
                    ));
                }
            }
        }
        println!("{kind:?}: {smooth} smooth, {bounded} bounded, worst {worst:.2} codes");
        assert!(only.is_some() || smooth > 15_000, "{kind:?}: {smooth} smooth, {bounded} bounded");
    }
    assert!(failures.is_empty(), "{} scenes:\n{}", failures.len(), failures.join("\n"));
}

/// Pictures of a scene that was changed by little, against the truth of the scene itself.
#[test]
fn what_is_drawn_otherwise_is_seen() {
    type Change = (Kind, &'static str, fn(&mut Scene));
    let changes: [Change; 8] = [
        (Kind::Slides, "a lit light", |scene| {
            scene.shading.passes = glumbra::scene::PicturePasses::One;
            scene.lights.iter_mut().for_each(|light| light.law = glumbra::scene::Law::Lit);
        }),
        (Kind::Slides, "the other aspect", |scene| change_spots(scene, |spot| spot.frustum.aspect *= 1.1)),
        (Kind::Lens, "a wider lens", |scene| {
            change_spots(scene, |spot| spot.focus.iter_mut().for_each(|focus| focus.radius *= 1.5));
        }),
        (Kind::Lens, "another focal plane", |scene| {
            change_spots(scene, |spot| spot.focus.iter_mut().for_each(|focus| focus.distance *= 0.25));
        }),
        (Kind::Dust, "denser air", |scene| change_dust(scene, |dust| dust.density *= 1.15)),
        (Kind::Dust, "other thicknesses", |scene| {
            change_dust(scene, |dust| dust.thickness_along_ray = !dust.thickness_along_ray);
        }),
        (Kind::DustOnSlides, "another blend", |scene| {
            change_dust(scene, |dust| dust.hides_in_shadow = !dust.hides_in_shadow);
            change_dust(scene, |dust| dust.slices += 3);
        }),
        (Kind::Waves, "another phase", |scene| {
            scene.objects.iter_mut().filter_map(|object| object.wave.as_mut()).for_each(|wave| wave.phase += 0.05);
        }),
    ];
    let (_context, mut renderer) = renderer();
    for (kind, name, change) in changes {
        let mut seen = 0;
        for round in 0..6 {
            let (scene, _) = scene(kind, &mut Random::new(9000 + 100 * kind as u64 + round));
            let mut changed = scene.clone();
            change(&mut changed);
            let judged = judge(&true_colors(&scene, true), &draw(&changed, true, &mut renderer), admitted(&scene));
            seen += usize::from(judged.wrong > 20);
        }
        println!("{kind:?}, {name}: seen in {seen} of 6");
        assert!(seen >= 2, "{kind:?}, {name}: seen in {seen} of 6");
    }
}

fn change_spots(scene: &mut Scene, change: impl Fn(&mut glumbra::scene::Spot)) {
    for light in &mut scene.lights {
        if let LightKind::Spot(spot) = &mut light.kind {
            change(spot);
        }
    }
}

fn change_dust(scene: &mut Scene, change: impl Fn(&mut glumbra::scene::Dust)) {
    scene.lights.iter_mut().filter_map(|light| light.dust.as_mut()).for_each(change);
}

/// Two ways to the same light in f64: through a lens, by rays to its points, with shadows; and in air, layer by layer.
#[test]
fn colours_agree_with_the_other_truths() {
    let mut random = Random::new(71);
    let mut compared = [0, 0];
    for _ in 0..6 {
        let white = "[image]\nsize = [48, 36]\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n[camera]\neye = [3.0, 2.5, 3.0]\n\
             target = [0, 0.4, 0]\nfov_y = 45.0\nnear = 0.1\nfar = 30.0\n";
        let place = (glam::DVec3::new(0.0, 3.0, 0.0) + random.vector()).to_array();
        let objects = objects(&mut random);
        let objects: String = objects
            .lines()
            .filter(|line| !line.starts_with("material") && !line.starts_with("lit"))
            .map(|line| format!("{line}\n"))
            .collect();
        let spot = |more: &str| {
            format!(
                "{white}[[light]]\nkind = \"spot\"\nposition = {place:?}\ntarget = [0, 0.3, 0]\ncone = 60.0\nnear = 0.3\nfar = 9.0\n\
                 attenuation = [0.7, 0.1, 0.01]\n{more}shadow = {{ technique = \"shadow-map\" }}\n{objects}"
            )
        };
        let mut soft = load(&spot(&focus(&mut random)), &[]).scene;
        let material = std::sync::Arc::new(glumbra::geometry::Material {
            diffuse: [1.0; 3],
            specular: [0.0; 3],
            ..Default::default()
        });
        for object in &mut soft.objects {
            object.material = Some(material.clone());
        }
        let points = truth::lens_points(soft.lights[0].spot().unwrap().focus.unwrap().samples);
        let lens = truth::lens(&soft, 0, &points).unwrap().unwrap();
        let request = ColorRequest { float_picture: true, ..ColorRequest::default() };
        let options = truth::Options::default();
        let colors = truth::color_as(&soft, &[Some(0.0)], &request, &options).unwrap();
        let is_flat = |object: Option<u32>| {
            object.is_some_and(|object| {
                ["quad", "box"].iter().any(|flat| soft.objects[object as usize].mesh.name.contains(flat))
            })
        };
        for (lens, color) in lens.iter().zip(&colors.pixels) {
            // Rays know no smooth normals.
            if is_flat(lens.object) && color.is_known {
                compared[0] += 1;
                let off = (0..3).map(|k| (color.rgb[k].value - lens.light[k]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-9, "{lens:?}: {:?}", color.rgb);
            }
        }
        let mut dusty = load(&spot("dust = { density = 0.3, slices = 40 }\n"), &[]).scene;
        dusty.lights[0].diffuse = [0.9, 0.8, 0.7];
        let colors = truth::color_as(&dusty, &[Some(0.0)], &ColorRequest { slices: Some(900), ..request }, &options);
        let air = truth::dust(&dusty, 0, 900).unwrap().unwrap();
        let mut clear = dusty.clone();
        clear.lights[0].dust = None;
        let clear = truth::color_as(&clear, &[Some(0.0)], &request, &options).unwrap();
        for ((color, air), clear) in colors.unwrap().pixels.iter().zip(&air).zip(&clear.pixels) {
            if color.is_known && clear.is_known {
                compared[1] += 1;
                let due = |k: usize| clear.rgb[k].value * (1.0 - air.opacity) + air.color[k];
                let off = (0..3).map(|k| (color.rgb[k].value - due(k)).abs()).fold(0.0, f64::max);
                // Both are sums of layers, off by a layer's share at each end of a beam and at each shadow in it.
                assert!(off < 4e-3, "{off}: {:?}, {:?}", color.rgb, [0, 1, 2].map(due));
            }
        }
    }
    println!("{compared:?} pixels compared");
    assert!(compared[0] > 1000 && compared[1] > 3000, "{compared:?}");
}

/// Without any light there are colours, too; what cannot be known is said.
#[test]
fn scenes_without_light_have_colours_and_noise_has_none() {
    let text = "[image]\nsize = [32, 24]\nbackground = [0.5, 0.25, 0.0]\n[camera]\neye = [0, 3, 3]\ntarget = [0, 0, 0]\n\
                [shading]\npasses = \"slide\"\nambient = [0.5, 0.25, 0.125]\n[[object]]\nmesh = \"quad\"\n\
                material = { diffuse = [0.5, 1.0, 0.5] }\n";
    let scene = load(text, &[]).scene;
    let options = truth::Options::default();
    let truth = truth::color(&scene, &[], &options).unwrap();
    assert_eq!(truth.pixels[0].rgb.map(|channel| channel.value), [0.5, 0.25, 0.0]);
    let middle = truth.pixels[32 * 12 + 16];
    assert_eq!(middle.rgb.map(|channel| channel.value), [0.25, 0.25, 0.0625]);
    let light = |more: &str| {
        text.replace("passes = \"slide\"", "")
            + &format!("[[light]]\nkind = \"spot\"\nposition = [0, 2, 1]\ntarget = [0, 0, 0]\ncone = 40.0\n{more}\n")
    };
    for (more, why) in [
        ("dust = { density = 1.0, jitter = true }", "noise has no one colour"),
        ("frustum = \"shown\"", "lines of its frustum"),
    ] {
        let scene = load(&light(more), &[]).scene;
        let error = truth::color(&scene, &[None], &options).unwrap_err().to_string();
        assert!(error.contains("light 0") && error.contains(why), "{error}");
    }
}

/// A report says what it compares colours with where the ray tracer has none, and why it has none.
#[test]
fn a_report_says_what_colours_are_compared_with() {
    use glumbra::report::measure::grid::Grid;
    use glumbra::report::measure::run::{MeasureOptions, prepare};

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    for jitter in [true, false] {
        let text = format!(
            "[image]\nsize = [32, 24]\n[camera]\neye = [0, 3, 3]\ntarget = [0, 0, 0]\n[[object]]\nmesh = \"quad\"\n[[light]]\n\
             kind = \"spot\"\nposition = [0, 2, 1]\ntarget = [0, 0, 0]\ncone = 40.0\ndust = {{ density = 0.1, jitter = {jitter} }}\n\
             shadow = {{ technique = \"shadow-map\", size = 64 }}\n"
        );
        std::fs::write(&path, text).unwrap();
        let options =
            MeasureOptions { light: 0, runs: 1, jobs: 1, shard: (1, 1), band_texels: 2.0, context: Default::default() };
        let sweep = prepare(&path, &[], &Grid::Own(Vec::new()), &options).unwrap();
        let from = sweep.report.colors_from.unwrap_or_default();
        assert_eq!(from.contains("the ray tracer has no colours") && from.contains("noise"), jitter, "{from}");
    }
}
