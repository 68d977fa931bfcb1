//! A run on the screen: a line a case, or a bar where a terminal shows one; at the end what fails, and counts.

use std::fmt::Write as _;
use std::io::Write as _;

use anstyle::{AnsiColor, Style};
use indicatif::ProgressBar;

use super::results::TestResults;
use crate::cases::{CaseOutcome, CaseVerdict};
use crate::cli::Error;
use crate::cli::screen::Screen;

/// Where a run is told.
pub struct TestScreen {
    bar: ProgressBar,
    verbose: bool,
    /// Standard output is for a file's text.
    to_error: bool,
    /// The first error of standard output: the cases are run nevertheless, and the files are written.
    lost: Option<std::io::Error>,
}

impl TestScreen {
    /// A screen for a run of `count` cases.
    pub fn new(count: usize, screen: Screen, to_error: bool) -> Self {
        let bar = screen.bar(count as u64, "{bar:40} {pos}/{len} cases  {msg}");
        Self { bar, verbose: screen.is_verbose(), to_error, lost: None }
    }

    /// Notes that a case begins.
    pub fn begins(&mut self, name: &str) {
        self.bar.set_message(name.to_owned());
    }

    /// Prints a case that has ended. With a bar, one that passes has no line.
    pub fn ended(&mut self, outcome: &CaseOutcome) {
        self.bar.inc(1);
        let passes = outcome.verdict == CaseVerdict::Pass;
        if passes && !self.verbose && !self.bar.is_hidden() {
            return;
        }
        let style = style(outcome.verdict);
        let mut text =
            format!("{style}{}{style:#} {} ({:.2} s)\n", outcome.verdict.name(), outcome.name, outcome.seconds);
        if self.verbose {
            outcome.measured.iter().for_each(|measured| text += &format!("    {measured}\n"));
        }
        let bar = self.bar.clone();
        bar.suspend(|| self.print(&text));
    }

    /// Passes on what a child said on standard error.
    pub fn said(&mut self, text: &str) {
        self.bar.suspend(|| crate::cli::say(text.trim_end()));
    }

    /// Shows that there is work.
    pub fn tick(&mut self) {
        self.bar.tick();
    }

    /// Takes the bar away.
    pub fn finish(&mut self) {
        self.bar.finish_and_clear();
    }

    /// Prints each failure with its question, place and pictures, and the counts. The last line names what fails.
    ///
    /// # Errors
    ///
    /// Standard output that is full. A reader that has seen enough is no error.
    pub fn end(&mut self, results: &TestResults, bless: bool) -> Result<(), Error> {
        let mut text = String::new();
        let fails = || results.cases.iter().filter(|case| case.verdict != CaseVerdict::Pass);
        for outcome in fails() {
            let style = style(outcome.verdict);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "\n{style}{}{style:#} {}", outcome.verdict.name(), outcome.name);
            let _ = writeln!(text, "{}", outcome.failure().unwrap_or_default());
        }
        text.push('\n');
        if let Some(driver) = &results.driver {
            let _ = writeln!(text, "{driver}");
        }
        let _ = writeln!(text, "{}", summary(results));
        if bless && results.cases.iter().any(|case| case.verdict == CaseVerdict::Blessed) {
            text += "Goldens were written. Look at each picture, then run again without --bless.\n";
        }
        let names: Vec<&str> = fails().map(|case| case.name.as_str()).collect();
        let style = style(if names.is_empty() { CaseVerdict::Pass } else { CaseVerdict::Fail });
        match (names.is_empty(), results.unfinished.len()) {
            (true, 0) => text += &format!("{style}No case fails.{style:#}\n"),
            (true, count) => text += &format!("Interrupted: {count} unfinished.\n"),
            (false, 0) => text += &format!("{style}FAIL:{style:#} {}\n", names.join(", ")),
            (false, count) => {
                text += &format!("Interrupted: {count} unfinished. {style}FAIL:{style:#} {}\n", names.join(", "))
            }
        }
        self.print(&text);
        match self.lost.take() {
            Some(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
            _ => Ok(()),
        }
    }

    fn print(&mut self, text: &str) {
        if self.to_error {
            // If standard error is closed, the text is lost; the results are in the files.
            let _ = anstream::stderr().write_all(text.as_bytes());
        } else if self.lost.is_none() {
            let mut out = anstream::stdout().lock();
            self.lost = out.write_all(text.as_bytes()).and_then(|()| out.flush()).err();
        }
    }
}

fn style(verdict: CaseVerdict) -> Style {
    let color = |color: AnsiColor| Style::new().fg_color(Some(color.into()));
    match verdict {
        CaseVerdict::Pass => color(AnsiColor::Green),
        CaseVerdict::Blessed => color(AnsiColor::Yellow).bold(),
        _ => color(AnsiColor::Red).bold(),
    }
}

/// Counts of verdicts, and the time.
fn summary(results: &TestResults) -> String {
    let counts = CaseVerdict::ALL.iter().filter_map(|verdict| {
        let count = results.cases.iter().filter(|case| case.verdict == *verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.name()))
    });
    let count = results.cases.len();
    let plural = if count == 1 { "" } else { "s" };
    let counts = match count {
        // A shard may have none.
        0 => String::new(),
        _ => format!(": {}", counts.collect::<Vec<_>>().join(", ")),
    };
    format!("{count} case{plural}{counts}; {:.1} s", results.seconds)
}
