//! `glumbra report`: errors against run time over a grid of settings, and `glumbra report merge`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, Subcommand};

use super::report_light::{measure_light, print_sweeps};
use super::scene_args::SceneChanges;
use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::context::{self, Profile};
use crate::frame::Renderer;
use crate::report::measure::documents::ClaimRequest;
use crate::report::measure::grid::{self, Grid};
use crate::report::measure::picks::Goals;
use crate::report::measure::run::{self, MeasureOptions, Sweep};
use crate::report::measure::sweeps::MeasuredSweep;
use crate::report::measure::{claims, documents, light_claims, picks};
use crate::report::show::html::ReportPictures;
use crate::report::store::journal::{self, Journal, Known};
use crate::report::store::results::{Outcome, Report, Row, SceneReport, VERSION};
use crate::report::store::{fingerprint, merge, picture_files, pictures, write};

/// Measures how wrong shadows and projected light are against ray-traced truth, and what they cost, over a grid of techniques
/// and settings.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, after_help = HELP)]
pub struct ReportArgs {
    #[command(subcommand)]
    command: Option<ReportCommand>,

    /// Scenes (.toml) or models (.obj)
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,

    /// The folder for report.html, report.json, report.csv and plots; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Sweeps the settings of this file in place of every technique's own
    #[arg(long, value_name = "FILE")]
    grid: Option<PathBuf>,

    /// Few settings, few runs
    #[arg(long)]
    quick: bool,

    /// Settings measured at once; above 1 their times disturb each other
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: u16,

    /// Timed frames for each setting; 5, or 3 when quick
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    runs: Option<u16>,

    /// The light whose shadow is measured, by its place in the scene
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,

    /// Measures only the I-th of N parts of the grid; `glumbra report merge` joins them
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parse_shard)]
    shard: (usize, usize),

    /// Continues an interrupted run into the same folder
    #[arg(long)]
    resume: bool,

    /// Error limit, in percent of the pixels: prints the fastest setting within it
    #[arg(long, value_name = "PERCENT", default_value_t = 0.1)]
    error: f64,

    /// Time limit for a frame, in milliseconds: prints the most accurate setting within it
    #[arg(long, value_name = "MS", default_value_t = 16.7)]
    time: f64,

    /// Half width of the band around the true shadow edge, in texels of the map
    #[arg(long, value_name = "TEXELS", default_value_t = 2.0)]
    band: f64,

    #[command(flatten)]
    changes: SceneChanges,

    #[command(flatten)]
    context: ContextArgs,
}

#[derive(Debug, Subcommand)]
enum ReportCommand {
    /// Joins the parts that --shard made, on this machine or on others, to one report
    Merge(MergeArgs),
}

#[derive(Debug, Args)]
struct MergeArgs {
    /// Folders of reports, or their report.json
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,

    /// The folder for the joined report
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,

    /// Error limit, in percent of the pixels: prints the fastest setting within it
    #[arg(long, value_name = "PERCENT", default_value_t = 0.1)]
    error: f64,

    /// Time limit for a frame, in milliseconds: prints the most accurate setting within it
    #[arg(long, value_name = "MS", default_value_t = 16.7)]
    time: f64,
}

const HELP: &str = "\
A grid file varies what it lists:
  [[sweep]]
  technique = \"shadow-map\"
  size = [512, 1024, 2048]
  filter = [\"nearest\", \"linear\"]
  offset = [{ factor = 1.1, units = 4.0 }, { factor = 2.0, units = 4.0 }]

Examples:
  glumbra report data/scenes/main.toml -o out/report --quick
  glumbra report a.toml b.toml -o out/report --grid grid.toml --error 0.05
  parallel glumbra report a.toml -o part{} --shard {}/4 ::: 1 2 3 4
  glumbra report merge part* -o out/report

A row is the scene's own [light.shadow] with the row's keys in place of its own, as `render --set` would draw it. All rows are \
checked before the first is drawn; a grid has at most 100000. The settings to take are printed as TOML; they take the place of \
[light.shadow]. Rows that could not be measured end in exit code 1, and the report holds the others.

Without a grid file the report also measures, on each scene, what the techniques' documents claim, and sweeps the keys of \
projected light that the light has: focus.samples, dust.slices, the filter of its image. Colours are compared by RMSE, by the \
greatest difference, by the share of pixels beyond a bound and by FLIP.

Ctrl-C leaves a report of the rows so far; --resume continues it.";

/// `I/N`.
pub(super) fn parse_shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    match parts {
        Some((index, count)) if (1..=count).contains(&index) => Ok((index, count)),
        _ => Err(String::from("write it as I/N with 1 <= I <= N, e.g. 2/8")),
    }
}

