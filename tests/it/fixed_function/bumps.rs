//! Bumps by texture units: vectors by a cube map, their products with the normals by GL_DOT3_RGB, decal and gloss by blending;
//! against the register combiners' shaders. And what the units cannot draw.

use std::path::{Path, PathBuf};

use glumbra::fixed_function::Error;
use glumbra::pass::{BumpMap, Decal, FixedFunctionDesc, GlossSource, Lit, Work};
use glumbra::plan::Request;
use glumbra::scene::Scene;

use super::pipelines::{HANDFUL, ONE_CODE, Pipelines, differing, load};

/// A doughnut in one light.
const DOUGHNUT: &str = r#"
[image]
size = [256, 256]
background = [0.1, 0.12, 0.16]
[camera]
eye = [0.6, 2.6, 3.2]
target = [0.0, 0.05, 0.0]
fov_y = 40.0
near = 0.5
far = 20.0
[shading]
ambient = [0.0, 0.0, 0.0]
bump = "three-pass"
[[light]]
LIGHT
diffuse = [0.9, 0.8, 1.0]
specular = [0.0, 0.0, 0.0]
[[object]]
name = "doughnut"
mesh = "torus"
closed = true
translate = [0.0, 0.15, 0.0]
rotate = { axis = [1, 0, 0.3], angle = 20 }
material = { diffuse = [0.9, 0.8, 0.7], specular = [0.9, 0.9, 0.8], shininess = 8, MATERIAL }
"#;

const POINT: &str = "kind = \"point\"\nposition = [-2.5, 1.5, 1.5]\nnear = 0.5\nfar = 12.0";
const PARALLEL: &str = "kind = \"directional\"\ndirection = [0.2, -0.5, 1.0]";
/// Light along the far side's horizon: most of what it reaches lies in the factor min(1, 8 L_z).
const GRAZING: &str = "kind = \"directional\"\ndirection = [1.0, 0.02, 0.3]";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn scene(folder: &Path, light: &str, material: &str, set: &[&str]) -> Scene {
    let textures = root().join("data/textures");
    let text = DOUGHNUT.replace("LIGHT", light).replace("MATERIAL", material);
    let path = folder.join("doughnut.toml");
    std::fs::write(&path, text.replace("FILES", textures.to_str().unwrap())).unwrap();
    load(&path, set)
}

const HIGHLIGHTS: &[&str] = &["shading.two_units=true", "light.0.specular=[1.0, 0.9, 0.8]"];

/// The light, what is set, and the codes that roundings allow: one where a pass rounds once; another where ambient light is
/// rounded by itself, and another for highlights.
const DRAWN: &[(&str, &[&str], f32)] = &[
    (POINT, &[], 1.0),
    (PARALLEL, &[], 1.0),
    (GRAZING, &["shading.normalize={ cube = 128 }"], 1.0),
    (POINT, &["shading.bump=\"one-pass\""], 1.0),
    (POINT, &["shading.normalize={ cube = 16, seamless = false }"], 1.0),
    (POINT, &["shading.normalize={ cube = 256 }", "shading.ambient=[0.2, 0.3, 0.1]"], 2.0),
    (PARALLEL, &["shading.ambient=[0.8, 0.3, 0.1]", "shading.bump=\"one-pass\""], 2.0),
    (POINT, HIGHLIGHTS, 2.0),
    (PARALLEL, HIGHLIGHTS, 2.0),
];

const MATERIALS: [&str; 4] = [
    "bump = { height = \"FILES/studs.png\", scale = 4.0 }",
    "bump = { height = \"FILES/studs.png\", scale = 4.0, format = \"unorm8\" }",
    "decal = \"FILES/bricks.png\", bump = { height = \"FILES/studs.png\", scale = 8.0, format = \"unorm8\" }",
    "decal = \"FILES/knight.png\", gloss = \"FILES/knight-gloss.png\", bump = { height = \"FILES/studs.png\", scale = 2.0 }",
];

/// A step of a mipmap level's weight, and the factor 8 of the horizon, may turn a rounding of the vectors into more codes: in a
/// handful of pixels. Measured: at most 5 of 65,536.
#[test]
fn light_on_bumps_is_that_of_the_combiners() {
    let folder = tempfile::tempdir().unwrap();
    let mut pipelines = Pipelines::open();
    for material in MATERIALS {
        for (light, set, codes) in DRAWN {
            let name = format!("{material} {light:?} {set:?}");
            let scene = scene(folder.path(), light, material, set);
            let plan = pipelines.plan(&scene, &Request::default());
            let drawn = pipelines.draw(&plan).unwrap_or_else(|error| panic!("{name}: {error}"));
            let off = |codes: f32| differing(&drawn.shaders[0], &drawn.fixed[0], codes * ONE_CODE);
            println!("{name}: {} pixels differ, {} by more than 1, {} by more than 2", off(0.0), off(1.0), off(2.0));
            assert!(off(*codes) <= HANDFUL, "{name}: {}", off(*codes));
            let lit = drawn.fixed[0].chunks(4).filter(|pixel| pixel[0] > 0.15).count();
            assert!(lit > 200, "{name}: {lit} pixels are bright");
        }
    }
}

