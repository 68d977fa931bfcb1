//! One cheap pass over an OBJ text before tobj sees it: refuses errors, with their line, and notes what tobj would misread
//! (see [`super::rewrite`]). It allocates nothing per line.

use std::path::Path;

use glam::DVec3;

use super::super::Error;
use super::super::tally::WarningTally;
use super::super::text::logical_lines;
use super::corner::{Corner, Counts, Wrong, read_corner, shorten};
use super::place::Places;
use crate::process::Reading;

/// Bytes after which a count goes to the progress bar: other threads then seldom wait for this one.
const COUNTED_AT_ONCE: u64 = 1 << 16;

/// Contents of the text.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// `mtllib` statements: line, and what is written.
    pub libraries: Vec<(usize, String)>,
    /// `usemtl` statements whose name differs from the one before: line and name.
    pub uses: Vec<(usize, String)>,
    pub faces: usize,
    pub places: Places,
    /// Origin of the mesh's positions.
    pub origin: DVec3,
    /// True if tobj would misread the text as it is.
    pub needs_rewrite: bool,
    /// Some corners name a texture coordinate (a normal), others do not.
    pub mixed_texcoords: bool,
    pub mixed_normals: bool,
    /// Statements that are ignored.
    pub oddities: WarningTally,
}

/// The largest numbers that faces name, of those that had not been read by then, with their lines.
struct Forward {
    line: usize,
    corner: Corner,
}

struct Scanner<'a> {
    path: &'a Path,
    scan: Scan,
    counts: Counts,
    forward: Vec<Forward>,
    /// The vertices of the face that is read.
    face: Vec<usize>,
    corners: usize,
    corners_with_texcoord: usize,
    corners_with_normal: usize,
}

/// Reads `text`, the file at `path`, and counts its bytes in `reading`.
pub(super) fn scan(text: &str, path: &Path, reading: &Reading) -> Result<Scan, Error> {
    let mut scanner = Scanner {
        path,
        scan: Scan::default(),
        counts: Counts::default(),
        forward: Vec::new(),
        face: Vec::new(),
        corners: 0,
        corners_with_texcoord: 0,
        corners_with_normal: 0,
    };
    let mut bytes = 0;
    for line in logical_lines(text) {
        bytes += line.text.len() as u64 + 1;
        if bytes >= COUNTED_AT_ONCE {
            reading.advance(std::mem::take(&mut bytes));
        }
        scanner.scan.needs_rewrite |= matches!(line.text, std::borrow::Cow::Owned(_));
        scanner.read_line(line.number, &line.text).map_err(|what| Error::malformed(path, line.number, what))?;
    }
    reading.advance(bytes);
    scanner.finish()
}

