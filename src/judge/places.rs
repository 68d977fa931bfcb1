//! Where a picture is wrong: regions of wrong pixels, each with its worst pixel, the point of the world that it shows, and
//! the caster whose shadow is wrong there.

use glam::DVec3;

use super::light::Judge;
use super::near::NearEdges;
use super::verdicts::{Judgement, PixelClass};

/// Wrong pixels of one kind that touch each other, corners included.
#[derive(Clone, Debug, PartialEq)]
pub struct WrongRegion {
    /// Class of the worst pixel: the one farthest from a true shadow edge, of those that nothing explains where there are any.
    pub class: PixelClass,
    /// Pixels of the region.
    pub pixels: usize,
    /// Number of these that nothing explains.
    pub beyond: usize,
    /// Least and greatest column and row.
    pub bounds: [[u32; 2]; 2],
    /// Column and row of the worst pixel.
    pub at: [u32; 2],
    /// Distance of its centre to the nearest true shadow edge of the picture, in pixels; infinite where there is none.
    pub edge_pixels: f64,
    /// The point that the pixel shows, in world space; `None`: the scene has no surface there.
    pub position: Option<DVec3>,
    /// The object that has the point; into [`crate::scene::Scene::objects`].
    pub object: Option<usize>,
    /// The object whose shadow should be there, or is where it should not be: the first before the point, as the light sees
    /// it, or the one before the nearest point in shadow.
    pub caster: Option<usize>,
}

impl Judge<'_> {
    /// Regions of wrong pixels: those with the most pixels that nothing explains first, then by size. At most `most`.
    pub fn regions(&mut self, judgement: &Judgement, most: usize) -> Vec<WrongRegion> {
        let near = NearEdges::of(self.plain_truth());
        let mut regions: Vec<Vec<usize>> = components(judgement);
        let beyond = |region: &[usize]| region.iter().filter(|index| judgement.classes[**index].is_beyond()).count();
        regions.sort_by_cached_key(|region| std::cmp::Reverse((beyond(region), region.len())));
        regions.truncate(most);
        regions.iter().map(|region| self.describe(judgement, &near, region, beyond(region))).collect()
    }

    fn describe(&self, judgement: &Judgement, near: &NearEdges, region: &[usize], beyond: usize) -> WrongRegion {
        let key = |index: &usize| (judgement.classes[*index].is_beyond(), near.to_shadow_edge(*index));
        let worse = |a: &usize, b: &usize| {
            let ((a_beyond, a), (b_beyond, b)) = (key(a), key(b));
            a_beyond.cmp(&b_beyond).then(a.total_cmp(&b))
        };
        // Of equals the first.
        let index = region.iter().copied().rev().max_by(|a, b| worse(a, b)).unwrap_or_default();
        let places = || region.iter().map(|index| self.place(*index));
        let ends = |k: usize| (places().map(|at| at[k]).min(), places().map(|at| at[k]).max());
        let (columns, rows) = (ends(0), ends(1));
        let least = [columns.0, rows.0].map(Option::unwrap_or_default);
        let greatest = [columns.1, rows.1].map(Option::unwrap_or_default);
        let class = judgement.classes[index];
        let hit = self.plain_truth().pixels[index].hit;
        let shaded = match class {
            PixelClass::FalseShadow(_) => near.dark_side_of_nearest(self.plain_truth(), index),
            _ => Some(index),
        };
        WrongRegion {
            class,
            pixels: region.len(),
            beyond,
            bounds: [least, greatest],
            at: self.place(index),
            edge_pixels: near.to_shadow_edge(index),
            position: hit.map(|hit| hit.position),
            object: hit.map(|hit| hit.object as usize),
            caster: shaded.and_then(|pixel| self.caster(pixel)),
        }
    }
}

/// Wrong pixels by what they touch: pixels of one kind whose sides or corners meet.
fn components(judgement: &Judgement) -> Vec<Vec<usize>> {
    let [width, height] = judgement.size.map(|side| side as usize);
    let kind = |index: usize| {
        let class = judgement.classes[index];
        class.is_wrong().then(|| std::mem::discriminant(&class))
    };
    let mut seen = vec![false; judgement.classes.len()];
    let mut regions = Vec::new();
    for start in 0..judgement.classes.len() {
        if seen[start] || kind(start).is_none() {
            continue;
        }
        seen[start] = true;
        let (mut region, mut next) = (vec![start], 0);
        while let Some(&index) = region.get(next) {
            next += 1;
            let (x, y) = (index % width, index / width);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let other = row * width + column;
                    if !seen[other] && kind(other) == kind(start) {
                        seen[other] = true;
                        region.push(other);
                    }
                }
            }
        }
        regions.push(region);
    }
    regions
}
