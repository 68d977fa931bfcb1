//! A run on the screen: what does not pass, the driver, and in the last line the rules that fail. Coloured by ANSI escapes,
//! which the caller takes out where no terminal shows them.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};

use super::{Checked, Finding, Rule, RuleOutcome, RuleVerdict};

/// A line each rule: id, title, section.
pub fn list(rules: &[&'static Rule]) -> String {
    let mut text = String::new();
    for rule in rules {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:6} {} [{}]", rule.id, rule.title, rule.section);
    }
    text
}

/// The text of a run, wrapped to `width` columns.
pub fn screen(checked: &Checked, width: usize) -> String {
    let mut page = Page { text: String::new(), width: width.max(20) };
    for outcome in &checked.outcomes {
        page.outcome(outcome);
    }
    page.changes(checked);
    page.end(checked);
    page.text
}

/// The end of a run, which stands below the table, too.
pub fn ending(checked: &Checked, width: usize) -> String {
    let mut page = Page { text: String::new(), width: width.max(20) };
    page.changes(checked);
    page.end(checked);
    page.text
}

fn style(verdict: RuleVerdict) -> Style {
    let color = |color: AnsiColor| Style::new().fg_color(Some(color.into()));
    match verdict {
        RuleVerdict::Pass => color(AnsiColor::Green),
        RuleVerdict::Warning => color(AnsiColor::Yellow),
        RuleVerdict::Waived => color(AnsiColor::Cyan),
        RuleVerdict::Untestable => Style::new().dimmed(),
        _ => color(AnsiColor::Red).bold(),
    }
}

fn mark(verdict: RuleVerdict) -> String {
    match verdict {
        RuleVerdict::Untestable => "not here".to_owned(),
        RuleVerdict::Warning => "warning".to_owned(),
        verdict => verdict.to_string(),
    }
}

struct Page {
    text: String,
    width: usize,
}

impl Page {
    /// Words in lines that are no longer than the width, but for words that are. `styled`: a word before them, in a style.
    fn lines(&mut self, indent: usize, styled: Option<(&str, Style)>, words: &str) {
        let mut column = indent;
        self.text += &" ".repeat(indent);
        if let Some((word, style)) = styled {
            self.text += &format!("{style}{word}{style:#}");
            column += word.chars().count();
        }
        let mut is_first = styled.is_none();
        for word in words.split_whitespace() {
            let length = word.chars().count();
            if !is_first && column + 1 + length > self.width {
                column = indent + 2;
                self.text += &format!("\n{}", " ".repeat(column));
            } else if !is_first {
                self.text.push(' ');
                column += 1;
            }
            self.text += word;
            column += length;
            is_first = false;
        }
        self.text.push('\n');
    }

    /// Nothing where all passes. What the specification says stands only where it is not kept.
    fn outcome(&mut self, outcome: &RuleOutcome) {
        if outcome.verdict == RuleVerdict::Pass {
            return;
        }
        let head = format!("{} [{}]", outcome.title, outcome.section);
        self.lines(0, Some((outcome.id, style(outcome.verdict))), &head);
        if outcome.verdict.fails() {
            self.lines(4, Some(("GL says:", Style::new())), outcome.says);
        }
        let told = |finding: &&Finding| finding.verdict != RuleVerdict::Pass;
        for finding in outcome.findings.iter().filter(told) {
            let mark = mark(finding.verdict) + ":";
            self.lines(4, Some((&mark, style(finding.verdict))), &finding.message());
        }
        if outcome.verdict.fails() {
            self.lines(4, Some(("tolerance:", Style::new())), outcome.tolerance);
        }
    }

    fn changes(&mut self, checked: &Checked) {
        for flake in &checked.flakes {
            let words = format!("{} {}: {}", flake.rule, flake.what, flake.answers.join(" | "));
            self.lines(0, Some(("differs between repeats:", style(RuleVerdict::Warning))), &words);
        }
        for stale in &checked.stale_waivers {
            self.lines(0, Some(("FAIL:", style(RuleVerdict::Fail))), stale);
        }
        let Some(changes) = &checked.since else { return };
        self.lines(0, None, &format!("Since the baseline, of {}:", changes.driver));
        let kinds = [
            ("new failure:", &changes.new_failures, RuleVerdict::Fail),
            ("fixed:", &changes.fixed, RuleVerdict::Pass),
            ("new:", &changes.new, RuleVerdict::Warning),
            ("gone:", &changes.gone, RuleVerdict::Warning),
        ];
        for (name, lines, verdict) in kinds {
            lines.iter().for_each(|line| self.lines(2, Some((name, style(verdict))), line));
        }
        let known = changes.known_failures.len();
        if kinds.iter().all(|(_, lines, _)| lines.is_empty()) {
            self.lines(2, None, &format!("no change; {known} known failure(s)"));
        } else if known > 0 {
            self.lines(2, None, &format!("{known} known failure(s)"));
        }
    }

    fn end(&mut self, checked: &Checked) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        let context = &checked.context;
        let driver = format!("{}, {} ({}, {})", context.renderer, context.version, context.backend, context.profile);
        self.lines(0, None, &driver);
        self.lines(0, None, &summary(checked));
        if !checked.unfinished.is_empty() {
            self.lines(0, Some(("not run:", style(RuleVerdict::Fail))), &checked.unfinished.join(", "));
        }
        let mut failing: Vec<String> = checked.failing().map(|outcome| outcome.id.to_owned()).collect();
        if !checked.stale_waivers.is_empty() {
            failing.push("waivers".to_owned());
        }
        // One line, however many rules it names, so that `tail -1` gives them all.
        if failing.is_empty() {
            let pass = style(RuleVerdict::Pass);
            self.text += &format!("{pass}No rule fails.{pass:#}\n");
        } else {
            let fail = style(RuleVerdict::Fail);
            self.text += &format!("{fail}FAIL:{fail:#} {}\n", failing.join(", "));
        }
    }
}

/// Counts of rules and checks, and the time.
fn summary(checked: &Checked) -> String {
    let verdicts = [
        (RuleVerdict::Pass, "pass"),
        (RuleVerdict::Warning, "with a quality warning"),
        (RuleVerdict::Waived, "waived"),
        (RuleVerdict::Fail, "FAIL"),
        (RuleVerdict::OutOfMemory, "OUT OF MEMORY"),
        (RuleVerdict::ContextLost, "CONTEXT LOST"),
        (RuleVerdict::Hang, "HANG"),
        (RuleVerdict::Crash, "CRASH"),
        (RuleVerdict::Untestable, "cannot be tested here"),
    ];
    let counts = verdicts.map(|(verdict, name)| (checked.count(verdict), name));
    let parts: Vec<String> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, name)| format!("{count} {name}")).collect();
    let seconds = checked.seconds;
    let findings: usize = checked.outcomes.iter().map(|outcome| outcome.findings.len()).sum();
    format!(
        "{} rule{}, {findings} checks: {}; {seconds:.1} s",
        checked.outcomes.len(),
        if checked.outcomes.len() == 1 { "" } else { "s" },
        parts.join(", "),
    )
}

#[cfg(test)]
#[path = "screen_tests.rs"]
mod tests;
