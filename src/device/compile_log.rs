//! A driver's compile log, with the file and the line that each message is about.

use std::ops::Range;

use crate::pass::Source;

/// The log of a text without `#line`: the places in it are replaced by file and line, and the line itself stands below.
/// Mesa writes `0:5(12): error: …`, NVIDIA `0(5) : error …`, AMD `ERROR: 0:5: …`.
pub fn explain(log: &str, source: &Source) -> String {
    let mut lines = Vec::new();
    for message in log.trim_end_matches(['\0', '\n', ' ']).lines() {
        let found = place(message).and_then(|(range, line)| Some((range, source.place(line)?)));
        let Some((range, place)) = found else {
            lines.push(message.to_owned());
            continue;
        };
        let (before, after) = (&message[..range.start], &message[range.end..]);
        lines.push(format!("{before}{}:{}{after}\n    {}", place.file, place.line, place.text.trim()));
    }
    lines.join("\n")
}

/// The first two numbers that are joined by a colon or a parenthesis, and the second of them: a line. A parenthesis that
/// is closed again is a part.
fn place(message: &str) -> Option<(Range<usize>, usize)> {
    let bytes = message.as_bytes();
    let digits = |from: usize| bytes.iter().skip(from).take_while(|byte| byte.is_ascii_digit()).count();
    let mut start = 0;
    while start < bytes.len() {
        let end = start + digits(start);
        let separator = bytes.get(end).copied();
        if end > start && matches!(separator, Some(b':' | b'(')) {
            let count = digits(end + 1);
            if count > 0 {
                let line = message[end + 1..end + 1 + count].parse().ok()?;
                let last = end + 1 + count;
                let closed = separator == Some(b'(') && bytes.get(last) == Some(&b')');
                return Some((start..last + usize::from(closed), line));
            }
        }
        start = end.max(start + 1);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::{Chunk, Program, Stage};

    #[test]
    fn places_of_three_drivers_are_read() {
        assert_eq!(place("0:5(12): error: `x' undeclared"), Some((0..3, 5)));
        assert_eq!(place("0(17) : error C1008: undefined variable \"x\""), Some((0..5, 17)));
        assert_eq!(place("ERROR: 0:3: 'x' : undeclared identifier"), Some((7..10, 3)));
        for none in ["", "error", "ERROR: 2 compilation errors", "1:99999999999999999999", "1:", "7(", "é 3: x"] {
            assert_eq!(place(none), None, "{none}");
        }
    }

    #[test]
    fn messages_name_file_and_line_and_show_it() {
        let chunk = |name: &str, text: &str| Chunk { name: name.to_owned().into(), text: text.to_owned().into() };
        let program = Program {
            label: String::from("test"),
            defines: Vec::new(),
            vertex: Vec::new(),
            fragment: vec![chunk("one.frag", "a\nb\n"), chunk("two.frag", "c\n  float x = y;\n")],
            attributes: Vec::new(),
        };
        let source = program.source(Stage::Fragment);
        // Drivers count the lines of the whole text.
        let line_of = |text: &str| 1 + source.without_line_marks().lines().position(|line| line == text).unwrap();
        let (wrong, odd) = (line_of("  float x = y;"), line_of("b"));
        let log =
            format!("0:{wrong}(13): error: `y' undeclared\n0({odd}) : warning\nERROR: 0:99: elsewhere\nand so on\n\0");
        let expected = "two.frag:2(13): error: `y' undeclared\n    float x = y;\none.frag:2 : warning\n    b\n\
                        ERROR: 0:99: elsewhere\nand so on";
        assert_eq!(explain(&log, &source), expected);
    }
}
