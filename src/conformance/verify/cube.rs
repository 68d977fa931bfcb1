//! Cube maps in f64: the face of a direction, the place on it, and a filter within a face or across its edges [GL 4.6,
//! 8.13, 8.14].

use super::Grade;

/// Relative difference of two coordinates within which either may be the major axis.
const NEAR_EDGE: f64 = 1e-6;

/// Faces that may be selected, by the coordinate of the greatest magnitude: several near an edge of the cube. In GL's order:
/// +x, -x, +y, -y, +z, -z.
pub fn faces(direction: [f64; 3]) -> impl Iterator<Item = usize> {
    let most = direction.into_iter().map(f64::abs).fold(0.0, f64::max);
    (0..6).filter(move |face| {
        let along = direction[face / 2] * if face % 2 == 0 { 1.0 } else { -1.0 };
        along >= most * (1.0 - NEAR_EDGE)
    })
}

/// s and t, in [0, 1] inside of the face [GL 4.6, table 8.19].
pub fn on_face(face: usize, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let (s, t, major) = match face {
        0 => (-z, -y, x),
        1 => (z, -y, x),
        2 => (x, z, y),
        3 => (x, -z, y),
        4 => (x, -y, z),
        _ => (-x, -y, z),
    };
    [s, t].map(|coordinate| 0.5 * (coordinate / major.abs() + 1.0))
}

/// A direction that meets a face at s and t; its greatest coordinate is 1.
pub fn direction(face: usize, place: [f64; 2]) -> [f64; 3] {
    let [s, t] = place.map(|coordinate| 2.0 * coordinate - 1.0);
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

/// Slack of a texel's position, in texels, and of a filtered value, in codes: strictly, and at most.
const POSITION: [f64; 2] = [1.0 / 128.0, 1.0 / 16.0];
const VALUE: [f64; 2] = [1.0 + 1e-3, 2.0 + 1e-3];

/// The texels of a cube map.
#[derive(Clone, Copy)]
pub struct Cube<'a> {
    /// Texels a side.
    pub side: u32,
    /// Six faces in GL's order, rows from t = 0.
    pub faces: &'a [Vec<[u8; 4]>; 6],
    /// True if filters reach across edges.
    pub seamless: bool,
}

