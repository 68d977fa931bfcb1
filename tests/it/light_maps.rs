//! Maps of point and directional lights against ray-traced truth: every face, edge and corner of a cube, parallel light
//! from many ways, and what of a cube is left out.

use std::path::Path;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::plan::{self, Request};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth;

use crate::support::rims;

fn load(name: &str, set: &[String]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes").join(name);
    glumbra::load(&path, set).unwrap().scene
}

/// Differences of the shade from the truth, within two texels of the map around edges and beyond.
fn errors(scene: &Scene, texels: u32, renderer: &mut Renderer) -> Metrics {
    let truth = truth::trace(scene, 0, &truth::Options::default()).unwrap();
    let mut shade = draw_shade(scene, 0, renderer).unwrap();
    // Steeper than ten to one no offset helps (tests/it/acne.rs): what all but grazes the light is not compared.
    for (covered, pixel) in shade.covered.iter_mut().zip(&truth.pixels) {
        *covered &= pixel.hit.is_none_or(|hit| hit.cos_light.abs() > 0.1);
    }
    compare(&truth, &shade, &Band { texels: 2.0, map_size: [texels; 2] }).unwrap()
}

/// The 26 ways to the faces, edges and corners of a cube.
fn directions() -> impl Iterator<Item = DVec3> {
    let steps = [-1.0, 0.0, 1.0];
    let all = steps
        .into_iter()
        .flat_map(move |x| steps.into_iter().flat_map(move |y| steps.into_iter().map(move |z| DVec3::new(x, y, z))));
    all.filter(|way| *way != DVec3::ZERO)
}

/// A light in a closed room of columns: beyond the edge band no pixel is wrong in any direction, however grazing, but
/// beside a column's rim as the light sees it whose shadow the camera does not see. Fifteen single pixels of 850,000 are
/// there: each lies, by the oracle looking from the light, within two texels of where the surface breaks off. A wrong face
/// or seam is hundreds, far from rims.
#[test]
fn a_cube_is_right_on_every_face_edge_and_corner() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (mut compared, mut shadowed, mut wrong) = (0, 0, 0);
    for filter in ["linear", "nearest"] {
        for way in directions() {
            let eye = DVec3::new(0.35, 0.1, 0.25);
            let target = eye + way + DVec3::new(0.01, 0.02, 0.03);
            let set = [
                format!("camera.target=[{:?}, {:?}, {:?}]", target.x, target.y, target.z),
                format!("light.shadow.filter={filter}"),
                String::from("light.shadow.size=128"),
            ];
            let scene = load("room.toml", &set);
            let truth = truth::trace(&scene, 0, &truth::Options::default()).unwrap();
            let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
            let band = Band { texels: 2.0, map_size: [128; 2] };
            let found = compare(&truth, &shade, &band).unwrap().all;
            let beyond = found.false_shadow.outside + found.leak.outside;
            println!("{filter} {way}: {beyond} wrong beyond the band");
            wrong += beyond;
            compared += found.compared;
            shadowed += found.compared_in_band;
            assert!(wrong <= 15, "{filter} {way}: {found:?}");
            assert_eq!(rims::without_rims(&scene, &truth, &shade, &band), Vec::<String>::new(), "{filter} {way}");
        }
    }
    assert!(compared > 600_000 && shadowed > 10_000, "{compared} {shadowed}: too little to see");
}

/// The walls of an empty room are in the map and lit all over, with a slope's offset alone: where GL_LINEAR looks across
/// a seam, it meets depths along another axis, and a reference along one's own would find them nearer.
#[test]
fn no_seam_shades_a_wall() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut lit = 0;
    // A kernel's slope is met over its own reach: of a tap 1.1 texels of it, and as many more as it is wide of centre.
    for (filter, size, kernel) in [
        ("linear", 16, 1),
        ("linear", 61, 1),
        ("linear", 256, 1),
        ("nearest", 61, 1),
        ("linear", 61, 4),
        ("nearest", 61, 5),
    ] {
        for way in directions() {
            let target = DVec3::new(0.35, 0.1, 0.25) + way;
            let factor = 1.1 + 0.5 * f64::from(kernel - 1);
            let set = [
                format!("camera.target=[{:?}, {:?}, {:?}]", target.x, target.y, target.z + 0.01),
                format!("light.shadow.filter={filter}"),
                format!("light.shadow.size={size}"),
                format!("light.shadow.kernel={kernel}"),
                format!("light.shadow.offset={{ factor = {factor:?}, units = 4.0 }}"),
            ];
            let mut scene = load("room.toml", &set);
            scene.objects.truncate(1);
            let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
            // At a corner three texels are averaged, whose weights may add up to a little less than 1.
            let darkest = shade.shade.iter().fold(1.0, |least: f32, shade| least.min(*shade));
            let dark = shade.shade.iter().filter(|shade| **shade < 0.999).count();
            assert_eq!(dark, 0, "{filter} {size} {kernel} {way}: {darkest}");
            lit += shade.shade.len();
        }
    }
    assert!(lit > 1_000_000);
}

/// The texel of a directional light's map is at most so many times that of a map around the whole scene's ball, by which
/// the band is measured: the box is no larger than the ball, but for its rim and a step of its texel's width.
const COARSER: f64 = 1.25;

