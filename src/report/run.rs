//! Runs a grid over a scene: each row is drawn, held against the truth and timed, in this order.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::grid::{Grid, Setting};
use super::metrics::{self, Band, Metrics, ShadeImage};
use super::results::{
    Cost, Machine, Measured, Outcome, PassCost, Row, Saved, SceneReport, Spread, TruthSummary, VERSION,
};
use crate::context::{self, ContextRequest};
use crate::device::{Measure, PassTime, Pixels};
use crate::frame::{self, Renderer};
use crate::oracle::ray::{self, Answer, Truth};
use crate::pass::{Pass, Work};
use crate::plan::{Plan, Request, ViewRequest};
use crate::scene::{self, Loaded, Scene, Settings};
use crate::techniques::views::View;

/// Why a report cannot be begun. What goes wrong in a row is told in that row.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Scene(#[from] scene::Error),
    #[error(transparent)]
    Context(#[from] context::Error),
    #[error(transparent)]
    Truth(#[from] ray::Error),
    #[error("the scene has {count} lights, there is no light {index}")]
    NoLight { index: usize, count: usize },
    #[error("--shard {index}/{count}: write I/N with 1 <= I <= N")]
    Shard { index: usize, count: usize },
}

/// How a grid is run.
#[derive(Clone, Debug)]
pub struct Options {
    pub light: usize,
    /// Timed frames a row, at least 1.
    pub runs: usize,
    /// Rows measured at once.
    pub jobs: usize,
    /// The I-th of N parts, I from 1.
    pub shard: (usize, usize),
    /// The edge band's half width in texels of the map.
    pub band_texels: f64,
    pub context: ContextRequest,
}

/// A scene ready to be swept.
pub struct Sweep {
    pub scene: Scene,
    pub truth: Truth,
    pub report: SceneReport,
    /// What loading the scene warned of.
    pub warnings: Vec<String>,
    /// By index; row 0 is the scene as written.
    rows: Vec<(Row, Settings)>,
}

/// Loads a scene, traces its truth and lays out its grid.
///
/// # Errors
///
/// A scene that does not load, a light that is not there, a truth that the oracle does not know.
pub fn prepare(path: &Path, overrides: &[String], grid: &Grid, options: &Options) -> Result<Sweep, Error> {
    let Loaded { scene, warnings } = scene::load(path, overrides)?;
    let count = scene.lights.len();
    let light = scene.lights.get(options.light).ok_or(Error::NoLight { index: options.light, count })?;
    let start = Instant::now();
    let truth = ray::trace(&scene, options.light, &ray::Options::default())?;
    let trace_ms = start.elapsed().as_secs_f64() * 1e3;
    let grid = grid.settings(&light.kind);
    let rows = layout(&light.shadow, &grid)?;
    let (index, shards) = options.shard;
    if index == 0 || index > shards {
        return Err(Error::Shard { index, count: shards });
    }
    let report = SceneReport {
        path: path.to_owned(),
        fingerprint: fingerprint(path, overrides, &grid, options),
        light: options.light,
        size: scene.image.size,
        triangles: scene.objects.iter().map(|object| object.mesh.triangle_count() as u64).sum(),
        truth: summarise(&truth, trace_ms),
        saved: None,
        claims: Vec::new(),
        grid_rows: rows.len(),
        rows: Vec::new(),
    };
    Ok(Sweep { scene, truth, report, warnings, rows })
}

/// Row 0 is the scene as written; the others are the grid's.
fn layout(written: &Settings, grid: &[Setting]) -> Result<Vec<(Row, Settings)>, Error> {
    let technique = match written.get("technique").map(|entry| &entry.value) {
        Some(scene::Value::String(name)) => name.clone(),
        _ => String::from("none"),
    };
    let keys = written.entries.iter().filter(|(key, _)| key != "technique");
    let settings = keys.map(|(key, entry)| (key.clone(), entry.value.to_toml())).collect();
    let row = |index, technique, settings| Row { index, technique, settings, outcome: Outcome::Failed(String::new()) };
    let mut rows = vec![(row(0, technique, settings), written.clone())];
    for (index, setting) in grid.iter().enumerate() {
        let table = scene::shadow_settings(&setting.to_inline())?;
        rows.push((row(index + 1, setting.technique.clone(), setting.keys.clone()), table));
    }
    Ok(rows)
}

fn summarise(truth: &Truth, trace_ms: f64) -> TruthSummary {
    TruthSummary {
        drawn: truth.drawn(),
        lit: truth.count(|answer| answer == Answer::Lit),
        shadowed: truth.count(|answer| answer == Answer::Shadowed),
        ambiguous: truth.count(|answer| matches!(answer, Answer::Ambiguous(_))),
        ambiguous_percent: 100.0 * truth.ambiguous_share(),
        trace_ms,
    }
}

/// Of everything that decides what the rows are, but not of the machine: FNV-1a, 64 bits.
fn fingerprint(path: &Path, overrides: &[String], grid: &[Setting], options: &Options) -> String {
    let mut text = std::fs::read(path).unwrap_or_default();
    let rest = format!("{overrides:?}{grid:?}{}{}{VERSION}", options.light, options.band_texels);
    text.extend_from_slice(rest.as_bytes());
    let hash = text
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{hash:016x}")
}

impl Sweep {
    /// The rows of this shard that `done` does not have.
    pub fn todo(&self, options: &Options, done: &[Row]) -> Vec<usize> {
        let (index, count) = options.shard;
        let rows = 0..self.rows.len();
        rows.filter(|row| row % count == index - 1 && !done.iter().any(|have| have.index == *row)).collect()
    }

    /// Measures `todo`, calling `finished` with each row as it is done, until all are or `stop` is set.
    ///
    /// # Errors
    ///
    /// A context that cannot be had.
    pub fn run(
        &self,
        todo: &[usize],
        options: &Options,
        stop: &Arc<AtomicBool>,
        mut finished: impl FnMut(Row),
    ) -> Result<(), Error> {
        let work = |place: usize, renderer: &mut Renderer| self.row(todo[place], options, renderer);
        frame::on_contexts(&options.context, [todo.len(), options.jobs], stop, work, |_, row| finished(row))?;
        Ok(())
    }

    fn row(&self, index: usize, options: &Options, renderer: &mut Renderer) -> Row {
        let (row, settings) = &self.rows[index];
        let scene = with_shadow(&self.scene, options.light, settings);
        let band = Band { texels: options.band_texels, map_size: [map_size(row); 2] };
        let outcome = match measure(&scene, &self.truth, &band, options, renderer) {
            Ok(measured) => Outcome::Measured(Box::new(measured)),
            Err(why) => Outcome::Failed(why),
        };
        Row { outcome, ..row.clone() }
    }

    /// Draws the scene as written with and without what its plan leaves out, and compares pixels, time and bytes.
    ///
    /// # Errors
    ///
    /// What the plan or the device says.
    pub fn saved(&self, options: &Options, renderer: &mut Renderer) -> Result<Saved, frame::Error> {
        let mut cost = |keep_all| {
            let plan = renderer.plan(&self.scene, &Request { frames: 100, keep_all, ..Request::default() })?;
            renderer.draw(&plan)?;
            let picture = renderer.read(&plan)?.picture;
            let frames = renderer.draw_timed(&plan, options.runs.max(1) as u32, false, || ())?.frames_ms;
            let summary = plan.summary();
            let cost = Cost {
                frame: Spread::of(&frames),
                image_bytes: summary.image_bytes,
                draw_calls: summary.passes.iter().map(|pass| pass.draw_calls).sum(),
                triangles: summary.passes.iter().map(|pass| pass.triangles).sum(),
            };
            Ok::<_, frame::Error>((picture, cost, summary.left_out))
        };
        let (whole_picture, whole, _) = cost(true)?;
        let (picture, pruned, left_out) = cost(false)?;
        Ok(Saved { same_pixels: picture == whole_picture, whole, pruned, left_out })
    }

    /// The scene with a row's settings.
    pub fn scene_of(&self, index: usize) -> Scene {
        with_shadow(&self.scene, self.report.light, &self.rows[index].1)
    }
}

/// `scene` with `[light.shadow]` of one light replaced.
pub fn with_shadow(scene: &Scene, light: usize, settings: &Settings) -> Scene {
    let mut scene = scene.clone();
    if let Some(light) = scene.lights.get_mut(light) {
        light.shadow = settings.clone();
    }
    scene
}

/// The map's side, by which the edge band is measured; 1024 for techniques without a map.
fn map_size(row: &Row) -> u32 {
    let size = row.settings.iter().find(|(key, _)| key == "size");
    size.and_then(|(_, value)| value.parse().ok()).unwrap_or(1024)
}

fn measure(
    scene: &Scene,
    truth: &Truth,
    band: &Band,
    options: &Options,
    renderer: &mut Renderer,
) -> Result<Measured, String> {
    let metrics = check(scene, options.light, truth, band, renderer)?;
    let request = Request { frames: 100, ..Request::default() };
    let plan = renderer.plan(scene, &request).map_err(|error| error.to_string())?;
    let costs = costs(&plan, options.runs, renderer).map_err(|error| error.to_string())?;
    let summary = plan.summary();
    Ok(Measured {
        metrics,
        frame_redrawn: costs.redrawn,
        frame_kept: costs.kept,
        passes: costs.passes,
        image_bytes: summary.image_bytes,
        buffer_bytes: summary.buffer_bytes,
        draw_calls: summary.passes.iter().map(|pass| pass.draw_calls).sum(),
        triangles: summary.passes.iter().map(|pass| pass.triangles).sum(),
        left_out: plan.left_out,
        warnings: plan.warnings,
    })
}

/// Draws the shade and holds it against the truth. A frame is not timed before that.
fn check(scene: &Scene, light: usize, truth: &Truth, band: &Band, renderer: &mut Renderer) -> Result<Metrics, String> {
    let shade = draw_shade(scene, light, renderer).map_err(|error| error.to_string())?;
    metrics::compare(truth, &shade, band).map_err(|error| error.to_string())
}

/// The shade of one light as GL draws it.
///
/// # Errors
///
/// What the plan or the device says.
pub fn draw_shade(scene: &Scene, light: usize, renderer: &mut Renderer) -> Result<ShadeImage, frame::Error> {
    let request = Request { views: vec![ViewRequest { view: View::Shade, light }], ..Request::default() };
    let plan = renderer.plan(scene, &request)?;
    renderer.draw(&plan)?;
    let [width, height] = scene.image.size;
    let texels = match renderer.read(&plan)?.views.pop() {
        Some(Pixels::RgbaF32 { data, .. }) => data,
        _ => Vec::new(),
    };
    Ok(ShadeImage {
        width,
        height,
        shade: texels.chunks_exact(4).map(|texel| texel[0].clamp(0.0, 1.0)).collect(),
        covered: texels.chunks_exact(4).map(|texel| texel[3] > 0.0).collect(),
    })
}

struct Costs {
    redrawn: Spread,
    kept: Spread,
    passes: Vec<PassCost>,
}

/// One frame to warm up, then each kind of frame `runs` times.
fn costs(plan: &Plan, runs: usize, renderer: &mut Renderer) -> Result<Costs, frame::Error> {
    renderer.draw_timed(plan, 1, false, || ())?;
    let mut redrawn = Vec::new();
    let mut kept = Vec::new();
    let mut passes: Vec<Vec<PassTime>> = Vec::new();
    for _ in 0..runs.max(1) {
        renderer.device().forget();
        redrawn.extend(renderer.draw_timed(plan, 1, false, || ())?.frames_ms);
        kept.extend(renderer.draw_timed(plan, 1, false, || ())?.frames_ms);
        renderer.device().forget();
        passes.push(renderer.device().run(&plan.list, Measure::Passes)?);
    }
    renderer.device().forget();
    let counted = renderer.device().run(&plan.list, Measure::Fragments)?;
    let passes = plan.list.passes.iter().enumerate().map(|(index, pass)| {
        let walls: Vec<f64> = passes.iter().filter_map(|run| run.get(index)).map(|time| time.wall_ms).collect();
        let gpus: Vec<f64> = passes.iter().filter_map(|run| run.get(index)).filter_map(|time| time.gpu_ms).collect();
        PassCost {
            label: pass.label.clone(),
            wall: Spread::of(&walls),
            gpu: (!gpus.is_empty()).then(|| Spread::of(&gpus)),
            triangles: triangles(pass),
            fragments: counted.get(index).and_then(|count| count.fragments),
        }
    });
    Ok(Costs { redrawn: Spread::of(&redrawn), kept: Spread::of(&kept), passes: passes.collect() })
}

fn triangles(pass: &Pass) -> u64 {
    match &pass.work {
        Work::Draw(draw) => draw.batches.iter().flat_map(|batch| &batch.draws).map(|draw| draw.primitive_count()).sum(),
        Work::CopyDepth { .. } => 0,
    }
}

/// What it is measured on.
///
/// # Errors
///
/// A context that cannot be had.
pub fn machine(options: &Options) -> Result<Machine, Error> {
    let context = context::open(&options.context)?;
    let info = context.describe();
    let processor = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    Ok(Machine {
        processor: processor.unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        renderer: info.renderer,
        gl_version: info.version,
        road: context.road().to_owned(),
        glumbra: env!("CARGO_PKG_VERSION").to_owned(),
        jobs: options.jobs,
    })
}
