//! Child processes that run cases, several at once: each is given a case when it has ended the one before. What ends a child
//! is that case's verdict, and a new one takes the next case.

use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::child::{CaseEvent, Job};
use crate::cases::{CaseOutcome, CaseVerdict};
use crate::cli::Error;
use crate::cli::child_process::{BadEnd, ChildProcess, Next, end_by_words, quoted};

/// Cases to run, and how.
pub struct Workers {
    /// Words of a child's command line.
    pub words: Vec<String>,
    /// Each with the time that it may take.
    pub jobs: Vec<(Job, Duration)>,
    /// Children at once.
    pub count: usize,
    /// Cores of the machine, which the children share.
    pub cores: usize,
    /// Set: the run ends.
    pub stop: Arc<AtomicBool>,
}

/// News while cases are run. An index is that of a job.
pub enum TestNews {
    Begins(usize),
    Ended {
        outcome: Box<CaseOutcome>,
        driver: Option<String>,
    },
    /// The child has ended before the case did.
    Died {
        index: usize,
        verdict: CaseVerdict,
        seconds: f64,
        message: String,
    },
    /// Standard error of a child that ended as it should: warnings of the driver.
    Said(String),
    /// Nothing for a while.
    Tick,
}

/// Words of a thread to the one that hears all.
enum Word {
    News(TestNews),
    /// Nothing can be run: the error.
    Refused(String),
}

/// Between two ticks.
const TICK: Duration = Duration::from_millis(200);

impl Workers {
    /// Runs all cases, and gives `hear` what happens.
    ///
    /// # Errors
    ///
    /// A child that cannot be started, and no context.
    pub fn run(&self, mut hear: impl FnMut(TestNews)) -> Result<(), Error> {
        let next = AtomicUsize::new(0);
        let (send, words) = channel();
        std::thread::scope(|scope| {
            for _ in 0..self.count {
                let (send, next) = (send.clone(), &next);
                scope.spawn(move || self.work(next, &send));
            }
            drop(send);
            let mut result = Ok(());
            let mut heard = HashSet::new();
            loop {
                hear(match words.recv_timeout(TICK) {
                    Ok(Word::News(TestNews::Said(text))) if !heard.insert(text.clone()) => continue,
                    Ok(Word::News(news)) => news,
                    Ok(Word::Refused(error)) => {
                        result = result.and(Err(Error::NoCaseRun(error)));
                        self.stop.store(true, Ordering::Relaxed);
                        continue;
                    }
                    Err(RecvTimeoutError::Timeout) => TestNews::Tick,
                    Err(RecvTimeoutError::Disconnected) => return result,
                });
            }
        })
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Runs cases in one child after the other, until none is left.
    fn work(&self, next: &AtomicUsize, send: &Sender<Word>) {
        let threads = (self.cores / self.count).max(1).to_string();
        // Software drivers and the ray tracer would each take all cores.
        let variables = [("LP_NUM_THREADS", threads.clone()), ("RAYON_NUM_THREADS", threads)];
        let mut child: Option<ChildProcess> = None;
        let mut done = 0;
        while !self.is_stopped() {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some((job, limit)) = self.jobs.get(index) else { break };
            let process = match child.take() {
                Some(process) => process,
                None => {
                    done = 0;
                    match ChildProcess::start(&self.words, &variables) {
                        Ok(process) => process,
                        Err(error) => {
                            let error = format!("the process that runs cases cannot be started: {error}");
                            let _ = send.send(Word::Refused(error));
                            return;
                        }
                    }
                }
            };
            let _ = send.send(Word::News(TestNews::Begins(index)));
            child = self.run_one((index, job, *limit), process, done, send);
            done += 1;
        }
        if let Some(mut process) = child {
            let said = process.finish();
            if !said.trim().is_empty() {
                let _ = send.send(Word::News(TestNews::Said(said)));
            }
        }
    }

    /// Runs a case in a child that has run `before` others. Returns the child, if it lives.
    fn run_one(
        &self,
        (index, job, limit): (usize, &Job, Duration),
        mut process: ChildProcess,
        before: usize,
        send: &Sender<Word>,
    ) -> Option<ChildProcess> {
        process.send(&serde_json::to_string(job).unwrap_or_default());
        match process.next(limit, || !self.is_stopped()) {
            Next::Event(CaseEvent::Ended { outcome, driver }) => {
                let _ = send.send(Word::News(TestNews::Ended { outcome, driver }));
                Some(process)
            }
            Next::Event(CaseEvent::Refused(error)) => {
                let _ = send.send(Word::Refused(error));
                None
            }
            Next::End(end) => {
                let seconds = process.seconds();
                let said = process.finish();
                // Ctrl-C reaches the children of a terminal, too, and may reach them first.
                std::thread::sleep(TICK);
                if !self.is_stopped() {
                    let (end, how) = end.unwrap_or((BadEnd::Crash, "ended without a word".to_owned()));
                    let verdict = match end_by_words(end, &said) {
                        BadEnd::Crash => CaseVerdict::Crash,
                        BadEnd::Hang => CaseVerdict::Hang,
                        BadEnd::OutOfMemory => CaseVerdict::OutOfMemory,
                    };
                    let behind = match before {
                        0 => String::new(),
                        1 => " behind another case in one process".to_owned(),
                        before => format!(" behind {before} other cases in one process"),
                    };
                    let message = format!("the case {how}{behind}{}", quoted(&said));
                    let _ = send.send(Word::News(TestNews::Died { index, verdict, seconds, message }));
                }
                None
            }
        }
    }
}