/// Measures and writes, or merges.
pub fn run(arguments: &ReportArgs, screen: Screen) -> Result<(), Error> {
    if let Some(ReportCommand::Merge(merge)) = &arguments.command {
        return run_merge(merge);
    }
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from("report"));
    let grid = match &arguments.grid {
        Some(path) => Grid::Own(grid::load(path)?),
        None => Grid::Standard { quick: arguments.quick },
    };
    let options = options(arguments);
    let sweeps = prepare(arguments, &grid, &options, screen)?;
    let mut report = Report {
        version: VERSION,
        complete: false,
        machine: run::machine(&options)?,
        notes: notes_of(&sweeps),
        asked_scenes: sweeps.len(),
        scenes: sweeps.iter().map(|sweep| sweep.report.clone()).collect(),
    };
    write::make_folder(&folder)?;
    let stop = stop_on_interrupt();
    let stamp = fingerprint::stamp(&report.machine, &options);
    if arguments.resume {
        take_up(&folder, &stamp, &sweeps, &mut report)?;
    }
    let mut journal = Journal::open(&folder, arguments.resume, &stamp)?;
    measure((&sweeps, screen), &options, &stop, &mut journal, &mut report)?;
    report.complete = report.has_all_rows();
    let goals = Goals { wrong_percent: arguments.error, milliseconds: arguments.time };
    let mut swept = Vec::new();
    if arguments.grid.is_none() && options.shard.0 == 1 && !stop.load(Ordering::Relaxed) {
        swept = measure_light((&sweeps, screen), &mut report, arguments.quick, &options)?;
        measure_claims((&sweeps, screen), &mut report, arguments.quick, &options)?;
    }
    let pictures = draw_pictures((&sweeps, &swept), &mut report, &options, &goals)?;
    write::write_all(&folder, &report, &pictures, &goals)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Error::Interrupted { folder });
    }
    journal.remove();
    let mut out = std::io::stdout().lock();
    report.scenes.iter().try_for_each(|scene| print_sweeps(scene, &mut out))?;
    report.scenes.iter().try_for_each(|scene| print_claims(scene, &mut out))?;
    print_answers(&report, &goals, &folder, &mut out)?;
    check_failures(&report, folder)
}

/// Parts of the standard grid that were left out, each once.
fn notes_of(sweeps: &[Sweep]) -> Vec<String> {
    sweeps.iter().flat_map(|sweep| sweep.notes.iter().cloned()).collect()
}

/// Prints the recommended settings, and the page's path.
fn print_answers(report: &Report, goals: &Goals, folder: &Path, out: &mut impl Write) -> Result<(), Error> {
    for scene in &report.scenes {
        writeln!(out, "{}", picks::to_text(scene, goals))?;
    }
    Ok(writeln!(out, "# {}", folder.join("report.html").display())?)
}

/// Reports rows that could not be measured, at the end, when the others are safe.
fn check_failures(report: &Report, folder: PathBuf) -> Result<(), Error> {
    let failed: Vec<&Row> = report.scenes.iter().flat_map(SceneReport::failed).collect();
    let rows = report.scenes.iter().map(|scene| scene.rows.len()).sum();
    match failed.first() {
        Some(Row { index, outcome: Outcome::Failed(why), .. }) => {
            Err(Error::FailedRows { failed: failed.len(), rows, row: *index, why: why.clone(), folder })
        }
        _ => Ok(()),
    }
}

fn options(arguments: &ReportArgs) -> MeasureOptions {
    MeasureOptions {
        light: arguments.light,
        runs: arguments.runs.map_or(if arguments.quick { 3 } else { 5 }, usize::from),
        jobs: usize::from(arguments.jobs),
        shard: arguments.shard,
        band_texels: arguments.band,
        context: arguments.context.request(Profile::Core33),
    }
}

fn prepare(arguments: &ReportArgs, grid: &Grid, options: &MeasureOptions, screen: Screen) -> Result<Vec<Sweep>, Error> {
    arguments.scenes.iter().try_for_each(|path| arguments.changes.check(path))?;
    let overrides = arguments.changes.overrides();
    let bar = screen.spinner("tracing the truth of {msg}");
    let prepared = arguments.scenes.iter().map(|path| {
        bar.set_message(path.display().to_string());
        bar.tick();
        run::prepare(path, &overrides, grid, options)
    });
    let sweeps: Vec<Sweep> = prepared.collect::<Result<_, _>>()?;
    bar.finish_and_clear();
    sweeps.iter().flat_map(|sweep| &sweep.warnings).for_each(|warning| super::say(format_args!("warning: {warning}")));
    Ok(sweeps)
}

/// Set by the first Ctrl-C; a second one ends the process.
pub(super) fn stop_on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = stop.clone();
    let handled = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    if let Err(error) = handled {
        super::say(format_args!("warning: Ctrl-C will not leave a report: {error}"));
    }
    stop
}

/// Takes over the rows of an earlier run from the journal, and warns of rejected ones.
fn take_up(folder: &Path, stamp: &str, sweeps: &[Sweep], report: &mut Report) -> Result<(), Error> {
    let is_known =
        |fingerprint: &str, row: &Row| match sweeps.iter().find(|sweep| sweep.report.fingerprint == fingerprint) {
            None => Known::OtherScene,
            Some(sweep) if sweep.has(row) => Known::Row,
            Some(_) => Known::NoSuchRow,
        };
    let done = journal::done(folder, stamp, is_known)?;
    done.warnings.iter().for_each(|warning| super::say(format_args!("warning: {warning}")));
    for scene in &mut report.scenes {
        let of_scene = done.rows.iter().filter(|(fingerprint, _)| *fingerprint == scene.fingerprint);
        scene.rows = of_scene.map(|(_, row)| row.clone()).collect();
    }
    Ok(())
}

