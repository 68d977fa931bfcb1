//! Bumps by texture units: the light vector by a cube map, its product with the normals by GL_DOT3_RGB, the decal and the
//! gloss by blending; against the register combiners' shaders. And what they cannot draw.

use std::path::Path;

use glumbra::fixed_function::Error;
use glumbra::pass::{BumpMap, FixedFunctionDesc, Work};
use glumbra::plan::Request;
use glumbra::scene::Scene;

use super::pipelines::{HANDFUL, ONE_CODE, Pipelines, differing, load};

/// A bump-mapped doughnut in one light. Its normal map dims in its smaller levels.
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
kind = "point"
position = [-2.5, 1.5, 1.5]
near = 0.5
far = 12.0
diffuse = [0.9, 0.8, 1.0]
specular = [0.0, 0.0, 0.0]

[[object]]
name = "doughnut"
mesh = "torus"
translate = [0.0, 0.15, 0.0]
rotate = { axis = [1, 0, 0.3], angle = 20 }
scale = [1.0, 0.7, 1.2]
"#;

const DIMPLES: &str = "height = \"DIMPLES\", scale = 4.0";

fn scene(folder: &Path, material: &str, set: &[&str]) -> Scene {
    let dimples = std::fs::canonicalize("data/textures/dimples.png").unwrap();
    let text = format!("{DOUGHNUT}material = {{ diffuse = [0.9, 0.8, 0.7], {material} }}\n");
    let path = folder.join("doughnut.toml");
    std::fs::write(&path, text.replace("DIMPLES", dimples.to_str().unwrap())).unwrap();
    load(&path, set)
}

/// What is set, and the codes that roundings allow: a pass's clamp and rounding is one, of each light that is added another.
const DRAWN: &[(&[&str], f32)] = &[
    (&[], 1.0),
    (&["shading.bump=\"one-pass\""], 1.0),
    (&["shading.normalize={ cube = 16 }"], 1.0),
    (&["shading.normalize={ cube = 16, seamless = false }"], 1.0),
    (&["shading.normalize={ cube = 256 }"], 1.0),
    (&["light.kind=directional", "light.direction=[0.2, -0.5, 1.0]"], 1.0),
    (&["shading.ambient=[0.2, 0.3, 0.1]"], 1.0),
    (&["shading.ambient=[0.8, 0.3, 0.1]", "shading.bump=\"one-pass\""], 1.0),
    (&["light.kind=directional", "light.direction=[1.0, 0.02, 0.3]", "shading.normalize={ cube = 128 }"], 1.0),
];

const MATERIALS: [&str; 4] = [
    "bump = { height = \"DIMPLES\", scale = 4.0 }",
    "bump = { height = \"DIMPLES\", scale = 4.0, format = \"unorm8\" }",
    "decal = \"DIMPLES\", bump = { height = \"DIMPLES\", scale = 8.0, format = \"unorm8\" }",
    "decal = \"DIMPLES\", gloss = \"decal-alpha\", bump = { height = \"DIMPLES\", scale = 2.0 }",
];

#[test]
fn diffuse_light_on_bumps_is_that_of_the_combiners() {
    let folder = tempfile::tempdir().unwrap();
    let mut pipelines = Pipelines::open();
    for material in MATERIALS {
        for (set, codes) in DRAWN {
            let name = format!("{material} {set:?}");
            let scene = scene(folder.path(), material, set);
            let plan = pipelines.plan(&scene, &Request::default());
            let drawn = pipelines.draw(&plan).unwrap_or_else(|error| panic!("{name}: {error}"));
            let off = |codes: f32| differing(&drawn.shaders[0], &drawn.fixed[0], codes * ONE_CODE);
            println!(
                "{name}: {} pixels differ, {} by more than a code, {} by more than 2",
                off(0.0),
                off(1.0),
                off(2.0)
            );
            assert!(off(*codes) <= HANDFUL / 4, "{name}: {}", off(*codes));
            let lit = drawn.fixed[0].chunks(4).filter(|pixel| pixel[0] > 0.5).count();
            assert!(lit > 2000, "{name}: {lit} pixels are bright");
        }
    }
}

#[test]
fn mistakes_in_bumps_are_seen() {
    let _ = (DIMPLES, Error::Inexpressible(Vec::new()), FixedFunctionDesc::Shader(""));
    let folder = tempfile::tempdir().unwrap();
    let mut pipelines = Pipelines::open();
    let scene = scene(folder.path(), MATERIALS[1], &[]);
    let plan = pipelines.plan(&scene, &Request::default());
    let right = pipelines.draw_fixed(&plan, &plan.list).unwrap();
    let mistakes: [(&str, fn(&mut glumbra::pass::Lit)); 3] = [
        ("packed normals as signed ones", |lit| lit.bumps = Some(BumpMap { is_signed: true })),
        ("a light behind the surface", |lit| lit.lights[0].position[2] = -lit.lights[0].position[2]),
        ("a light far away", |lit| lit.lights[0].position[3] = 0.0),
    ];
    for (name, mistake) in mistakes {
        let mut list = plan.list.clone();
        for pass in &mut list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            for batch in &mut draw.batches {
                if let FixedFunctionDesc::Lit(lit) = &mut batch.meaning {
                    mistake(lit);
                }
            }
        }
        let wrong = pipelines.draw_fixed(&plan, &list).unwrap();
        let off = differing(&right[0], &wrong[0], 4.0 * ONE_CODE);
        assert!(off > 1000, "{name}: {off} pixels differ");
    }
}
