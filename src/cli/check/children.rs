//! The processes that check, seen from the one that was started: each is given rules, is heard, and is ended if a rule takes
//! too long. After a crash the rest goes on in a new process.

use std::collections::VecDeque;
use std::sync::Mutex;
use std::sync::mpsc::channel;
use std::time::Duration;

use crate::cli::child_process::{self, BadEnd, ChildProcess, Next, quoted};
use crate::conformance::events::{Event, rule};
use crate::conformance::{Finding, Rule, RuleOutcome, RuleVerdict};
use crate::context::ContextInfo;

/// Reason why nothing can be checked.
#[derive(Debug, thiserror::Error)]
pub enum ChildError {
    #[error("the process that checks cannot be started: {0}")]
    Start(std::io::Error),
    /// The words of the process, which found no context.
    #[error("{0}")]
    Refused(String),
    #[error("{0}")]
    Ended(String),
}

/// News while rules are run.
pub enum Heard {
    Context(Box<ContextInfo>),
    Begins(&'static Rule),
    Ended(RuleOutcome),
    /// Standard error of a process that ended as it should: warnings of the driver.
    Said(String),
    /// Nothing for a while.
    Tick,
}

/// Name of the finding that stands for the end of a rule's process.
const PROCESS: &str = "the rule runs to its end";

/// Runs `rules` with `jobs` child processes at once, and gives `hear` what happens, in the order in which it does. The rest
/// is as with [`run`].
///
/// # Errors
///
/// No process that finds a context.
pub fn run_at_once(
    arguments: &[String],
    rules: &[&'static Rule],
    (limit, each_alone): (Duration, bool),
    jobs: usize,
    hear: &mut impl FnMut(Heard),
) -> Result<(), ChildError> {
    if jobs == 1 {
        return run(arguments, rules, limit, each_alone, hear);
    }
    let left = Mutex::new(parts(rules, jobs));
    let take = || left.lock().ok().and_then(|mut left| left.pop_front());
    let (send, news) = channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            let send = send.clone();
            scope.spawn(move || {
                while let Some(part) = take() {
                    let ran = run(arguments, &part, limit, each_alone, &mut |heard| {
                        let _ = send.send(Ok(heard));
                    });
                    if let Err(error) = ran {
                        let _ = send.send(Err(error));
                    }
                }
            });
        }
        drop(send);
        let mut result = Ok(());
        for word in news {
            match word {
                Ok(heard) => hear(heard),
                Err(error) => {
                    // The others would meet it, too.
                    if let Ok(mut left) = left.lock() {
                        left.clear();
                    }
                    result = result.and(Err(error));
                }
            }
        }
        result
    })
}

