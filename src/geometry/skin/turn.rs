//! Angles by which the pieces of a skin are turned, so that t axes agree across the edges between them.
//!
//! The sum over edges of length times angle is lessened piece by piece, each turned by the angle that is best while the
//! others stay. That ends in a local minimum. The search runs three times and the lowest sum is taken: it begins with
//! the skin as it is, with t axes that point upwards, and with pieces turned one after the other, each to agree with
//! those before it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::Skin;
use super::discontinuity::{EdgeAxes, NO_TURN, Turn, degrees_between};
use super::islands::Islands;

/// Most rounds over all pieces. A round without a change ends the search.
const ROUNDS: usize = 40;
/// Angles that are tried of a piece at first, over the full circle.
const COARSE: usize = 48;
/// Steps of the golden section search between two of them: down to 1e-7 degrees.
const FINE: usize = 40;
/// Fall of the mean angle at a piece's edges for which it is turned again.
const LEAST_GAIN_DEGREES: f64 = 1e-6;
/// Mean angle in degrees by which a quarter turn may be worse than the best angle and still be taken: it keeps texels whole.
const SPARE_DEGREES: f64 = 0.05;
/// Share of a piece's area that must point one way for the piece to have an upward direction.
const LEAST_DIRECTION: f64 = 0.1;

/// A turn counter-clockwise. Quarter turns are exact.
pub(super) fn turn(radians: f64) -> Turn {
    let quarters = radians / FRAC_PI_2;
    match (quarters - quarters.round()).abs() < 1e-12 {
        true => match quarters.round().rem_euclid(4.0) as u8 {
            0 => [0.0, 1.0],
            1 => [1.0, 0.0],
            2 => [0.0, -1.0],
            _ => [-1.0, 0.0],
        },
        false => [radians.sin(), radians.cos()],
    }
}

/// Tests whether texels stay whole.
pub(super) fn is_quarter([sine, cosine]: Turn) -> bool {
    sine == 0.0 || cosine == 0.0
}

struct Search<'a> {
    crossings: &'a [EdgeAxes],
    /// For each edge, the pieces of its triangles.
    pieces: Vec<[usize; 2]>,
    /// For each piece, the edges whose angle its turn changes.
    of_piece: Vec<Vec<usize>>,
}

/// Angles of the pieces in radians, counter-clockwise with y upwards.
///
/// `skin` and the axes at its edges, `crossings`, are those after mirrored pieces have been turned over, if they are.
pub(super) fn best_turns(skin: &Skin, crossings: &[EdgeAxes], islands: &Islands) -> Vec<f64> {
    let search = Search::new(crossings, islands);
    let as_it_is = search.descend(vec![0.0; islands.pieces]);
    let mut best = (search.sum(&as_it_is), as_it_is);
    for start in [upward(skin, islands), search.grow()] {
        let angles = search.descend(start);
        let sum = search.sum(&angles);
        if sum < best.0 * (1.0 - 1e-9) {
            best = (sum, angles);
        }
    }
    best.1
}

impl<'a> Search<'a> {
    fn new(crossings: &'a [EdgeAxes], islands: &Islands) -> Self {
        let pieces: Vec<[usize; 2]> = crossings
            .iter()
            .map(|crossing| crossing.triangles.map(|triangle| islands.piece_of_triangle[triangle]))
            .collect();
        let mut of_piece = vec![Vec::new(); islands.pieces];
        for (index, [one, other]) in pieces.iter().enumerate() {
            // Within a piece only mirrored neighbours turn against each other.
            if one != other || crossings[index].is_mirrored() {
                of_piece[*one].push(index);
                if one != other {
                    of_piece[*other].push(index);
                }
            }
        }
        Self { crossings, pieces, of_piece }
    }

