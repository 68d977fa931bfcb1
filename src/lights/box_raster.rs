//! Boxes by their places in a picture or a map: all rays through one place meet the same few boxes.

use glam::{DVec2, DVec3, DVec4};

/// Greatest number of cells a side.
const MOST_CELLS: usize = 128;

/// Growth of each box's place, as a share of the raster: far more than rounding moves a place.
const RIM: f64 = 1e-6;

/// Depth below which a corner has no sure place, relative to the coordinates that it is found from.
const LEAST_DEPTH: f64 = 1e-6;

/// Boxes in a square of cells.
#[derive(Default)]
pub struct BoxRaster {
    /// Number of cells a side.
    side: usize,
    /// Boxes that cover some of each cell, row by row.
    cells: Vec<Vec<Covering>>,
    /// Boxes that have no place, as they lie on both sides of the eye: rays through any place may meet them.
    everywhere: Vec<u32>,
}

/// A box by its index, and the rectangle that it covers.
#[derive(Clone, Copy)]
struct Covering {
    index: u32,
    min: DVec2,
    max: DVec2,
}

/// Place of a point in [0, 1]², its depth before the eye, and the greatest coordinate that these were found from.
pub struct Sighting {
    pub place: DVec2,
    pub depth: f64,
    pub size: f64,
}

impl Sighting {
    /// The sighting of a point of clip space.
    pub fn new(clip: DVec4, size: f64) -> Self {
        Self { place: 0.5 + 0.5 * clip.truncate().truncate() / clip.w, depth: clip.w, size }
    }

    /// Tests whether no ray ahead of the eye meets it, whatever rounding does.
    fn is_behind(&self) -> bool {
        self.depth < -LEAST_DEPTH * self.size
    }

    /// Tests whether rounding leaves the place as it is.
    fn is_sure(&self) -> bool {
        self.place.is_finite() && self.depth > LEAST_DEPTH * self.size
    }
}

/// A raster, and a place in it.
#[derive(Clone, Copy)]
pub struct At<'r> {
    pub raster: &'r BoxRaster,
    pub place: DVec2,
}

impl BoxRaster {
    /// Sorts boxes, each by its corners, by where `see` finds their corners.
    pub fn new(boxes: impl ExactSizeIterator<Item = [DVec3; 8]>, see: impl Fn(DVec3) -> Sighting) -> Self {
        let side = (2.0 * (boxes.len() as f64).sqrt()).ceil().clamp(1.0, MOST_CELLS as f64) as usize;
        let mut raster = Self { side, cells: vec![Vec::new(); side * side], everywhere: Vec::new() };
        for (index, corners) in boxes.enumerate() {
            let index = index as u32;
            let corners = corners.map(&see);
            if corners.iter().all(Sighting::is_behind) {
                continue;
            }
            let Some((min, max)) = rectangle(&corners) else {
                raster.everywhere.push(index);
                continue;
            };
            if max.cmplt(DVec2::ZERO).any() || min.cmpgt(DVec2::ONE).any() {
                continue;
            }
            let [first, last] = [raster.cell(min), raster.cell(max)];
            for y in first[1]..=last[1] {
                for cell in &mut raster.cells[y * side + first[0]..=y * side + last[0]] {
                    cell.push(Covering { index, min, max });
                }
            }
        }
        raster
    }

