//! Shadow edges in a picture: between neighbouring pixels that see one surface and differ; and how far one set of edges
//! lies from another, in pixels.

use crate::truth::{Hit, Pixel, Truth};

/// Two neighbouring pixels of the truth, by index, `first` before `second` in rows; and their common edge's middle in
/// half pixels: pixel (x, y) has its centre at (2x + 1, 2y + 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pair {
    pub first: usize,
    pub second: usize,
    pub middle: [usize; 2],
}

/// Distances in pixels from each of a set of edges to the nearest of another set.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct EdgeDistance {
    /// Edges measured: sides of pixels.
    pub edges: usize,
    /// Mean distance.
    pub mean_pixels: f64,
    /// 95 % of the edges are not farther away.
    pub p95_pixels: f64,
    /// Greatest distance.
    pub max_pixels: f64,
}

/// Neighbouring pixels that see one surface inside the light's shape: their points are no farther apart than a pixel's step
/// on either surface. Across a silhouette a change of light is no shadow's edge.
pub(super) fn connected_pairs(truth: &Truth) -> Vec<Pair> {
    pairs_that(truth, is_connected)
}

/// Neighbouring pixels that see different surfaces, or of which one sees none.
pub(super) fn silhouette_pairs(truth: &Truth) -> Vec<Pair> {
    pairs_that(truth, |a, b| match (a.hit, b.hit) {
        (Some(a), Some(b)) => !is_near(&a, &b),
        (a, b) => a.is_some() != b.is_some(),
    })
}

fn pairs_that(truth: &Truth, is_wanted: impl Fn(&Pixel, &Pixel) -> bool) -> Vec<Pair> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let mut pairs = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let first = y * width + x;
            let (right, below) = ([2 * x + 2, 2 * y + 1], [2 * x + 1, 2 * y + 2]);
            for (second, middle, exists) in [(first + 1, right, x + 1 < width), (first + width, below, y + 1 < height)]
            {
                if exists && is_wanted(&truth.pixels[first], &truth.pixels[second]) {
                    pairs.push(Pair { first, second, middle });
                }
            }
        }
    }
    pairs
}

fn is_connected(a: &Pixel, b: &Pixel) -> bool {
    let in_light = a.lit_at_center.is_some() && b.lit_at_center.is_some();
    in_light && a.hit.zip(b.hit).is_some_and(|(a, b)| is_near(&a, &b))
}

pub(super) fn is_near(a: &Hit, b: &Hit) -> bool {
    a.position.distance(b.position) <= a.pixel_size + b.pixel_size
}

impl Pair {
    /// Tests whether a true shadow edge lies between the two.
    pub(super) fn changes_light(&self, truth: &Truth) -> bool {
        let [a, b] = [self.first, self.second].map(|index| truth.pixels[index].lit_at_center);
        a.is_some() && b.is_some() && a != b
    }
}

/// Distance in pixels from each pixel's centre to the nearest of `to`, row by row; infinite where there is none.
pub(super) fn distances_of_pixels(size: [u32; 2], to: &[Pair]) -> Vec<f32> {
    let columns = 2 * size[0] as usize + 1;
    let squares = squares_to(size, to);
    let at = |x: usize, y: usize| 0.5 * squares[(2 * y + 1) * columns + 2 * x + 1].sqrt();
    (0..size[1] as usize).flat_map(|y| (0..size[0] as usize).map(move |x| [x, y])).map(|[x, y]| at(x, y)).collect()
}

/// Squared distances in half pixels to the nearest of `to`, at every half pixel; infinite where there is none.
fn squares_to(size: [u32; 2], to: &[Pair]) -> Vec<f32> {
    let (columns, rows) = (2 * size[0] as usize + 1, 2 * size[1] as usize + 1);
    let mut squares = vec![f32::INFINITY; columns * rows];
    for pair in to {
        squares[pair.middle[1] * columns + pair.middle[0]] = 0.0;
    }
    spread_squares(&mut squares, columns, rows);
    squares
}

