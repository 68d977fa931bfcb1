//! Soft shadows of a lens, against rays to its points in f64, against many random points of it, and against closed forms.

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::plan::{self, Request};
use glumbra::scene::Scene;
use glumbra::truth::{self, LensLight};

use super::{draw, random_points, random_scene, with_lens};
use crate::support::random::Random;
use crate::support::scene_of;

/// Differences of a picture from what truth found, largest channel of each pixel.
fn errors(picture: &[[f64; 3]], due: &[LensLight]) -> Vec<f64> {
    let error = |(is, due): (&[f64; 3], &LensLight)| (0..3).map(|k| (is[k] - due.light[k]).abs()).fold(0.0, f64::max);
    picture.iter().zip(due).map(error).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count.max(1))
}

fn rms(values: &[f64]) -> f64 {
    mean(values.iter().map(|value| value * value)).sqrt()
}

const SCENES: usize = 30;

/// Without shadows every lens point's light ends at the sides of its own frustum, and falls at its own angle: but for
/// rounding at those sides and at the edges of surfaces, the picture is truth's. There a pixel is off by a share of a lens
/// point's light, or shows another surface.
#[test]
fn each_lens_point_lights_from_its_own_place() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(401);
    let mut lit = 0;
    for number in 0..SCENES {
        let focus = [random.size(0.2, 20.0), random.size(0.02, 2.0)];
        let samples = random.pick(&[2, 3, 9, 16]);
        let mut scene = random_scene(&mut random, "technique = \"none\"", focus, samples);
        scene.objects.iter_mut().for_each(|object| object.casts_shadow = false);
        let due = truth::lens(&scene, 0, &truth::lens_points(samples)).unwrap().unwrap();
        let errors = errors(&draw(&scene, &mut renderer).0, &due);
        lit += due.iter().filter(|due| due.share > 0.0).count();
        let off = errors.iter().filter(|error| **error > 1e-5).count();
        assert!(100 * off <= errors.len(), "scene {number}, {focus:?}, {samples}: {off} of {} are off", errors.len());
    }
    assert!(lit > 20_000, "only {lit} pixels are lit");
}

/// With shadows each lens point's map decides at its texels: on the average over the picture by far less than what the
/// shadows take.
#[test]
fn soft_shadows_are_the_mean_of_rays() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(402);
    let (mut shadowed, mut softened) = (0, 0);
    for number in 0..SCENES {
        let focus = [random.size(0.5, 20.0), random.size(0.02, 0.6)];
        let technique = random.pick(&[
            "technique = \"shadow-map\", size = 1024",
            "technique = \"shadow-map\", size = 1024, fit = \"view\", casters = \"texel\"",
            "technique = \"shadow-map\", size = 1024, kernel = \"3x3\", bias = \"normal-offset\"",
            "technique = \"shadow-map\", size = 1024, bias = \"receiver-plane\", addressing = \"direct3d\"",
            "technique = \"second-depth\", size = 1024",
            "technique = \"midpoint\", size = 1024",
        ]);
        let scene = random_scene(&mut random, technique, focus, 12);
        let points = truth::lens_points(12);
        let due = truth::lens(&scene, 0, &points).unwrap().unwrap();
        let mut open = scene.clone();
        open.objects.iter_mut().for_each(|object| object.casts_shadow = false);
        let open = truth::lens(&open, 0, &points).unwrap().unwrap();
        let error = mean(errors(&draw(&scene, &mut renderer).0, &due).into_iter());
        let taken = mean(due.iter().zip(&open).map(|(due, open)| (open.light - due.light).max_element()));
        let hard = with_lens(&scene, focus[0], 0.0, 12);
        let hard = mean(errors(&draw(&hard, &mut renderer).0, &due).into_iter());
        println!("scene {number}, {technique}: off by {error:.5}, shadows {taken:.5}, from one point {hard:.5}");
        shadowed += usize::from(taken > 0.004);
        softened += usize::from(hard > 2e-4 + 4.0 * error);
        assert!(error < 2e-4 + 0.02 * taken, "scene {number}, {technique}: {error:.5} of {taken:.5}");
    }
    assert!(shadowed >= SCENES / 3, "only {shadowed} scenes have shadows");
    assert!(softened >= SCENES / 3, "only {softened} scenes have soft ones");
}

