//! Runs a grid over a scene: each row is drawn, compared with the truth and timed, in this order.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::costs::{costs, work_of};
use super::grid::{self, Grid};
pub use super::options::MeasureOptions;
use super::reference::{self, Reference};
use crate::context;
use crate::frame::{self, Renderer, draw_shade};
use crate::judge::colors::{self, compare_colors};
use crate::judge::metrics::{Band, Metrics, Ruler};
use crate::plan::{self, Request, ViewRequest};
use crate::report::store::fingerprint;
use crate::report::store::results::{
    Cost, Machine, Measured, Outcome, Row, Saved, SceneReport, Spread, TruthSummary, bytes_of,
};
use crate::scene::{self, Loaded, Scene, Settings, SettingsError, Shadow, with_shadow};
use crate::techniques::{self, LightShadow, vary};
use crate::truth::{self, Answer, Truth};
use crate::views::View;

/// Reason why a report cannot be started. Errors of a row are kept in that row.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The scene does not load.
    #[error(transparent)]
    Scene(#[from] scene::Error),
    /// There is no context to measure on.
    #[error(transparent)]
    Context(#[from] context::Error),
    /// The ray tracer has no answer for the scene.
    #[error(transparent)]
    Truth(#[from] truth::Error),
    /// There are no colours to compare with.
    #[error("{scene}: no colours to compare with: {reason}", scene = .scene.display())]
    Reference { scene: PathBuf, reason: Box<reference::Error> },
    /// A grid of shadow settings for a light that casts no shadow.
    #[error("{scene}: light {light} has no [light.shadow] to sweep: {why}; leave out --grid", scene = .scene.display())]
    NoShade { scene: PathBuf, light: usize, why: &'static str },
    /// A row of the grid makes no valid scene.
    #[error("{scene}: the grid's row {inline}: {reason}", scene = .scene.display())]
    Row { scene: PathBuf, inline: String, reason: String },
    /// The scene does not have the light.
    #[error("there is no light {index}: the scene's number of lights is {count}")]
    NoLight { index: usize, count: usize },
    /// The shard is none of 1/N to N/N.
    #[error("--shard {index}/{count}: write I/N with 1 <= I <= N")]
    Shard { index: usize, count: usize },
}

/// A scene ready to be swept.
pub struct Sweep {
    /// The scene as written.
    pub scene: Scene,
    /// The ray tracer's answer for the measured light.
    pub truth: Truth,
    /// Colours to compare with, if light and shadow alone do not say what they should be.
    pub colors: Option<Reference>,
    /// The scene's part of the report, still without rows.
    pub report: SceneReport,
    /// Warnings of loading the scene and laying out its grid.
    pub warnings: Vec<String>,
    /// Notes on the grid, for the report.
    pub notes: Vec<String>,
    /// By index; row 0 is the scene as written.
    rows: Vec<GridRow>,
}

/// A row that can be measured.
struct GridRow {
    row: Row,
    /// The light's settings in this row; or why the scene's objects cannot be drawn with them.
    shadow: Result<Shadow, SettingsError>,
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
    let Loaded { scene, mut warnings } = techniques::load(path, overrides)?;
    let count = scene.lights.len();
    if options.light >= count {
        return Err(Error::NoLight { index: options.light, count });
    }
    let Layout { rows, left_out } = layout(path, &scene, options.light, grid)?;
    warnings.extend(left_out.iter().cloned());
    let unshaded = colors::why_unshaded(&scene, options.light);
    let start = Instant::now();
    // Without a shade to compare, only the surfaces that are seen are of use.
    let sure = truth::Options::default();
    let most_ambiguous = if unshaded.is_some() { 1.0 } else { sure.most_ambiguous };
    let truth = truth::trace(&scene, options.light, &truth::Options { most_ambiguous, ..sure })?;
    let trace_ms = start.elapsed().as_secs_f64() * 1e3;
    let colors = if colors::has_projected_light(&scene) { Some(colors_of(path, &scene, options)?) } else { None };
    let report = SceneReport {
        path: path.to_owned(),
        path_bytes: bytes_of(path),
        fingerprint: fingerprint::of_rows(&scene, rows.iter().map(|row| &row.row), options),
        light: options.light,
        size: scene.image.size,
        triangles: scene.objects.iter().map(|object| object.mesh.triangle_count() as u64).sum(),
        truth: summarise(&truth, trace_ms),
        unshaded: unshaded.map(str::to_owned),
        colors_from: colors.as_ref().map(|colors| colors.from.clone()),
        saved: None,
        claims: Vec::new(),
        claim_sweeps: Vec::new(),
        sweeps: Vec::new(),
        grid_rows: rows.len(),
        rows: Vec::new(),
    };
    Ok(Sweep { scene, truth, colors, report, warnings, notes: left_out, rows })
}

fn colors_of(path: &Path, scene: &Scene, options: &MeasureOptions) -> Result<Reference, Error> {
    let context = context::open(&options.context)?;
    let mut renderer = Renderer::new(&context);
    let colors = reference::reference(scene, options.light, &mut renderer);
    colors.map_err(|reason| Error::Reference { scene: path.to_owned(), reason: Box::new(reason) })
}

/// The rows of a scene's grid, and the parts of the standard grid that do not go with the scene's own keys.
struct Layout {
    rows: Vec<GridRow>,
    left_out: Vec<String>,
}

/// Row 0 is the scene as written; the others are the grid's over it.
fn layout(path: &Path, scene: &Scene, light: usize, grid: &Grid) -> Result<Layout, Error> {
    let source = &scene.lights[light];
    let bare = Scene { objects: Vec::new(), ..scene.clone() };
    let first = row_of(0, &vary::readable(source.shadow.written()), &source.shadow);
    let first = GridRow { row: first, shadow: Ok(source.shadow.clone()) };
    let mut layout = Layout { rows: vec![first], left_out: Vec::new() };
    if let Some(why) = why_not_swept(scene, light) {
        match (grid, colors::why_unshaded(scene, light)) {
            (Grid::Standard { .. }, _) => {
                let path = path.display();
                layout.left_out.push(format!("{path}: the grid of shadow settings is left out: {why}"));
                return Ok(layout);
            }
            (Grid::Own(settings), Some(why)) if !settings.is_empty() => {
                return Err(Error::NoShade { scene: path.to_owned(), light, why });
            }
            (Grid::Own(_), _) => {}
        }
    }
    // Dust is drawn with objects only, and does not go with every technique.
    let planned = if source.dust.is_some() { scene } else { &bare };
    for setting in grid.settings(&source.kind)? {
        let settings = vary::over(source.shadow.written(), &setting);
        match check_settings([&bare, planned], light, &settings) {
            Ok(shadow) => {
                let row = row_of(layout.rows.len(), &settings, &shadow);
                let shadow = techniques::read(settings, &source.kind, &scene.objects);
                layout.rows.push(GridRow { row, shadow });
            }
            Err(reason) => {
                let inline = grid::to_inline(&setting);
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

/// Reason why the standard grid has no place on this light.
fn why_not_swept(scene: &Scene, light: usize) -> Option<String> {
    let lens = || scene.lights.get(light).and_then(|light| light.spot()?.lens());
    colors::why_unshaded(scene, light).map(str::to_owned).or_else(|| {
        let samples = lens()?.samples;
        Some(format!(
            "light {light} has a lens, so that each of its rows would be drawn through {samples} lens points, and the shade of \
             its middle says little of soft shadows. --grid sweeps what it names"
        ))
    })
}

/// A row that is not measured yet.
fn row_of(index: usize, settings: &Settings, shadow: &Shadow) -> Row {
    let keys = settings.entries.iter().filter(|(key, _)| key != "technique");
    let settings_text = keys.map(|(key, entry)| (key.clone(), entry.value.to_toml())).collect();
    let technique = vary::technique_of(settings).to_owned();
    let map_size = LightShadow::of(shadow).and_then(LightShadow::map).map(|map| map.size);
    Row { index, technique, settings: settings_text, map_size, outcome: Outcome::Failed(String::new()) }
}

/// Reads `settings` for a scene without objects, and plans them in another: so every error of the settings alone is found
/// here.
fn check_settings([bare, planned]: [&Scene; 2], light: usize, settings: &Settings) -> Result<Shadow, String> {
    let shadow = techniques::read(settings.clone(), &bare.lights[light].kind, &bare.objects);
    let shadow = shadow.map_err(|error| error.to_string())?;
    let views = vec![ViewRequest { view: View::Shade, light }];
    let request = Request { views, sampled_warnings: false, ..Request::default() };
    plan::make(&with_shadow(planned, light, &shadow), &request).map_err(|error| error.to_string())?;
    Ok(shadow)
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
        let known = self.rows.get(row.index).map(|known| &known.row);
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
        let ruler = Ruler::new(&self.truth);
        let work = |place: usize, renderer: &mut Renderer| self.row(todo[place], &ruler, options, renderer);
        frame::on_contexts(&options.context, [todo.len(), options.jobs], stop, work, |_, row| finished(row))?;
        Ok(())
    }

    fn row(&self, index: usize, ruler: &Ruler<'_>, options: &MeasureOptions, renderer: &mut Renderer) -> Row {
        let GridRow { row, shadow } = &self.rows[index];
        let outcome = match shadow {
            Ok(shadow) => self.outcome(shadow, ruler, options, renderer),
            Err(error) => Outcome::Failed(error.to_string()),
        };
        Row { outcome, ..row.clone() }
    }

    fn outcome(
        &self,
        shadow: &Shadow,
        ruler: &Ruler<'_>,
        options: &MeasureOptions,
        renderer: &mut Renderer,
    ) -> Outcome {
        let scene = with_shadow(&self.scene, options.light, shadow);
        let band = Band { texels: options.band_texels, map_size: [techniques::map_size(shadow); 2] };
        match self.measure(&scene, (ruler, &band), options, renderer) {
            Ok(measured) => Outcome::Measured(Box::new(measured)),
            Err(why) => Outcome::Failed(why),
        }
    }

    fn measure(
        &self,
        scene: &Scene,
        (ruler, band): (&Ruler<'_>, &Band),
        options: &MeasureOptions,
        renderer: &mut Renderer,
    ) -> Result<Measured, String> {
        let metrics = match &self.report.unshaded {
            None => check(scene, options.light, ruler, band, renderer)?,
            Some(_) => Metrics::none(band),
        };
        let colors = self.colors.as_ref().map(|colors| compare_colors(scene, &colors.colors, renderer)).transpose();
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
        &self.rows[index].row
    }

    /// The scene with a row's settings; `None`: they cannot draw its objects.
    pub fn scene_of(&self, index: usize) -> Option<Scene> {
        let shadow = self.rows.get(index)?.shadow.as_ref().ok()?;
        Some(with_shadow(&self.scene, self.report.light, shadow))
    }
}

/// Draws the shade and compares it with the truth. A frame is not timed before that.
fn check(
    scene: &Scene,
    light: usize,
    ruler: &Ruler<'_>,
    band: &Band,
    renderer: &mut Renderer,
) -> Result<Metrics, String> {
    let shade = draw_shade(&in_clear_air(scene), light, renderer).map_err(|error| error.to_string())?;
    ruler.compare(&shade, band).map_err(|error| error.to_string())
}

/// The scene without dust, which no shade shows.
pub fn in_clear_air(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.lights.iter_mut().for_each(|light| light.dust = None);
    scene
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
