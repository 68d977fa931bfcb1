//! A fitted map shows the same shadows with smaller texels: held against ray-traced truth from many sides.

use std::fmt::Write as _;

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::plan::{Plan, Request};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth;

/// Boxes and spheres on a floor, wider than the camera sees.
fn field(eye: [f64; 3], target: [f64; 3], light: [f64; 3], cone: f64) -> Scene {
    let mut text = format!(
        "[image]\nsize = [192, 128]\n[camera]\neye = {eye:?}\ntarget = {target:?}\nfov_y = 30.0\nnear = 0.2\nfar = 60.0\n\
         [[light]]\nposition = {light:?}\ntarget = [0.0, 0.0, 0.0]\ncone = {cone:?}\nnear = 0.5\nfar = 80.0\n\
         [[object]]\nmesh = \"quad\"\nscale = [20.0, 1.0, 20.0]\n"
    );
    for k in 0..25 {
        let (mesh, x, z) = (["box", "sphere"][k % 2], 2.5 * ((k % 5) as f64 - 2.0), 2.5 * ((k / 5) as f64 - 2.0));
        let _ = writeln!(text, "[[object]]\nmesh = \"{mesh}\"\nscale = 0.5\ntranslate = [{x:?}, 0.6, {z:?}]");
    }
    scene_of(&text)
}

/// Factor by which a pixel gets more texels, as the plan says.
fn gain(plan: &Plan) -> f64 {
    let said = plan.left_out.iter().find_map(|left| left.why.strip_suffix(" times the texels a pixel"));
    said.and_then(|text| text.rsplit(' ').next()).map_or(1.0, |number| number.parse().unwrap())
}

/// With as many texels the error is never more, and mostly as much less as the texels are smaller; the other way round,
/// a mistake in what may be cropped would be a leak or a false shadow far from any edge.
#[test]
fn fitted_maps_are_right_and_finer() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (mut wrong, mut gains) = ([0.0; 3], Vec::new());
    for (eye, target) in [
        ([6.0, 5.0, 8.0], [0.0, 0.0, 0.0]),
        ([1.0, 1.5, 3.5], [0.0, 0.2, 0.5]),
        ([-7.0, 2.0, 0.3], [-4.0, 0.0, 0.0]),
        ([2.0, 9.0, -3.0], [2.0, 0.0, -3.1]),
    ] {
        for (light, cone) in [([6.0, 14.0, 4.0], 70.0), ([-16.0, 6.0, 2.0], 50.0), ([0.3, 3.0, 0.2], 150.0)] {
            let scene = field(eye, target, light, cone);
            let Ok(truth) =
                truth::trace(&scene, 0, &truth::Options { most_ambiguous: 0.2, ..truth::Options::default() })
            else {
                panic!("no truth from {eye:?}, light {light:?}")
            };
            let measured = ["none", "casters", "view"].map(|fit| {
                let keys = format!("technique = \"shadow-map\", size = 512, fit = \"{fit}\"");
                let scene = techniques::with_keys(&scene, 0, &keys).unwrap();
                let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
                let found: Metrics = compare(&truth, &shade, &Band { texels: 2.0, map_size: [512; 2] }).unwrap();
                let plan = renderer.plan(&scene, &Request::default()).unwrap();
                (found.facing, gain(&plan))
            });
            let [none, casters, view] = measured;
            println!(
                "eye {eye:?}, light {light:?}: wrong {:.3} %, casters {:.3} % ({:.2} x), view {:.3} % ({:.2} x)",
                none.0.wrong_percent, casters.0.wrong_percent, casters.1, view.0.wrong_percent, view.1
            );
            for (errors, _) in &measured[1..] {
                // Texels that are hardly finer only fall otherwise: by a tenth and half a dozen pixels.
                let spare = 100.0 * 6.0 / none.0.compared.max(1) as f64;
                assert!(errors.wrong_percent <= 1.1 * none.0.wrong_percent + spare, "{eye:?} {light:?}: {errors:?}");
                assert!(errors.wrong_outside_percent <= none.0.wrong_outside_percent + spare, "{eye:?} {light:?}");
            }
            assert!(none.1 == 1.0 && casters.1 >= 1.0 && view.1 >= casters.1);
            measured.iter().zip(&mut wrong).for_each(|((errors, _), sum)| *sum += errors.wrong_percent);
            gains.push(view.1);
        }
    }
    println!("wrong in all, none, casters, view: {wrong:.3?}");
    assert!(wrong[1] <= wrong[0] && wrong[2] < 0.7 * wrong[0], "{wrong:?}");
    assert!(gains.iter().filter(|gain| **gain > 2.0).count() > 6, "{gains:?}");
}

/// Triangles that no texel shows are not drawn: with a fraction of the triangles the shadow is the same but for its rim.
#[test]
fn casters_at_the_map_s_resolution_cast_the_same_shadow() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/data/");
    let keys = [format!("object.1.mesh=\"{root}meshes/dense.obj\""), String::from("image.size=[384, 384]")];
    let point = "light.0={ kind = \"point\", position = [2.0, 4.0, 3.0], near = 0.5, far = 20.0 }";
    // A face of a cube shows three times the area that the spotlight's frustum does, in other directions.
    for (kind, keys, sizes) in [
        ("spot", keys.to_vec(), vec![256, 512, 1024]),
        ("point", [keys.to_vec(), vec![String::from(point)]].concat(), vec![512, 1024]),
    ] {
        let scene = glumbra::load(format!("{root}scenes/example.toml").as_ref(), &keys).unwrap().scene;
        let truth = truth::trace(&scene, 0, &truth::Options::default()).unwrap();
        for size in &sizes {
            let size = *size;
            let [full, texel] = ["full", "texel"].map(|casters| {
                let keys = format!("technique = \"shadow-map\", size = {size}, casters = \"{casters}\"");
                let scene = techniques::with_keys(&scene, 0, &keys).unwrap();
                let plan = renderer.plan(&scene, &Request::default()).unwrap();
                let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
                let found = compare(&truth, &shade, &Band { texels: 2.0, map_size: [size; 2] }).unwrap();
                println!(
                    "{kind}, map {size}, casters {casters}: {} triangles; wrong {:.4} % (facing {:.4} %, false beyond the band {})",
                    plan.summary().passes[0].triangles,
                    found.all.wrong_percent,
                    found.facing.wrong_percent,
                    found.facing.false_shadow.outside
                );
                (plan.summary().passes[0].triangles, found)
            });
            // The model's facets are half as wide as a texel of the coarsest of these maps, and two of the finest's.
            let most = if size == sizes[0] { 0.6 } else { 0.9 };
            let left = texel.0 as f64 / full.0 as f64;
            assert!(left < most, "{kind}, map {size}: {} of {}", texel.0, full.0);
            // A hundredth of a point; in the coarsest map, where silhouettes lose more facets, four of them.
            let more = texel.1.all.wrong_percent - full.1.all.wrong_percent;
            assert!(more < if size == sizes[0] { 0.045 } else { 0.01 }, "{kind}, map {size}: {more} points more");
        }
    }
}
