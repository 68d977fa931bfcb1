//! Islands of a skin: triangles that are joined on the surface and on the skin alike, and pieces: islands that share texels
//! and move together.

use std::collections::HashMap;

use glam::DVec2;

use super::Skin;
use super::discontinuity::{NO_TURN, SharedEdge, crossings};

/// Islands and pieces, each numbered as it is first met.
#[derive(Clone, Debug)]
pub(super) struct Islands {
    pub count: usize,
    /// The piece of each triangle.
    pub piece_of_triangle: Vec<usize>,
    pub pieces: usize,
}

/// Sets of numbers, joined one by one.
struct Sets(Vec<usize>);

impl Sets {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut number: usize) -> usize {
        while self.0[number] != number {
            self.0[number] = self.0[self.0[number]];
            number = self.0[number];
        }
        number
    }

    /// The lower root stays.
    fn join(&mut self, one: usize, other: usize) {
        let [one, other] = [self.root(one), self.root(other)];
        self.0[one.max(other)] = one.min(other);
    }

    /// The set of each number, counted from 0 in the order of their first members, and their count.
    fn numbered(mut self) -> (Vec<usize>, usize) {
        let mut names = vec![usize::MAX; self.0.len()];
        let mut count = 0;
        let of = (0..self.0.len()).map(|number| {
            let root = self.root(number);
            if names[root] == usize::MAX {
                names[root] = count;
                count += 1;
            }
            names[root]
        });
        (of.collect(), count)
    }
}

/// A place on the skin, exactly.
type Key = [u64; 2];

fn key(texel: DVec2) -> Key {
    // Adding zero makes 0 of -0.
    texel.to_array().map(|value| (value + 0.0).to_bits())
}

/// Cuts a skin. Two triangles at an edge are in one island if both ends lie at the same place of the skin, the triangles on
/// both sides of it, neither or both are mirrored, and their t axes differ by at most `cut_degrees`.
///
/// Islands share texels, and are one piece, if triangles of theirs lie on the same side of a common edge on the skin; with
/// `unmirror` not if one island is mirrored and the other is not.
pub(super) fn cut(skin: &Skin, edges: &[SharedEdge], cut_degrees: f64, unmirror: bool) -> Islands {
    let mut sets = Sets::new(skin.triangles.len());
    let sharp: std::collections::HashSet<[usize; 2]> = match cut_degrees < 180.0 {
        false => Default::default(),
        true => {
            let (crossings, _) = crossings(skin, edges);
            let is_sharp = |degrees: f64| degrees > cut_degrees;
            let sharp = crossings.iter().filter(|crossing| is_sharp(crossing.degrees([NO_TURN; 2])));
            sharp.map(|crossing| crossing.triangles).collect()
        }
    };
    for edge in edges {
        if is_joined(skin, edge) && !sharp.contains(&edge.triangles) {
            sets.join(edge.triangles[0], edge.triangles[1]);
        }
    }
    let (of_triangle, count) = sets.numbered();
    let (piece_of_island, pieces) = pieces(skin, &of_triangle, count, unmirror).numbered();
    let piece_of_triangle = of_triangle.iter().map(|island| piece_of_island[*island]).collect();
    Islands { count, piece_of_triangle, pieces }
}

fn is_joined(skin: &Skin, edge: &SharedEdge) -> bool {
    let [first, second] = edge.triangles.map(|number| &skin.triangles[number]);
    let [of_first, of_second] = edge.corners;
    let meet = (0..2).all(|end| key(first.texels[of_first[end]]) == key(second.texels[of_second[end]]));
    let apart = || {
        let [a, b] = of_first.map(|corner| first.texels[corner]);
        let side = |texels: &[DVec2; 3], [from, to]: [usize; 2]| (b - a).perp_dot(texels[3 - from - to] - a);
        side(&first.texels, of_first) * side(&second.texels, of_second) <= 0.0
    };
    meet && first.sense() == second.sense() && apart()
}

/// Joins islands that share texels.
fn pieces(skin: &Skin, of_triangle: &[usize], count: usize, unmirror: bool) -> Sets {
    let mut sets = Sets::new(count);
    // For each edge on the skin, side of it and sense that must agree: an island.
    let mut known: HashMap<([Key; 2], i8, bool), usize> = HashMap::new();
    for (triangle, island) in skin.triangles.iter().zip(of_triangle) {
        let sense = triangle.sense();
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [from, to].map(|corner| key(triangle.texels[corner]));
            let (ends, is_turned) = if a <= b { ([a, b], false) } else { ([b, a], true) };
            let side = if is_turned { -sense } else { sense };
            let is_mirrored = unmirror && sense < 0;
            // A triangle without an area lies on both sides.
            let sides: &[i8] = if sense == 0 { &[-1, 1] } else { &[side] };
            for side in sides {
                let other = *known.entry((ends, *side, is_mirrored)).or_insert(*island);
                sets.join(*island, other);
            }
        }
    }
    sets
}
