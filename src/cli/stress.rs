//! `glumbra stress`: scenes against truth.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;

use super::report::{parse_shard, stop_on_interrupt};
use super::scene_args::parse_size;
use super::screen::Screen;
use super::{ContextArgs, Error, json};
use crate::context::{self, Profile};
use crate::frame::Renderer;
use crate::stress::files::{self, FileChanges};
use crate::stress::{self, Case, CaseResult, StressOptions, Verdict, named, random};
use crate::techniques::TABLE;

/// Draws extreme and random scenes, or models and scenes of yours, by every technique and holds each picture against ray-traced
/// truth.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct StressArgs {
    /// Models (.obj, .md2, .gltf, .glb, .ply, .stl) and scenes (.toml) to judge in place of the named and the random ones. Lights
    /// of every kind are put around a model, beside its own; an animated one is drawn as it stands and at a third and two
    /// thirds of its animation
    #[arg(value_name = "FILE", conflicts_with_all = ["seed", "count"])]
    files: Vec<PathBuf>,

    /// Size of the files' pictures in pixels; 160x120 where absent
    #[arg(long, value_name = "WxH", value_parser = parse_size, requires = "files")]
    size: Option<[u32; 2]>,

    /// Changes a key of each file's scene, as for `glumbra render`
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "files")]
    set: Vec<String>,

    /// A time at which the files' animations are drawn, in place of the three; may be given several times
    #[arg(long, value_name = "SECONDS", requires = "files")]
    at: Vec<f64>,

    /// The random scenes' seed: the same seed is the same scenes on every machine
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,

    /// Number of random scenes, in addition to the named cases
    #[arg(long, value_name = "N", default_value_t = 100)]
    count: u64,

    /// Only cases whose name contains this, e.g. `cone` or `random-1-17`
    #[arg(long, value_name = "NAME")]
    case: Option<String>,

    /// Only this technique
    #[arg(long, value_name = "NAME", value_parser = parse_technique)]
    technique: Option<String>,

    /// One in N of each technique's changed settings, others in each case; its defaults always
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=100))]
    one_in: u16,

    /// Cases drawn at once; one a core where absent
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,

    /// Only the I-th of N parts of the cases
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parse_shard)]
    shard: (usize, usize),

    /// Writes every row as JSON to a file; - is standard output, in place of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// A folder for stress.html, stress.json, and failing scenes made small; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Lists the cases and draws nothing
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    context: ContextArgs,
}

const HELP: &str = "\
Verdicts:
  right           within the technique's bound
  false alarm     within it, although the plan warns
  warned          outside it, with a warning in the plan
  refused         an error instead of a picture; of a file: it cannot be loaded
  silently wrong  outside it, without a warning

The bound: a shadow volume has no wrong pixel where the ray caster is certain. A map has wrong pixels only within a lookup's \
reach of a silhouette or a crease, or where a shadow is thinner than its bias, and at most 1.5 % of the surfaces that face \
the light. Colours of projected light and of bumps lie within bounds that a sample's error, roundings and tables explain; \
with shadow maps in dust or through a lens, so does their mean. A scene that fails is reduced, and written as a scene file \
for `glumbra render`.

What a file's loader warns of is printed, and excuses no wrong picture of what it did load.

Exit status: 0 nothing is silently wrong, 1 something is, 2 nothing could be run.

