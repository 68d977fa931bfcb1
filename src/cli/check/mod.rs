//! `glumbra check`: GL's rules for shadows and bump mapping on the driver at hand.

mod child;
mod children;
mod files;
mod reduce;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::ProgressBar;

pub use self::children::ChildError;
use self::children::Heard;
use self::files::Files;
use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::conformance::events::Event;
use crate::conformance::{self, Checked, Rule, RuleOutcome, baseline, events, waivers};
use crate::context::ContextInfo;

/// Runs GL's rules for shadows and bump mapping on the driver at hand: does it do what the specification says?
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct CheckArgs {
    /// Only rules with this id, kind or word: GL-C1, s, stencil; may be given again
    #[arg(long, value_name = "PATTERN")]
    filter: Vec<String>,

    /// Lists the rules, a line each, and draws nothing
    #[arg(long)]
    list: bool,

    /// Uses a core context, where rules of the fixed-function pipeline cannot be tested
    #[arg(long)]
    core: bool,

    /// Writes a JUnit report, for continuous integration: a case each check; - is standard output
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    junit: Option<PathBuf>,

    /// Writes all measurements as JSON; - is standard output
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    json: Option<PathBuf>,

    /// Compares with an earlier run that --json wrote: only what fails now and did not then fails this run
    #[arg(long, value_name = "FILE", help_heading = "Known failures")]
    baseline: Option<PathBuf>,

    /// Known deviations (TOML), in place of those that come with glumbra
    #[arg(long, value_name = "FILE", help_heading = "Known failures")]
    waivers: Option<PathBuf>,

    /// Writes waivers for all that fails, to be read by --waivers
    #[arg(long, value_name = "FILE", help_heading = "Known failures")]
    write_waivers: Option<PathBuf>,

    /// Seconds that a rule may take before it is ended, and its verdict is HANG
    #[arg(long, value_name = "SECONDS", default_value_t = 30, help_heading = "Processes",
        value_parser = clap::value_parser!(u32).range(1..=86_400))]
    timeout: u32,

    /// Writes the smallest program in C that shows the failure of this rule, in place of a run
    #[arg(long, value_name = "RULE", help_heading = "Bug report",
        conflicts_with_all = ["filter", "list", "json", "junit", "baseline", "waivers", "write_waivers", "repeat", "isolate", "here"])]
    reduce: Option<String>,

    /// File of --reduce, in place of RULE.c in this folder; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Bug report", requires = "reduce")]
    output: Option<PathBuf>,

    /// Runs all N times, keeps the worst of each check, and names checks that do not answer alike
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Processes",
        value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeat: u16,

    /// Processes at once; absent: one a core, 8 at most. 1 runs rule after rule, for a driver that shares badly
    #[arg(long, value_name = "N", help_heading = "Processes", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,

    /// Runs each rule in a process of its own, so that no rule meets what another has left
    #[arg(long, help_heading = "Processes")]
    isolate: bool,

    /// Runs all in this process, for a debugger or a tracer; a crash then ends the run
    #[arg(long, conflicts_with_all = ["isolate", "timeout", "jobs"], help_heading = "Processes")]
    here: bool,

    /// Rules to run, as a child process
    #[arg(long, hide = true, value_delimiter = ',')]
    child: Vec<String>,

    #[command(flatten)]
    context: ContextArgs,
}

impl CheckArgs {
    /// Words of the command line that a child process is given.
    fn for_child(&self) -> Vec<String> {
        let mut words = self.context.to_words();
        words.extend(self.core.then(|| "--core".to_owned()));
        words
    }
}

const HELP: &str = "\
A rule passes, has a quality warning (it is allowed, but good drivers do better), fails, or cannot be \
tested here. Verdicts come from bounds on what the specification allows, never from a picture.

Rules: C comparison, T coordinates, D depth, O polygon offset, S stencil, R raster, I invariance, \
F framebuffers, E texture environments, M cube maps, L levels and filters of textures, \
U uploads and read-backs, B blending, masks and clears, G GLSL, V vertices, Q queries, \
K sequences of calls, and large numbers, X what is generated at random and held against models. \
--list has all.

The rules run in child processes. What ends one is a verdict of the rule that it was at, and the rest \
goes on in a new one:
  CRASH          a signal, such as SIGSEGV, or an exit of the driver's own
  HANG           no end within --timeout
  OUT OF MEMORY  the driver, the system or GL says so
  CONTEXT LOST   GL says so: the GPU was reset
