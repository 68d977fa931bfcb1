//! Rules of the key `focus`: what it leaves out, what it refuses, how its passes share images.

use std::collections::HashSet;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::plan::{self, Request};
use glumbra::truth;

use super::{draw, random_scene, spot_of, with_lens};
use crate::support::random::Random;
use crate::support::scene_of;

const TECHNIQUES: [&str; 6] = [
    "technique = \"none\"",
    "technique = \"shadow-map\", size = 256",
    "technique = \"shadow-map\", size = 256, fit = \"view\", casters = \"texel\", transfer = \"copy\"",
    "technique = \"shadow-map\", size = 256, kernel = \"3x3\", bias = \"normal-offset\"",
    "technique = \"midpoint\", size = 256",
    "technique = \"second-depth\", size = 256",
];

/// One lens point, or a lens without a size: the ordinary light, to the bit, and the plan says so.
#[test]
fn one_point_is_no_lens() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(5);
    for technique in TECHNIQUES {
        let scene = random_scene(&mut random, technique, [3.0, 0.2], 8);
        let mut plain = scene.clone();
        spot_of(&mut plain).focus = None;
        let (due, ordinary) = draw(&plain, &mut renderer);
        for (radius, samples, why) in [(0.2, 1, "middle"), (0.0, 64, "radius 0")] {
            let (picture, plan) = draw(&with_lens(&scene, 3.0, radius, samples), &mut renderer);
            assert_eq!(picture, due, "{technique} {radius} {samples}");
            assert_eq!(plan.list, ordinary.list);
            let said = plan.left_out.iter().find(|left| left.what == "focus of light 0").unwrap();
            assert!(said.why.contains(why), "{}", said.why);
        }
    }
}

/// The scene's and truth's lens points are the same, by two computations; their mean is the middle, and all of them lie
/// within the lens, none nearer to another than the area of each allows by much.
#[test]
fn lens_points_follow_their_rule() {
    for samples in [1, 2, 3, 4, 7, 16, 64, 255, 1024, 4096] {
        let focus = glumbra::scene::Focus { distance: 1.0, radius: 2.5, samples };
        let points: Vec<glam::DVec2> = (0..samples).map(|index| focus.lens_point(index)).collect();
        for (is, due) in points.iter().zip(truth::lens_points(samples)) {
            assert!((*is / 2.5 - due).length() < 1e-9, "{samples}: {is} for {due}");
        }
        let mean = points.iter().sum::<glam::DVec2>() / f64::from(samples);
        assert!(mean.length() < 1e-12, "{samples}: {mean}");
        assert!(points.iter().all(|point| point.length() <= 2.5));
        // A disc's second moment is a quarter of the radius squared: 1 / N² off at most, by the areas' middles.
        let moment =
            points.iter().map(|point| point.length_squared()).sum::<f64>() / f64::from(samples) / 2.5_f64.powi(2);
        if samples > 1 {
            let allowed = 1.0 / f64::from(samples);
            assert!((moment - 0.5).abs() <= allowed, "{samples}: {moment}");
        }
        let least = (0..points.len())
            .flat_map(|a| (0..a).map(move |b| (a, b)))
            .map(|(a, b)| points[a].distance(points[b]))
            .fold(f64::INFINITY, f64::min);
        assert!(samples == 1 || least > 0.5 * 2.5 * 2.0 / f64::from(samples).sqrt(), "{samples}: {least}");
    }
}

/// One set of images serves all lens points: memory does not grow with their number. Ambient light is drawn once.
#[test]
fn lens_points_share_their_images() {
    let mut random = Random::new(6);
    for technique in TECHNIQUES {
        let scene = random_scene(&mut random, technique, [3.0, 0.2], 8);
        let images = |samples| {
            let plan = plan::make(&with_lens(&scene, 3.0, 0.2, samples), &Request::default()).unwrap();
            let labels: HashSet<String> = plan.list.passes.iter().map(|pass| pass.label.clone()).collect();
            assert_eq!(labels.len(), plan.list.passes.len(), "{technique}: labels are unique");
            let notes = plan.left_out.len() + plan.chosen.len() + plan.warnings.len();
            (plan.list.images.len(), plan.list.passes.len(), notes)
        };
        let (few, many) = (images(4), images(32));
        assert_eq!(few.0, many.0, "{technique}");
        // What is said of a lens point is that of the first, which lies elsewhere among more of them.
        assert!(few.2.abs_diff(many.2) <= 3, "{technique}: {few:?} {many:?}");
        // Two passes, the surfaces and the sum, are there once.
        assert_eq!((few.1 - 2) * 8, many.1 - 2, "{technique}");
    }
}

