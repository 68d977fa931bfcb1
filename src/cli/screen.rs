//! `--color`, `--quiet` and `--verbose`, the same in every command: what a command shows beside its results.

use std::fmt::Display;
use std::io::IsTerminal;
use std::path::Path;

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};

use crate::context::Context;

/// Things that a command shows beside its results. Bars and notes go to standard error.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Screen")]
pub struct Screen {
    /// Colours of text
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t)]
    color: Colors,

    /// Shows no progress and does not name written files; warnings and errors stay
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,

    /// Shows more: the driver, what is left out, times; for `check` the full table
    #[arg(short, long, global = true)]
    verbose: bool,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Colors {
    /// Where a terminal shows them and NO_COLOR is not set
    #[default]
    Auto,
    /// Into files and pipes, too
    Always,
    /// None
    Never,
}

impl Screen {
    /// Makes `--color` hold for all text that this process writes.
    pub fn apply(self) {
        let choice = match self.color {
            Colors::Auto => anstream::ColorChoice::Auto,
            Colors::Always => anstream::ColorChoice::Always,
            Colors::Never => anstream::ColorChoice::Never,
        };
        choice.write_global();
    }

    /// `--verbose` was given.
    pub fn is_verbose(self) -> bool {
        self.verbose
    }

    /// Tests whether progress is shown: on a terminal, without `--quiet`.
    pub fn shows_progress(self) -> bool {
        !self.quiet && std::io::stderr().is_terminal()
    }

    /// A progress bar of `length` steps; the template is indicatif's.
    pub fn bar(self, length: u64, template: &str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        with_style(ProgressBar::new(length), ProgressStyle::with_template(template).ok())
    }

    /// A spinner with a message, for work without a known length.
    pub fn spinner(self, template: &str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template(&format!("{{spinner}} {template}"));
        with_style(ProgressBar::new_spinner(), style.ok())
    }

    /// Names a file that was written, and says what is in it.
    pub fn wrote(self, path: &Path, what: impl Display) {
        if !self.quiet {
            super::say(format_args!("wrote {}: {what}", path.display()));
        }
    }

    /// Says what to do next.
    pub fn hint(self, line: impl Display) {
        if !self.quiet {
            super::say(line);
        }
    }

    /// Says something that `--verbose` asks for.
    pub fn detail(self, line: impl Display) {
        if self.verbose {
            super::say(line);
        }
    }

    /// Names the driver that draws, for `--verbose`.
    pub fn driver(self, context: &dyn Context) {
        if self.verbose {
            let info = context.describe();
            super::say(format_args!("driver: {}, OpenGL {}, by {}", info.renderer, info.version, info.backend));
        }
    }
}

fn with_style(bar: ProgressBar, style: Option<ProgressStyle>) -> ProgressBar {
    match style {
        Some(style) => bar.with_style(style),
        None => bar,
    }
}