    /// The sum that is lessened.
    fn sum(&self, angles: &[f64]) -> f64 {
        let turns: Vec<Turn> = angles.iter().map(|angle| turn(*angle)).collect();
        let value = |(crossing, pieces): (&EdgeAxes, &[usize; 2])| {
            crossing.length * crossing.degrees(pieces.map(|piece| turns[piece]))
        };
        self.crossings.iter().zip(&self.pieces).map(value).sum()
    }

    fn descend(&self, mut angles: Vec<f64>) -> Vec<f64> {
        let mut turns: Vec<Turn> = angles.iter().map(|angle| turn(*angle)).collect();
        // Pieces of which a neighbour has turned since they were looked at.
        let mut is_due = vec![true; angles.len()];
        for _ in 0..ROUNDS {
            let mut is_changed = false;
            for piece in 0..angles.len() {
                if !std::mem::replace(&mut is_due[piece], false) {
                    continue;
                }
                let among = &self.of_piece[piece];
                let cost = Cost::new(self, piece, &turns, among);
                let (angle, after) = cost.best_angle();
                if after < cost.at(angles[piece]) - LEAST_GAIN_DEGREES * cost.length {
                    (angles[piece], turns[piece], is_changed) = (angle, turn(angle), true);
                    among.iter().flat_map(|index| self.pieces[*index]).for_each(|other| is_due[other] = true);
                    is_due[piece] = false;
                }
            }
            if !is_changed {
                break;
            }
        }
        angles
    }

    /// Turns pieces one after the other, each to agree with its neighbours among those before it. The next is always the one
    /// that shares the greatest length of edges with them.
    fn grow(&self) -> Vec<f64> {
        let mut angles = vec![0.0; self.of_piece.len()];
        let mut turns = vec![NO_TURN; angles.len()];
        let mut is_done = vec![false; angles.len()];
        let mut shared = vec![0.0; angles.len()];
        // Lengths that have grown since are entered again; the bits of positive numbers are in their order.
        let mut next: BinaryHeap<(u64, Reverse<usize>)> = (0..angles.len()).map(|piece| (0, Reverse(piece))).collect();
        while let Some((_, Reverse(piece))) = next.pop() {
            if std::mem::replace(&mut is_done[piece], true) {
                continue;
            }
            let other = |index: usize| self.pieces[index].into_iter().find(|other| *other != piece).unwrap_or(piece);
            let before: Vec<usize> =
                self.of_piece[piece].iter().copied().filter(|index| is_done[other(*index)]).collect();
            angles[piece] = Cost::new(self, piece, &turns, &before).best_angle().0;
            turns[piece] = turn(angles[piece]);
            for index in &self.of_piece[piece] {
                let other = other(*index);
                if !is_done[other] {
                    shared[other] += self.crossings[*index].length;
                    next.push((f64::to_bits(shared[other]), Reverse(other)));
                }
            }
        }
        angles
    }
}

/// Edges of a piece, whose angles depend on its turn while the other pieces stay.
struct Cost<'a> {
    edges: Vec<CostEdge<'a>>,
    /// Length of all of them.
    length: f64,
}

struct CostEdge<'a> {
    crossing: &'a EdgeAxes,
    /// The side that is the piece's.
    side: usize,
    /// Directions on the other side; `None`: it is the same piece.
    other: Option<[f64; 2]>,
}

impl<'a> Cost<'a> {
    /// `among`: the edges of the piece that count.
    fn new(search: &Search<'a>, piece: usize, turns: &[Turn], among: &[usize]) -> Self {
        let edges: Vec<CostEdge> = among
            .iter()
            .map(|index| {
                let (crossing, pieces) = (&search.crossings[*index], search.pieces[*index]);
                let side = usize::from(pieces[0] != piece);
                let is_other = pieces[1 - side] != piece;
                let other = is_other.then(|| crossing.t_axes(1 - side, turns[pieces[1 - side]]));
                CostEdge { crossing, side, other }
            })
            .collect();
        let length = edges.iter().map(|edge| edge.crossing.length).sum();
        Self { edges, length }
    }

