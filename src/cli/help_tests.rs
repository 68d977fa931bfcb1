//! Text below the options in `--help`: clap wraps it to the terminal, so that lines broken by hand would be broken twice.

use clap::CommandFactory;

use super::Arguments;

/// Columns of a terminal that nobody has made wider.
const COLUMNS: usize = 80;

#[test]
fn lines_of_help_are_broken_once() {
    let mut command = Arguments::command();
    command.build();
    let mut lines = 0;
    each(&command, &mut |command| {
        let text = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let text: Vec<&str> = text.lines().collect();
        lines += text.len();
        for pair in text.windows(2) {
            let is_table = pair.iter().any(|line| line.is_empty() || line.starts_with(' ')) || pair[0].ends_with(':');
            assert!(is_table, "{}: prose that is broken by hand: {pair:?}", command.get_name());
        }
        for line in text.iter().filter(|line| line.starts_with(' ')) {
            assert!(line.chars().count() <= COLUMNS, "{}: longer than {COLUMNS}: {line}", command.get_name());
        }
    });
    assert!(lines > 100, "{lines} lines of help were read");
}

fn each(command: &clap::Command, act: &mut impl FnMut(&clap::Command)) {
    act(command);
    command.get_subcommands().for_each(|command| each(command, act));
}