/// A mistake in what a batch means.
type Mistake = fn(&mut FixedFunctionDesc);

fn lit(desc: &mut FixedFunctionDesc, change: impl Fn(&mut Lit)) {
    if let FixedFunctionDesc::Lit(lit) = desc {
        change(lit);
    }
}

fn decal(desc: &mut FixedFunctionDesc, change: impl Fn(&mut Decal)) {
    if let FixedFunctionDesc::Decal(decal) = desc {
        change(decal);
    }
}

#[test]
fn mistakes_in_bumps_are_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut pipelines = Pipelines::open();
    let material = "decal = \"FILES/knight.png\", gloss = \"FILES/knight-gloss.png\", \
                    bump = { height = \"FILES/studs.png\", scale = 2.0, format = \"unorm8\" }";
    let scene = scene(folder.path(), POINT, material, HIGHLIGHTS);
    let plan = pipelines.plan(&scene, &Request::default());
    let right = pipelines.draw_fixed(&plan, &plan.list).unwrap();
    let mistakes: [(&str, Mistake); 5] = [
        ("packed normals as signed ones", |desc| lit(desc, |lit| lit.bumps = Some(BumpMap { is_signed: true }))),
        ("a light far away", |desc| lit(desc, |lit| lit.lights[0].position[3] = 0.0)),
        ("a light on the other side", |desc| lit(desc, |lit| lit.lights[0].position[0] *= -1.0)),
        ("no gloss", |desc| decal(desc, |decal| decal.gloss = GlossSource::One)),
        ("no decal", |desc| decal(desc, |decal| decal.texturing.decal = false)),
    ];
    for (name, mistake) in mistakes {
        let mut list = plan.list.clone();
        for pass in &mut list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            draw.batches.iter_mut().for_each(|batch| mistake(&mut batch.meaning));
        }
        let wrong = pipelines.draw_fixed(&plan, &list).unwrap();
        let off = differing(&right[0], &wrong[0], 4.0 * ONE_CODE);
        assert!(off > 500, "{name}: {off} pixels differ");
    }
}

/// Settings that texture units cannot draw, and words of the reason.
const REFUSED: &[(&[&str], &str)] = &[
    (&["shading.bump=\"reference\""], "found for each fragment: choose bump"),
    (&["shading.normalize=\"exact\""], "choose normalize = { cube = 64 }"),
    (&["shading.precision=\"9-bit\""], "combiners of 9 bits"),
    (&["object.0.closed=false"], "write closed = true"),
    (&["light.0.attenuation=[1.0, 0.1, 0.0]"], "is attenuated, for each fragment"),
    (&["light.0.specular=[1, 1, 1]"], "choose two_units = true"),
    (&["light.0.specular=[1, 1, 1]", "shading.bump=\"one-pass\""], "beside diffuse light"),
];

#[test]
fn bumps_that_texture_units_cannot_draw_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut pipelines = Pipelines::open();
    for (set, why) in REFUSED {
        let scene = scene(folder.path(), POINT, MATERIALS[0], set);
        let plan = pipelines.plan(&scene, &Request::default());
        match pipelines.draw_fixed(&plan, &plan.list) {
            Err(Error::Inexpressible(all)) => {
                assert!(all.iter().any(|each| each.why.contains(why)), "{set:?}: {all:#?}")
            }
            Err(error) => panic!("{set:?}: {error}"),
            Ok(_) => panic!("{set:?} is drawn"),
        }
    }
}

/// Three lights, one of them a spotlight with a shadow map, on bumps before a floor that is not lit.
#[test]
fn bumps_in_a_shadow_map_are_those_of_the_combiners() {
    let mut pipelines = Pipelines::open();
    let set = [
        "shading.bump=\"three-pass\"",
        "object.0.closed=true",
        "object.0.material.specular=[0, 0, 0]",
        "object.0.material.bump.format=\"unorm8\"",
        "object.1.lit=false",
        "light.0.shape=\"frustum\"",
    ];
    let plan = pipelines.plan(&load(&root().join("data/scenes/doughnut.toml"), &set), &Request::default());
    let drawn = pipelines.draw(&plan).unwrap_or_else(|error| panic!("{error}"));
    // Ambient light and each light are rounded by themselves, where the shader rounds a pass.
    let off = differing(&drawn.shaders[0], &drawn.fixed[0], 2.0 * ONE_CODE);
    assert!(off <= 2 * HANDFUL, "{off} pixels");
}
