//! Both pipelines of a pass list: shaders and the driver's own fixed-function pipeline. With planes and matrices of the
//! driver's arithmetic the shade is the same to the bit; with ours, but for a handful of pixels; colours are within 1/255.

mod bumps;
mod cases;
mod pipelines;
mod programs;

use std::path::Path;

use glam::DMat4;
use glumbra::fixed_function::{Error, Inexpressible};
use glumbra::pass::{FixedFunctionDesc, Projection, Work};
use glumbra::plan::{Request, ViewRequest};
use glumbra::viewer::Mode;
use glumbra::views::View;

use pipelines::{HANDFUL, ONE_CODE, Pipelines, compare, differing, differing_bits, load, picture_and_shades};

const SAMPLE: &str = "data/scenes/hw_shadowmaps_simple.toml";

#[test]
fn the_sample_is_the_same_in_every_mode_to_one_code() {
    let mut pipelines = Pipelines::open();
    for (name, mode) in Mode::ALL {
        let scene = load(Path::new(SAMPLE), &[]);
        let (scene, request) = mode.frame(&scene, scene.image.size);
        let plan = pipelines.plan(&scene, &request);
        let drawn = pipelines.draw_in_driver_arithmetic(&plan).unwrap();
        // Rounded to 8 bits: one code more, where a value lies at the border of two.
        assert_eq!(differing(&drawn.shaders[0], &drawn.fixed[0], ONE_CODE), 0, "{name}");
        let apart = differing_bits(&drawn.shaders[0], &drawn.fixed[0]);
        assert!(apart < 262_144 / 1000, "{name}: {apart} pixels of 8 bits differ by a code");
        let off = pipelines.draw(&plan).map(|drawn| differing(&drawn.shaders[0], &drawn.fixed[0], ONE_CODE)).unwrap();
        assert!(off <= HANDFUL, "{name}: {off} pixels with our own planes");
    }
}

#[test]
fn a_cone_ends_where_the_shader_ends_it_with_eight_bits_of_alpha_too() {
    let mut pipelines = Pipelines::open();
    let scene = load(Path::new("data/cases/scenes/box.toml"), &["shading.lighting=per-vertex"]);
    let plan = pipelines.plan(&scene, &Request::default());
    let drawn = pipelines.draw(&plan).unwrap();
    // Ambient and the light are rounded one by one and added: one code.
    assert_eq!(differing(&drawn.shaders[0], &drawn.fixed[0], ONE_CODE), 0);
}

/// Passes that blend by DST_COLOR and DST_ALPHA, in 8 bits, where each pass is rounded: scene, what is set, and the codes
/// that the roundings of colour, factor and sum allow, of each light.
const BLENDED: &[(&str, &[&str], f32)] = &[
    ("data/cases/slide-projector/room/scene.toml", &[], 2.0),
    ("data/cases/slide-projector/room/scene.toml", &["shading.background=ambient", "light.shape=cone"], 2.0),
    ("data/figures/slide.toml", &["light.1.color=[0.3, 0.3, 0.3]"], 2.0),
    ("data/figures/spotlight.toml", &["shading.passes=shadow", "shading.lighting=per-vertex"], 2.0),
    ("data/cases/scenes/two_lights.toml", &["shading.passes=shadow", "shading.lighting=per-vertex"], 2.0),
    (SAMPLE, &["shading.passes=shadow"], 1.0),
    (SAMPLE, &["shading.passes=shadow", "light.shadow.dimming=0.4", "light.shape=cone"], 2.0),
];

#[test]
fn passes_that_multiply_and_weigh_by_alpha_are_those_of_the_shaders() {
    let mut pipelines = Pipelines::open();
    for (path, set, codes) in BLENDED {
        let plan = pipelines.plan(&load(Path::new(path), set), &Request::default());
        let drawn =
            pipelines.draw_in_driver_arithmetic(&plan).unwrap_or_else(|error| panic!("{path} {set:?}: {error}"));
        let off = |codes: f32| differing(&drawn.shaders[0], &drawn.fixed[0], codes * ONE_CODE);
        println!("{path} {set:?}: {} pixels differ, {} by more than a code", off(0.0), off(1.0));
        // Where a silhouette's two faces round to the same depth, either may be the one that a pass meets.
        assert!(off(*codes) <= HANDFUL / 4, "{path} {set:?}: {}", off(*codes));
        let colors: std::collections::HashSet<Vec<u32>> =
            drawn.fixed[0].chunks(4).map(|pixel| pixel.iter().map(|value| value.to_bits()).collect()).collect();
        assert!(colors.len() > 10, "{path} {set:?}: an empty picture");
    }
}

/// Keys of the sample's shadow that are varied, beside set-ups and splits.
const VARIANTS: &[&[&str]] = &[
    &["light.shadow.format=depth16"],
    &["light.shadow.format=depth32f", "light.far=20"],
    &["light.shadow.filter=nearest"],
    &["light.shadow.transfer=copy"],
    &["light.shadow.compare=gequal"],
    &["light.shadow.addressing=direct3d"],
    &["light.shadow.cull=front"],
    &["light.shadow.r.bias=0.498"],
    &["light.shadow.dimming=0.4"],
    &["light.shape=cone"],
    &["light.shape=cone", "light.shadow.dimming=0.4", "shading.ambient=[0.2, 0.2, 0.2]"],
    &["light.ambient=[0.2, 0.1, 0.1]"],
    &["light.attenuation=[0.5, 0.1, 0.02]", "shading.ambient=[0.2, 0.2, 0.2]"],
    &["light.attenuation=[1.5, 0.1, 0.02]", "light.ambient=[0.1, 0.1, 0.2]", "light.diffuse=[0.8, 0.9, 0.7]"],
];