/// Distances to the nearest of a set of edges, at every half pixel; `None` where the set is empty.
pub(super) struct DistanceField {
    columns: usize,
    /// In half pixels, squared.
    squares: Vec<f32>,
}

impl DistanceField {
    /// The field of edges in a picture of `size` pixels.
    pub fn new(size: [u32; 2], to: &[Pair]) -> Option<Self> {
        (!to.is_empty()).then(|| Self { columns: 2 * size[0] as usize + 1, squares: squares_to(size, to) })
    }

    /// Distances from each of `from`; `None` where that is empty.
    pub fn of(&self, from: &[Pair]) -> Option<EdgeDistance> {
        if from.is_empty() {
            return None;
        }
        let halves = from.iter().map(|pair| self.squares[pair.middle[1] * self.columns + pair.middle[0]]);
        let mut pixels: Vec<f64> = halves.map(|square| 0.5 * f64::from(square).sqrt()).collect();
        pixels.sort_by(f64::total_cmp);
        let rank = (0.95 * pixels.len() as f64).ceil() as usize;
        Some(EdgeDistance {
            edges: pixels.len(),
            mean_pixels: pixels.iter().sum::<f64>() / pixels.len() as f64,
            p95_pixels: pixels[rank.clamp(1, pixels.len()) - 1],
            max_pixels: pixels[pixels.len() - 1],
        })
    }
}

/// Turns 0 at marks and infinity elsewhere into squared distances to the nearest mark, exactly: a lower envelope of
/// parabolas along columns, then along rows (Felzenszwalb and Huttenlocher, Theory of Computing 2012).
fn spread_squares(squares: &mut [f32], columns: usize, rows: usize) {
    let mut line = Vec::new();
    let mut envelope = Envelope::default();
    for x in 0..columns {
        line.clear();
        line.extend((0..rows).map(|y| squares[y * columns + x]));
        envelope.apply(&mut line);
        for (y, &value) in line.iter().enumerate() {
            squares[y * columns + x] = value;
        }
    }
    for row in squares.chunks_exact_mut(columns) {
        envelope.apply(row);
    }
}

/// The parabolas that are lowest somewhere: where each stands, how high, and from where on it is the lowest.
#[derive(Default)]
struct Envelope {
    parabolas: Vec<(f64, f64, f64)>,
}

impl Envelope {
    fn apply(&mut self, line: &mut [f32]) {
        self.parabolas.clear();
        for (at, &height) in line.iter().enumerate().filter(|(_, height)| height.is_finite()) {
            self.add(at as f64, f64::from(height));
        }
        if self.parabolas.is_empty() {
            return;
        }
        let mut k = 0;
        for (at, value) in line.iter_mut().enumerate() {
            let at = at as f64;
            while self.parabolas.get(k + 1).is_some_and(|next| next.2 <= at) {
                k += 1;
            }
            let (center, height, _) = self.parabolas[k];
            *value = ((at - center) * (at - center) + height) as f32;
        }
    }

    fn add(&mut self, at: f64, height: f64) {
        let mut from = f64::NEG_INFINITY;
        while let Some(&(center, other, lowest_from)) = self.parabolas.last() {
            from = ((height + at * at) - (other + center * center)) / (2.0 * (at - center));
            if from > lowest_from {
                break;
            }
            self.parabolas.pop();
            from = f64::NEG_INFINITY;
        }
        self.parabolas.push((at, height, from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_equal_brute_force() {
        let (columns, rows) = (23, 17);
        let marks = [(3, 4), (20, 1), (11, 16), (12, 16), (0, 0)];
        let mut squares = vec![f32::INFINITY; columns * rows];
        for (x, y) in marks {
            squares[y * columns + x] = 0.0;
        }
        spread_squares(&mut squares, columns, rows);
        for y in 0..rows {
            for x in 0..columns {
                let nearest = marks.iter().map(|&(u, v)| x.abs_diff(u).pow(2) + y.abs_diff(v).pow(2)).min();
                assert_eq!(Some(squares[y * columns + x] as usize), nearest, "({x}, {y})");
            }
        }
    }
}
