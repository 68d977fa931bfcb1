//! Captions of `glumbra figures`, checked against pixels of the panels; and the command itself.

use std::process::Command;
use std::sync::Arc;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::figures::{FIGURES, Figure};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::{PicturePasses, Scene};
use glumbra::truth::{self, Answer};
use glumbra::views::View;

fn figure(name: &str) -> &'static Figure {
    FIGURES.iter().find(|figure| figure.name == name).unwrap()
}

/// Value of a view at a point. The caller knows that the point is visible there.
fn at(scene: &Scene, view: View, point: DVec3, renderer: &mut Renderer) -> [f32; 2] {
    let views = vec![ViewRequest { view, light: 0 }];
    let plan = renderer.plan(scene, &Request { views, ..Request::default() }).unwrap();
    renderer.draw(&plan).unwrap();
    let clip = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world() * point.extend(1.0);
    let [width, height] = scene.image.size.map(f64::from);
    let x = ((0.5 + 0.5 * clip.x / clip.w) * width).floor() as usize;
    let y = ((0.5 - 0.5 * clip.y / clip.w) * height).floor() as usize;
    assert!(x < width as usize && y < height as usize, "{point} is not in the picture");
    let pixel = y * width as usize + x;
    match &renderer.read(&plan).unwrap().views[0] {
        Pixels::RgbaF32 { data, .. } => [data[4 * pixel], data[4 * pixel + 3]],
        Pixels::Stencil { data, .. } => [f32::from(data[pixel]), 1.0],
        other => panic!("{:?}", other.size()),
    }
}

/// A panel's scene, by the figure's name and the panel's place.
fn scene(name: &str, panel: usize) -> Scene {
    figure(name).scene_of(&figure(name).panels[panel]).unwrap()
}

/// Point of the floor that the ray from `light` through `point` meets.
fn on_floor(light: DVec3, point: DVec3) -> DVec3 {
    light + (point - light) * light.y / (light.y - point.y)
}

const LIGHT: DVec3 = DVec3::new(-3.4, 5.0, 3.0);

/// The middle of the ball's shadow in the workshop.
fn shadow_of_ball() -> DVec3 {
    on_floor(LIGHT, DVec3::new(1.8, 0.45, 1.0))
}

/// Points of some panels of each figure, and the shade that its caption means there: 1 lit, 0 shadowed. In pictures of
/// failures it is the wrong shade.
#[test]
fn captions_are_true_of_points() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    // Behind both boxes as the light sees them.
    let overlap = DVec3::new(1.6, 0.0, -0.85);
    // Well within the left box's shadow from the lower light, which reaches to its top's at (2.97, -1.57).
    let long = on_floor(DVec3::new(-2.0, 2.9, 0.5), DVec3::new(-0.8, 2.1, 0.0));
    let out_of_shadow = DVec3::new(3.6, 0.0, 1.4);
    for (name, shades, point) in [
        ("hsm-title", &[1.0, 0.0][..], shadow_of_ball()),
        ("hsm-2-light-view", &[0.0], shadow_of_ball()),
        ("hsm-4-comparison", &[0.0], shadow_of_ball()),
        ("lec-dimming", &[0.0, 0.0, 0.0], shadow_of_ball()),
        ("gdc-volumes", &[0.0], overlap),
        ("gdc-truncated", &[1.0, 0.0], long),
        ("gdc-parity", &[1.0, 0.0], overlap),
        ("gdc-eye-inside", &[0.0, 1.0, 1.0], out_of_shadow),
    ] {
        for (panel, expected) in shades.iter().enumerate() {
            let found = at(&scene(name, panel), View::Shade, point, &mut renderer);
            assert_eq!(found, [*expected, 1.0], "{name}, panel {panel} at {point}");
        }
    }
    assert_eq!(at(&scene("gdc-volumes", 3), View::StencilCount, overlap, &mut renderer)[0], 2.0);
    let lamp = scene("lec-back-projection", 0);
    let walls = [DVec3::new(3.2, 1.6, -0.6), DVec3::new(-3.2, 1.6, 0.0)];
    let reached = walls.map(|wall| at(&lamp, View::Shade, wall, &mut renderer)[1]);
    assert_eq!(reached, [1.0, 0.0], "q > 0 alone is reached");
    let unguarded = scene("lec-back-projection", 1);
    let reached = walls.map(|wall| at(&unguarded, View::Shade, wall, &mut renderer)[1]);
    assert_eq!(reached, [1.0, 1.0], "without a guard q < 0 is reached too");
}

