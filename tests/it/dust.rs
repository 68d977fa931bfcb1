//! Beams of light in dusty air, against closed forms and against a march along each ray in f64.

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::pass::{PassList, Work};
use glumbra::plan::{self, Request};
use glumbra::scene::Scene;
use glumbra::truth::{self, Air};

use crate::support::random::Random;
use crate::support::scene_of;

/// The picture in floats, and its passes.
fn draw(scene: &Scene, renderer: &mut Renderer) -> (Vec<[f64; 3]>, PassList) {
    let request = Request { float_picture: true, sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request).unwrap();
    renderer.draw(&plan).unwrap();
    let Pixels::RgbaF32 { data, .. } = renderer.read(&plan).unwrap().picture else { panic!("a float picture") };
    (data.chunks_exact(4).map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k]))).collect(), plan.list)
}

fn without_dust(scene: &Scene) -> Scene {
    let mut clear = scene.clone();
    clear.lights.iter_mut().for_each(|light| light.dust = None);
    clear
}

/// Depths of the slices that the plan draws.
fn depths(list: &PassList) -> Vec<f64> {
    let mut depths: Vec<f64> = Vec::new();
    for pass in &list.passes {
        let Work::Draw(drawn) = &pass.work else { continue };
        for draw in drawn.batches.iter().flat_map(|batch| &batch.draws).filter(|draw| draw.label.starts_with("slices"))
        {
            for position in &draw.mesh.positions {
                let depth = -f64::from(position[2]);
                if depths.last().is_none_or(|last| (last - depth).abs() > 1e-6 * depth) {
                    depths.push(depth);
                }
            }
        }
    }
    depths
}

/// Differences of the picture from the surfaces' light through the dust that truth found, largest channel of each pixel.
fn errors(picture: &[[f64; 3]], clear: &[[f64; 3]], air: &[Air]) -> Vec<f64> {
    let pixels = picture.iter().zip(clear).zip(air);
    let error = |((is, behind), air): ((&[f64; 3], &[f64; 3]), &Air)| {
        let due = |k: usize| behind[k] * (1.0 - air.opacity) + air.color[k];
        (0..3).map(|k| (is[k] - due(k)).abs()).fold(0.0, f64::max)
    };
    pixels.map(error).collect()
}

/// A camera and a light at one place, which look the same way: all rays are lit between two planes.
fn headlight(dust: &str) -> Scene {
    scene_of(&format!(
        "[image]\nsize = [64, 48]\nbackground = [0.3, 0.5, 0.7]\n[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -1]\nfov_y = 60.0\n\
         near = 0.1\nfar = 50.0\n[[light]]\nkind = \"spot\"\nshape = \"frustum\"\nposition = [0, 0, 0]\ntarget = [0, 0, -1]\n\
         cone = 120.0\nnear = 1.0\nfar = 4.0\ncolor = [1.0, 0.5, 0.25]\ndust = {{ {dust} }}\n\
         [[object]]\nmesh = \"quad\"\ntranslate = [0, -30, 0]\n"
    ))
}

/// Length of a pixel's ray between two planes a unit apart.
fn secant(x: usize, y: usize) -> f64 {
    let pixel = 2.0 * 30.0_f64.to_radians().tan() / 48.0;
    let [x, y] = [x as f64 + 0.5 - 32.0, y as f64 + 0.5 - 24.0].map(|at| at * pixel);
    (1.0 + x * x + y * y).sqrt()
}

