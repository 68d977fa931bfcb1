//! What is wrong in a picture, by ray-traced truth: beside a time that is bought with a coarser caster.

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::oracle::ray;
use glumbra::report::metrics::{Band, compare};
use glumbra::report::run::draw_shade;
use glumbra::scene;

use super::rounds::Bench;
use super::{Result, Scene};

/// Prints the wrong pixels of the full casters and of those at the map's resolution.
pub fn print_texel(bench: &Bench) -> Result<()> {
    let file = bench.folder.join("scene.toml");
    let context = context::open(&ContextRequest::default())?;
    let mut renderer = Renderer::new(context.as_ref());
    let mut truth = None;
    println!("\n{:?}: wrong pixels, by ray-traced truth", bench.scene);
    for casters in ["full", "texel"] {
        let loaded = scene::load(&file, &[format!("light.shadow.casters={casters}")])?;
        if truth.is_none() {
            truth = Some(ray::trace(&loaded.scene, 0, &ray::Options::default())?);
        }
        let Some(truth) = &truth else { continue };
        let size = if bench.scene == Scene::S1 { 1024 } else { 2048 };
        let band = Band { texels: 2.0, map_size: [size; 2] };
        let found = compare(truth, &draw_shade(&loaded.scene, 0, &mut renderer)?, &band)?;
        println!(
            "casters = {casters}: wrong {:.4} %, false shadow {:.4} %, leak {:.4} %",
            found.all.wrong_percent, found.all.false_shadow_percent, found.all.leak_percent
        );
    }
    Ok(())
}
