//! Pictures of the product that faults of the tenth measure change: the scene, and the share of its pixels.

#![allow(dead_code, reason = "the test and the program use parts of it")]

use glumbra::conformance::faults::Fault;

use super::judge::{self, SceneRow, Sound};

/// Scenes beside those of the judge: a name, a file and what is set over it.
#[rustfmt::skip]
pub const SCENES: &[SceneRow] = &[
    ("kernel", "cases/scenes/box", &["light.shadow.kernel=3x3", "light.shadow.filter=linear"]),
    ("adaptive", "cases/scenes/box", &["light.shadow.bias=adaptive", "light.shadow.filter=linear", "light.shadow.kernel=3x3"]),
    ("parallel light", "cases/scenes/box", &["light.0={ kind = \"directional\", direction = [2.0, -5.0, -1.5], shadow = { technique = \"shadow-map\", size = 256 } }"]),
    ("parallel light, back faces of mirrored boxes", "cases/scenes/box", &["light.0={ kind = \"directional\", direction = [2.0, -5.0, -1.5], shadow = { technique = \"shadow-map\", size = 256, cull = \"front\" } }", "object.1.scale=[-0.5, 0.5, 0.5]"]),
    ("mirrored", "cases/scenes/box", &["object.1.scale=[-0.5, 0.5, 0.5]", "light.shadow.cull=front"]),
    ("two biases", "cases/scenes/two_lights", &["light.0.shadow.offset={ factor = 1.4, units = 4 }", "light.1.shadow.offset={ factor = 40, units = 4 }"]),
    ("weak bias", "cases/scenes/box", &["light.shadow.offset={ factor = 0.4, units = 2 }"]),
    ("tags", "cases/scenes/two_lights", &["light.shadow.filter=nearest", "light.shadow.into=stencil"]),
    ("soft alpha shadows", "cases/scenes/two_lights", &["shading.passes=shadow", "light.shadow.filter=linear", "light.1.shadow.filter=linear", "light.shadow.size=64", "light.1.shadow.size=64"]),
    ("ledge", "cases/scenes/box", &["light.shadow.technique=shadow-volume", "light.shadow.method=z-pass-capped", "light.shadow.ledge=[0.05, 0.1, 1.0]", "camera.eye=[0.9, 0.15, -0.45]", "camera.target=[1.8, 0.0, 0.2]", "camera.near=0.02"]),
    ("lens and dust", "cases/scenes/two_lights", &["light.0.focus={ distance = 5.0, radius = 0.2, samples = 4 }", "light.1.dust={ density = 0.2, slices = 16 }"]),
    ("moved dust", "cases/scenes/box", &["light.dust={ density = 0.2, slices = 16, jitter = true }"]),
    ("cone", "cases/scenes/above", &["light.shadow.technique=none", "light.cone=40"]),
    ("highlights", "cases/scenes/box", &["object.0.material.specular=[0.5, 0.4, 0.3]", "object.0.material.shininess=32", "light.attenuation=[0.2, 0.1, 0.05]"]),
    ("midpoint of floats", "cases/scenes/box", &["light.shadow.technique=midpoint", "light.shadow.format=depth32f", "light.shadow.filter=linear"]),
];

/// A fault, a scene of the judge or of [`SCENES`] that it changes, and the least percent of its picture's pixels.
#[rustfmt::skip]
pub const SHOWN: &[(&str, &str, f64)] = &[
    ("upload-chunks-repeat-a-row", "beam", 1.0),
    ("float-maps-compared-at-one-texel", "midpoint of floats", 0.5),
    ("samplers-lost-with-copies", "map of 16 bits, copied", 50.0),
    ("projective-q-of-ten-bits", "weak bias", 30.0),
    ("projected-look-ups-clamped-to-edge", "weak bias", 2.0),
    ("texels-fetched-once-for-four-pixels", "midpoint of floats", 5.0),
    ("small-matrices-read-with-padding", "parallel light", 80.0),
    ("small-uniform-floats-are-zero", "midpoint compared", 3.0),
    ("uniform-zeros-not-sent", "lens", 50.0),
    ("uniform-arrays-share-w", "kernel", 50.0),
    ("depth-fail-lost-without-depth-writes", "volumes, z-fail", 3.0),
    ("stencil-func-compared-by-function", "lens", 40.0),
    ("stencil-clears-set-reference", "tags", 3.0),
    ("blend-func-compared-by-source", "lens and dust", 60.0),
    ("lone-alpha-of-one-bit", "soft alpha shadows", 2.0),
    ("offset-compared-by-units", "two biases", 0.8),
    ("offset-lost-under-depth-clamp", "parallel light", 3.0),
    ("offset-factor-whole", "weak bias", 15.0),
    ("mirrored-fronts-not-culled", "mirrored", 1.0),
    ("bare-framebuffers-as-large-as-the-last", "two biases", 40.0),
    ("triangles-beyond-guard-band-lost", "two biases", 30.0),
    ("clip-distances-of-halves", "guard by a clip plane", 10.0),
    ("discard-ignored-while-blending", "moved dust", 30.0),
    ("depth-ranges-compared-by-far", "ledge", 50.0),
    ("clears-reset-winding", "mirrored", 1.0),
    ("reciprocals-of-nine-bits", "highlights", 3.0),
    ("spread-numbers-end-at-zero", "bumps in one pass", 40.0),
    ("odd-last-turns-of-loops-lost", "kernel", 40.0),
    ("gaps-in-swizzles-closed", "cone", 12.0),
    ("fract-beyond-64-in-eighths", "adaptive", 0.5),
    ("cos-of-negative-angles-turned", "wave", 5.0),
    ("comparisons-with-one-limit-merged", "cone", 12.0),
    ("varyings-linear-beside-noperspective", "kernel", 40.0),
    ("globals-written-in-functions-lost", "adaptive", 20.0),
    ("numbers-taken-from-x-alone", "two biases", 50.0),
    ("fourth-elements-are-third", "kernel", 40.0),
    ("own-depth-lost-beside-color", "moved dust", 6.0),
    ("exp-in-sixteenths", "moved dust", 60.0),
];

/// The scenes in their order, those of the judge first: a fault of state may need what an earlier scene left.
pub fn scenes() -> Vec<SceneRow> {
    [judge::SCENES, SCENES].concat()
}

/// Statements of [`SHOWN`] about faults that do not hold.
pub fn wrong(fault: &Fault, scenes: &[Sound]) -> Option<String> {
    let (_, scene, percent) = SHOWN.iter().find(|(name, _, _)| *name == fault.name)?;
    let shares = judge::shares(fault, scenes);
    match shares.iter().find(|(name, _)| name == scene) {
        Some((_, share)) if 100.0 * share >= *percent => None,
        found => Some(format!("{}: {found:?} of {scene}, and {percent} % are said", fault.name)),
    }
}