Files are tried before the run and written as results come. A run that is ended leaves what it has:
`unfinished` names the rules that are missing.

The screen has what does not pass; its last line names the rules that fail. Colours: NO_COLOR turns \
them off. With `--json -` or `--junit -` the screen's text goes to standard error.

A waiver names a deviation that is known, by driver, versions, rule and check:
  [[waiver]]
  renderer = \"llvmpipe\"         # the beginning of GL_RENDERER
  version = \"Mesa \"            # a part of GL_VERSION
  from = \"22.3\"               # the first such version; may be absent
  until = \"27\"                # the first that is sound again; may be absent
  rule = \"GL-O1\"
  finding = \"DEPTH_COMPONENT32: one unit\"  # absent: every check of the rule
  reason = \"f32 has 24 bits\"
One that no longer applies is a failure. --write-waivers writes such a file.

--reduce writes a program for a driver's developers: the calls of GL that the failure needs, no more, \
and what the specification asks of the number that they read. It needs libEGL alone. Calls that by the \
specification cannot matter are left out if the driver errs without them, too; each trial draws the \
scene in a new context, 250 times at most. A failure that is no single number (two pictures that must be \
alike, a crash) is refused. cc FILE.c -o reduced -ldl; exit status of ./reduced: 1 the driver has the \
fault, 0 it has not, 2 nothing can be said.

Exit status: 0 nothing fails, 1 a rule fails (with --baseline: one that did not fail before), 2 nothing \
could be run.

Examples:
  glumbra check
  glumbra check --filter stencil --filter GL-O1 --verbose
  glumbra check --junit out/check.xml --json out/check.json
  glumbra check --json now.json --baseline before.json  # broken, mended?
  glumbra check --filter GL-F3 --repeat 20              # always alike?
  glumbra check --reduce GL-R1 -o r1.c && cc r1.c -o r1 -ldl && ./r1
  gdb --args glumbra check --here --filter GL-R1
  GALLIUM_DRIVER=softpipe glumbra check --context egl";

/// Processes at once where none are asked for: more would not make it quicker, and each has a context.
fn default_jobs() -> usize {
    const MOST: usize = 8;
    std::thread::available_parallelism().map_or(1, usize::from).min(MOST)
}

/// Columns of the text without --verbose, at most.
const WIDTH: usize = 80;

/// Checks, prints, writes.
pub fn run(arguments: &CheckArgs, screen: Screen) -> ExitCode {
    let result = match &arguments.reduce {
        Some(rule) => reduce::run(arguments, rule, screen).map(|()| None),
        None if !arguments.child.is_empty() => child::run(arguments, &arguments.child).map(|()| None),
        None if arguments.list => list(arguments).map(|()| None),
        None => check(arguments, screen).map(Some),
    };
    match result {
        Ok(None) => ExitCode::SUCCESS,
        Ok(Some(checked)) if checked.is_empty() => ExitCode::from(2),
        Ok(Some(checked)) => ExitCode::from(u8::from(checked.fails())),
        Err(error) => super::failure(error, 2),
    }
}

fn list(arguments: &CheckArgs) -> Result<(), Error> {
    super::print(&conformance::list(&conformance::choose(&arguments.filter)?))
}

fn check(arguments: &CheckArgs, screen: Screen) -> Result<Checked, Error> {
    let rules = conformance::choose(&arguments.filter)?;
    let known = waivers::load(arguments.waivers.as_deref())?;
    let before = arguments.baseline.as_deref().map(baseline::load).transpose()?;
    let files = Files::new(arguments)?;
    let bar = screen.bar(rules.len() as u64 * u64::from(arguments.repeat), "{bar:40} {pos}/{len} rules  {msg}");
    let mut run = Run {
        start: Instant::now(),
        context: None,
        repeats: Vec::new(),
        rules,
        known,
        before,
        files,
        bar,
        dirty: false,
        error: None,
    };
    for _ in 0..arguments.repeat {
        run.repeats.push(Vec::new());
        run.once(arguments)?;
    }
    run.bar.finish_and_clear();
    if let Some(error) = run.error.take() {
        return Err(error);
    }
    let Some(checked) = run.checked() else {
        return Err(ChildError::Ended("the process that checks has told no driver".to_owned()).into());
    };
    run.files.write_all(&checked, &run.known)?;
    print(&checked, screen.is_verbose(), run.files.take_standard_output())?;
    Ok(checked)
}