/// A room whose floor and boxes are in the penumbrae of each other.
fn penumbrae(size: [u32; 2]) -> Scene {
    scene_of(&format!(
        "[image]\nsize = {size:?}\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n[camera]\neye = [2.5, 3.0, 4.0]\n\
         target = [0, 0.3, 0]\nfov_y = 40.0\nnear = 0.5\nfar = 20.0\n[[light]]\nkind = \"spot\"\nshape = \"frustum\"\n\
         position = [-1.5, 4.0, 1.0]\ntarget = [0, 0, 0]\ncone = 70.0\nnear = 1.0\nfar = 12.0\ncolor = [1, 1, 1]\n\
         focus = {{ distance = 4.3, radius = 0.5, samples = 4 }}\nshadow = {{ technique = \"shadow-map\", size = 1024 }}\n\
         [[object]]\nmesh = \"quad\"\nscale = 4.0\nmaterial = {{ diffuse = [1, 1, 1], specular = [0, 0, 0] }}\n\
         [[object]]\nmesh = \"box\"\nscale = [0.4, 0.5, 0.4]\ntranslate = [0, 0.5, 0]\n\
         material = {{ diffuse = [1, 1, 1], specular = [0, 0, 0] }}\n\
         [[object]]\nmesh = \"box\"\nscale = [0.6, 0.1, 0.3]\ntranslate = [0.7, 1.4, -0.5]\nrotate = {{ axis = [0, 1, 0], angle = 30 }}\n\
         material = {{ diffuse = [1, 1, 1], specular = [0, 0, 0] }}\n"
    ))
}

/// More lens points come nearer to the lens's whole area: the rms error falls at least as N^-1/2, as that of random points
/// does, until the maps' texels are what is left. The area stands in as many random points, which are off by 0.5 / √count
/// in the middle of a penumbra.
#[test]
fn more_lens_points_come_nearer_to_the_area() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = penumbrae([48, 36]);
    let mut random = Random::new(403);
    let area = truth::lens(&scene, 0, &random_points(&mut random, 6000)).unwrap().unwrap();
    let off = |due: &[LensLight]| {
        rms(&due.iter().zip(&area).map(|(a, b)| (a.light - b.light).abs().max_element()).collect::<Vec<f64>>())
    };
    println!("lens points: rms error of rays, of the picture, of as many random rays; time of the picture");
    let mut rows = Vec::new();
    for samples in [1, 4, 16, 64, 256] {
        let rays = off(&truth::lens(&scene, 0, &truth::lens_points(samples)).unwrap().unwrap());
        let by_chance = random_points(&mut random, samples as usize);
        let chance = off(&truth::lens(&scene, 0, &by_chance).unwrap().unwrap());
        let soft = with_lens(&scene, 4.3, 0.5, samples);
        draw(&soft, &mut renderer);
        let start = std::time::Instant::now();
        let picture = draw(&soft, &mut renderer).0;
        let time = start.elapsed();
        let picture = rms(&errors(&picture, &area));
        println!("{samples:5}: {rays:.5} {picture:.5} {chance:.5}; {:.1} ms", time.as_secs_f64() * 1e3);
        assert!(rays < chance, "{samples}: random points are better");
        rows.push([rays, picture]);
    }
    for pair in rows[..4].windows(2) {
        assert!(pair[1][0] < 0.55 * pair[0][0], "{rows:?}");
    }
    // Texels of a 1024th are off by a share of a pixel at hard edges that remain: where boxes stand on the floor.
    for pair in rows[..3].windows(2) {
        assert!(pair[1][1] < 0.6 * pair[0][1], "{rows:?}");
    }
    assert!(rows[4][1] < 0.04 * rows[0][1], "{rows:?}");
}

/// The edge of a half plane at `height` over a floor that the light shines down on from 10, and the floor as it is seen
/// from below the half plane.
fn edge(height: f64, shadow: &str) -> Scene {
    scene_of(&format!(
        "[image]\nsize = [240, 8]\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n[camera]\neye = [0, 1.5, 0]\n\
         target = [0, 0, 0]\nup = [0, 0, -1]\nfov_y = 1.6\nnear = 0.5\nfar = 3.0\n[[light]]\nkind = \"spot\"\n\
         shape = \"frustum\"\nposition = [0, 10, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\ncone = 40.0\nnear = 1.0\n\
         far = 12.0\ncolor = [1, 1, 1]\nshadow = {{ {shadow} }}\n[[object]]\nmesh = \"quad\"\nscale = 8.0\nlit = false\n\
         casts_shadow = false\nmaterial = {{ diffuse = [1, 1, 1] }}\n[[object]]\nmesh = \"quad\"\nscale = 4.0\n\
         translate = [-4, {height:?}, 0]\n"
    ))
}

