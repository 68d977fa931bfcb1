//! Angles by which the pieces of a skin are turned, so that t axes agree across the edges between them.
//!
//! The sum over edges of length times angle is lessened piece by piece, each turned by the angle that is best while the
//! others stay. That ends in a local minimum; of two, found from the skin as it is and from t axes that point upwards, the
//! lower is taken.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::Skin;
use super::discontinuity::{Crossing, Turn};
use super::islands::Islands;

/// Most rounds over all pieces. A round without a change ends the search.
const ROUNDS: usize = 40;
/// Angles that are tried of a piece at first, over the full circle.
const COARSE: usize = 72;
/// Steps of the golden section search between two of them: down to 1e-8 degrees.
const FINE: usize = 45;
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
    crossings: &'a [Crossing],
    /// For each crossing, the pieces of its triangles.
    pieces: Vec<[usize; 2]>,
    /// For each piece, the crossings whose angle its turn changes.
    of_piece: Vec<Vec<usize>>,
}

/// Angles of the pieces in radians, counter-clockwise with y upwards.
///
/// `skin` and its `crossings` are those after mirrored pieces have been turned over, if they are.
pub(super) fn best_turns(skin: &Skin, crossings: &[Crossing], islands: &Islands) -> Vec<f64> {
    let search = Search::new(crossings, islands);
    let starts = [vec![0.0; islands.pieces], upward(skin, islands)];
    let found = starts.map(|start| search.descend(start));
    let [as_it_is, upward] = [0, 1].map(|index| search.sum(&found[index]));
    let [first, second] = found;
    if upward < as_it_is { second } else { first }
}

impl<'a> Search<'a> {
    fn new(crossings: &'a [Crossing], islands: &Islands) -> Self {
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
        let value = |(crossing, pieces): (&Crossing, &[usize; 2])| {
            crossing.length * crossing.degrees(pieces.map(|piece| turns[piece]))
        };
        self.crossings.iter().zip(&self.pieces).map(value).sum()
    }

    /// The part of the sum that the angle of one piece changes.
    fn cost(&self, piece: usize, angle: f64, turns: &[Turn]) -> f64 {
        let own = turn(angle);
        let value = |index: &usize| {
            let sides = self.pieces[*index].map(|other| if other == piece { own } else { turns[other] });
            self.crossings[*index].length * self.crossings[*index].degrees(sides)
        };
        self.of_piece[piece].iter().map(value).sum()
    }

    fn descend(&self, mut angles: Vec<f64>) -> Vec<f64> {
        let mut turns: Vec<Turn> = angles.iter().map(|angle| turn(*angle)).collect();
        for _ in 0..ROUNDS {
            let mut is_changed = false;
            for piece in 0..angles.len() {
                let before = self.cost(piece, angles[piece], &turns);
                let (angle, after) = self.best_angle(piece, &turns);
                if after < before * (1.0 - 1e-9) - 1e-12 {
                    (angles[piece], turns[piece], is_changed) = (angle, turn(angle), true);
                }
            }
            if !is_changed {
                break;
            }
        }
        angles
    }

    /// The best angle of a piece while the others stay, and its cost.
    fn best_angle(&self, piece: usize, turns: &[Turn]) -> (f64, f64) {
        let cost = |angle: f64| self.cost(piece, angle, turns);
        let step = TAU / COARSE as f64;
        let coarse = least((0..COARSE).map(|index| index as f64 * step), cost);
        let fine = golden([coarse.0 - step, coarse.0 + step], cost);
        let best = if fine.1 < coarse.1 { fine } else { coarse };
        let quarter = least((0..4).map(|index| f64::from(index) * FRAC_PI_2), cost);
        let length: f64 = self.of_piece[piece].iter().map(|index| self.crossings[*index].length).sum();
        if quarter.1 <= best.1 + SPARE_DEGREES * length { quarter } else { best }
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