/// Surfaces that coincide are lit once, as many lens points as there are.
#[test]
fn coincident_surfaces_are_lit_once() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for seed in 0..4 {
        let scene = random_scene(&mut Random::new(seed), TECHNIQUES[0], [2.0, 0.3], 19);
        let mut twice = scene.clone();
        twice.objects.extend(scene.objects.clone());
        assert_eq!(draw(&scene, &mut renderer).0, draw(&twice, &mut renderer).0, "{seed}");
    }
}

/// Another light, ambient light and lines are there as without the lens; the focused light is added to them.
#[test]
fn other_light_stays() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut scene = random_scene(&mut Random::new(9), TECHNIQUES[1], [2.0, 0.3], 16);
    scene.shading.ambient = [0.1, 0.05, 0.02];
    let mut other = scene.lights[0].clone();
    if let glumbra::scene::LightKind::Spot(spot) = &mut other.kind {
        spot.focus = None;
        spot.frustum.position = -spot.frustum.position;
    }
    let alone = scene.clone();
    scene.lights.push(other);
    let mut without = scene.clone();
    without.lights.remove(0);
    let mut dark = alone.clone();
    dark.lights.clear();
    let [both, first, second, none] = [&scene, &alone, &without, &dark].map(|scene| draw(scene, &mut renderer).0);
    for (index, pixel) in both.iter().enumerate() {
        for k in 0..3 {
            let due = first[index][k] + second[index][k] - none[index][k];
            assert!((pixel[k] - due).abs() < 1e-5, "{index}: {} for {due}", pixel[k]);
        }
    }
}

#[test]
fn what_a_lens_cannot_have_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let refused = |light: &str, shading: &str| {
        let text = format!(
            "[camera]\neye = [0, 1, 4]\ntarget = [0, 0, 0]\n[[object]]\nmesh = \"box\"\n[[light]]\n{light}\n[shading]\n{shading}\n"
        );
        std::fs::write(&path, text).unwrap();
        match glumbra::load(&path, &[]) {
            Err(error) => error.to_string(),
            Ok(loaded) => plan::make(&loaded.scene, &Request::default()).unwrap_err().to_string(),
        }
    };
    let spot = "position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { distance = 3.0, radius = 0.1 }";
    for (light, shading, place, says) in [
        ("kind = \"point\"\nposition = [0, 3, 1]\nfocus = { distance = 3.0, radius = 0.1 }", "", ":9:", "point light"),
        (
            "position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { distance = 0.0, radius = 0.1 }",
            "",
            ":10:",
            "above 0",
        ),
        (
            "position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { distance = 1.0, radius = -0.1 }",
            "",
            ":10:",
            "radius",
        ),
        (
            "position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { distance = 1.0, radius = inf }",
            "",
            ":10:",
            "radius",
        ),
        ("position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { radius = 0.1 }", "", ":10:", "distance"),
        (
            "position = [0, 3, 1]\ntarget = [0, 0, 0]\ncone = 50.0\nfocus = { distance = 1.0, radius = 0.1, samples = 4097 }",
            "",
            ":10:",
            "4096",
        ),
        (&format!("{spot}\ndust = {{ density = 0.1 }}"), "", ":11:", "focus"),
        (&format!("{spot}\nshadow = {{ technique = \"shadow-volume\" }}"), "", ":11:", "stencil bit"),
        (&format!("{spot}\nshadow = {{ technique = \"shadow-map\", into = \"stencil\" }}"), "", ":11:", "stencil bit"),
        (
            &format!("{spot}\nshadow = {{ technique = \"shadow-map\", guard = \"clip-plane\" }}"),
            "",
            ":11:",
            "clip-plane",
        ),
        (&format!("{spot}\nshadow = {{ technique = \"shadow-map\", guard = \"stencil\" }}"), "", ":11:", "stencil"),
        (spot, "lighting = \"per-vertex\"", "light 0", "lighting per vertex"),
    ] {
        let error = refused(light, shading);
        assert!(error.contains(place) && error.contains(says), "{light}: {error}");
    }
    // Without a lens that matters, all of it is allowed.
    let one = spot.replace("radius = 0.1", "radius = 0.1, samples = 1");
    scene_of(&format!(
        "[camera]\neye = [0, 1, 4]\ntarget = [0, 0, 0]\n[[object]]\nmesh = \"box\"\n[[light]]\n{one}\nshadow = {{ technique = \"shadow-volume\" }}\n"
    ));
}