/// [Segal 1992, Figure 4]: on surfaces that are white and unlit, shadow and image together are the product of both.
#[test]
fn a_spotlight_s_picture_is_its_shadow_times_its_image() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut picture = |panel: usize, passes: PicturePasses| {
        let mut scene = scene("segal-4-spotlight", panel);
        (scene.shading.ambient, scene.shading.passes, scene.lights[0].diffuse) = ([0.0; 3], passes, [1.0; 3]);
        for object in &mut scene.objects {
            let mut material = object.material.as_deref().unwrap().clone();
            (material.diffuse, object.lit) = ([1.0; 3], false);
            object.material = Some(Arc::new(material));
        }
        scene.image.background = [0.0; 3];
        let plan = renderer.plan(&scene, &Request::default()).unwrap();
        renderer.draw(&plan).unwrap();
        let Pixels::Rgba8 { data, .. } = renderer.read(&plan).unwrap().picture else { panic!() };
        data.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).map(f64::from).collect::<Vec<f64>>()
    };
    let one = PicturePasses::One;
    let [both, shadow, image] = [2, 3, 4].map(|panel| picture(panel, one));
    let three = picture(2, PicturePasses::Shadow);
    let count = |of: &[f64], low: f64, high: f64| of.iter().filter(|value| (low..=high).contains(*value)).count();
    assert!(
        count(&shadow, 0.0, 0.0) > 20_000 && count(&image, 20.0, 230.0) > 20_000 && count(&both, 200.0, 255.0) > 20_000
    );
    for (name, picture) in [("one pass", &both), ("three passes", &three)] {
        let off = picture
            .iter()
            .zip(&shadow)
            .zip(&image)
            .map(|((both, shadow), image)| (both - shadow * image / 255.0).abs());
        let worst = off.fold(0.0, f64::max);
        println!("{name}: {worst:.2} codes");
        // Both factors are rounded to codes.
        assert!(worst <= 1.01, "{name}: {worst}");
    }
}

#[test]
fn nearest_is_zero_or_one_and_linear_between() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut between = |panel: usize| {
        let views = vec![ViewRequest { view: View::Shade, light: 0 }];
        let plan = renderer.plan(&scene("hsm-5-filtering", panel), &Request { views, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let Pixels::RgbaF32 { data, .. } = &renderer.read(&plan).unwrap().views[0] else { panic!() };
        data.chunks_exact(4).filter(|p| p[3] > 0.0 && p[0] > 0.0 && p[0] < 1.0).count()
    };
    let [nearest, coarse, fine] = [between(0), between(1), between(2)];
    assert_eq!(nearest, 0);
    // A ramp of one texel, a 16th as wide; what grazes the light has partly shadowed texels of its own in both.
    assert!(coarse > 2000 && fine < coarse / 3, "{coarse}, {fine}");
}

/// The floor's density against the projections' own formula: the area of a pixel's square in the map, by points of the
/// floor half a pixel aside.
#[test]
fn texels_per_pixel_follow_the_projections() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut found = Vec::new();
    for panel in [1, 4] {
        let scene = scene("hsm-6-dueling-frusta", panel);
        let camera_clip = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world();
        let light_clip = scene.lights[0].frustum().unwrap().clip_from_world();
        let [width, height] = scene.image.size.map(f64::from);
        for point in [DVec3::new(1.0, 0.0, 2.6), DVec3::new(0.4, 0.0, 1.6), DVec3::new(-1.0, 0.0, 1.4)] {
            let at_clip = camera_clip.project_point3(point);
            let pixel =
                DVec3::new((0.5 + 0.5 * at_clip.x) * width, (0.5 - 0.5 * at_clip.y) * height, 0.0).floor() + 0.5;
            let texel = |x: f64, y: f64| {
                let ends = [0.2, 0.8].map(|z| {
                    let ndc = DVec3::new(2.0 * x / width - 1.0, 1.0 - 2.0 * y / height, z);
                    camera_clip.inverse().project_point3(ndc)
                });
                let floor = ends[0] + (ends[1] - ends[0]) * ends[0].y / (ends[0].y - ends[1].y);
                150.0 * light_clip.project_point3(floor).truncate()
            };
            let along = texel(pixel.x + 0.5, pixel.y) - texel(pixel.x - 0.5, pixel.y);
            let down = texel(pixel.x, pixel.y + 0.5) - texel(pixel.x, pixel.y - 0.5);
            let expected = along.perp_dot(down).abs().sqrt();
            let density = f64::from(at(&scene, View::TexelsPerPixel, point, &mut renderer)[0]);
            // Derivatives are taken between neighbours: half a pixel aside, where density differs by a few thousandths.
            assert!((density / expected - 1.0).abs() < 0.02, "panel {panel} {point}: {density}, not {expected}");
            found.push(density);
        }
    }
    // Even beside the light; falling towards an eye that the light faces.
    assert!(found[..3].iter().all(|density| (0.5..2.0).contains(density)), "{found:?}");
    assert!(found[3] < 0.8 * found[5], "{found:?}");
}