impl Scanner<'_> {
    fn read_line(&mut self, number: usize, line: &str) -> Result<(), Wrong> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => self.read_position(number, words),
            Some("f") => self.read_face(number, words),
            Some("vt") => self.read_texcoord(words),
            Some("vn") => self.read_normal(words),
            // tobj takes a line of three points for a triangle.
            Some(keyword @ ("l" | "p")) => {
                self.scan.needs_rewrite = true;
                let what = if keyword == "l" { "lines" } else { "points" };
                self.note(keyword, number, || format!("{keyword}: {what} are not drawn"));
                Ok(())
            }
            Some(keyword @ ("o" | "g")) => {
                self.note_odd_spacing(line, keyword);
                Ok(())
            }
            Some("usemtl") => {
                self.note_odd_spacing(line, "usemtl");
                self.use_material(number, statement_value(line, "usemtl"));
                Ok(())
            }
            Some("mtllib") => {
                self.note_odd_spacing(line, "mtllib");
                // tobj knows a material only after its library.
                self.scan.needs_rewrite |= !self.scan.uses.is_empty();
                self.scan.libraries.push((number, statement_value(line, "mtllib").to_owned()));
                Ok(())
            }
            Some(keyword) => {
                self.leave_out(number, keyword);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Warns of a statement that is ignored, unless it changes no picture of polygons.
    fn leave_out(&mut self, number: usize, keyword: &str) {
        match keyword {
            _ if keyword.starts_with('#') => {}
            // Groups that are smooth, parameters of curves and of surfaces, hints for display.
            "s" | "mg" | "lod" | "bevel" | "c_interp" | "d_interp" | "ctech" | "stech" | "vp" | "cstype" | "deg"
            | "bmat" | "step" | "parm" | "trim" | "hole" | "scrv" | "sp" | "end" | "con" | "\u{1a}" => {}
            "curv" | "curv2" | "surf" => {
                self.note("curves", number, || format!("{keyword}: curves and curved surfaces are not drawn"));
            }
            _ => {
                let what = || format!("'{}' is no statement of OBJ that is drawn; it is left out", shorten(keyword));
                self.note("unknown", number, what);
            }
        }
    }

    fn note(&mut self, kind: &str, number: usize, message: impl FnOnce() -> String) {
        self.scan.oddities.note(kind, self.path, number, message);
    }

    /// tobj takes a name from behind the first space of the line.
    fn note_odd_spacing(&mut self, line: &str, keyword: &str) {
        let plain = line.strip_prefix(keyword).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '));
        self.scan.needs_rewrite |= !plain;
    }

    fn use_material(&mut self, number: usize, name: &str) {
        self.scan.needs_rewrite |= name.is_empty();
        if self.scan.uses.last().is_none_or(|(_, last)| last != name) {
            self.scan.uses.push((number, name.to_owned()));
        }
    }

    fn read_position<'a>(&mut self, number: usize, words: impl Iterator<Item = &'a str>) -> Result<(), Wrong> {
        let (mut count, mut xyz, mut weight) = (0, [""; 3], "");
        for word in words {
            match count {
                0..3 => {
                    check_coordinate("v", word)?;
                    xyz[count] = word;
                }
                3 => weight = word,
                _ => {}
            }
            count += 1;
        }
        match count {
            0..3 => return Err(format!("v has {count} of 3 coordinates")),
            4 => check_weight(weight, xyz)?,
            3 => {}
            // Colours, which tobj takes only as exactly three numbers.
            _ => {
                self.scan.needs_rewrite = true;
                self.note("colours", number, || String::from("v: colours of vertices are not drawn"));
            }
        }
        self.scan.places.add(xyz, if count == 4 { weight } else { "" });
        self.counts.v += 1;
        Ok(())
    }

    fn read_texcoord<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), Wrong> {
        let mut count = 0;
        for word in words.take(2) {
            check_coordinate("vt", word)?;
            count += 1;
        }
        match count {
            0 => return Err(String::from("vt has no coordinate")),
            1 => self.scan.needs_rewrite = true,
            _ => {}
        }
        self.counts.vt += 1;
        Ok(())
    }

    /// Normals that are not finite are repaired later; what is not a number at all is refused.
    fn read_normal<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), Wrong> {
        let mut count = 0;
        for word in words.take(3) {
            if !is_plain_number(word) && word.parse::<f32>().is_err() {
                return Err(format!("vn: '{}' is not a number", shorten(word)));
            }
            count += 1;
        }
        if count < 3 {
            return Err(format!("vn has {count} of 3 coordinates"));
        }
        self.counts.vn += 1;
        Ok(())
    }

    fn read_face<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a str>) -> Result<(), Wrong> {
        self.face.clear();
        for word in words {
            if word.starts_with('#') {
                self.scan.needs_rewrite = true;
                break;
            }
            let corner = read_corner(word, self.counts)?;
            self.note_corner(line, corner);
            self.face.push(corner.v);
        }
        if self.face.len() < 3 {
            self.scan.needs_rewrite = true;
            let count = self.face.len();
            let vertices = if count == 1 { "vertex" } else { "vertices" };
            self.note("short", line, || format!("f: a face of {count} {vertices} is left out; it takes 3"));
            return Ok(());
        }
        self.scan.places.add_face(&self.face);
        self.scan.faces += 1;
        Ok(())
    }

    fn note_corner(&mut self, line: usize, corner: Corner) {
        self.corners += 1;
        self.corners_with_texcoord += usize::from(corner.vt.is_some());
        self.corners_with_normal += usize::from(corner.vn.is_some());
        let ahead = corner.v > self.counts.v
            || corner.vt.is_some_and(|vt| vt > self.counts.vt)
            || corner.vn.is_some_and(|vn| vn > self.counts.vn);
        if ahead {
            self.forward.push(Forward { line, corner });
        }
    }

    /// Checks the faces that named vertices before they were read.
    fn finish(self) -> Result<Scan, Error> {
        let Self { path, mut scan, counts, forward, corners, corners_with_texcoord, corners_with_normal, .. } = self;
        for Forward { line, corner } in &forward {
            let named = [
                ("vertex", Some(corner.v), counts.v),
                ("texture coordinate", corner.vt, counts.vt),
                ("normal", corner.vn, counts.vn),
            ];
            for (kind, index, count) in named {
                if let Some(index) = index.filter(|index| *index > count) {
                    let what = format!("the face names {kind} {index}, but the file has {count}");
                    return Err(Error::malformed(path, *line, what));
                }
            }
        }
        if scan.faces == 0 {
            return Err(Error::NoFaces { path: path.to_owned() });
        }
        scan.origin = scan.places.origin();
        scan.mixed_texcoords = !(corners_with_texcoord == 0 || corners_with_texcoord == corners);
        scan.mixed_normals = !(corners_with_normal == 0 || corners_with_normal == corners);
        let is_moved = scan.origin != DVec3::ZERO;
        scan.needs_rewrite |= is_moved || !forward.is_empty() || scan.mixed_texcoords || scan.mixed_normals;
        Ok(scan)
    }
}

/// Refuses a word that is not a finite f32.
fn check_coordinate(statement: &str, word: &str) -> Result<(), Wrong> {
    if is_plain_number(word) {
        return Ok(());
    }
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(()),
        Ok(_) => Err(format!("{statement}: '{}' is not finite as a 32-bit float", shorten(word))),
        Err(_) => Err(format!("{statement}: '{}' is not a number", shorten(word))),
    }
}

/// tobj divides by the fourth number of a position.
fn check_weight(weight: &str, xyz: [&str; 3]) -> Result<(), Wrong> {
    check_coordinate("v", weight)?;
    let value = |word: &str| word.parse::<f32>().unwrap_or(f32::NAN);
    let weight = value(weight);
    if xyz.iter().all(|word| (value(word) / weight).is_finite()) {
        return Ok(());
    }
    Err(format!("v: the weight {weight} leaves no finite position"))
}

/// Tests whether `word` is a sign, digits and a point, and so few that the value must be finite.
fn is_plain_number(word: &str) -> bool {
    let digits = word.as_bytes();
    let digits = match digits {
        [b'+' | b'-', rest @ ..] => rest,
        _ => digits,
    };
    let points = digits.iter().filter(|byte| **byte == b'.').count();
    let plain = digits.iter().all(|byte| byte.is_ascii_digit() || *byte == b'.');
    plain && points <= 1 && digits.len() > points && digits.len() <= 30
}

/// Text after the keyword of a statement, to the line's end.
pub(super) fn statement_value<'a>(line: &'a str, keyword: &str) -> &'a str {
    line.trim().strip_prefix(keyword).unwrap_or_default().trim()
}
