//! `glumbra test`: pixel tests of a folder, anyone's.

mod child;
mod files;
mod junit;
mod page;
mod results;
mod screen;
mod workers;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;

use self::child::Job;
use self::files::ResultFiles;
use self::results::TestResults;
use self::screen::TestScreen;
use self::workers::{TestNews, Workers};
use super::report::{parse_shard, stop_on_interrupt};
use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::cases::{self, CaseOutcome, PixelCase, Settings};
use crate::context::Profile;

/// Runs pixel tests: draws each case's scene, and checks what must be seen of it.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct TestArgs {
    /// Folders of cases: each folder at or below one that has a case.toml is a case
    #[arg(value_name = "DIR", required_unless_present = "child")]
    folders: Vec<PathBuf>,

    /// Only cases whose name, the path below DIR, contains this; may be given again
    #[arg(long, value_name = "TEXT", help_heading = "Which cases")]
    filter: Vec<String>,

    /// A filter is the whole name
    #[arg(long, requires = "filter", help_heading = "Which cases")]
    exact: bool,

    /// Only the I-th of N parts of the cases, for N machines
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parse_shard, help_heading = "Which cases")]
    shard: (usize, usize),

    /// Lists the names of the cases, a line each, and draws nothing
    #[arg(long, help_heading = "Which cases")]
    list: bool,

    /// Writes golden pictures; the run fails on purpose, as nobody has looked at them
    #[arg(long)]
    bless: bool,

    /// Cases at once; one a core where absent
    #[arg(long, value_name = "N", help_heading = "Processes", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,

    /// Seconds that a case may take before it is ended, and its verdict is HANG
    #[arg(long, value_name = "SECONDS", default_value_t = 120, help_heading = "Processes",
        value_parser = clap::value_parser!(u32).range(1..=86_400))]
    timeout: u32,

    /// Writes a JUnit report, for continuous integration: a test a case; - is standard output
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    junit: Option<PathBuf>,

    /// Writes the results as JSON; - is standard output
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    json: Option<PathBuf>,

    /// Writes a page to look at, index.html: failing cases with actual, expected and difference; made if it is not there
    #[arg(long, value_name = "FOLDER", help_heading = "Results")]
    html: Option<PathBuf>,

    /// Folder for pictures of failures; absent: case-failures in `target`, if there is one here
    #[arg(long, value_name = "FOLDER", help_heading = "Results")]
    failures: Option<PathBuf>,

    /// Runs the cases that standard input names, as a child process
    #[arg(long, hide = true)]
    child: bool,

    #[command(flatten)]
    context: ContextArgs,
}

const HELP: &str = "\
A case is a folder with a case.toml: a scene, and what must be seen of it. For example:

  asks = \"Does the box throw its shadow on the floor?\"
  scene = \"scene.toml\"          # beside case.toml

  [[pick]]
  at = [0.8, 0, -0.4]           # a point of the world; the test finds its pixel
  class = \"shadowed\"
  why = \"the box is between it and the lamp\"

  [[truth]]
  false_shadow = 0.1           # % of the pixels, by rays cast against the scene
  leak = 0.2
  edge = 0.5                   # pixels that edges may lie aside, in the mean
  why = \"a map of 1024 texels\"

  [golden]                      # golden.png, written by --bless
  max = 2                       # of 255
  mean = 0.05
  why = \"another compiler of its shaders rounds otherwise\"

Checks, in this order: GL errors, fails_with, warns, leaves_out, [[pick]], [[edge]], [[cone]], [[count]], [[same]], \
[[after]], [[sum]], [[truth]], [golden]. data/cases/README.md has every key. A check that could not fail is refused.