/// Parts of `rules` for processes that each take the next one: the generated rules first and alone, since they take longest,
/// then some at a time.
fn parts(rules: &[&'static Rule], jobs: usize) -> VecDeque<Vec<&'static Rule>> {
    /// Parts for each process: few enough that starting them costs little, enough that none has to wait long.
    const PARTS: usize = 4;
    let (generated, others): (Vec<_>, Vec<_>) = rules.iter().copied().partition(|rule| rule.id.starts_with("GL-X"));
    let size = others.len().div_ceil(jobs * PARTS).max(1);
    generated.chunks(1).chain(others.chunks(size)).map(<[&Rule]>::to_vec).collect()
}

/// Runs `rules` in child processes with these arguments, one after the other, at most `limit` a rule, and gives `hear` what
/// happens.
///
/// # Errors
///
/// No process that finds a context.
pub fn run(
    arguments: &[String],
    rules: &[&'static Rule],
    limit: Duration,
    each_alone: bool,
    hear: &mut impl FnMut(Heard),
) -> Result<(), ChildError> {
    let mut left: VecDeque<&'static Rule> = rules.iter().copied().collect();
    // The rule that a process is given alone: the first after a crash, or each.
    let mut alone = each_alone;
    let mut crashed: Option<Finding> = None;
    let mut has_context = false;
    while let Some(first) = left.front().copied() {
        let batch: Vec<&str> = left.iter().take(if alone { 1 } else { left.len() }).map(|rule| rule.id).collect();
        let mut process = start(arguments, &batch)?;
        let mut done = 0;
        let end = loop {
            match process.next(limit, || {
                hear(Heard::Tick);
                true
            }) {
                Next::Event(Event::Refused(error)) if !has_context => return Err(ChildError::Refused(error)),
                Next::Event(Event::Refused(error)) => {
                    break Some((BadEnd::Crash, format!("no new context: {error}")));
                }
                Next::Event(Event::Context(info)) => {
                    has_context = true;
                    hear(Heard::Context(info));
                }
                Next::Event(Event::Begins(id)) => rule(&id).into_iter().for_each(|rule| hear(Heard::Begins(rule))),
                Next::Event(Event::Ends { id, mut findings, facts, seconds, .. }) => {
                    if let Some(rule) = rule(&id) {
                        // It crashed behind other rules, and alone it does not.
                        findings.extend(crashed.take().filter(|_| done == 0));
                        hear(Heard::Ended(RuleOutcome::new(rule, findings, facts, seconds)));
                    }
                    done += 1;
                    left.pop_front();
                }
                Next::End(end) => break end,
            }
        };
        let said = process.finish();
        if end.is_none() && !said.is_empty() {
            hear(Heard::Said(said.clone()));
        }
        match end {
            end if done == batch.len() => {
                if let Some((_, how)) = end {
                    let rule = batch.last().copied().unwrap_or_default();
                    hear(Heard::Said(format!(
                        "warning: behind {rule}, its last rule, a process that checks {how}{}",
                        quoted(&said)
                    )));
                }
                alone = each_alone;
            }
            // A lost context: the process has told it, and ended.
            None if done > 0 => alone = each_alone,
            None | Some(_) if !has_context => {
                let (_, how) = end.unwrap_or((BadEnd::Crash, "ended without a word".to_owned()));
                return Err(ChildError::Ended(without_context(&how, &said)));
            }
            end => {
                let (end, how) = end.unwrap_or((BadEnd::Crash, "ended without a word".to_owned()));
                let verdict = verdict_of(end, &said);
                let rule = left.front().copied().unwrap_or(first);
                if verdict == RuleVerdict::Crash && done > 0 {
                    // What rules before it have left may be why: once more, alone.
                    let after = "behind other rules in one process; alone it does not";
                    crashed = Some(Finding::new(PROCESS, verdict, format!("{how} {after}{}", quoted(&said))));
                    alone = true;
                } else {
                    crashed = None;
                    let finding = Finding::new(PROCESS, verdict, format!("{how}{}", quoted(&said)));
                    hear(Heard::Ended(RuleOutcome::new(rule, vec![finding], Vec::new(), process.seconds())));
                    left.pop_front();
                    alone = each_alone;
                }
            }
        }
    }
    Ok(())
}

fn start(arguments: &[String], rules: &[&str]) -> Result<ChildProcess, ChildError> {
    let mut words = vec!["check".to_owned()];
    words.extend_from_slice(arguments);
    words.push(format!("--child={}", rules.join(",")));
    ChildProcess::start(&words, &[]).map_err(ChildError::Start)
}

/// The verdict of a rule by its process's end and last words.
fn verdict_of(end: BadEnd, said: &str) -> RuleVerdict {
    match child_process::end_by_words(end, said) {
        BadEnd::OutOfMemory => RuleVerdict::OutOfMemory,
        BadEnd::Hang => RuleVerdict::Hang,
        BadEnd::Crash => RuleVerdict::Crash,
    }
}

/// The error of a process that ended before it had a context: its own words, if it had any.
fn without_context(how: &str, said: &str) -> String {
    match said.split_once("error: ") {
        Some((_, error)) => error.trim_end().to_owned(),
        None => format!("no context: the process that checks {how}"),
    }
}