#[test]
fn the_samples_shadow_is_the_same_to_the_bit() {
    let mut pipelines = Pipelines::open();
    for variant in VARIANTS {
        let name = variant.join(" ");
        let shadowed = compare(&mut pipelines, &load(Path::new(SAMPLE), variant), &name);
        assert!(shadowed.unwrap_or_else(|all| panic!("{name}: {all:?}")), "{name}: no shadow");
    }
}

#[test]
fn planes_set_under_every_modelview_give_the_shadow_to_the_bit() {
    let mut pipelines = Pipelines::open();
    for set_up in ["eye", "world", "light", "identity"] {
        for split in ["identity", "scale-bias", "projection"] {
            let set = [format!("light.shadow.texgen={set_up}"), format!("light.shadow.texture_matrix={split}")];
            let scene = load(Path::new(SAMPLE), &[&set[0], &set[1], "image.size=[256, 256]"]);
            assert_eq!(compare(&mut pipelines, &scene, &set.join(" ")), Ok(true));
        }
    }
}

/// A mistake in the planes that GL is given.
type Mistake = fn(&mut Projection);

const MISTAKES: &[(&str, Mistake)] = &[
    ("planes under the identity", |projection| projection.texgen.modelview = DMat4::IDENTITY),
    ("planes under the inverse", |projection| projection.texgen.modelview = projection.texgen.modelview.inverse()),
    ("planes transposed", |projection| projection.texgen.planes = projection.texgen.planes.transpose()),
    ("no texture matrix", |projection| projection.texgen.texture_matrix = DMat4::IDENTITY),
    ("r and q exchanged", |projection| {
        let rows = projection.texgen.planes.transpose();
        projection.texgen.planes = DMat4::from_cols(rows.x_axis, rows.y_axis, rows.w_axis, rows.z_axis).transpose();
    }),
];

#[test]
fn mistakes_in_the_planes_are_seen() {
    let mut pipelines = Pipelines::open();
    let set = ["light.shadow.texgen=light", "light.shadow.texture_matrix=scale-bias", "image.size=[256, 256]"];
    let scene = load(Path::new(SAMPLE), &set);
    let plan = pipelines.plan(&scene, &picture_and_shades(&scene));
    let right = pipelines.draw(&plan).unwrap();
    assert!(differing(&right.shaders[1], &right.fixed[1], ONE_CODE) <= HANDFUL);
    for (name, mistake) in MISTAKES {
        let mut list = plan.list.clone();
        for pass in &mut list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            for batch in &mut draw.batches {
                if let FixedFunctionDesc::Sampled(view) = &mut batch.meaning {
                    view.projection.iter_mut().for_each(&mistake);
                }
            }
        }
        let wrong = pipelines.draw_fixed(&plan, &list).unwrap();
        let off = differing(&right.shaders[1], &wrong[1], ONE_CODE);
        assert!(off > 1000, "{name}: {off} pixels differ");
    }
}

/// Settings that fixed function cannot draw, the pass, the draw, and words of the reason.
const REFUSED: &[(&[&str], &str, &str, &str)] = &[
    (&["shading.lighting=per-fragment"], "lit", "teapot", "for each fragment"),
    (&["light.shadow.format=depth32f"], "lit", "floor", "beyond the light's far plane"),
    (
        &["object.1.material.specular=[0.4, 0.4, 0.4]", "object.1.material.shininess=200"],
        "lit",
        "teapot",
        "GL_SHININESS ends at 128",
    ),
    (&["light.shadow.technique=shadow-volume"], "light 0", "teapot", "stencil"),
    (&["light.shadow.into=stencil"], "light 0: tag", "floor, teapot", "tag in the stencil buffer"),
    (
        &["object.1.wave={ direction = [1, 0, 0], axis = [0, 1, 0], amplitude = 0.1, wavelength = 1 }"],
        "light 0: depth",
        "teapot",
        "waves in the vertex stage",
    ),
];

#[test]
fn what_fixed_function_cannot_draw_is_named() {
    let mut pipelines = Pipelines::open();
    for (set, pass, what, why) in REFUSED {
        let scene = load(Path::new(SAMPLE), set);
        let plan = pipelines.plan(&scene, &Request::default());
        let error = pipelines.draw(&plan).err().unwrap_or_else(|| panic!("{set:?} is drawn"));
        let Error::Inexpressible(all) = &error else { panic!("{error}") };
        let named = |each: &Inexpressible| each.pass == *pass && each.what.contains(what) && each.why.contains(why);
        assert!(all.iter().any(named), "{error}");
        assert!(error.to_string().contains(&format!("\"{pass}\", ")), "{error}");
    }
    let scene = load(Path::new(SAMPLE), &[]);
    let views = vec![ViewRequest { view: View::LightDistance, light: 0 }];
    let plan = pipelines.plan(&scene, &Request { views, ..Request::default() });
    let named = pipelines.fixed.inexpressible(&plan.list);
    let [only] = named.as_slice() else { panic!("{named:#?}") };
    assert_eq!((only.pass.as_str(), only.why.as_str()), ("view: light-distance of light 0", "r/q as a colour"));
}
