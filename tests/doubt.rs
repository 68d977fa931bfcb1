//! Warnings of maps that cannot show what is seen: given where the picture is wrong, and not where it is right.

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::oracle::ray;
use glumbra::plan::{self, Request};
use glumbra::report::metrics::{Band, compare};
use glumbra::report::run::draw_shade;
use glumbra::scene;

/// README's camera and objects, under a spotlight.
fn wrong_and_warned(cone: f64, near: f64, far: f64, keys: &str, renderer: &mut Renderer) -> (f64, Vec<String>) {
    let text = format!(
        "[image]\nsize = [160, 120]\n[camera]\neye = [3.0, 2.5, 4.0]\ntarget = [0.0, 0.6, 0.0]\n\
         [[light]]\nkind = \"spot\"\nposition = [-3.0, 4.0, 1.0]\ntarget = [0.0, 0.5, 0.0]\ncone = {cone:?}\n\
         near = {near:?}\nfar = {far:?}\n[light.shadow]\ntechnique = \"shadow-map\"\n{keys}\n\
         [[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\n\
         [[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [0.0, 0.5, 0.0]\n\
         [[object]]\nmesh = \"box\"\nscale = [0.3, 1.0, 0.3]\ntranslate = [-1.0, 1.0, -1.0]\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let scene = scene::load(&path, &[]).unwrap().scene;
    let truth = ray::trace(&scene, 0, &ray::Options::default()).unwrap();
    let shade = draw_shade(&scene, 0, renderer).unwrap();
    let errors = compare(&truth, &shade, &Band { texels: 2.0, map_size: [1024; 2] }).unwrap().facing;
    (errors.wrong_percent, plan::make(&scene, &Request::default()).unwrap().warnings)
}

#[test]
fn too_few_codes_and_too_few_texels_are_told() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(context.as_ref());
    for (cone, near, far, keys, is_told) in [
        (60.0, 0.5, 20.0, "", None),
        (60.0, 0.5, 20.0, "format = \"depth16\"", None),
        (60.0, 0.01, 100.0, "", None),
        (60.0, 1e-3, 1e3, "", None),
        (60.0, 0.05, 100.0, "format = \"depth16\"", None),
        (60.0, 3e-6, 1e3, "format = \"depth16\"", Some("one code of depth16")),
        (120.0, 0.5, 20.0, "", None),
        (178.9, 0.5, 20.0, "", Some("a texel of its map covers")),
        (178.5, 0.5, 20.0, "bias = \"adaptive\"", Some("a texel of its map covers")),
    ] {
        let (wrong, warnings) = wrong_and_warned(cone, near, far, keys, &mut renderer);
        println!("cone {cone}, near {near}, far {far}, {keys}: {wrong:.2} % wrong, {warnings:?}");
        match is_told {
            Some(words) => {
                assert!(warnings.iter().any(|warning| warning.contains(words)), "{cone} {near} {keys}: {warnings:?}");
                assert!(wrong > 1.5, "{cone} {near} {keys}: {wrong} %");
            }
            None => {
                assert!(warnings.is_empty(), "{cone} {near} {keys}: {warnings:?}");
                assert!(wrong < 1.5, "{cone} {near} {keys}: {wrong} %");
            }
        }
    }
}
