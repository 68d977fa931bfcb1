//! Times of two scenes, drawn in turn on one context, and the ratio of both with its range.
//!
//! A machine that does other work slows down both of a pair; the ratio of a round hardly changes. The median of the ratios has
//! a range that holds whatever their distribution: it lies between two of them, by their ranks, with a probability that
//! follows from the binomial distribution.

use crate::frame::{self, Renderer};
use crate::plan::Request;
use crate::scene::Scene;

/// Two times and their ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedTimes {
    /// Median of the first scene's times in milliseconds.
    pub first_ms: f64,
    /// Median of the second scene's.
    pub second_ms: f64,
    /// Range of the first over the second that holds the median ratio with a confidence of at least 95 %; all ratios, if
    /// there are fewer than six.
    pub ratio_range: [f64; 2],
}

/// Frames of which the fastest counts, because other work only adds to a time.
const FRAMES: u32 = 5;

/// Draws both in turn, `rounds` times; which of the two is first alternates. `redrawn`: frames draw their maps anew.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn paired(
    [first, second]: [&Scene; 2],
    redrawn: bool,
    rounds: usize,
    renderer: &mut Renderer,
) -> Result<PairedTimes, frame::Error> {
    let request = Request { frames: 100, sampled_warnings: false, ..Request::default() };
    let plans = [renderer.plan(first, &request)?, renderer.plan(second, &request)?];
    in_turn(rounds, |which| {
        // Uploads what the other one's frame has replaced.
        renderer.draw_timed(&plans[which], 1, false, || ())?;
        let mut least = f64::INFINITY;
        for _ in 0..FRAMES {
            if redrawn {
                renderer.device().forget();
            }
            let frames = renderer.draw_timed(&plans[which], 1, false, || ())?.frames_ms;
            least = frames.into_iter().fold(least, f64::min);
        }
        Ok(least)
    })
}

/// Times two works in turn, `rounds` times; which of the two is first alternates. `time` does the first (0) or the second
/// (1) and returns its milliseconds.
///
/// # Errors
///
/// An error of `time`.
pub fn in_turn(
    rounds: usize,
    mut time: impl FnMut(usize) -> Result<f64, frame::Error>,
) -> Result<PairedTimes, frame::Error> {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..rounds.max(1) {
        for turn in 0..2 {
            let which = (round + turn) % 2;
            times[which].push(time(which)?);
        }
    }
    let ratios: Vec<f64> = times[0].iter().zip(&times[1]).map(|(first, second)| first / second).collect();
    let [first_ms, second_ms] = times.map(|times| middle(&sorted(times)));
    Ok(PairedTimes { first_ms, second_ms, ratio_range: range_of_median(&sorted(ratios)) })
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

fn middle(sorted: &[f64]) -> f64 {
    let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
    let count = sorted.len();
    0.5 * (at(count / 2) + at(count.saturating_sub(1) / 2))
}

/// The narrowest interval between the k-th least and the k-th greatest value that covers the median with at least 95 %.
fn range_of_median(sorted: &[f64]) -> [f64; 2] {
    let count = sorted.len();
    let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
    // The median lies below the value of rank k + 1 if at most k of the values lie below the median.
    let (mut chance, mut below, mut rank) = (0.5_f64.powi(count as i32), 0.0, 0);
    for k in 0..count / 2 {
        below += chance;
        if below > 0.025 {
            break;
        }
        rank = k;
        chance *= (count - k) as f64 / (k + 1) as f64;
    }
    [at(rank), at(count.saturating_sub(1 + rank))]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranks from tables of the sign test: of 9 values the second and the second last, of 21 the sixth.
    #[test]
    fn the_range_has_the_ranks_of_the_sign_test() {
        let values = |count: usize| (1..=count).map(|value| value as f64).collect::<Vec<_>>();
        for (count, range) in [(5, [1.0, 5.0]), (6, [1.0, 6.0]), (9, [2.0, 8.0]), (15, [4.0, 12.0]), (21, [6.0, 16.0])]
        {
            assert_eq!(range_of_median(&values(count)), range, "{count} values");
        }
        assert_eq!(range_of_median(&[3.0]), [3.0, 3.0]);
    }

    #[test]
    fn the_range_holds_the_median_as_often_as_it_says() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut held = 0;
        for _ in 0..4000 {
            // Skewed: other work only adds.
            let values = (0..15).map(|_| 1.0 + random.f64().powi(4)).collect();
            let [least, greatest] = range_of_median(&sorted(values));
            held += usize::from(least <= 1.0 + 0.5_f64.powi(4) && 1.0 + 0.5_f64.powi(4) <= greatest);
        }
        // The fourth of 15 from either end: 96.5 %, within three standard deviations of a count.
        assert!((3823..=3897).contains(&held), "{held}");
    }

    #[test]
    fn the_middle_is_the_median() {
        assert_eq!((middle(&[1.0, 2.0, 9.0]), middle(&[1.0, 3.0]), middle(&[])), (2.0, 2.0, 0.0));
    }
}