/// Even air, lit all over: 1 - exp(-density l), for every number of slices; density l where slices are added. The layer's
/// floats are rounded once a slice: 2^-24 each, and exp() by 2^-20 or so.
#[test]
fn even_air_has_its_closed_form_for_every_number_of_slices() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for density in [1e-4, 0.02, 0.35, 3.0, 1e6] {
        for slices in [1, 2, 7, 64, 512] {
            for (blend, adds) in [("over", false), ("add", true)] {
                let scene = headlight(&format!("density = {density:?}, slices = {slices}, blend = \"{blend}\""));
                let (picture, _) = draw(&scene, &mut renderer);
                for (index, pixel) in picture.iter().enumerate() {
                    let optical = density * 3.0 * secant(index % 64, index / 64);
                    let share = if adds { optical } else { -f64::exp_m1(-optical) };
                    let passes = if adds { 1.0 } else { 1.0 - share };
                    for (k, (behind, color)) in [(0.3, 1.0), (0.5, 0.5), (0.7, 0.25)].into_iter().enumerate() {
                        let due = behind * passes + share * color;
                        let error = (pixel[k] - due).abs() / due.max(1.0);
                        let allowed = 2e-6 + 1e-7 * f64::from(slices);
                        assert!(error < allowed, "{blend} {density} {slices}: {} for {due} at {index}", pixel[k]);
                    }
                }
            }
        }
    }
}

/// Random beams around random things.
fn random_scene(random: &mut Random, technique: &str, slices: u32) -> Scene {
    let vector = |random: &mut Random, reach: f64| {
        let at = random.vector() * random.within(0.3, 1.0) * reach;
        format!("[{:?}, {:?}, {:?}]", at.x, at.y, at.z)
    };
    let mut text = format!(
        "[image]\nsize = [80, 60]\nbackground = [0.1, 0.2, 0.3]\n[camera]\neye = {}\ntarget = {}\nfov_y = {:?}\nnear = 0.1\nfar = 30.0\n",
        vector(random, 4.0),
        vector(random, 0.5),
        random.within(30.0, 80.0)
    );
    let blend = random.pick(&["blend = \"over\"", "blend = \"over\", extinct = \"all\"", "blend = \"add\""]);
    text += &format!(
        "[[light]]\nkind = \"spot\"\nshape = \"{}\"\nposition = {}\ntarget = {}\ncone = {:?}\nnear = 0.4\nfar = 9.0\n\
         color = [0.9, 0.8, 0.7]\nattenuation = [{:?}, {:?}, 0.02]\ndust = {{ density = {:?}, slices = {slices}, {blend} }}\nshadow = {{ {technique} }}\n",
        random.pick(&["cone", "frustum"]),
        vector(random, 4.0),
        vector(random, 0.5),
        random.within(20.0, 90.0),
        random.within(0.5, 1.5),
        random.within(0.0, 0.2),
        random.size(0.05, 1.0)
    );
    for _ in 0..3 + random.below(4) {
        text += &format!(
            "[[object]]\nmesh = \"{}\"\nscale = [{:?}, {:?}, {:?}]\nrotate = {{ axis = {}, angle = {:?} }}\ntranslate = {}\n",
            random.pick(if technique.contains("second-depth") {
                &["box", "sphere"]
            } else {
                &["box", "sphere", "quad"]
            }),
            random.within(0.1, 0.8),
            random.within(0.1, 0.8),
            random.within(0.1, 0.8),
            vector(random, 1.0),
            random.within(0.0, 180.0),
            vector(random, 1.6)
        );
    }
    scene_of(&text)
}

const SCENES: usize = 16;

/// Without shadows every layer is the same on both sides, but for rounding at the rim of the beam and at surfaces: there a
/// ray gains or loses a slice.
#[test]
fn slices_without_shadows_are_the_marched_layers() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(2711);
    let mut seen = 0;
    for number in 0..SCENES {
        let mut scene = random_scene(&mut random, "technique = \"none\"", 24);
        scene.objects.iter_mut().for_each(|object| object.casts_shadow = false);
        let (picture, list) = draw(&scene, &mut renderer);
        let depths = depths(&list);
        if depths.len() < 2 {
            continue;
        }
        let air = truth::dust_at(&scene, 0, &depths, (depths[0] - depths[1]).abs()).unwrap().unwrap();
        let errors = errors(&picture, &draw(&without_dust(&scene), &mut renderer).0, &air);
        let off = errors.iter().filter(|error| **error > 2e-4).count();
        seen += air.iter().filter(|air| air.color.x > 0.02).count();
        assert!(50 * off <= errors.len(), "scene {number}: {off} of {} pixels are off", errors.len());
    }
    assert!(seen > 20_000, "only {seen} pixels show dust");
}