    /// The place of the ray through a point. `None`: rounding may move it.
    pub fn at(&self, sighting: &Sighting) -> Option<At<'_>> {
        sighting.is_sure().then_some(At { raster: self, place: sighting.place })
    }

    /// The same for a ray through two points. `None`: rounding may move them, or has moved them apart.
    pub fn at_both(&self, ends: [DVec3; 2], see: impl Fn(DVec3) -> Sighting) -> Option<At<'_>> {
        let [near, far] = ends.map(see);
        let apart = (near.place - far.place).abs().max_element();
        self.at(&near).filter(|_| far.is_sure() && apart < 0.25 * RIM)
    }

    /// Calls `look` with each box that a ray through `place` may meet, in no order. `None`: the place lies outside.
    pub fn met(&self, place: DVec2, mut look: impl FnMut(u32)) -> Option<()> {
        if !(place.cmpge(DVec2::ZERO).all() && place.cmple(DVec2::ONE).all()) {
            return None;
        }
        let [x, y] = self.cell(place);
        let covering = self.cells[y * self.side + x].iter();
        let covering = covering.filter(|own| own.min.cmple(place).all() && own.max.cmpge(place).all());
        covering.map(|own| own.index).chain(self.everywhere.iter().copied()).for_each(&mut look);
        Some(())
    }

    /// The greatest sum of what `weight` says of the boxes that a ray through one place may meet.
    pub fn most(&self, weight: impl Fn(u32) -> usize) -> usize {
        let sum = |boxes: &mut dyn Iterator<Item = u32>| boxes.map(&weight).sum::<usize>();
        let cells = self.cells.iter().map(|cell| sum(&mut cell.iter().map(|own| own.index)));
        cells.max().unwrap_or(0) + sum(&mut self.everywhere.iter().copied())
    }

    fn cell(&self, place: DVec2) -> [usize; 2] {
        // A cast takes numbers below 0 to 0.
        (place * self.side as f64).to_array().map(|at| (at as usize).min(self.side - 1))
    }
}

/// Rectangle that holds the places of a box; `None` if a corner lies behind the eye, or so near it that rounding decides.
fn rectangle(corners: &[Sighting; 8]) -> Option<(DVec2, DVec2)> {
    let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for corner in corners {
        if !corner.is_sure() {
            return None;
        }
        (min, max) = (min.min(corner.place), max.max(corner.place));
    }
    Some((min - RIM, max + RIM))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rays::{Boxes, Ray};
    use crate::math::Aabb;
    use crate::math::spaces::perspective;

    /// Every box that a ray of an eye meets is among those of its place, whether the boxes lie before the eye, around it or
    /// behind it; and most others are not.
    #[test]
    fn no_box_on_a_ray_is_missed() {
        let clip_from_view = perspective(1.2, 1.0, 0.1, 100.0);
        let mut random = fastrand::Rng::with_seed(5);
        let mut number = |least: f64, most: f64| least + (most - least) * random.f64();
        let boxes: Vec<Aabb> = (0..500)
            .map(|_| {
                let center = DVec3::new(number(-20.0, 20.0), number(-20.0, 20.0), number(-40.0, 10.0));
                let half = DVec3::new(number(0.0, 1.0), number(0.0, 1.0), number(0.0, 1.0)).powf(3.0) * 4.0;
                Aabb { min: center - half, max: center + half }
            })
            .collect();
        let see = |point: DVec3| {
            let clip = clip_from_view * point.extend(1.0);
            Sighting::new(clip, point.abs().max_element())
        };
        let raster = BoxRaster::new(boxes.iter().map(Aabb::corners), see);
        let exact = Boxes::new(boxes.iter().map(|bounds| [bounds.min, bounds.max]));
        let (mut met, mut looked_at) = (0, 0);
        for _ in 0..5000 {
            let place = DVec2::new(number(0.0, 1.0), number(0.0, 1.0));
            let way = clip_from_view.inverse().project_point3((2.0 * place - 1.0).extend(0.5));
            let mut near = Vec::new();
            raster.met(place, |index| near.push(index)).unwrap();
            exact.met(&Ray { origin: DVec3::ZERO, way, start: 0.0, end: f64::MAX }, |index| {
                assert!(near.contains(&index), "box {index}: {:?} at {place}", boxes[index as usize]);
                met += 1;
            });
            looked_at += near.len() - raster.everywhere.len();
        }
        assert!(met > 9000 && looked_at < 4 * met, "{met} met, {looked_at} looked at");
        // Boxes across the eye's plane, one in twenty; none of the hundred behind it.
        assert!(raster.everywhere.len() < 40, "{}", raster.everywhere.len());
        assert_eq!(raster.met(DVec2::new(1.1, 0.5), |_| {}), None);
        // No cell has fewer than what a place in it meets, and few have more.
        let most = raster.most(|_| 1);
        assert!((8..60).contains(&(most - raster.everywhere.len())), "{most}");
        assert_eq!(raster.most(|_| 2), 2 * most);
    }
}
