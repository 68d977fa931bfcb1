//! Rewrites an OBJ text so that tobj reads it right: libraries and vertices first, one statement a line, every number
//! counted from the start, positions relative to the origin, no lines, points, colours or short texture coordinates. Where
//! only some corners have a normal or a texture coordinate, the others are given one of zeros, which later is taken for a
//! missing one.

use std::fmt::Write as _;

use glam::DVec3;

use super::super::text::logical_lines;
use super::corner::{Corner, Counts, read_corner};
use super::place::Places;
use super::scan::{Scan, statement_value};

/// Name of a material without a name.
pub(super) const UNNAMED: &str = "unnamed";

/// Rewrites `text`, which [`super::scan::scan`] has accepted.
pub(super) fn rewrite(text: &str, scan: &Scan) -> String {
    let mut rewriter = Rewriter {
        vertices: String::with_capacity(text.len()),
        faces: String::with_capacity(text.len() / 2),
        counts: Counts::default(),
        moved: (scan.origin != DVec3::ZERO).then_some((&scan.places, scan.origin)),
        first_texcoord: usize::from(scan.mixed_texcoords),
        first_normal: usize::from(scan.mixed_normals),
    };
    if !scan.libraries.is_empty() {
        rewriter.vertices.push_str("mtllib all\n");
    }
    if scan.mixed_texcoords {
        rewriter.vertices.push_str("vt 0 0\n");
    }
    if scan.mixed_normals {
        rewriter.vertices.push_str("vn 0 0 0\n");
    }
    for line in logical_lines(text) {
        rewriter.add_line(&line.text);
    }
    rewriter.vertices + &rewriter.faces
}

struct Rewriter<'a> {
    vertices: String,
    faces: String,
    counts: Counts,
    /// The vertices and their origin; `None`: they are written as they are.
    moved: Option<(&'a Places, DVec3)>,
    /// Number of texture coordinates (normals) before the file's own.
    first_texcoord: usize,
    first_normal: usize,
}

impl Rewriter<'_> {
    fn add_line(&mut self, line: &str) {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                self.counts.v += 1;
                if let Some((places, origin)) = self.moved {
                    let [x, y, z] = places.relative(self.counts.v - 1, origin);
                    // The shortest digits that are read as the same f32; writing to a String cannot fail.
                    let _ = writeln!(self.vertices, "v {x} {y} {z}");
                    return;
                }
                let words: Vec<_> = words.collect();
                let kept = if words.len() == 4 { 4 } else { 3 };
                self.add_vertex("v", words.into_iter().take(kept));
            }
            Some("vt") => {
                self.counts.vt += 1;
                self.add_vertex("vt", words.chain(["0"]).take(2));
            }
            Some("vn") => {
                self.counts.vn += 1;
                self.add_vertex("vn", words.take(3));
            }
            Some("f") => self.add_face(words),
            Some(keyword @ ("o" | "g")) => self.add_name(keyword, statement_value(line, keyword)),
            Some("usemtl") => match statement_value(line, "usemtl") {
                "" => self.add_name("usemtl", UNNAMED),
                name => self.add_name("usemtl", name),
            },
            _ => {}
        }
    }

    fn add_vertex<'a>(&mut self, keyword: &str, words: impl Iterator<Item = &'a str>) {
        self.vertices.push_str(keyword);
        for word in words {
            self.vertices.push(' ');
            self.vertices.push_str(word);
        }
        self.vertices.push('\n');
    }

    fn add_face<'a>(&mut self, words: impl Iterator<Item = &'a str>) {
        let corners = words.take_while(|word| !word.starts_with('#'));
        let corners: Vec<Corner> = corners.filter_map(|word| read_corner(word, self.counts).ok()).collect();
        if corners.len() < 3 {
            return;
        }
        self.faces.push('f');
        corners.into_iter().for_each(|corner| self.add_corner(corner));
        self.faces.push('\n');
    }

    fn add_corner(&mut self, corner: Corner) {
        // Where a shift is in use, a missing number becomes 1, the row of zeros; else it stays missing.
        let shift = |index: Option<usize>, shift| match index {
            Some(index) => Some(index + shift),
            None => (shift > 0).then_some(1),
        };
        // Writing to a String cannot fail.
        let _ = match (shift(corner.vt, self.first_texcoord), shift(corner.vn, self.first_normal)) {
            (None, None) => write!(self.faces, " {}", corner.v),
            (Some(vt), None) => write!(self.faces, " {}/{vt}", corner.v),
            (None, Some(vn)) => write!(self.faces, " {}//{vn}", corner.v),
            (Some(vt), Some(vn)) => write!(self.faces, " {}/{vt}/{vn}", corner.v),
        };
    }

    fn add_name(&mut self, keyword: &str, name: &str) {
        let _ = writeln!(self.faces, "{keyword} {name}");
    }
}