/// With shadows the map's texels decide at their edges: on the average far less than a slice.
#[test]
fn shadows_in_the_air_are_the_marched_ones() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(1127);
    let mut seen = 0;
    for number in 0..SCENES {
        let technique = random.pick(&[
            "technique = \"shadow-map\", size = 1024",
            "technique = \"shadow-map\", size = 1024, fit = \"view\", casters = \"texel\"",
            "technique = \"shadow-map\", size = 1024, kernel = \"3x3\"",
            "technique = \"second-depth\", size = 1024",
            "technique = \"shadow-map\", size = 1024, into = \"stencil\"",
        ]);
        let scene = random_scene(&mut random, technique, 24);
        let (picture, list) = draw(&scene, &mut renderer);
        let depths = depths(&list);
        if depths.len() < 2 {
            continue;
        }
        let air = truth::dust_at(&scene, 0, &depths, (depths[0] - depths[1]).abs()).unwrap().unwrap();
        let unshadowed = {
            let mut scene = scene.clone();
            scene.objects.iter_mut().for_each(|object| object.casts_shadow = false);
            truth::dust_at(&scene, 0, &depths, (depths[0] - depths[1]).abs()).unwrap().unwrap()
        };
        let errors = errors(&picture, &draw(&without_dust(&scene), &mut renderer).0, &air);
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / errors.len() as f64;
        let error = mean(&mut errors.iter().copied());
        // What a picture without shadows in the air would be wrong by.
        let shadows = mean(&mut air.iter().zip(&unshadowed).map(|(a, b)| (a.color - b.color).abs().max_element()));
        seen += usize::from(shadows > 0.004);
        let allowed = 2e-4 + 0.03 * shadows;
        assert!(error < allowed, "scene {number}, {technique}: {error:.5} of {shadows:.5}");
    }
    assert!(seen >= SCENES / 3, "only {seen} scenes have shadows in the air");
}

/// More slices come nearer to the endless sum: the error falls as 1 / slices, in the mean of all pixels.
#[test]
fn more_slices_come_nearer() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(31);
    let mut means = [0.0; 3];
    for _ in 0..5 {
        let scene = random_scene(&mut random, "technique = \"shadow-map\", size = 1024", 8);
        let clear = draw(&without_dust(&scene), &mut renderer).0;
        let air = truth::dust(&scene, 0, 600).unwrap().unwrap();
        for (mean, slices) in means.iter_mut().zip([8, 32, 128]) {
            let mut scene = scene.clone();
            scene.lights[0].dust.as_mut().unwrap().slices = slices;
            let errors = errors(&draw(&scene, &mut renderer).0, &clear, &air);
            *mean += errors.iter().sum::<f64>() / errors.len() as f64;
        }
    }
    println!("mean errors of 8, 32 and 128 slices: {means:?}");
    assert!(means[0] > 2.5 * means[1] && means[1] > 2.5 * means[2], "{means:?}");
}