impl Cube<'_> {
    /// Grade of a colour, in codes, that NEAREST found: near a texel's edge either neighbour may be meant.
    pub fn nearest(&self, color: [f64; 4], direction: [f64; 3]) -> Grade {
        let side = f64::from(self.side);
        let found = faces(direction).any(|face| {
            let place = on_face(face, direction).map(|coordinate| coordinate * side);
            let near = |at: f64| [at - POSITION[0], at + POSITION[0]].map(|at| at.floor() as i64);
            let [columns, rows] = place.map(near);
            let texels = rows.into_iter().flat_map(|row| columns.map(|column| self.inside(face, [column, row])));
            texels.into_iter().any(|texel| (0..4).all(|channel| (texel[channel] - color[channel]).abs() < 0.01))
        });
        if found { Grade::Good } else { Grade::Wrong }
    }

    /// Grade of a colour, in codes, that LINEAR found, and its distance from the range that is allowed strictly: weights
    /// good to 1/128 texel and a code, else to 1/16 and 2.
    pub fn linear(&self, color: [f64; 4], direction: [f64; 3]) -> (Grade, f64) {
        let by_face = faces(direction).map(|face| {
            let outside = [0, 1].map(|tier| self.distance(color, face, direction, tier));
            let grade = match () {
                () if outside[0] <= VALUE[0] => Grade::Good,
                () if outside[1] <= VALUE[1] => Grade::Allowed,
                () => Grade::Wrong,
            };
            (grade, outside[0])
        });
        by_face.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).unwrap_or((Grade::Wrong, f64::NAN))
    }

    /// Grade of a comparison that LINEAR found in faces of comparisons: channels are 255 where one passes, else 0.
    pub fn compared(&self, value: f64, direction: [f64; 3]) -> Grade {
        let by_face = faces(direction).map(|face| {
            let places = on_face(face, direction).map(|coordinate| coordinate * f64::from(self.side) - 0.5);
            let (low, weights) = (places.map(|place| place.floor() as i64), places.map(|place| place - place.floor()));
            let texel = |x: i64, y: i64| self.texel(face, [low[0] + x, low[1] + y]).map(|texel| texel[0] / 255.0);
            let texels = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
            let there: Vec<f64> = texels.into_iter().flatten().collect();
            let with = |fourth: f64| super::filtered_of(value, texels.map(|texel| texel.unwrap_or(fourth)), weights);
            let strict = with(there.iter().sum::<f64>() / there.len() as f64);
            match there.len() {
                4 => strict,
                // Any of the three may stand for the fourth.
                _ => there.iter().map(|fourth| with(*fourth).max(Grade::Allowed)).fold(strict, Grade::min),
            }
        });
        by_face.min().unwrap_or(Grade::Wrong)
    }

    /// Distance of a colour from the ranges of a tier.
    fn distance(&self, color: [f64; 4], face: usize, direction: [f64; 3], tier: usize) -> f64 {
        let places = on_face(face, direction).map(|coordinate| coordinate * f64::from(self.side) - 0.5);
        let [columns, rows] = places.map(|place| positions(place, POSITION[tier]));
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
        for (column, row) in rows.into_iter().flat_map(|row| columns.map(|column| (column, row))) {
            for color in self.filtered(face, [column, row], tier) {
                for (range, value) in ranges.iter_mut().zip(color) {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        let outside = |[low, high]: [f64; 2], value: f64| (low - value).max(value - high).max(0.0);
        ranges.into_iter().zip(color).map(|(range, value)| outside(range, value)).fold(0.0, f64::max)
    }

    /// The mean of four texels by their weights at a place in texels. A corner of the cube has three texels: strictly the
    /// fourth is their mean; at most it is any of them.
    fn filtered(&self, face: usize, place: [f64; 2], tier: usize) -> Vec<[f64; 4]> {
        let low = place.map(|place| place.floor() as i64);
        let [alpha, beta] = [0, 1].map(|axis| place[axis] - place[axis].floor());
        let texels = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| self.texel(face, [low[0] + x, low[1] + y]));
        let there: Vec<_> = texels.into_iter().flatten().collect();
        let mean = [0, 1, 2, 3].map(|channel| there.iter().map(|texel| texel[channel]).sum::<f64>() / 3.0);
        let fourths = match (there.len(), tier) {
            (4, _) | (_, 0) => vec![mean],
            _ => there.into_iter().chain([mean]).collect(),
        };
        let with = |fourth: [f64; 4]| {
            let channel = |channel: usize| texels.map(|texel| texel.unwrap_or(fourth)[channel]);
            [0, 1, 2, 3].map(|index| super::bilinear(channel(index), alpha, beta))
        };
        fourths.into_iter().map(with).collect()
    }

    /// A texel of a face, or beyond one of its edges; `None` beyond two.
    fn texel(&self, face: usize, [column, row]: [i64; 2]) -> Option<[f64; 4]> {
        let side = i64::from(self.side);
        let beyond = [column, row].map(|index| !(0..side).contains(&index));
        match beyond {
            [true, true] if self.seamless => None,
            [true, _] | [_, true] if self.seamless => Some(self.across(face, [column, row])),
            _ => Some(self.inside(face, [column, row])),
        }
    }

    /// The texel of a face, clamped to its edge.
    fn inside(&self, face: usize, texel: [i64; 2]) -> [f64; 4] {
        let [column, row] = texel.map(|index| index.clamp(0, i64::from(self.side) - 1) as usize);
        self.faces[face][row * self.side as usize + column].map(f64::from)
    }

    /// The texel on the other side of an edge: as far from it as the middle of the one that is asked for, which the cube's
    /// edge folds inwards.
    fn across(&self, face: usize, texel: [i64; 2]) -> [f64; 4] {
        let side = f64::from(self.side);
        let middle = texel.map(|index| (index as f64 + 0.5) / side);
        let mut folded = direction(face, middle.map(|coordinate| coordinate.clamp(0.0, 1.0)));
        let beyond = middle.map(|coordinate| (coordinate - 0.5).abs() - 0.5).into_iter().fold(0.0, f64::max);
        folded[face / 2] *= 1.0 - 2.0 * beyond;
        let Some(other) = faces(folded).next() else { return [f64::NAN; 4] };
        self.inside(other, on_face(other, folded).map(|coordinate| (coordinate * side).floor() as i64))
    }
}

/// Places at which a filter that is off by at most `slack` is least and greatest: the ends, and a texel's middle between.
fn positions(place: f64, slack: f64) -> [f64; 3] {
    [place - slack, place.round().clamp(place - slack, place + slack), place + slack]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_faces(side: u32) -> [Vec<[u8; 4]>; 6] {
        let mut random = fastrand::Rng::with_seed(8);
        [(); 6].map(|()| (0..side * side).map(|_| [(); 4].map(|()| random.u8(..))).collect())
    }

    #[test]
    fn places_and_directions_are_inverse() {
        let mut random = fastrand::Rng::with_seed(6);
        for face in 0..6 {
            for _ in 0..100 {
                let place = [random.f64(), random.f64()];
                let there = direction(face, place).map(|coordinate| 0.37 * coordinate);
                assert_eq!(faces(there).collect::<Vec<_>>(), [face]);
                let back = on_face(face, there);
                assert!((0..2).all(|axis| (back[axis] - place[axis]).abs() < 1e-12), "{face} {place:?} {back:?}");
            }
        }
        assert_eq!(faces([1.0, -1.0, 0.5]).collect::<Vec<_>>(), [0, 3]);
        assert_eq!(faces([-1.0; 3]).collect::<Vec<_>>(), [1, 3, 5]);
    }

    /// The neighbours of +x: its left edge is +z's right one, its right one is -z's left one, and above it lies +y's right
    /// column, read downwards.
    #[test]
    fn neighbours_across_edges() {
        const SIDE: u32 = 4;
        let faces = random_faces(SIDE);
        let cube = Cube { side: SIDE, faces: &faces, seamless: true };
        let stored = |face: usize, column: usize, row: usize| faces[face][row * 4 + column].map(f64::from);
        for index in 0..4 {
            let at = index as i64;
            assert_eq!(cube.texel(0, [-1, at]), Some(stored(4, 3, index)));
            assert_eq!(cube.texel(0, [4, at]), Some(stored(5, 0, index)));
            assert_eq!(cube.texel(0, [at, -1]), Some(stored(2, 3, 3 - index)));
            assert_eq!(cube.texel(0, [at, 4]), Some(stored(3, 3, index)));
            assert_eq!(cube.texel(4, [at, -1]), Some(stored(2, index, 3)));
        }
        assert_eq!(cube.texel(0, [-1, -1]), None);
        let clamped = Cube { seamless: false, ..cube };
        assert_eq!(clamped.texel(0, [-1, -1]), Some(stored(0, 0, 0)));
        assert_eq!(clamped.texel(0, [-1, 2]), Some(stored(0, 0, 2)));
    }

    /// At a corner of the cube: the mean of the three texels; any of them is allowed.
    #[test]
    fn corners() {
        let faces = random_faces(4);
        let seamless = Cube { side: 4, faces: &faces, seamless: true };
        let texels = [faces[0][0], faces[4][3], faces[2][15]].map(|texel| texel.map(f64::from));
        let mean = [0, 1, 2, 3].map(|channel| texels.iter().map(|texel| texel[channel]).sum::<f64>() / 3.0);
        assert_eq!(seamless.linear(mean, [1.0; 3]).0, Grade::Good);
        let clamped = Cube { seamless: false, ..seamless };
        for texel in texels {
            assert_eq!(clamped.linear(texel, [1.0; 3]).0, Grade::Good);
            assert_eq!(seamless.linear(texel, [1.0; 3]).0, Grade::Wrong);
        }
        let [weights, other] = [[0.5, 0.25, 0.25], [0.25, 0.25, 0.5]].map(|weights: [f64; 3]| {
            [0, 1, 2, 3].map(|channel| (0..3).map(|index| weights[index] * texels[index][channel]).sum::<f64>())
        });
        assert_eq!(seamless.linear(weights, [1.0; 3]).0, Grade::Allowed);
        assert_eq!(seamless.linear(other, [1.0; 3]).0, Grade::Allowed);
        assert_eq!(clamped.linear(mean, [1.0; 3]).0, Grade::Wrong);
    }

    #[test]
    fn tiers_of_a_filter() {
        let faces = [(); 6].map(|()| vec![[0; 4], [255; 4], [0; 4], [255; 4]]);
        let cube = Cube { side: 2, faces: &faces, seamless: false };
        // A quarter of the way from the left texel's middle to the right one's.
        let at = direction(4, [0.375, 0.5]);
        let strict = 63.75 + 255.0 / 128.0 + 1.0;
        let most = 63.75 + 255.0 / 16.0 + 2.0;
        let cases = [
            (63.75, Grade::Good),
            (strict - 0.01, Grade::Good),
            (strict + 0.01, Grade::Allowed),
            (most - 0.01, Grade::Allowed),
            (most + 0.01, Grade::Wrong),
        ];
        for (value, grade) in cases {
            assert_eq!(cube.linear([value; 4], at).0, grade, "{value}");
        }
        assert_eq!(cube.nearest([0.0; 4], at), Grade::Good);
        assert_eq!(cube.nearest([255.0; 4], at), Grade::Wrong);
        assert_eq!(cube.nearest([255.0; 4], direction(4, [0.499, 0.5])), Grade::Good);
    }
}
