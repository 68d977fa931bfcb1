//! Which pixels lie near a true shadow edge, in texels of a shadow map.
//!
//! Distances are taken in the map's plane, not in the picture: a pixel is in the band when its point projects to
//! within k texels of where an edge projects. That is where a map of that size can be wrong by its texels alone,
//! however the camera foreshortens it and however far the receiver lies behind the caster. An edge is known between two
//! pixels only, so that it is taken for the whole stretch between their points: both belong to the band at any k.

use std::collections::HashMap;

use glam::DVec2;

use super::edges::Pair;
use crate::oracle::ray::Truth;

/// What counts as near a true shadow edge: within so many texels of a map that the light's square frustum fills.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Band {
    /// k, not below 0. Pixels next to the edge belong to the band at any k.
    pub texels: f64,
    /// Of the whole frustum at the light's angle; for a map that covers less, of the map that would.
    pub map_size: [u32; 2],
}

/// The pixels of `truth` within `band` of its shadow `edges`.
pub(super) fn find_band(truth: &Truth, edges: &[Pair], band: &Band) -> Vec<bool> {
    let size = DVec2::new(f64::from(band.map_size[0]), f64::from(band.map_size[1]));
    let texel = |index: usize| truth.pixels[index].hit.map_or(DVec2::INFINITY, |hit| 0.5 * hit.in_light * size);
    let stretches: Vec<[DVec2; 2]> = edges.iter().map(|edge| [texel(edge.first), texel(edge.second)]).collect();
    let near = Cells::new(stretches, band.texels);
    let mut in_band: Vec<bool> = (0..truth.pixels.len()).map(|index| near.holds(texel(index))).collect();
    for edge in edges {
        (in_band[edge.first], in_band[edge.second]) = (true, true);
    }
    in_band
}

/// Stretches by the square cells that their surroundings reach.
struct Cells {
    stretches: Vec<[DVec2; 2]>,
    reach: f64,
    cell: f64,
    lists: HashMap<[i64; 2], Vec<usize>>,
}

impl Cells {
    fn new(mut stretches: Vec<[DVec2; 2]>, reach: f64) -> Self {
        stretches.retain(|[a, b]| a.is_finite() && b.is_finite());
        let length: f64 = stretches.iter().map(|[a, b]| a.distance(*b)).sum();
        let cell = (length / stretches.len().max(1) as f64).max(reach).max(1e-3);
        let mut cells = Self { stretches, reach, cell, lists: HashMap::new() };
        for (index, [a, b]) in cells.stretches.iter().enumerate() {
            let [low, high] = [a.min(*b) - reach, a.max(*b) + reach].map(|corner| cell_of(corner, cell));
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    cells.lists.entry([x, y]).or_default().push(index);
                }
            }
        }
        cells
    }

    fn holds(&self, point: DVec2) -> bool {
        let list = self.lists.get(&cell_of(point, self.cell));
        list.is_some_and(|list| list.iter().any(|&index| distance(point, self.stretches[index]) <= self.reach))
    }
}

fn cell_of(point: DVec2, cell: f64) -> [i64; 2] {
    (point / cell).floor().as_i64vec2().to_array()
}

fn distance(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let way = b - a;
    let along = if way == DVec2::ZERO { 0.0 } else { ((point - a).dot(way) / way.length_squared()).clamp(0.0, 1.0) };
    point.distance(a + along * way)
}