/// Moved slices are noise around the same mean in place of bands: no pixel's error is larger than a slice's share, and the
/// mean over the picture is nearer to the endless sum than that of slices in place.
#[test]
fn jitter_leaves_the_mean() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(77);
    let (mut still, mut moved) = (0.0, 0.0);
    for _ in 0..5 {
        let mut scene = random_scene(&mut random, "technique = \"shadow-map\", size = 1024", 12);
        let clear = draw(&without_dust(&scene), &mut renderer).0;
        let air = truth::dust(&scene, 0, 600).unwrap().unwrap();
        let mut bias = |jitter: bool| {
            scene.lights[0].dust.as_mut().unwrap().jitter = jitter;
            let picture = draw(&scene, &mut renderer).0;
            let off = picture
                .iter()
                .zip(&clear)
                .zip(&air)
                .map(|((is, behind), air)| is[0] - (behind[0] * (1.0 - air.opacity) + air.color[0]));
            // In blocks of 4 x 4 pixels, as the eye averages.
            let off: Vec<f64> = off.collect();
            let block = |x: usize, y: usize| {
                (0..16).map(|k| off[(4 * y + k / 4) * 80 + 4 * x + k % 4]).sum::<f64>().abs() / 16.0
            };
            (0..15).flat_map(|y| (0..20).map(move |x| (x, y))).map(|(x, y)| block(x, y)).sum::<f64>() / 300.0
        };
        still += bias(false);
        moved += bias(true);
    }
    println!("blocks are off by {still:.5} in place, {moved:.5} moved");
    assert!(moved < 0.8 * still, "{still} {moved}");
}

/// A slice that counts along the view axis is too thin by the cosine: at the corner of this picture, 0.72 to 0.81 of it.
#[test]
fn thickness_along_the_axis_is_too_thin_at_the_corners() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let added = |thickness: &str, renderer: &mut Renderer| {
        draw(&headlight(&format!("density = 0.1, blend = \"add\", thickness = \"{thickness}\"")), renderer).0[0][0]
            - 0.3
    };
    let ratio = added("axis", &mut renderer) / added("ray", &mut renderer);
    assert!((ratio - 1.0 / secant(0, 0)).abs() < 1e-5, "{ratio}");
}

/// Beams and eyes at their limits: each within a slice's share of the marched layers, or more exactly.
#[test]
fn extreme_beams_are_right() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = |camera: &str, light: &str, dust: &str| {
        scene_of(&format!(
            "[image]\nsize = [80, 60]\nbackground = [0.1, 0.2, 0.3]\n[camera]\nfov_y = 50.0\n{camera}\n[[light]]\nkind = \"spot\"\n\
             near = 0.5\nfar = 8.0\ncone = 40.0\n{light}\ncolor = [1.0, 0.9, 0.8]\ndust = {{ {dust} }}\n\
             shadow = {{ technique = \"shadow-map\", size = 1024 }}\n[[object]]\nmesh = \"box\"\nscale = 0.3\n\
             [[object]]\nmesh = \"quad\"\nscale = 4.0\ntranslate = [0, -1, 0]\n"
        ))
    };
    let eye = "eye = [0, 1, 4]\ntarget = [0, 0, 0]\nnear = 0.1\nfar = 20.0";
    let above = "position = [0.0, 4.0, 0.3]\ntarget = [0, 0, 0]";
    let even = "density = 0.2, slices = 64";
    let cases = [
        (
            "the eye in the beam",
            scene("eye = [0.1, 2.5, 0.4]\ntarget = [0, 0, 0]\nnear = 0.05\nfar = 20.0", above, even),
        ),
        ("the light at the eye", scene(eye, "position = [0, 1, 4]\ntarget = [0, 0, 0]", even)),
        ("a spotlight behind the eye", scene(eye, "position = [0, 2, 7]\ntarget = [0, 0, 0]", even)),
        ("a beam towards the eye", scene(eye, "position = [0, -0.9, -3]\ntarget = [0, 1, 4]", even)),
        (
            "a beam along a slice",
            scene(
                "eye = [0, 1, 4]\ntarget = [0, 1, 0]\nnear = 0.1\nfar = 20.0",
                "position = [-4, 1, 0]\ntarget = [0, 1, 0]",
                even,
            ),
        ),
        (
            "slices across the near plane",
            scene("eye = [0, 1, 4]\ntarget = [0, 0, 0]\nnear = 3.9\nfar = 20.0", above, even),
        ),
        ("one slice", scene(eye, above, "density = 0.2, slices = 1")),
        ("4096 slices", scene(eye, above, "density = 0.2, slices = 4096")),
        ("hardly any dust", scene(eye, above, "density = 1e-6, slices = 64")),
        ("a wall of dust", scene(eye, above, "density = 1e5, slices = 64")),
        (
            "a beam whose up is along z",
            scene(eye, "position = [0.0, 4.0, 0.3]\ntarget = [0, 0, 0]\nup = [0, 0, 1]", "density = 0.2, slices = 64"),
        ),
    ];
    for (name, scene) in cases {
        let (picture, list) = draw(&scene, &mut renderer);
        let depths = depths(&list);
        let thickness = if depths.len() > 1 { (depths[0] - depths[1]).abs() } else { f64::NAN };
        let dust = scene.lights[0].dust.unwrap();
        let thickness = if dust.slices == 1 { one_thickness(&scene) } else { thickness };
        let air = truth::dust_at(&scene, 0, &depths, thickness).unwrap().unwrap();
        let errors = errors(&picture, &draw(&without_dust(&scene), &mut renderer).0, &air);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        // A texel of the map at the box's edge decides a slice or two of a pixel.
        let slice = -f64::exp_m1(-2.0 * dust.density * thickness);
        let off = errors.iter().filter(|error| **error > 3e-4 + 2.0 * slice).count();
        let dusty = air.iter().filter(|air| air.span.is_some()).count();
        println!("{name}: mean {mean:.6}, {off} of {dusty} off by more than two slices ({slice:.4} each)");
        assert!(dusty > 100, "{name}: {dusty} pixels");
        assert!(mean < 1e-4 + 0.02 * slice.min(0.2) && 200 * off <= dusty, "{name}: mean {mean}, {off} of {dusty}");
    }
}