#[test]
fn parallel_light_is_right_from_every_way() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let ways = [[0.4, -1.0, -0.3], [0.1, -1.0, 0.05], [-1.0, -0.5, 0.8], [0.3, -0.12, -1.0], [-0.7, -1.0, 1.4]];
    for direction in ways {
        for keys in [
            "technique = \"shadow-map\"",
            "technique = \"shadow-map\", filter = \"nearest\", format = \"depth16\"",
            "technique = \"shadow-map\", format = \"depth32f\"",
            "technique = \"shadow-map\", bias = \"normal-offset\"",
            "technique = \"shadow-map\", bias = \"normal-offset\", compare = \"gequal\", format = \"depth32f\"",
            "technique = \"midpoint\"",
            "technique = \"midpoint\", compare = \"gequal\", format = \"depth16\"",
            "technique = \"second-depth\"",
        ] {
            let light = format!("kind = \"directional\", direction = {direction:?}");
            let set = [format!("light.0={{ {light}, shadow = {{ {keys}, size = 512 }} }}")];
            for name in ["box.toml", "sphere.toml"] {
                let found = errors(&load(name, &set), (512.0 / COARSER) as u32, &mut renderer);
                // What looks away is compared with itself by second depth: that is its error, and no other's.
                let found = if keys.contains("second-depth") { found.facing } else { found.all };
                let wrong = (found.false_shadow.outside, found.leak.outside);
                println!("{name} {direction:?} {keys}: {wrong:?}, in the band {}", found.compared_in_band);
                // At a caster's rim both layers meet, and the middle is no farther than the surface: single pixels there.
                // And where the box stands on the floor, its bottom and what it shades are one surface for second depth.
                let dark = if keys.contains("midpoint") { 4 } else { 0 };
                let lit = if keys.contains("second-depth") { 2 } else { 0 };
                assert!(wrong.0 <= dark && wrong.1 <= lit, "{name} {direction:?} {keys}: {found:?}");
                assert!(found.compared_in_band > 50, "too little to see");
            }
        }
    }
}

fn faces_drawn(scene: &Scene) -> Vec<String> {
    let plan = plan::make(scene, &Request::default()).unwrap();
    let labels = plan.list.passes.iter().map(|pass| pass.label.clone());
    labels.filter(|label| label.contains("face")).collect()
}

#[test]
fn a_cube_has_the_faces_that_are_needed() {
    // All casters below the light, the camera sees them: one face.
    let light = "light.0={ kind = \"point\", position = [0.0, 6.0, 0.0], shadow = { technique = \"shadow-map\" } }";
    let below = ["object.0.scale=[3.0, 1.0, 3.0]", light].map(String::from);
    assert_eq!(faces_drawn(&load("box.toml", &below)), ["light 0: depth, face -y"]);
    // With `transfer = "copy"` it is drawn and copied.
    let copied = [below.as_slice(), &[String::from("light.shadow.transfer=copy")]].concat();
    let expected = ["light 0: depth, face -y", "light 0: depth, face -y, copied"];
    assert_eq!(faces_drawn(&load("box.toml", &copied)), expected);
    // In the room the camera looks along +x with 60 degrees from nearly where the light is: what lies behind is not seen.
    let seen = faces_drawn(&load("room.toml", &[]));
    assert!(seen.contains(&String::from("light 0: depth, face +x")), "{seen:?}");
    assert!(!seen.contains(&String::from("light 0: depth, face -x")), "{seen:?}");
    let plan = plan::make(&load("room.toml", &[]), &Request::default()).unwrap();
    let left = plan.left_out.iter().find(|left| left.what == "face -x of the map of light 0").unwrap();
    assert_eq!(left.why, "the camera sees nothing in it");
}

/// Faces and casters that a cube leaves out change no pixel, wherever the camera looks.
#[test]
fn faces_that_are_left_out_change_no_pixel() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut draw = |scene: &Scene, keep_all: bool| {
        let plan = renderer.plan(scene, &Request { keep_all, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let faces = plan.list.passes.iter().filter(|pass| pass.label.contains("face")).count();
        (renderer.read(&plan).unwrap().picture, faces)
    };
    let mut fewer = 0;
    for way in directions() {
        let target = DVec3::new(0.35, 0.1, 0.25) + way;
        let scene =
            load("room.toml", &[format!("camera.target=[{:?}, {:?}, {:?}]", target.x, target.y, target.z + 0.01)]);
        let (pruned, faces) = draw(&scene, false);
        let (whole, all) = draw(&scene, true);
        assert_eq!(all, 6);
        assert!(pruned == whole, "{way}: {faces} faces");
        fewer += all - faces;
    }
    assert!(fewer > 26, "only {fewer} faces were left out");
}

/// All faces are copied from one depth buffer, which holds the last one's depths: where a cube is made again, for other bits or
/// other faces, each face is drawn again before it is copied.
#[test]
fn faces_are_drawn_again_before_they_are_copied_again() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let room = load("room.toml", &[]);
    let by = |keys: &str| techniques::with_keys(&room, 0, &format!("technique = \"shadow-map\", {keys}")).unwrap();
    let copied = by("size = 128, transfer = \"copy\"");
    let unsized_map = by("size = 128, transfer = \"copy\", format = \"depth\"");
    let mut elsewhere = copied.clone();
    elsewhere.camera.target = DVec3::new(4.0, 0.0, 4.0);
    for (first, second) in
        [(&copied, &unsized_map), (&unsized_map, &copied), (&copied, &elsewhere), (&elsewhere, &copied)]
    {
        let expected = draw_shade(second, 0, &mut Renderer::new(&context)).unwrap().shade;
        let mut renderer = Renderer::new(&context);
        draw_shade(first, 0, &mut renderer).unwrap();
        assert!(draw_shade(second, 0, &mut renderer).unwrap().shade == expected);
    }
}
