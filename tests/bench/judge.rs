//! Wrong pixels of a picture, by ray-traced truth: where a way draws another picture than its floor, and beside times that
//! a coarser caster makes shorter.

use std::path::PathBuf;
use std::rc::Rc;

use glumbra::context::{self, Context, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::truth::{self, Truth};

use super::rounds::Bench;
use super::{Result, Scene};

/// Wrong pixels, in percent, above those of the plain map, that rounding and a picture's size may cause.
const MORE_WRONG: f64 = 0.01;

/// Knows the truth of one scene.
pub struct Judge {
    file: PathBuf,
    band: Band,
    truth: Truth,
    context: Rc<dyn Context>,
    plain: f64,
}

impl Judge {
    pub fn new(bench: &Bench) -> Result<Self> {
        let file = bench.folder.join("scene.toml");
        let truth = truth::trace(&glumbra::load(&file, &[])?.scene, 0, &truth::Options::default())?;
        let size = if bench.scene == Scene::S1 { 1024 } else { 2048 };
        let band = Band { texels: 2.0, map_size: [size; 2] };
        let context = context::open(&ContextRequest::default())?;
        let mut judge = Self { file, band, truth, context, plain: 0.0 };
        judge.plain = judge.metrics(&[])?.all.wrong_percent;
        Ok(judge)
    }

    fn metrics(&self, sets: &[&str]) -> Result<Metrics> {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let scene = glumbra::load(&self.file, &sets)?.scene;
        let mut renderer = Renderer::new(&self.context);
        Ok(compare(&self.truth, &draw_shade(&scene, 0, &mut renderer)?, &self.band)?)
    }

    /// Tests whether overrides of the scene that move neither light nor objects draw shadows that are no more wrong than
    /// the plain map's; and the two shares in words.
    pub fn is_as_right(&self, sets: &[&str]) -> Result<(bool, String)> {
        let wrong = self.metrics(sets)?.all.wrong_percent;
        let words = format!("by ray-traced truth {wrong:.3} % wrong, the plain map {:.3} %", self.plain);
        Ok((wrong <= self.plain + MORE_WRONG, words))
    }

    /// Prints the wrong pixels of the full casters and of those at the map's resolution.
    pub fn print_texel(&self, bench: &Bench) -> Result<()> {
        println!("\n{:?}: wrong pixels, by ray-traced truth", bench.scene);
        for casters in ["full", "texel"] {
            let all = self.metrics(&[&format!("light.shadow.casters={casters}")])?.all;
            println!(
                "casters = {casters}: wrong {:.4} %, false shadow {:.4} %, leak {:.4} %",
                all.wrong_percent, all.false_shadow_percent, all.leak_percent
            );
        }
        Ok(())
    }
}