/// Width of the ramp from 10 % to 90 % of the light on the floor, in world units.
fn penumbra(scene: &Scene, renderer: &mut Renderer) -> f64 {
    let (picture, _) = draw(scene, renderer);
    let row: Vec<f64> = picture[240 * 4..][..240].iter().map(|pixel| pixel[0]).collect();
    let reaches = |level: f64| {
        let at = row.iter().position(|value| *value >= level).unwrap();
        assert!(at > 0, "{row:?}");
        at as f64 + (level - row[at]) / (row[at] - row[at - 1])
    };
    let pixel = 2.0 * 1.5 * 0.8_f64.to_radians().tan() / 8.0;
    (reaches(0.9) - reaches(0.1)) * pixel
}

/// A lens of radius R at height H makes a penumbra of 1.374 R h / (H - h) between 10 % and 90 % of its light, at a height h
/// of the edge: it widens with the distance between caster and floor. Percentage-closer filtering blurs by its own width
/// over texels, whatever that distance: not soft shadows [LEC, "Hardware Shadow
/// Map Filtering"].
#[test]
fn penumbrae_widen_with_distance_and_filters_do_not() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (mut lens, mut filter) = (Vec::new(), Vec::new());
    let texel = 20.0 * 20_f64.to_radians().tan() / 256.0;
    for height in [2.0, 3.0, 5.0] {
        let scene = with_lens(&edge(height, "technique = \"shadow-map\", size = 1024"), 10.0, 0.3, 256);
        let measured = penumbra(&scene, &mut renderer);
        let blur = 0.3 * height / (10.0 - height);
        // As the knife's edge; and a texel of the map at each end.
        let allowed = 2.0 * blur / 256_f64.sqrt() + 2.0 * texel / 4.0 + 0.006;
        println!("edge at {height}: lens {measured:.4} of {:.4} ± {allowed:.4}", 1.374 * blur);
        assert!((measured - 1.374 * blur).abs() < allowed, "{height}: {measured}");
        lens.push(measured);
        filter.push(penumbra(
            &edge(height, "technique = \"shadow-map\", size = 256, kernel = \"7x7\", filter = \"linear\""),
            &mut renderer,
        ));
    }
    println!("a filter of 7 x 7 taps: {filter:.4?}, a texel on the floor: {texel:.4}");
    assert!(lens[2] > 3.0 * lens[0]);
    // A tap or filter's step more or less, as the edge lies in its texel.
    assert!(filter.iter().all(|width| (width - filter[0]).abs() < texel && *width > 3.0 * texel), "{filter:?}");
}

/// Warnings are of the first lens point's own map: a light without any has none through a lens, however far its frustum
/// leans.
#[test]
fn forecasts_know_where_frusta_lean() {
    let scene = penumbrae([320, 240]);
    for (distance, radius, samples) in [(4.3, 0.0, 2), (4.3, 1.2, 2), (1.5, 0.6, 2), (50.0, 1.0, 4)] {
        let plan = plan::make(&with_lens(&scene, distance, radius, samples), &Request::default()).unwrap();
        assert!(plan.warnings.is_empty(), "{distance} {radius}: {:?}", plan.warnings);
    }
}

/// Lenses at their limits: as exact as any.
#[test]
fn extreme_lenses_are_right() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = penumbrae([80, 60]);
    for (name, distance, radius, samples) in [
        ("focal plane at infinity", 1e12, 0.3, 16),
        ("focal plane before near", 0.2, 0.05, 16),
        ("focal plane at the light, nearly", 1e-3, 1e-3, 16),
        ("lens wider than the focal distance", 1.0, 2.0, 16),
        ("lens around the scene", 4.0, 30.0, 64),
        ("lens of no size, nearly", 4.0, 1e-9, 16),
        ("two points", 4.3, 0.5, 2),
        ("4096 points", 4.3, 0.5, 4096),
    ] {
        let scene = with_lens(&scene, distance, radius, samples);
        let (picture, plan) = draw(&scene, &mut renderer);
        assert!(picture.iter().flatten().all(|value| value.is_finite()));
        let due = truth::lens(&scene, 0, &truth::lens_points(samples)).unwrap().unwrap();
        let error = mean(errors(&picture, &due).into_iter());
        let light = mean(due.iter().map(|due| due.light.x));
        println!("{name}: off by {error:.6} of {light:.4}, {} images", plan.list.images.len());
        assert!(error < 4e-4 + 1e-3 * light, "{name}: {error}");
    }
}
