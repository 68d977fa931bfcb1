//! Runs a grid over a scene: each row is drawn, compared with the truth and timed, in this order.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::colors::{self, compare_colors};
use super::costs::{costs, work_of};
use super::grid::{self, Grid};
use super::metrics::{self, Band, Metrics, ShadeImage};
pub use super::options::MeasureOptions;
use crate::context;
use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::plan::{self, Request, ViewRequest};
use crate::report::store::fingerprint;
use crate::report::store::results::{
    Cost, Machine, Measured, Outcome, Row, Saved, SceneReport, Spread, TruthSummary, bytes_of,
};
use crate::scene::{self, Loaded, Scene, Settings, Value};
use crate::techniques::{self, TABLE, Technique};
use crate::truth::{self, Answer, ColorTruth, Truth};
use crate::views::View;

/// Reason why a report cannot be started. Errors of a row are kept in that row.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Scene(#[from] scene::Error),
    #[error(transparent)]
    Context(#[from] context::Error),
    #[error(transparent)]
    Truth(#[from] truth::Error),
    #[error("{scene}: the grid's row {inline}: {reason}", scene = .scene.display())]
    Row { scene: PathBuf, inline: String, reason: String },
    #[error("the scene has {count} lights, there is no light {index}")]
    NoLight { index: usize, count: usize },
    #[error("--shard {index}/{count}: write I/N with 1 <= I <= N")]
    Shard { index: usize, count: usize },
}

/// A scene ready to be swept.
pub struct Sweep {
    pub scene: Scene,
    pub truth: Truth,
    /// Colours in f64, if a light has an image, a beam or a law of distance.
    colors: Option<ColorTruth>,
    pub report: SceneReport,
    /// Warnings of loading the scene and laying out its grid.
    pub warnings: Vec<String>,
    /// Notes on the grid, for the report.
    pub notes: Vec<String>,
    /// By index; row 0 is the scene as written.
    rows: Vec<(Row, Settings)>,
}

/// Loads a scene, lays out its grid and traces its truth. Every row is resolved here, before any is drawn.
///
/// # Errors
///
/// A scene that does not load, a light that is not there, a wrong row of a grid file, a truth that the ray tracer cannot
/// find.
pub fn prepare(path: &Path, overrides: &[String], grid: &Grid, options: &MeasureOptions) -> Result<Sweep, Error> {
    let (index, shards) = options.shard;
    if index == 0 || index > shards {
        return Err(Error::Shard { index, count: shards });
    }
    let Loaded { scene, mut warnings } = scene::load(path, overrides)?;
    let count = scene.lights.len();
    if options.light >= count {
        return Err(Error::NoLight { index: options.light, count });
    }
    let Layout { rows, left_out } = layout(path, &scene, options.light, grid)?;
    warnings.extend(left_out.iter().cloned());
    let start = Instant::now();
    let truth = truth::trace(&scene, options.light, &truth::Options::default())?;
    let trace_ms = start.elapsed().as_secs_f64() * 1e3;
    let colors = colors::has_projected_light(&scene).then(|| colors::true_colors(&scene, options.light)).transpose()?;
    let report = SceneReport {
        path: path.to_owned(),
        path_bytes: bytes_of(path),
        fingerprint: fingerprint::of_rows(&scene, rows.iter().map(|(row, _)| row), options),
        light: options.light,
        size: scene.image.size,
        triangles: scene.objects.iter().map(|object| object.mesh.triangle_count() as u64).sum(),
        truth: summarise(&truth, trace_ms),
        saved: None,
        claims: Vec::new(),
        grid_rows: rows.len(),
        rows: Vec::new(),
    };
    Ok(Sweep { scene, truth, colors, report, warnings, notes: left_out, rows })
}

/// The rows of a scene's grid, and the parts of the standard grid that do not go with the scene's own keys.
struct Layout {
    rows: Vec<(Row, Settings)>,
    left_out: Vec<String>,
}

/// Row 0 is the scene as written; the others are the grid's over it.
fn layout(path: &Path, scene: &Scene, light: usize, grid: &Grid) -> Result<Layout, Error> {
    let source = &scene.lights[light];
    let bare = Scene { objects: Vec::new(), ..scene.clone() };
    let written = readable(&source.shadow);
    let mut layout = Layout { rows: vec![(row_of(0, &written), written)], left_out: Vec::new() };
    for setting in grid.settings(&source.kind)? {
        let settings = over(&source.shadow, &setting);
        match check_settings(&bare, light, &settings) {
            Ok(()) => layout.rows.push((row_of(layout.rows.len(), &settings), settings)),
            Err(error) => {
                let (inline, reason) = (grid::to_inline(&setting), error.to_string());
                match grid {
                    Grid::Own(_) => return Err(Error::Row { scene: path.to_owned(), inline, reason }),
                    Grid::Standard { .. } => layout.left_out.push(format!(
                        "{}: the grid's row {inline} is left out, as it does not go with the scene's own keys: {reason}",
                        path.display()
                    )),
                }
            }
        }
    }
    Ok(layout)
}

/// A row that is not measured yet.
fn row_of(index: usize, settings: &Settings) -> Row {
    let keys = settings.entries.iter().filter(|(key, _)| key != "technique");
    let settings_text = keys.map(|(key, entry)| (key.clone(), entry.value.to_toml())).collect();
    let technique = technique_of(settings).to_owned();
    Row { index, technique, settings: settings_text, outcome: Outcome::Failed(String::new()) }
}

fn technique_of(settings: &Settings) -> &str {
    match settings.get("technique").map(|entry| &entry.value) {
        Some(Value::String(name)) => name,
        _ => "none",
    }
}

/// The side of a map by default, by which the edge band of techniques without one is measured.
const DEFAULT_SIZE: u32 = 1024;

/// The side of a light's map.
pub(super) fn size_of(shadow: &Settings) -> u32 {
    match shadow.get("size").map(|entry| &entry.value) {
        Some(Value::Integer(size)) => u32::try_from(*size).unwrap_or(DEFAULT_SIZE),
        _ => DEFAULT_SIZE,
    }
}

/// A scene's `[light.shadow]` with the keys of `setting` in place of its own, as with `render --set`; without keys that the
/// technique does not read. Written into the scene file it draws the same.
pub fn over(written: &Settings, setting: &Settings) -> Settings {
    let mut merged = setting.clone();
    merged.path.clone_from(&written.path);
    for (key, entry) in &written.entries {
        if merged.get(key).is_none() {
            merged.set(key, entry.clone());
        }
    }
    readable(&merged)
}

/// Without the keys that only other techniques read.
fn readable(settings: &Settings) -> Settings {
    let name = technique_of(settings);
    let (mine, others): (Vec<_>, Vec<_>) = TABLE.iter().partition(|technique| technique.name() == name);
    let keys = |rows: Vec<&&'static dyn Technique>| -> Vec<&str> {
        rows.into_iter().flat_map(|technique| techniques::keys(*technique)).collect()
    };
    let (mine, others) = (keys(mine), keys(others));
    let mut kept = settings.clone();
    kept.entries.retain(|(key, _)| {
        let key = key.as_str();
        key == "technique" || mine.contains(&key) || !others.contains(&key)
    });
    kept
}

