//! Vertex positions of a file, read in f64. They are taken relative to an origin near them if f32, which meshes and tobj
//! hold, would merge positions that f64 keeps apart (map coordinates).

use glam::DVec3;

use super::corner::{Counts, read_corner};
use crate::geometry::far;
use crate::geometry::text::logical_lines;
use crate::math::Aabb;

/// Error of an edge, as a share of the face's longest, above which the face has lost its shape.
const MOST_OFF: f64 = 1.0 / 16.0;

/// The vertices of a file.
#[derive(Debug)]
pub(in super::super) struct Places {
    positions: Vec<DVec3>,
    bounds: Aabb,
    /// The least, over the faces, of their longest edge's length.
    finest: f64,
}

impl Default for Places {
    fn default() -> Self {
        Self { positions: Vec::new(), bounds: Aabb::EMPTY, finest: f64::INFINITY }
    }
}

impl Places {
    /// The place of a position as written; `weight` divides it where it is not empty.
    pub fn add(&mut self, xyz: [&str; 3], weight: &str) {
        let number = |word: &str| word.parse::<f64>().unwrap_or(0.0);
        let weight = if weight.is_empty() { 1.0 } else { number(weight) };
        let place = DVec3::from_array(xyz.map(number)) / weight;
        self.bounds = self.bounds.including(place);
        self.positions.push(place);
    }

    pub fn count(&self) -> usize {
        self.positions.len()
    }

    /// Notes how fine a face is. `corners` count from 1; those that are not read yet do not count.
    pub fn add_face(&mut self, corners: &[usize]) {
        let longest = self.edges(corners).map(|[a, b]| a.distance_squared(b)).fold(0.0, f64::max).sqrt();
        if longest > 0.0 {
            self.finest = self.finest.min(longest);
        }
    }

    fn edges(&self, corners: &[usize]) -> impl Iterator<Item = [DVec3; 2]> {
        let place = |k: usize| self.positions.get(corners[k % corners.len()].wrapping_sub(1)).copied();
        (0..corners.len()).filter_map(move |k| Some([place(k)?, place(k + 1)?]))
    }

    /// Origin of the mesh's positions; zero where another saves nothing.
    pub fn origin(&self) -> DVec3 {
        far::origin_of(&self.bounds)
    }

    /// The position of vertex `index`, from 0, relative to `origin`.
    pub fn relative(&self, index: usize, origin: DVec3) -> [f32; 3] {
        let place = self.positions.get(index).copied().unwrap_or_default();
        (place - origin).as_vec3().to_array()
    }

    /// The worst face that f32 does not hold: its line, its longest edge and what an edge is off by; and how many such
    /// faces there are.
    pub fn lost(&self, text: &str, origin: DVec3) -> Option<(usize, [f64; 2], usize)> {
        let reach = (self.bounds.min - origin).abs().max((self.bounds.max - origin).abs()).length();
        // Half a step for either end: no face as large as this can be lost.
        if self.finest * MOST_OFF > reach * f64::from(f32::EPSILON) {
            return None;
        }
        let (mut counts, mut worst, mut lost) = (Counts::default(), None, 0);
        for line in logical_lines(text) {
            let mut words = line.text.split_whitespace();
            match words.next() {
                Some("v") => counts.v += 1,
                Some("vt") => counts.vt += 1,
                Some("vn") => counts.vn += 1,
                Some("f") => {
                    let corners = words.map_while(|word| read_corner(word, counts).ok());
                    let corners: Vec<usize> = corners.map(|corner| corner.v).collect();
                    if corners.len() < 3 {
                        continue;
                    }
                    let Some([length, off]) = self.longest(&corners, origin) else { continue };
                    if off > MOST_OFF * length {
                        lost += 1;
                        let ratio = off / length;
                        if worst.is_none_or(|(_, [length, off]): (_, [f64; 2])| ratio > off / length) {
                            worst = Some((line.number, [length, off]));
                        }
                    }
                }
                _ => {}
            }
        }
        worst.map(|(line, edge)| (line, edge, lost))
    }

    /// A face's longest edge, and the most that f32 makes any of its edges wrong by.
    fn longest(&self, corners: &[usize], origin: DVec3) -> Option<[f64; 2]> {
        let held = |place: DVec3| (place - origin).as_vec3().as_dvec3();
        let edges = self.edges(corners).map(|[a, b]| [(b - a).length(), (held(b) - held(a) - (b - a)).length()]);
        let worst = edges.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        worst.filter(|[length, _]| *length > 0.0)
    }
}

/// Warning about a file whose faces f32 does not hold: the line, and why.
pub(super) fn warning(places: &Places, origin: DVec3, text: &str) -> Option<(usize, String)> {
    let (line, [length, off], count) = places.lost(text, origin)?;
    let faces = if count == 1 { String::from("this face is") } else { format!("{count} faces as this one are") };
    let message = format!(
        "{faces} too fine for 32-bit floats so far from the file's middle: it is {length:.3e} long, and an edge is off by {off:.1e}"
    );
    Some((line, message))
}