Examples:
  glumbra stress
  glumbra stress --seed 7 --count 1000 -o out/stress
  glumbra stress --count 0 --case cone --technique shadow-map
  glumbra stress --count 50 --case projected    # beams, lenses, bumps, …
  glumbra stress models/*.glb -o out/models     # models of yours
  glumbra stress robot.glb --at 0.5 --at 2 --technique shadow-volume
  parallel glumbra stress --count 10000 --shard {}/4 -o part{} ::: 1 2 3 4";

/// Scenes reduced at most: each takes some seconds.
const MOST_REDUCED: usize = 12;

fn parse_technique(text: &str) -> Result<String, String> {
    let names = || TABLE.iter().map(|technique| technique.name()).filter(|name| *name != "none");
    match names().any(|name| name == text) {
        true => Ok(text.to_owned()),
        false => Err(crate::scene::suggest(text, names())),
    }
}

/// Draws, judges, prints, writes.
pub fn run(arguments: &StressArgs, screen: Screen) -> ExitCode {
    match stress(arguments, screen) {
        Ok(status) => ExitCode::from(status),
        Err(error) => super::failure(error, 2),
    }
}

/// The exit status.
fn stress(arguments: &StressArgs, screen: Screen) -> Result<u8, Error> {
    let cases = cases(arguments)?;
    if arguments.list {
        let mut out = std::io::stdout().lock();
        cases.iter().try_for_each(|case| writeln!(out, "{}: {}", case.name, case.why))?;
        return Ok(0);
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let options = StressOptions {
        jobs: arguments.jobs.map_or(cores, usize::from),
        technique: arguments.technique.clone(),
        one_in: arguments.one_in.into(),
        pictures: arguments.output.is_some(),
        context: arguments.context.request(Profile::Core33),
    };
    let stop = stop_on_interrupt();
    let results = draw(&cases, &options, &stop, screen)?;
    if !arguments.files.is_empty() {
        for (name, why) in results.iter().filter_map(|result| Some((&result.name, result.refused.as_ref()?))) {
            super::say(format_args!("error: {name} is refused: {why}"));
        }
    }
    if let Some(folder) = &arguments.output {
        let reduced = reduce(&cases, &results, &options, screen)?;
        stress::write(folder, arguments.seed, &results, &reduced)?;
    }
    if let Some(path) = &arguments.json {
        json::put(path, &stress::to_json(arguments.seed, &results)?)?;
    }
    if !arguments.json.as_deref().is_some_and(json::is_standard_stream) {
        print(arguments, &results)?;
    }
    let is_nothing_drawn = !results.is_empty() && results.iter().all(|result| result.refused.is_some());
    Ok(match results.iter().any(CaseResult::fails) {
        true => 1,
        false if is_nothing_drawn && !arguments.files.is_empty() => 2,
        false => 0,
    })
}

/// The cases of the files. Those of one name are numbered.
fn file_cases(arguments: &StressArgs) -> Result<Vec<Case>, Error> {
    let changes = FileChanges { size: arguments.size, set: arguments.set.clone(), at: arguments.at.clone() };
    let mut all: Vec<Case> = Vec::new();
    for path in &arguments.files {
        std::fs::metadata(path).map_err(|error| Error::ReadFile { path: path.clone(), error })?;
        let (cases, warnings) = files::cases(path, &changes);
        warnings.iter().for_each(|warning| super::say(format_args!("warning: {warning}")));
        for case in cases {
            let numbered = (2..).map(|number| format!("{}-{number}", case.name));
            let mut names = std::iter::once(case.name.clone()).chain(numbered);
            let is_free = |name: &String| all.iter().all(|other| other.name != *name);
            let Some(name) = names.find(is_free) else { continue };
            all.push(Case { name, ..case });
        }
    }
    Ok(all)
}

/// The files' cases, or the named and the random ones, of this shard, by the filter.
fn cases(arguments: &StressArgs) -> Result<Vec<Case>, Error> {
    let is_of_files = !arguments.files.is_empty();
    let named = if is_of_files { file_cases(arguments)? } else { named::cases()? }.into_iter();
    let random = (0..if is_of_files { 0 } else { arguments.count }).map(|index| random::case(arguments.seed, index));
    let (part, parts) = arguments.shard;
    // Drawn where they are named: they take the colours of every pixel.
    let named_projected = !is_of_files && arguments.case.as_ref().is_some_and(|name| name.starts_with("projected"));
    let projected = (0..if named_projected { arguments.count } else { 0 })
        .map(|index| stress::projected::case(arguments.seed, index));
    let of_shard = named.chain(random).chain(projected).enumerate().filter(|(index, _)| index % parts == part - 1);
    let is_wanted = |case: &Case| arguments.case.as_ref().is_none_or(|name| case.name.contains(name.as_str()));
    let cases: Vec<Case> = of_shard.map(|(_, case)| case).filter(is_wanted).collect();
    match (cases.is_empty(), &arguments.case) {
        (true, Some(name)) if !is_of_files => Err(Error::NoSuchCase { name: name.clone() }),
        (true, Some(name)) => Err(Error::NoSuchFileCase { name: name.clone() }),
        _ => Ok(cases),
    }
}

fn draw(
    cases: &[Case],
    options: &StressOptions,
    stop: &Arc<AtomicBool>,
    screen: Screen,
) -> Result<Vec<CaseResult>, Error> {
    let bar = screen.bar(cases.len() as u64, "{bar:40} {pos}/{len} cases, {eta} left  {msg}");
    let mut results: Vec<Option<CaseResult>> = cases.iter().map(|_| None).collect();
    let mut failing = 0;
    stress::run(cases, options, stop, |index, result| {
        failing += usize::from(result.fails());
        if failing > 0 {
            bar.set_message(format!("{failing} silently wrong"));
        }
        results[index] = Some(result);
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    Ok(results.into_iter().flatten().collect())
}

/// The first failing cases, each made small under its first setting that is silently wrong.
fn reduce(cases: &[Case], results: &[CaseResult], options: &StressOptions, screen: Screen) -> Result<Vec<Case>, Error> {
    let failing = results.iter().filter_map(|result| {
        let row = result.rows.iter().find(|row| row.verdict == Verdict::SilentlyWrong)?;
        Some((cases.iter().find(|case| case.name == result.name)?, row.settings.to_inline()))
    });
    let failing: Vec<_> = failing.take(MOST_REDUCED).collect();
    if failing.is_empty() {
        return Ok(Vec::new());
    }
    let context = context::open(&options.context)?;
    let mut renderer = Renderer::new(&context);
    let options = StressOptions { pictures: false, ..options.clone() };
    let bar = screen.spinner("making {msg} small");
    let mut reduced = Vec::new();
    for (case, inside) in failing {
        bar.set_message(case.name.clone());
        bar.tick();
        reduced.extend(stress::reduce(case, &inside, &options, &mut renderer));
    }
    bar.finish_and_clear();
    Ok(reduced)
}

fn print(arguments: &StressArgs, results: &[CaseResult]) -> Result<(), Error> {
    const UNKNOWN_WIDTH: u16 = 160;
    let width = terminal_size::terminal_size().map_or(UNKNOWN_WIDTH, |(width, _)| width.0);
    let mut out = std::io::stdout().lock();
    out.write_all(stress::to_text(results, width).as_bytes())?;
    if let Some(folder) = &arguments.output {
        writeln!(out, "{}", folder.join("stress.html").display())?;
    }
    Ok(())
}
