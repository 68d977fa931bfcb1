//! Decodes text files: UTF-8 with or without its mark, UTF-16 with one, Latin-1; any line ends. Counts the bytes that a parser
//! reads.

use std::borrow::Cow;
use std::io::{self, BufRead, Read, Seek, SeekFrom};
use std::path::Path;

use super::Error;
use crate::process::Reading;

/// The whole file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    if path.is_dir() {
        return Err(Error::Directory { path: path.to_owned() });
    }
    std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })
}

/// A file's text.
///
/// # Errors
///
/// A file that cannot be read or is no text.
pub fn read_text(path: &Path) -> Result<String, Error> {
    Ok(decode(&read(path)?, path)?.into_owned())
}

/// `bytes` as text whose lines end in `\n` or `\r\n`. Control characters are refused: they indicate a binary file.
pub(super) fn decode<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>, Error> {
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => Cow::Owned(decode_utf16(rest, u16::from_le_bytes)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(decode_utf16(rest, u16::from_be_bytes)),
        [0xef, 0xbb, 0xbf, rest @ ..] => decode_bytes(rest),
        _ => decode_bytes(bytes),
    };
    // Checks the whole first, which the compiler vectorises.
    let has_binary = text.bytes().fold(false, |any, byte| any | is_binary(byte));
    if let Some(at) = has_binary.then(|| text.bytes().position(is_binary)).flatten() {
        let line = 1 + text.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count();
        return Err(Error::NotText { path: path.to_owned(), line, byte: text.as_bytes()[at] });
    }
    // Line ends of the old Macintosh.
    Ok(if text.contains('\r') && !text.contains('\n') { Cow::Owned(text.replace('\r', "\n")) } else { text })
}

/// Characters that no text has; 0x1a ended files under DOS.
fn is_binary(byte: u8) -> bool {
    (byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0b | 0x0c | 0x1a)) || byte == 0x7f
}

fn decode_bytes(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
    }
}

fn decode_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// A file in memory whose bytes are counted as they are read.
pub(super) struct CountedBytes<'a, R> {
    pub inner: R,
    pub reading: &'a Reading,
}

impl<R: Read> Read for CountedBytes<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.reading.advance(count as u64);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for CountedBytes<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.inner.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        self.inner.consume(amount);
        self.reading.advance(amount as u64);
    }
}

impl<R: Seek> Seek for CountedBytes<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}

/// A line with what continues it: a `\` at a line's end joins the next.
pub(super) struct LogicalLine<'a> {
    /// Number of the first physical line, from 1.
    pub number: usize,
    pub text: Cow<'a, str>,
}

/// The last part of a path, for a progress bar.
pub(super) fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The lines of `text`, continued lines joined by a space.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = LogicalLine<'_>> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (first, number) = lines.next()?;
        let Some(head) = continued(first) else {
            return Some(LogicalLine { number, text: Cow::Borrowed(first) });
        };
        let mut joined = head.to_owned();
        for (line, _) in lines.by_ref() {
            joined.push(' ');
            match continued(line) {
                Some(part) => joined.push_str(part),
                None => {
                    joined.push_str(line);
                    break;
                }
            }
        }
        Some(LogicalLine { number, text: Cow::Owned(joined) })
    })
}

/// `line` without the `\` at its end, if there is one. A comment is not continued.
fn continued(line: &str) -> Option<&str> {
    if !line.ends_with('\\') || line.trim_start().starts_with('#') {
        return None;
    }
    line.strip_suffix('\\')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> String {
        decode(bytes, Path::new("a")).unwrap().into_owned()
    }

    #[test]
    fn encodings_and_line_ends() {
        assert_eq!(decoded(b"\xef\xbb\xbfv 1"), "v 1");
        assert_eq!(decoded(b"\xff\xfev\0\n\0"), "v\n");
        assert_eq!(decoded(b"\xfe\xff\0v\0\n"), "v\n");
        assert_eq!(decoded(b"d\xe4k"), "däk");
        assert_eq!(decoded(b"v\rf"), "v\nf");
        let error = decode(b"v\nf \x02", Path::new("a")).unwrap_err();
        assert_eq!(error.to_string(), "a:2: is not text: byte 0x02");
    }

    #[test]
    fn continued_lines_are_joined_and_keep_their_number() {
        let lines: Vec<_> =
            logical_lines("a \\\nb\\\n c\r\n# no \\\nd\\").map(|line| (line.number, line.text)).collect();
        let expected = [(1, "a  b  c"), (4, "# no \\"), (5, "d")].map(|(number, text)| (number, Cow::from(text)));
        assert_eq!(lines, expected);
    }
}