/// Thickness of the only slice: the depths that the beam spans, by the march's own spans.
fn one_thickness(scene: &Scene) -> f64 {
    let mut open = scene.clone();
    open.objects.clear();
    open.image.size = [640, 480];
    let air = truth::dust_at(&open, 0, &[], 0.0).unwrap().unwrap();
    let spans = air.iter().filter_map(|air| air.span);
    let [near, far] = spans.fold([f64::INFINITY, 0.0], |[near, far], [a, b]| [near.min(a), f64::max(far, b)]);
    far - near
}

#[test]
fn what_shows_no_dust_is_left_out_or_refused() {
    let left_out = |scene: &Scene| {
        let plan = plan::make(scene, &Request::default()).unwrap();
        let drawn = plan.list.passes.iter().any(|pass| pass.label.contains("dust"));
        let said = plan.left_out.iter().find(|left| left.what.starts_with("dust")).map(|left| left.why.clone());
        (drawn, said)
    };
    assert_eq!(left_out(&headlight("density = 0.0")), (false, Some(String::from("its density is 0"))));
    let mut scene = headlight("density = 1.0");
    assert_eq!(left_out(&scene), (true, None));
    scene.camera.target = glam::DVec3::new(0.0, 0.0, 1.0);
    scene.camera.eye = glam::DVec3::new(0.0, 0.0, 0.5);
    let (drawn, _) = left_out(&scene);
    assert!(!drawn);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let point = "[camera]\neye = [0, 1, 4]\ntarget = [0, 0, 0]\n[[light]]\nkind = \"point\"\nposition = [0, 2, 0]\n\
                 dust = { density = 1.0 }\n[[object]]\nmesh = \"quad\"\n";
    std::fs::write(&path, point).unwrap();
    let error = glumbra::load(&path, &[]).unwrap_err().to_string();
    assert!(error.contains(":7:") && error.contains("needs a spotlight"), "{error}");
    for (technique, why) in [("shadow-volume", "counted at surfaces"), ("midpoint", "halfway")] {
        let mut scene = random_scene(&mut Random::new(3), &format!("technique = \"{technique}\""), 8);
        scene.camera.target = scene.lights[0].position().unwrap();
        let error = plan::make(&scene, &Request::default()).unwrap_err().to_string();
        assert!(error.contains("[light.dust] of light 0") && error.contains(why), "{error}");
    }
}
