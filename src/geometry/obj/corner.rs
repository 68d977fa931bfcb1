//! Corners of faces, and their indices.

/// Error in a line.
pub(super) type Wrong = String;

/// Counts of statements, so far or in total.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub v: usize,
    pub vt: usize,
    pub vn: usize,
}

/// A corner of a face: its indices, from 1; `None`: missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    pub v: usize,
    pub vt: Option<usize>,
    pub vn: Option<usize>,
}

/// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count back from the last one read.
pub(super) fn read_corner(word: &str, counts: Counts) -> Result<Corner, Wrong> {
    if !word.as_bytes().contains(&b'/')
        && let Some(v) = read_index(word, "vertex", counts.v, word)?
    {
        return Ok(Corner { v, vt: None, vn: None });
    }
    let mut parts = word.split('/');
    let v = read_index(parts.next().unwrap_or_default(), "vertex", counts.v, word)?;
    let vt = read_index(parts.next().unwrap_or_default(), "texture coordinate", counts.vt, word)?;
    let vn = read_index(parts.next().unwrap_or_default(), "normal", counts.vn, word)?;
    match v {
        Some(v) if parts.next().is_none() => Ok(Corner { v, vt, vn }),
        _ => Err(format!("'{}' is not a corner of a face", shorten(word))),
    }
}

fn read_index(digits: &str, kind: &str, count: usize, word: &str) -> Result<Option<usize>, Wrong> {
    if digits.is_empty() {
        return Ok(None);
    }
    let index: i64 = digits.parse().map_err(|_| format!("'{}' is not a corner of a face", shorten(word)))?;
    match index {
        0 => Err(format!("the face names {kind} 0; they count from 1")),
        1.. => Ok(usize::try_from(index).ok()),
        _ => match usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)) {
            Some(at) => Ok(Some(at + 1)),
            None => Err(format!("the face names {kind} {index}, but {count} stand before it")),
        },
    }
}

/// `word`, shortened for a message.
pub(in super::super) fn shorten(word: &str) -> String {
    match word.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &word[..end]),
        None => word.to_owned(),
    }
}
