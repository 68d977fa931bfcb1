//! How far each pixel of a picture lies from the nearest true shadow edge, and from the nearest silhouette, in pixels.

use super::edges::{Pair, connected_pairs, distances_of_pixels, silhouette_pairs};
use crate::truth::Truth;

/// Greatest distance in pixels at which a silhouette explains a surface in only one of two pictures. A pixel's sample may
/// stand anywhere in it.
const SILHOUETTE_PIXELS: f32 = 1.0;

/// Distances from pixels' centres to the sides between pixels where something changes; infinite where there are none.
pub(super) struct NearEdges {
    edges: Vec<Pair>,
    to_shadow_edge: Vec<f32>,
    to_silhouette: Vec<f32>,
}

impl NearEdges {
    pub(super) fn of(truth: &Truth) -> Self {
        let size = [truth.width, truth.height];
        let pairs = connected_pairs(truth);
        let edges: Vec<Pair> = pairs.into_iter().filter(|pair| pair.changes_light(truth)).collect();
        let to_shadow_edge = distances_of_pixels(size, &edges);
        Self { edges, to_shadow_edge, to_silhouette: distances_of_pixels(size, &silhouette_pairs(truth)) }
    }

    pub(super) fn to_shadow_edge(&self, index: usize) -> f64 {
        self.to_shadow_edge.get(index).map_or(f64::INFINITY, |distance| f64::from(*distance))
    }

    /// The pixel in shadow beside the shadow edge that is nearest to a pixel.
    pub(super) fn dark_side_of_nearest(&self, truth: &Truth, index: usize) -> Option<usize> {
        let width = truth.width as usize;
        let (x, y) = (2 * (index % width) + 1, 2 * (index / width) + 1);
        let square = |pair: &&Pair| pair.middle[0].abs_diff(x).pow(2) + pair.middle[1].abs_diff(y).pow(2);
        let nearest = self.edges.iter().min_by_key(square)?;
        [nearest.first, nearest.second].into_iter().find(|side| truth.pixels[*side].lit_at_center == Some(false))
    }

    pub(super) fn is_by_silhouette(&self, index: usize) -> bool {
        self.to_silhouette.get(index).is_some_and(|distance| *distance <= SILHOUETTE_PIXELS)
    }
}