/// Runs every scene's rows that are not there yet, and puts all of them into the journal and the report.
fn measure(
    (sweeps, screen): (&[Sweep], Screen),
    options: &MeasureOptions,
    stop: &Arc<AtomicBool>,
    journal: &mut Journal,
    report: &mut Report,
) -> Result<(), Error> {
    let todo: Vec<Vec<usize>> =
        sweeps.iter().zip(&report.scenes).map(|(sweep, scene)| sweep.todo(options, &scene.rows)).collect();
    let settings = todo.iter().map(|rows| rows.len() as u64).sum();
    let bar = screen.bar(settings, "{bar:40} {pos}/{len} settings, {eta} left  {msg}");
    for ((sweep, todo), scene) in sweeps.iter().zip(&todo).zip(&mut report.scenes) {
        bar.set_message(scene.path.display().to_string());
        let mut failure = None;
        sweep.run(todo, options, stop, |row| {
            if let Err(error) = journal.add(&sweep.report.fingerprint, &row) {
                failure = Some(error);
                stop.store(true, Ordering::Relaxed);
            }
            scene.rows.push(row);
            bar.inc(1);
        })?;
        if let Some(error) = failure {
            return Err(error.into());
        }
        scene.rows.sort_by_key(|row| row.index);
    }
    bar.finish_and_clear();
    Ok(())
}

/// Measures published claims on each scene.
fn measure_claims(
    (sweeps, screen): (&[Sweep], Screen),
    report: &mut Report,
    quick: bool,
    options: &MeasureOptions,
) -> Result<(), Error> {
    let context = context::open(&options.context)?;
    screen.driver(context.as_ref());
    let mut renderer = Renderer::new(&context);
    let bar = screen.spinner("published claims, on {msg}");
    for (sweep, scene) in sweeps.iter().zip(&mut report.scenes) {
        bar.set_message(scene.path.display().to_string());
        bar.tick();
        let (light, band) = (options.light, options.band_texels);
        let is_shaded = scene.unshaded.is_none() && !light_claims::has_lens(&sweep.scene, light);
        if is_shaded {
            let clear = run::in_clear_air(&sweep.scene);
            scene.claims = claims::measure(&clear, light, &sweep.truth, band, &mut renderer)?;
            let request = ClaimRequest { scene: &clear, light, truth: &sweep.truth, quick };
            let further = documents::measure(&request, &mut renderer, |what| {
                bar.set_message(format!("{}: {what}", sweep.report.path.display()));
                bar.tick();
            });
            scene.claims.extend(further.claims);
            scene.claim_sweeps = further.sweeps;
        }
        scene.claims.extend(light_claims::measure(&sweep.scene, light, &scene.sweeps, &mut renderer)?);
    }
    bar.finish_and_clear();
    Ok(())
}

fn print_claims(scene: &SceneReport, out: &mut impl Write) -> std::io::Result<()> {
    if scene.claims.is_empty() {
        return Ok(());
    }
    writeln!(out, "# Published claims, on {}:", scene.path.display())?;
    scene.claims.iter().try_for_each(|claim| writeln!(out, "#   {claim}"))
}

/// Draws the pictures, and the scene with everything that its plan leaves out.
fn draw_pictures(
    (sweeps, swept): (&[Sweep], &[Vec<MeasuredSweep>]),
    report: &mut Report,
    options: &MeasureOptions,
    goals: &Goals,
) -> Result<ReportPictures, Error> {
    let context = context::open(&options.context)?;
    let mut renderer = Renderer::new(&context);
    let mut pictures = ReportPictures::default();
    for (index, (sweep, scene)) in sweeps.iter().zip(&mut report.scenes).enumerate() {
        scene.saved = Some(sweep.saved(options, &mut renderer)?);
        let swept = swept.get(index).map_or(&[][..], Vec::as_slice);
        pictures.scenes.push(pictures::of(sweep, scene, swept, goals, &mut renderer)?);
    }
    Ok(pictures)
}

fn run_merge(arguments: &MergeArgs) -> Result<(), Error> {
    let load = |path: &PathBuf| merge::load(path).map(|report| (path.clone(), report));
    let parts = arguments.parts.iter().map(load).collect::<Result<Vec<_>, _>>()?;
    let mut report = merge::merge(parts)?;
    let goals = Goals { wrong_percent: arguments.error, milliseconds: arguments.time };
    let pictures = picture_files::of_parts(&arguments.parts, &mut report, &goals)?;
    write::make_folder(&arguments.output)?;
    write::write_all(&arguments.output, &report, &pictures, &goals)?;
    print_answers(&report, &goals, &arguments.output, &mut std::io::stdout().lock())?;
    check_failures(&report, arguments.output.clone())
}