Another renderer can draw in glumbra's place:
  render = [\"my-engine\", \"--scene\", \"{scene}\", \"{kind}\", \"-o\", \"{out}\"]
It runs in the case's folder. {kind} is picture, or shade: a gray picture of how much of light number {light} arrives, 1 lit, \
0 shadowed. {width} and {height} are the scene's. {out} is a PNG file; {out.exr} and {out.npy} have floats.

JSON and JUnit are written as results come, once a second at most, so that a run that is killed leaves what it has: \
`unfinished` names the cases that have not ended. The page is written at the end, or after Ctrl-C.

Verdicts: pass, FAIL, BLESSED (a golden was written); CRASH, HANG and OUT OF MEMORY of the process that ran the case, which \
the others survive.

Exit status: 0 all pass, 1 a case fails or was blessed, 2 nothing could be run, 130 interrupted.

Examples:
  glumbra test data/cases
  glumbra test tests/pixels --filter shadow --html out/failures
  glumbra test tests/pixels --bless        # look at each, run again
  glumbra test tests/pixels --junit test.xml --json test.json --shard 2/4";

/// Time beyond --timeout in which a case that runs a command is expected to end it and to say so.
const GRACE: Duration = Duration::from_secs(3);

/// Runs, prints, writes.
pub fn run(arguments: &TestArgs, screen: Screen) -> ExitCode {
    let result = match arguments.child {
        true => child::run(settings(arguments)).map(|()| ExitCode::SUCCESS),
        false => test(arguments, screen),
    };
    result.unwrap_or_else(|error| super::failure(error, 2))
}

fn settings(arguments: &TestArgs) -> Settings {
    Settings {
        context: arguments.context.request(Profile::Core33),
        failures: failures(arguments),
        bless: arguments.bless,
        limit: Duration::from_secs(arguments.timeout.into()),
    }
}

/// Folder for pictures of failures: where cargo builds, if it does.
fn failures(arguments: &TestArgs) -> PathBuf {
    const NAME: &str = "case-failures";
    if let Some(folder) = &arguments.failures {
        return folder.clone();
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.or_else(|| Path::new("target").is_dir().then(|| PathBuf::from("target")));
    target.map_or_else(|| PathBuf::from(NAME), |target| target.join(NAME))
}

fn test(arguments: &TestArgs, screen: Screen) -> Result<ExitCode, Error> {
    let found = cases::choose(cases::find(&arguments.folders)?, &arguments.filter, arguments.exact)?;
    let found = cases::shard(found, arguments.shard);
    if arguments.list {
        let names: String = found.iter().map(|case| format!("{}\n", case.name)).collect();
        return super::print(&names).map(|()| ExitCode::SUCCESS);
    }
    let cases = read(&found)?;
    let files = ResultFiles::new(arguments.json.as_deref(), arguments.junit.as_deref(), arguments.html.as_deref())?;
    let mut run = Run {
        screen: TestScreen::new(cases.len(), screen, files.take_standard_output()),
        results: TestResults::new(&arguments.folders, cases.iter().map(|case| case.name.as_str())),
        files,
        cases,
        has_warned: false,
    };
    let ended = run.all(arguments);
    run.screen.finish();
    run.results.take_time();
    let interrupted = match ended {
        Err(error) if run.results.cases.is_empty() => return Err(error),
        ended => {
            let written = run.files.write(&run.results);
            // The screen has the results if the files have not.
            run.screen.end(&run.results, arguments.bless)?;
            written?;
            ended?
        }
    };
    Ok(match interrupted {
        true => ExitCode::from(130),
        false => ExitCode::from(u8::from(run.results.fails())),
    })
}

/// Reads all cases. Every file that cannot be used is named.
fn read(found: &[cases::FoundCase]) -> Result<Vec<PixelCase>, Error> {
    let mut read = Vec::new();
    let mut errors = Vec::new();
    for case in found {
        match PixelCase::read(&case.folder, &case.name) {
            Ok(case) => read.push(case),
            Err(error) => errors.push(error),
        }
    }
    match errors.pop() {
        None => Ok(read),
        Some(last) => {
            errors.iter().for_each(|error| super::say(format_args!("error: {error}")));
            Err(last.into())
        }
    }
}

/// A run so far.
struct Run {
    cases: Vec<PixelCase>,
    screen: TestScreen,
    results: TestResults,
    files: ResultFiles,
    /// It was said that a file cannot be written while cases are run.
    has_warned: bool,
}

impl Run {
    /// Runs the cases in child processes. Returns whether the run was interrupted.
    fn all(&mut self, arguments: &TestArgs) -> Result<bool, Error> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let count = arguments.jobs.map_or(cores, usize::from).min(self.cases.len()).max(1);
        let limit = Duration::from_secs(arguments.timeout.into());
        let jobs = self.cases.iter().map(|case| {
            let grace = if case.checks.render.is_some() { GRACE } else { Duration::ZERO };
            (Job { folder: case.folder.clone(), name: case.name.clone() }, limit + grace)
        });
        let stop = stop_on_interrupt();
        let workers = Workers { words: for_child(arguments), jobs: jobs.collect(), count, cores, stop: stop.clone() };
        workers.run(|news| self.hear(news))?;
        Ok(stop.load(std::sync::atomic::Ordering::Relaxed))
    }

    fn hear(&mut self, news: TestNews) {
        match news {
            TestNews::Begins(index) => self.screen.begins(&self.cases[index].name),
            TestNews::Ended { outcome, driver } => {
                self.results.driver = self.results.driver.take().or(driver);
                self.add(*outcome);
            }
            TestNews::Died { index, verdict, seconds, message } => {
                self.add(CaseOutcome::ended(&self.cases[index], verdict, seconds, message));
            }
            TestNews::Said(text) => self.screen.said(&text),
            TestNews::Tick => self.screen.tick(),
        }
        if let Err(error) = self.files.write_unfinished(&mut self.results)
            && !std::mem::replace(&mut self.has_warned, true)
        {
            // The cases are run nevertheless, and each write is another attempt.
            self.screen.said(&format!("warning: {error}"));
        }
    }

    fn add(&mut self, outcome: CaseOutcome) {
        self.screen.ended(&outcome);
        self.results.add(outcome);
        self.files.note_result();
    }
}

/// Words of the command line that a child process is given.
fn for_child(arguments: &TestArgs) -> Vec<String> {
    let mut words = vec!["test".to_owned(), "--child".to_owned(), format!("--timeout={}", arguments.timeout)];
    words.push(format!("--failures={}", failures(arguments).display()));
    words.extend(arguments.bless.then(|| "--bless".to_owned()));
    words.extend(arguments.context.to_words());
    words
}
