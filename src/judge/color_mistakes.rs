//! Mistakes that make all colours of a picture wrong: it would fit if it were turned over, moved, or coded otherwise.

use super::colors::{DrawnColors, excess};
use super::mistakes::{FoundMistake, Mistake, Tally, explain, shifts};
use crate::truth::ColorTruth;

/// Finds the mistake that explains most of what is wrong; `None`: nothing is much better than the picture as it is.
pub fn color_mistake(truth: &ColorTruth, drawn: &DrawnColors) -> Option<FoundMistake> {
    let [width, height] = drawn.size.map(i64::from);
    if drawn.size != [truth.width, truth.height] || drawn.codes.len() as i64 != width * height {
        return None;
    }
    let at = |x: i64, y: i64| {
        let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
        is_inside.then(|| drawn.codes[(y * width + x) as usize])
    };
    let now = count(truth, &at);
    if !now.is_worth_a_search() {
        return None;
    }
    let mut tried = vec![
        (Mistake::UpsideDown, count(truth, &|x, y| at(x, height - 1 - y))),
        (Mistake::Mirrored, count(truth, &|x, y| at(width - 1 - x, y))),
        (Mistake::Turned, count(truth, &|x, y| at(width - 1 - x, height - 1 - y))),
        (Mistake::RedAndBlue, count(truth, &|x, y| at(x, y).map(|[r, g, b]| [b, g, r]))),
        (Mistake::Encoded, count(truth, &|x, y| at(x, y).map(|codes| codes.map(decoded)))),
    ];
    tried.extend(shifts().map(|[right, down]| {
        let moved = count(truth, &|x, y| at(x + i64::from(right), y + i64::from(down)));
        (Mistake::Shifted([right, down]), moved)
    }));
    explain(now, &tried)
}

/// The code of a linear value whose code by the curve of sRGB is `code` [IEC 61966-2-1].
fn decoded(code: f64) -> f64 {
    let value = code / 255.0;
    let linear = if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
    255.0 * linear
}

/// Counts pixels whose colour is known, and of these the ones beyond their bounds, if the picture has `codes` there; `None`
/// lies outside the picture.
fn count(truth: &ColorTruth, codes: &dyn Fn(i64, i64) -> Option<[f64; 3]>) -> Tally {
    let mut tally = Tally::default();
    let width = truth.width as usize;
    for (index, due) in truth.pixels.iter().enumerate().filter(|(_, due)| due.is_known) {
        if let Some(codes) = codes((index % width) as i64, (index / width) as i64) {
            tally.add(excess(truth, due, codes).is_some());
        }
    }
    tally
}
