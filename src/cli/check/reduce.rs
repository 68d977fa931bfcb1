//! `--reduce`: runs a rule in a child process to see how it fails, then has the smallest program written that shows it.

use std::path::Path;
use std::time::Duration;

use super::children::{self, Heard};
use super::{CheckArgs, ChildError, child};
use crate::cli::Error;
use crate::cli::screen::Screen;
use crate::conformance::reduce::{self, MOST_REPLAYS, ReduceError, Step};
use crate::conformance::{self, Rule, RuleOutcome, RuleVerdict};
use crate::output::atomic_write;

/// Writes the program of the rule that `pattern` names.
///
/// # Errors
///
/// An unknown rule, one that does not fail, one whose failure cannot be reduced; a file that cannot be written.
pub fn run(arguments: &CheckArgs, pattern: &str, screen: Screen) -> Result<(), Error> {
    let rules = conformance::choose(&[pattern.to_owned()])?;
    let [rule] = rules[..] else {
        return Err(Error::ReduceOne {
            pattern: pattern.to_owned(),
            rules: rules.iter().map(|rule| rule.id).collect(),
        });
    };
    let default = format!("{}.c", rule.id.to_lowercase());
    let path = arguments.output.as_deref().unwrap_or(Path::new(&default));
    let is_screen = path == Path::new("-");
    if !is_screen {
        atomic_write::try_to_write(path).map_err(|error| Error::WriteFile { path: path.to_owned(), error })?;
    }
    must_fail(arguments, rule)?;
    let bar = screen.bar(MOST_REPLAYS as u64, "{bar:40} {pos} of at most {len} replays  {msg}");
    let mut asked = 0;
    let mut tick = |step| match step {
        Step::Asks => {
            asked += 1;
            bar.set_message(format!("{}: looks for the number that is wrong, {asked} trials", rule.id));
        }
        Step::Draws => {
            bar.set_message(format!("{}: draws less", rule.id));
            bar.inc(1);
        }
    };
    let reduced = reduce::reduce(&|| child::open(arguments), rule, &mut tick)?;
    bar.finish_and_clear();
    if is_screen {
        return super::super::print(&reduced.program);
    }
    let written = atomic_write::write_all(&[path], |_, path| std::fs::write(path, &reduced.program));
    written.map_err(|(_, error)| Error::WriteFile { path: path.to_owned(), error })?;
    let [before, after] = reduced.calls;
    super::super::print(&format!(
        "{}, {}\n{}\n{}: {after} calls of GL of {before}, after {} replays of at most {MOST_REPLAYS}\n",
        rule.id,
        rule.title,
        reduced.says,
        path.display(),
        reduced.replays
    ))
}

/// Runs the rule in a process of its own: what ends that is no matter for this one.
fn must_fail(arguments: &CheckArgs, rule: &'static Rule) -> Result<(), Error> {
    let mut outcome: Option<RuleOutcome> = None;
    let limit = Duration::from_secs(arguments.timeout.into());
    let mut hear = |heard| {
        if let Heard::Ended(ended) = heard {
            outcome = Some(ended);
        }
    };
    children::run(&arguments.for_child(), &[rule], limit, false, &mut hear)?;
    let Some(outcome) = outcome else {
        return Err(ChildError::Ended("the process that checks has told no result".to_owned()).into());
    };
    let rule = rule.id;
    match outcome.verdict {
        RuleVerdict::Fail => Ok(()),
        RuleVerdict::Untestable => Err(ReduceError::Untestable { rule }.into()),
        RuleVerdict::Pass | RuleVerdict::Warning | RuleVerdict::Waived => Err(ReduceError::Passes { rule }.into()),
        verdict => {
            let how = outcome.findings.iter().find(|finding| finding.verdict == verdict);
            Err(ReduceError::Ends { rule, how: how.map_or_else(|| verdict.to_string(), |how| how.measured.clone()) }
                .into())
        }
    }
}
