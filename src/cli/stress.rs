//! `glumbra stress`: scenes against truth.

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::{ContextArgs, Error};
use crate::context::Profile;
use crate::stress::{self, CaseResult, Options, Row, Verdict, random, tally};

/// Draws extreme and random scenes by every technique and holds each picture against ray-traced truth.
#[derive(Debug, Args)]
pub struct StressArgs {
    /// The random scenes' seed
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,

    /// How many random scenes
    #[arg(long, value_name = "N", default_value_t = 100)]
    count: u64,

    /// Only cases whose name contains this text
    #[arg(long, value_name = "NAME")]
    case: Option<String>,

    /// Only rows of this technique
    #[arg(long, value_name = "NAME")]
    technique: Option<String>,

    /// Cases drawn at once
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,

    #[command(flatten)]
    context: ContextArgs,
}

pub fn run(arguments: &StressArgs) -> Result<(), Error> {
    let mut cases = stress::named::cases()?;
    cases.extend((0..arguments.count).map(|index| random::case(arguments.seed, index)));
    let cases: Vec<_> =
        cases.into_iter().filter(|case| arguments.case.as_ref().is_none_or(|name| case.name.contains(name))).collect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let options = Options {
        jobs: arguments.jobs.map_or(cores, usize::from),
        technique: arguments.technique.clone(),
        context: arguments.context.request(Profile::Core33),
    };
    let bar = ProgressBar::new(cases.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} cases, {eta} left  {msg}") {
        bar.set_style(style);
    }
    let mut results: Vec<Option<CaseResult>> = cases.iter().map(|_| None).collect();
    stress::run(&cases, &options, &Arc::new(AtomicBool::new(false)), |index, result| {
        results[index] = Some(result);
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let results: Vec<CaseResult> = results.into_iter().flatten().collect();
    let mut out = std::io::stdout().lock();
    for result in &results {
        if let Some(why) = &result.refused {
            writeln!(out, "{}: refused: {why}", result.name)?;
        }
        for row in result.rows.iter().filter(|row| row.verdict != Verdict::Right) {
            writeln!(
                out,
                "{}: light {} {} | {} {:.3} % beyond {} of {} | {}",
                result.name,
                row.light,
                row.settings.to_inline(),
                row.verdict.name(),
                row.wrong_percent(),
                row.beyond,
                row.compared,
                row.why
            )?;
        }
    }
    let rows: Vec<&Row> = results.iter().flat_map(|result| &result.rows).collect();
    writeln!(out, "{:?}", tally(rows.iter().copied()))?;
    let seconds: f64 = results.iter().map(|r| r.seconds).sum();
    writeln!(
        out,
        "{seconds:.1} s, decided {:.3}",
        results.iter().map(|r| r.decided).sum::<f64>() / results.len() as f64
    )?;
    Ok(())
}