/// Tests whether a scene without objects can be planned with `settings`: so every error of the settings alone is found
/// here, as for a frame's plan.
fn check_settings(bare: &Scene, light: usize, settings: &Settings) -> Result<(), plan::Error> {
    let views = vec![ViewRequest { view: View::Shade, light }];
    let request = Request { views, sampled_warnings: false, ..Request::default() };
    plan::make(&with_shadow(bare, light, settings), &request).map(|_| ())
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

impl Sweep {
    /// The rows of this shard that `done` does not have.
    pub fn todo(&self, options: &MeasureOptions, done: &[Row]) -> Vec<usize> {
        let (index, count) = options.shard;
        let done: HashSet<usize> = done.iter().map(|row| row.index).collect();
        (0..self.rows.len()).filter(|row| row % count == index - 1 && !done.contains(row)).collect()
    }

    /// Tests whether `row` is one of this sweep's, measured or not.
    pub fn has(&self, row: &Row) -> bool {
        let known = self.rows.get(row.index).map(|(known, _)| known);
        known.is_some_and(|known| known.technique == row.technique && known.settings == row.settings)
    }

    /// Measures `todo`, calling `finished` with each row as it is done, until all are or `stop` is set.
    ///
    /// # Errors
    ///
    /// A context that cannot be had.
    pub fn run(
        &self,
        todo: &[usize],
        options: &MeasureOptions,
        stop: &Arc<AtomicBool>,
        mut finished: impl FnMut(Row),
    ) -> Result<(), Error> {
        let work = |place: usize, renderer: &mut Renderer| self.row(todo[place], options, renderer);
        frame::on_contexts(&options.context, [todo.len(), options.jobs], stop, work, |_, row| finished(row))?;
        Ok(())
    }

    fn row(&self, index: usize, options: &MeasureOptions, renderer: &mut Renderer) -> Row {
        let (row, settings) = &self.rows[index];
        let scene = with_shadow(&self.scene, options.light, settings);
        let band = Band { texels: options.band_texels, map_size: [size_of(settings); 2] };
        let outcome = match measure(&scene, (&self.truth, self.colors.as_ref()), &band, options, renderer) {
            Ok(measured) => Outcome::Measured(Box::new(measured)),
            Err(why) => Outcome::Failed(why),
        };
        Row { outcome, ..row.clone() }
    }

    /// Draws the scene as written with and without the parts that its plan leaves out, and compares pixels, time and bytes.
    ///
    /// # Errors
    ///
    /// An error of the plan or the device.
    pub fn saved(&self, options: &MeasureOptions, renderer: &mut Renderer) -> Result<Saved, frame::Error> {
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

    /// A row, not measured.
    pub fn row_of(&self, index: usize) -> &Row {
        &self.rows[index].0
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

fn measure(
    scene: &Scene,
    (truth, colors): (&Truth, Option<&ColorTruth>),
    band: &Band,
    options: &MeasureOptions,
    renderer: &mut Renderer,
) -> Result<Measured, String> {
    let metrics = check(scene, options.light, truth, band, renderer)?;
    let colors = colors.map(|colors| compare_colors(scene, colors, renderer)).transpose();
    let colors = colors.map_err(|error| error.to_string())?.flatten();
    let request = Request { frames: 100, ..Request::default() };
    let plan = renderer.plan(scene, &request).map_err(|error| error.to_string())?;
    let costs = costs(&plan, options.runs, renderer).map_err(|error| error.to_string())?;
    let summary = plan.summary();
    Ok(Measured {
        metrics,
        colors,
        frame_redrawn: costs.redrawn,
        frame_kept: costs.kept,
        passes: costs.passes,
        image_bytes: summary.image_bytes,
        buffer_bytes: summary.buffer_bytes,
        draw_calls: summary.passes.iter().map(|pass| pass.draw_calls).sum(),
        triangles: summary.passes.iter().map(|pass| pass.triangles).sum(),
        work: work_of(&plan),
        left_out: plan.left_out,
        warnings: plan.warnings,
    })
}

/// Draws the shade and compares it with the truth. A frame is not timed before that.
fn check(scene: &Scene, light: usize, truth: &Truth, band: &Band, renderer: &mut Renderer) -> Result<Metrics, String> {
    let shade = draw_shade(scene, light, renderer).map_err(|error| error.to_string())?;
    metrics::compare(truth, &shade, band).map_err(|error| error.to_string())
}

/// The shade of one light as GL draws it.
///
/// # Errors
///
/// An error of the plan or the device.
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

/// Describes the machine that is measured on.
///
/// # Errors
///
/// A context that cannot be had.
pub fn machine(options: &MeasureOptions) -> Result<Machine, Error> {
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
        backend: context.backend().to_owned(),
        glumbra: env!("CARGO_PKG_VERSION").to_owned(),
        jobs: options.jobs,
    })
}
