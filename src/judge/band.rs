//! Pixels near a true shadow edge, in texels of a shadow map of all the light.
//!
//! Distances are taken in the map's plane, not in the picture: a pixel is in the band when its point projects to within k
//! texels of where an edge projects. That is where a map of that size can be wrong by its texels alone, however the camera
//! foreshortens it and however far the receiver lies behind the caster. An edge is known between two pixels only, so that
//! the whole stretch between their points counts: both belong to the band at any k.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3};

use super::edges::Pair;
use crate::truth::Truth;

/// Width of the band along a true shadow edge, in texels of a map that holds all of the light.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Band {
    /// k, not below 0. Pixels next to the edge belong to the band at any k.
    pub texels: f64,
    /// Size of a map of the whole light: a spotlight's frustum, each face of a point light's cube, the square around all
    /// the scene across a directional light's rays (see [`crate::truth::Hit::in_map`]); for a map that covers less, the
    /// size that a map of the whole would have.
    pub map_size: [u32; 2],
}

/// The pixels of `truth` within `band` of its shadow `edges`.
pub(super) fn find_band(truth: &Truth, edges: &[Pair], band: &Band) -> Vec<bool> {
    let [width, height] = band.map_size.map(f64::from);
    // Only cube maps, whose faces are square, have a third coordinate.
    let size = DVec3::new(width, height, width);
    let texel = |index: usize| truth.pixels[index].hit.map_or(DVec3::INFINITY, |hit| 0.5 * hit.in_map * size);
    let stretches: Vec<[DVec3; 2]> = edges.iter().map(|edge| [texel(edge.first), texel(edge.second)]).collect();
    let near = Cells::new(stretches, band.texels);
    let mut in_band: Vec<bool> = (0..truth.pixels.len()).map(|index| near.holds(texel(index))).collect();
    for edge in edges {
        (in_band[edge.first], in_band[edge.second]) = (true, true);
    }
    in_band
}

/// Stretches, by the square cells within their reach.
struct Cells {
    stretches: Vec<[DVec3; 2]>,
    reach: f64,
    cell: f64,
    lists: HashMap<I64Vec3, Vec<usize>>,
}

impl Cells {
    fn new(mut stretches: Vec<[DVec3; 2]>, reach: f64) -> Self {
        stretches.retain(|[a, b]| a.is_finite() && b.is_finite());
        let length: f64 = stretches.iter().map(|[a, b]| a.distance(*b)).sum();
        let cell = (length / stretches.len().max(1) as f64).max(reach).max(1e-3);
        let mut cells = Self { stretches, reach, cell, lists: HashMap::new() };
        for (index, [a, b]) in cells.stretches.iter().enumerate() {
            let [low, high] = [a.min(*b) - reach, a.max(*b) + reach].map(|corner| cell_of(corner, cell));
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    for x in low.x..=high.x {
                        cells.lists.entry(I64Vec3::new(x, y, z)).or_default().push(index);
                    }
                }
            }
        }
        cells
    }

    fn holds(&self, point: DVec3) -> bool {
        let list = self.lists.get(&cell_of(point, self.cell));
        list.is_some_and(|list| list.iter().any(|&index| distance(point, self.stretches[index]) <= self.reach))
    }
}

fn cell_of(point: DVec3, cell: f64) -> I64Vec3 {
    (point / cell).floor().as_i64vec3()
}

fn distance(point: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let way = b - a;
    let along = if way == DVec3::ZERO { 0.0 } else { ((point - a).dot(way) / way.length_squared()).clamp(0.0, 1.0) };
    point.distance(a + along * way)
}