    /// The sum of length times degrees at an angle of the piece in radians.
    fn at(&self, angle: f64) -> f64 {
        let own = turn(angle);
        let value = |edge: &CostEdge| {
            let other = edge.other.unwrap_or_else(|| edge.crossing.t_axes(1 - edge.side, own));
            edge.crossing.length * degrees_between(edge.crossing.t_axes(edge.side, own), other)
        };
        self.edges.iter().map(value).sum()
    }

    /// The best angle, and its cost.
    fn best_angle(&self) -> (f64, f64) {
        let cost = |angle: f64| self.at(angle);
        let step = TAU / COARSE as f64;
        let coarse = least((0..COARSE).map(|index| index as f64 * step), cost);
        let fine = golden([coarse.0 - step, coarse.0 + step], cost);
        let best = if fine.1 < coarse.1 { fine } else { coarse };
        let quarter = least((0..4).map(|index| f64::from(index) * FRAC_PI_2), cost);
        if quarter.1 <= best.1 + SPARE_DEGREES * self.length { quarter } else { best }
    }
}

/// The first of the angles of least cost.
fn least(angles: impl Iterator<Item = f64>, cost: impl Fn(f64) -> f64) -> (f64, f64) {
    angles.fold((0.0, f64::INFINITY), |best, angle| {
        let found = cost(angle);
        if found < best.1 { (angle, found) } else { best }
    })
}

/// Golden section search for a minimum between two angles.
fn golden([mut low, mut high]: [f64; 2], cost: impl Fn(f64) -> f64) -> (f64, f64) {
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let inner = |low: f64, high: f64| [high - share * (high - low), low + share * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    for _ in 0..FINE {
        if at_a <= at_b {
            (high, b, at_b) = (b, a, at_a);
            a = inner(low, high)[0];
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = inner(low, high)[1];
            at_b = cost(b);
        }
    }
    if at_a <= at_b { (a, at_a) } else { (b, at_b) }
}

/// Angles that turn the t axes upwards, y in model space, in the mean over a piece's triangles; zero where they have no
/// common direction.
fn upward(skin: &Skin, islands: &Islands) -> Vec<f64> {
    let mut sums = vec![[0.0; 3]; islands.pieces];
    for (triangle, piece) in skin.triangles.iter().zip(&islands.piece_of_triangle) {
        let Some(derivatives) = triangle.derivatives() else { continue };
        let area = triangle.surface();
        let size = (derivatives.by_s.length() * derivatives.by_t.length()).sqrt();
        let [by_s, by_t] = [derivatives.by_s, derivatives.by_t].map(|vector| area * DVec3::Y.dot(vector) / size);
        let sum = &mut sums[*piece];
        *sum = [sum[0] + by_s, sum[1] + by_t, sum[2] + area];
    }
    let angle = |[by_s, by_t, area]: [f64; 3]| match by_s.hypot(by_t) > LEAST_DIRECTION * area {
        true => by_s.atan2(by_t),
        false => 0.0,
    };
    sums.into_iter().map(angle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for quarters in -9..=9 {
            let radians = f64::from(quarters) * FRAC_PI_2;
            let [sine, cosine] = turn(radians);
            assert!(is_quarter([sine, cosine]) && sine.abs() + cosine.abs() == 1.0);
            assert!((sine - radians.sin()).abs() < 1e-9 && (cosine - radians.cos()).abs() < 1e-9);
        }
        assert!(!is_quarter(turn(0.001)) && !is_quarter(turn(FRAC_PI_2 - 0.001)));
    }

    #[test]
    fn golden_section_search_ends_at_a_kink() {
        for kink in [-0.03, 0.0, 0.001, 0.05] {
            let (angle, cost) = golden([-0.1, 0.1], |angle| (angle - kink).abs());
            assert!((angle - kink).abs() < 1e-8 && cost < 1e-8);
        }
    }
}
