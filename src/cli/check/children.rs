//! The processes that check, seen from the one that was started: each is given rules, is heard, and is ended if a rule takes
//! too long. After a crash the rest goes on in a new process.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

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

/// Between two ticks.
const TICK: Duration = Duration::from_millis(200);
/// Name of the finding that stands for the end of a rule's process.
const PROCESS: &str = "the rule runs to its end";

/// Runs `rules` in child processes with these arguments, at most `limit` a rule, and gives `hear` what happens.
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
        let mut process = Process::start(arguments, &batch)?;
        let mut done = 0;
        let end = loop {
            match process.next(limit, hear) {
                Next::Event(Event::Refused(error)) if !has_context => return Err(ChildError::Refused(error)),
                Next::Event(Event::Refused(error)) => {
                    break Some((RuleVerdict::Crash, format!("no new context: {error}")));
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
                let (_, how) = end.unwrap_or((RuleVerdict::Crash, "ended without a word".to_owned()));
                return Err(ChildError::Ended(without_context(&how, &said)));
            }
            end => {
                let (verdict, how) = end.unwrap_or((RuleVerdict::Crash, "ended without a word".to_owned()));
                let verdict = verdict_of(verdict, &said);
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

/// The verdict by what a process said before its end: its watchdog and its allocator end it themselves.
fn verdict_of(verdict: RuleVerdict, said: &str) -> RuleVerdict {
    match () {
        () if said.contains("out of memory") => RuleVerdict::OutOfMemory,
        () if said.contains("has done nothing for") => RuleVerdict::Hang,
        () => verdict,
    }
}

/// The error of a process that ended before it had a context: its own words, if it had any.
fn without_context(how: &str, said: &str) -> String {
    match said.split_once("error: ") {
        Some((_, error)) => error.trim_end().to_owned(),
        None => format!("no context: the process that checks {how}"),
    }
}

/// The last error that a process wrote on standard error, or its last line.
fn quoted(said: &str) -> String {
    let lines = || said.lines().filter(|line| !line.trim().is_empty());
    let last = lines().rfind(|line| line.starts_with("error: ")).or_else(|| lines().next_back());
    last.map_or_else(String::new, |line| format!(": \"{}\"", line.trim()))
}

enum Next {
    Event(Event),
    /// The end, and how: nothing if it ended as it should.
    End(Option<(RuleVerdict, String)>),
}

/// A process that checks. It is ended on drop.
struct Process {
    child: Child,
    lines: Receiver<String>,
    /// The text that it wrote on standard error, at the end of the thread that reads it.
    said: Option<JoinHandle<String>>,
    since: Instant,
}

impl Process {
    fn start(arguments: &[String], rules: &[&str]) -> Result<Self, ChildError> {
        let program = std::env::current_exe().map_err(ChildError::Start)?;
        let mut command = Command::new(program);
        command.arg("check").args(arguments).arg(format!("--child={}", rules.join(",")));
        // Standard input is held open and never written to: the child ends when it ends.
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(ChildError::Start)?;
        let (send, lines) = channel();
        if let Some(out) = child.stdout.take() {
            std::thread::spawn(move || {
                // Bytes: what a driver writes need not be UTF-8.
                let lines = BufReader::new(out).split(b'\n').map_while(Result::ok);
                lines.map(|line| String::from_utf8_lossy(&line).into_owned()).try_for_each(|line| send.send(line))
            });
        }
        let said = child.stderr.take().map(|err| std::thread::spawn(move || listen(err)));
        Ok(Self { child, lines, said, since: Instant::now() })
    }

    fn seconds(&self) -> f64 {
        self.since.elapsed().as_secs_f64()
    }

    /// Waits for the next event, or the end. Ends it if nothing comes in time.
    fn next(&mut self, limit: Duration, hear: &mut impl FnMut(Heard)) -> Next {
        self.since = Instant::now();
        loop {
            match self.lines.recv_timeout(TICK) {
                // Anything else is a driver's.
                Ok(line) => {
                    if let Ok(event) = serde_json::from_str(&line) {
                        return Next::Event(event);
                    }
                }
                Err(RecvTimeoutError::Timeout) if self.since.elapsed() > limit => {
                    let _ = self.child.kill();
                    let _ = self.child.wait();
                    let how = format!("did not end in {} s, and was killed", limit.as_secs_f64());
                    return Next::End(Some((RuleVerdict::Hang, how)));
                }
                Err(RecvTimeoutError::Timeout) => hear(Heard::Tick),
                Err(RecvTimeoutError::Disconnected) => {
                    return Next::End(self.child.wait().map_or_else(
                        |error| Some((RuleVerdict::Crash, format!("cannot be waited for: {error}"))),
                        how_it_ended,
                    ));
                }
            }
        }
    }

    /// Ends it, and gives what it wrote on standard error.
    fn finish(&mut self) -> String {
        drop(self.child.stdin.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.said.take().and_then(|thread| thread.join().ok()).unwrap_or_default()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Reads to the end, and keeps the last part.
fn listen(mut stream: impl Read) -> String {
    const MOST: usize = 1 << 14;
    let (mut kept, mut part) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = stream.read(&mut part) {
        kept.extend_from_slice(&part[..count]);
        let surplus = kept.len().saturating_sub(MOST);
        kept.drain(..surplus);
    }
    String::from_utf8_lossy(&kept).into_owned()
}

/// The way in which a process ended; nothing if as it should.
fn how_it_ended(status: ExitStatus) -> Option<(RuleVerdict, String)> {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = crate::process::signal_name(signal);
        // Linux ends a process by SIGKILL where memory runs out; nobody else does it here.
        return Some(match name.as_str() {
            "SIGKILL" => {
                (RuleVerdict::OutOfMemory, "was killed by SIGKILL, as a system does that is out of memory".to_owned())
            }
            _ => (RuleVerdict::Crash, format!("crashed ({name})")),
        });
    }
    (!status.success()).then(|| (RuleVerdict::Crash, format!("ended itself ({status})")))
}
