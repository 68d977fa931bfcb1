//! Surfaces beyond a depth that none before it hides, by samples: the middles of an object's largest triangles.
//! The work is that of looking at all objects a few times, however many of them are tested.

use glam::{DVec2, DVec3};

use super::Object;
use super::sight::{Cut, LEAST_PIECE, Pyramid};
use crate::process::work;

/// Number of triangles of a cut-off part that are tested for lying behind other surfaces.
const SAMPLES: usize = 16;

/// Greatest number of cells a side.
const MOST_CELLS: usize = 128;

impl Pyramid {
    /// Place of the first of `cut` of which some beyond depth `far` is not hidden by surfaces of `objects` before that depth.
    pub fn first_beyond(&self, cut: &[&Object], far: f64, objects: &[Object], size: [u32; 2]) -> Option<usize> {
        let (mut start, mut count) = (0, 1);
        while start < cut.len() {
            let end = (start + count).min(cut.len());
            let mut points = Points::new(count);
            for (owner, object) in (start..end).zip(&cut[start..end]) {
                self.sample(object, far, size)
                    .into_iter()
                    .for_each(|point| points.add(owner, self.place(point), point));
            }
            self.hide(&mut points, far, objects);
            if let Some(owner) = points.first() {
                return Some(owner);
            }
            // Each look at all objects serves twice as many.
            (start, count) = (end, 2 * count);
        }
        None
    }

    /// Middles of the largest triangles of `object` beyond depth `far`.
    fn sample(&self, object: &Object, far: f64, size: [u32; 2]) -> Vec<DVec3> {
        let mut pieces: Vec<(f64, DVec3)> = Vec::new();
        self.visit(object, |polygon| {
            let piece = Cut::Between(far, f64::INFINITY).piece(polygon);
            let area = self.pixels(&piece, size);
            if area >= LEAST_PIECE {
                pieces.push((area, piece.iter().sum::<DVec3>() / piece.len() as f64));
            }
            true
        });
        pieces.sort_by(|a, b| b.0.total_cmp(&a.0));
        pieces.into_iter().take(SAMPLES).map(|(_, point)| point).collect()
    }

    /// Removes the points that surfaces before depth `far` hide.
    fn hide(&self, points: &mut Points, far: f64, objects: &[Object]) {
        for object in objects {
            if points.left == 0 {
                return;
            }
            self.visit(object, |polygon| {
                if polygon.iter().any(|corner| -corner.z < far) {
                    let ahead = polygon.iter().all(|corner| corner.z < 0.0);
                    let places = polygon.iter().map(|corner| self.place(*corner));
                    let [least, most] = places.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[least, most], place| {
                        [least.min(place), most.max(place)]
                    });
                    let around = if ahead { [least, most] } else { [DVec2::NEG_ONE, DVec2::ONE] };
                    points.remove(around, |point| hides(polygon, point, far));
                }
                points.left > 0
            });
        }
    }

    /// Place of a point of view space in the picture, from -1 to 1.
    fn place(&self, point: DVec3) -> DVec2 {
        point.truncate() / (-point.z * self.tan)
    }
}

/// Points of objects, in a square of cells by their places.
struct Points {
    side: usize,
    cells: Vec<Vec<(usize, DVec3)>>,
    left: usize,
}

impl Points {
    /// Room for the points of so many objects.
    fn new(objects: usize) -> Self {
        let side = ((SAMPLES * objects) as f64).sqrt().ceil().clamp(1.0, MOST_CELLS as f64) as usize;
        Self { side, cells: vec![Vec::new(); side * side], left: 0 }
    }

    fn cell(&self, place: DVec2) -> [usize; 2] {
        // A cast takes numbers below 0, and what is none, to 0.
        ((0.5 + 0.5 * place) * self.side as f64).to_array().map(|at| (at as usize).min(self.side - 1))
    }

    fn add(&mut self, owner: usize, place: DVec2, point: DVec3) {
        let [x, y] = self.cell(place);
        self.cells[y * self.side + x].push((owner, point));
        self.left += 1;
    }

    /// Removes the points that `is_hidden`, among those whose places may lie between two corners.
    fn remove(&mut self, [least, most]: [DVec2; 2], is_hidden: impl Fn(DVec3) -> bool) {
        // Far more than rounding moves a place.
        let [first, last] = [self.cell(least - 1e-6), self.cell(most + 1e-6)];
        for y in first[1]..=last[1] {
            for cell in &mut self.cells[y * self.side + first[0]..=y * self.side + last[0]] {
                let before = cell.len();
                cell.retain(|(_, point)| {
                    work::count_comparison();
                    !is_hidden(*point)
                });
                self.left -= before - cell.len();
            }
        }
    }

    /// The first object that has a point left.
    fn first(&self) -> Option<usize> {
        self.cells.iter().flatten().map(|(owner, _)| *owner).min()
    }
}

/// Tests whether the ray from the view's origin to `point` meets the polygon before it, at a depth below `far`.
fn hides(polygon: &[DVec3], point: DVec3, far: f64) -> bool {
    let sides = (0..polygon.len()).map(|k| polygon[k].cross(polygon[(k + 1) % polygon.len()]).dot(point));
    let (mut left, mut right) = (false, false);
    sides.for_each(|side| (left, right) = (left || side > 0.0, right || side < 0.0));
    let normal =
        (1..polygon.len() - 1).map(|k| (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0])).sum::<DVec3>();
    let at = normal.dot(polygon[0]) / normal.dot(point);
    left != right && 0.0 < at && at * -point.z < far
}