/// A run so far.
struct Run<'a> {
    start: Instant,
    context: Option<ContextInfo>,
    /// Outcomes of each repeat.
    repeats: Vec<Vec<RuleOutcome>>,
    rules: Vec<&'static Rule>,
    known: Vec<waivers::Waiver>,
    before: Option<baseline::Baseline>,
    files: Files<'a>,
    bar: ProgressBar,
    /// Results are not in the files yet.
    dirty: bool,
    /// The first error of the files.
    error: Option<Error>,
}

impl Run<'_> {
    /// Runs all rules once.
    fn once(&mut self, arguments: &CheckArgs) -> Result<(), Error> {
        let rules = self.rules.clone();
        if arguments.here {
            return child::steps(arguments, &rules, |event| {
                match event {
                    Event::Refused(error) => return Err(ChildError::Refused(error).into()),
                    Event::Context(info) => self.hear(Heard::Context(info)),
                    Event::Begins(id) => events::rule(&id).into_iter().for_each(|rule| self.hear(Heard::Begins(rule))),
                    Event::Ends { id, findings, facts, seconds, .. } => {
                        let outcome = events::rule(&id).map(|rule| RuleOutcome::new(rule, findings, facts, seconds));
                        outcome.into_iter().for_each(|outcome| self.hear(Heard::Ended(outcome)));
                    }
                }
                Ok(())
            });
        }
        let for_child = arguments.for_child();
        let limit = Duration::from_secs(arguments.timeout.into());
        let jobs = arguments.jobs.map_or_else(default_jobs, usize::from);
        Ok(children::run_at_once(&for_child, &rules, (limit, arguments.isolate), jobs, &mut |heard| self.hear(heard))?)
    }

    fn hear(&mut self, heard: Heard) {
        match heard {
            Heard::Context(info) => {
                self.context.get_or_insert(*info);
                self.dirty = true;
            }
            Heard::Begins(rule) => self.bar.set_message(format!("{} {}", rule.id, rule.title)),
            Heard::Ended(outcome) => {
                self.bar.inc(1);
                if let Some(repeat) = self.repeats.last_mut() {
                    repeat.push(outcome);
                }
                self.dirty = true;
            }
            Heard::Said(text) => self.bar.suspend(|| super::say(text.trim_end())),
            Heard::Tick => self.bar.tick(),
        }
        if self.dirty && self.error.is_none() {
            let written = self.checked().map_or(Ok(false), |checked| self.files.write_unfinished(&checked));
            match written {
                Ok(written) => self.dirty = !written,
                Err(error) => self.error = Some(error),
            }
        }
    }

    /// The results so far; nothing before there is a context.
    fn checked(&self) -> Option<Checked> {
        let context = self.context.clone()?;
        let mut repeats = self.repeats.clone();
        // Processes at once end their rules in any order.
        let place = |id: &str| self.rules.iter().position(|rule| rule.id == id);
        repeats.iter_mut().for_each(|outcomes| outcomes.sort_by_key(|outcome| place(outcome.id)));
        let is_done = |id: &str| repeats.last().is_some_and(|last| last.iter().any(|outcome| outcome.id == id));
        let unfinished = self.rules.iter().map(|rule| rule.id).filter(|id| !is_done(id)).collect();
        let (mut outcomes, flakes) = conformance::join(repeats);
        let stale_waivers = waivers::apply(&self.known, &context, &mut outcomes);
        let mut checked = Checked {
            context,
            outcomes,
            seconds: self.start.elapsed().as_secs_f64(),
            stale_waivers,
            unfinished,
            flakes,
            since: None,
        };
        checked.since = self.before.as_ref().map(|before| baseline::compare(before, &checked));
        Some(checked)
    }
}

/// On standard output, or on standard error if the other is for a file's text.
fn print(checked: &Checked, verbose: bool, to_error: bool) -> Result<(), Error> {
    use std::io::Write;
    const UNKNOWN_WIDTH: u16 = 160;
    let terminal = terminal_size::terminal_size().map(|(width, _)| width.0);
    let text = match verbose {
        true => conformance::print(checked, terminal.unwrap_or(UNKNOWN_WIDTH), true),
        false => conformance::screen(checked, terminal.map_or(WIDTH, |width| WIDTH.min(width.into()))),
    };
    if to_error {
        // If standard error is closed, the text is lost; the results are in the files.
        let _ = anstream::stderr().write_all(text.as_bytes());
        return Ok(());
    }
    let mut out = anstream::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}