/// The light's view has a pixel for each texel of the map: what it shows is how many pixels of the eye a texel covers. Of what
/// the eye sees in it, the part that needs many more texels than it has is small where eye and light face each other, and can
/// be seen.
#[test]
fn pixels_per_texel_follow_the_projections() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut needy = Vec::new();
    for (eye, from_light) in [(0, 2), (3, 5)] {
        let (eye, swapped) = (scene("hsm-6-dueling-frusta", eye), scene("hsm-6-dueling-frusta", from_light));
        let eye_clip = eye.camera.clip_from_view(eye.aspect()) * eye.camera.view_from_world();
        let map_clip = eye.lights[0].frustum().unwrap().clip_from_world();
        assert_eq!(swapped.image.size, [300; 2], "texels of the map");
        for point in [DVec3::new(1.0, 0.0, 2.6), DVec3::new(1.3, 0.0, 2.8), DVec3::new(0.9, 0.0, 3.0)] {
            let texel = (150.0 * map_clip.project_point3(point).truncate()).floor() + 0.5;
            let pixel = |x: f64, y: f64| {
                let ends = [0.2, 0.8].map(|z| {
                    map_clip.inverse().project_point3(DVec3::new((texel.x + x) / 150.0, (texel.y + y) / 150.0, z))
                });
                let floor = ends[0] + (ends[1] - ends[0]) * ends[0].y / (ends[0].y - ends[1].y);
                150.0 * eye_clip.project_point3(floor).truncate()
            };
            let (along, up) = (pixel(0.5, 0.0) - pixel(-0.5, 0.0), pixel(0.0, 0.5) - pixel(0.0, -0.5));
            let expected = along.perp_dot(up).abs().sqrt();
            let density = f64::from(at(&swapped, View::TexelsPerPixel, point, &mut renderer)[0]);
            assert!((density / expected - 1.0).abs() < 0.02, "panel {from_light} {point}: {density}, not {expected}");
        }
        let views = [View::TexelsPerPixel, View::Shade].map(|view| ViewRequest { view, light: 0 }).to_vec();
        let plan = renderer.plan(&swapped, &Request { views, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let frame = renderer.read(&plan).unwrap();
        let [Pixels::RgbaF32 { data, .. }, Pixels::RgbaF32 { data: shade, .. }] = &frame.views[..] else { panic!() };
        let seen: Vec<f32> =
            data.chunks_exact(4).zip(shade.chunks_exact(4)).filter(|(_, s)| s[0] > 0.5).map(|(d, _)| d[0]).collect();
        let many = seen.iter().filter(|density| **density > 1.5).count();
        println!("panel {from_light}: {many} of {} texels are too few", seen.len());
        needy.push(many as f64 / seen.len() as f64);
    }
    assert!(needy[0] < 0.02 && (0.02..0.2).contains(&needy[1]), "{needy:?}");
}

/// Every count is one too low with the eye in one volume: light and shadow change places exactly.
#[test]
fn with_the_eye_inside_light_and_shadow_change_places() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut counts = |panel: usize| {
        let views = vec![ViewRequest { view: View::StencilColors, light: 0 }];
        let plan = renderer.plan(&scene("gdc-eye-inside", panel), &Request { views, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let Pixels::Stencil { data, .. } = &renderer.read(&plan).unwrap().views[0] else { panic!() };
        data.clone()
    };
    let [failed, capped, fail] = [counts(3), counts(4), counts(5)];
    assert!(capped == fail);
    let of = |count: u8| failed.iter().zip(&fail).filter(|pair| pair == &(&count.wrapping_sub(1), &count)).count();
    let (lit, shadowed) = (of(0), of(1));
    assert_eq!(lit + shadowed, failed.len(), "0 becomes -1 and 1 becomes 0, everywhere");
    assert!(lit > 10_000 && shadowed > 10_000, "{lit} {shadowed}");
}

/// Names of the cited documents' figures and headings.
const HEADINGS: &[&str] = &[
    "Hardware Shadow Mapping, title picture",
    "Hardware Shadow Mapping, Figure 2",
    "Hardware Shadow Mapping, Figure 4",
    "Hardware Shadow Mapping, Figure 5",
    "Hardware Shadow Mapping, Figure 6",
    "Advantages and Limitations",
    "Advice for Shadowed Illumination Model",
    "Careful about Back Projecting Shadow Maps",
    "Visualizing Shadow Volumes",
    "Visualizing Stenciled Shadow Volume Tagging",
    "Polygons Very Close to the Light Source Cause Problems",
    "OpenGL Renders W=0 Polygons Correctly",
    "Stencil Inverting of Shadow Volume",
    "For Shadow Volumes With Intersecting Polygons",
    "Shadow Volume Near Plane Clipping Artifacts",
    "Alternative to Near Plane Capping: Carmack's Reverse",
    "Combine with Projective Texturing for Spotlight Shadows",
    "Why Is Polygon Offset Needed?",
    "About Projective Texturing",
    "Segal 1992, 2 and Figure 1",
    "Segal 1992, 3.1 and Figure 3",
    "Segal 1992, 3.3",
    "Combining Shadows with Atmospherics",
    "Hardware Shadow Map Filtering",
    "Segal 1992, 3.1",
    "Segal 1992, 2",
    "Segal 1992, 3.2",
    "Three Passes",
    "Same Math in a Single Pass on GeForce3",
    "Converting Height-Field to a Normal Map",
    "Tangent Space Basis is a Gateway for Vectors",
    "GPU Bump Mapping for More than Just Doughnuts",
    "Gloss Map Modulates Per-fragment Specular",
    "Warning about Pre-lit Decal Skins",
    "Decal Skin Comparison",
    "Examples of Quake 2 Model Keyframes",
    "More Bump Mapped Knight Examples",
    "Combining Shadow Volumes With Bump Mapped Models",
    "Compute Partial Derivatives From Polygon Plane Equations",
    "GPU Bump Mapping Texture Requirements",
    "GPU Bump Mapping Basics",
    "Tangent Space Vector Continuity",
    "Tangent Continuity Solutions",
];

#[test]
fn figures_name_what_is_in_documents() {
    for figure in FIGURES {
        let quoted: Vec<&str> = figure.source.split('"').skip(1).step_by(2).collect();
        let named = if quoted.is_empty() { vec![figure.source] } else { quoted };
        let is_ours = figure.source.starts_with("Ours: ");
        assert!(is_ours || named.iter().all(|name| HEADINGS.contains(name)), "{}: {}", figure.name, figure.source);
        let is_of = |prefix: &str| figure.name.starts_with(prefix);
        assert!(!is_ours || !["hsm-", "lec-", "gdc-"].into_iter().any(is_of), "{}", figure.name);
    }
}

/// A point that eight saturating bits call lit, and eight wrapping bits shadowed, is in shadow.
#[test]
fn saturating_counts_lose_shadows() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let shades = [0, 1].map(|panel| draw_shade(&scene("stencil-width", panel), 0, &mut renderer).unwrap());
    let truth = truth::trace(&scene("stencil-width", 0), 0, &truth::Options::default()).unwrap();
    let (mut lost, mut wrapped) = (0, 0);
    let shadowed = truth.pixels.iter().enumerate().filter(|(_, pixel)| pixel.answer == Answer::Shadowed);
    for (index, _) in shadowed {
        lost += usize::from(shades[0].shade[index] > 0.5);
        wrapped += usize::from(shades[1].shade[index] > 0.5);
    }
    // 256 of 300 volumes: a line.
    assert!(lost > 500 && wrapped < lost / 5, "{lost}, {wrapped}");
}

#[test]
fn the_command_writes_sheets_and_an_index() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_glumbra")).arg("figures").args(arguments).output().unwrap()
    };
    let out = folder.path().join("new/folder");
    let done = run(&["--only", "gdc-parity", "--only", "lec-dimming", "-o", out.to_str().unwrap()]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let index = std::fs::read_to_string(out.join("index.md")).unwrap();
    for name in ["gdc-parity", "lec-dimming"] {
        assert!(index.contains(&format!("({name}.png)")), "{index}");
        let size = image::image_dimensions(out.join(format!("{name}.png"))).unwrap();
        assert!(size.0 > 800 && size.1 > 400, "{size:?}");
    }
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 3);
    let unknown = run(&["--only", "gdc-party", "-o", out.to_str().unwrap()]);
    let message = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(!unknown.status.success() && message.contains("gdc-parity"), "{message}");
}
