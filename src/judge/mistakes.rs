//! Mistakes that make a whole picture wrong: it would fit if it were turned over, moved, or of another light.

use std::fmt;

use super::light::{Judge, options};
use super::metrics::is_lit;
use crate::frame::ShadeImage;
use crate::truth::{self, Answer, Truth};

/// Mistake without which a picture would fit much better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// Its rows are in the order of OpenGL, from the bottom up.
    UpsideDown,
    /// Left and right are exchanged.
    Mirrored,
    /// Both of these.
    Turned,
    /// 0 is light, and 1 is shadow.
    Inverted,
    /// It lies so many pixels too far right and too far down.
    Shifted([i32; 2]),
    /// It shows the shade of the light with this number.
    OtherLight(usize),
    /// Red and blue are exchanged in a picture in colours.
    RedAndBlue,
    /// A picture in colours has the codes of sRGB where they must be proportional to light.
    Encoded,
}

/// A mistake, and how far it explains what is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundMistake {
    /// The mistake.
    pub mistake: Mistake,
    /// Wrong pixels over those compared, as the picture is, in [0, 1].
    pub wrong_share: f64,
    /// The same without the mistake.
    pub without_share: f64,
}

impl fmt::Display for FoundMistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.mistake {
            Mistake::UpsideDown => write!(f, "the picture is upside down: its rows run from the bottom up")?,
            Mistake::Mirrored => write!(f, "left and right of the picture are exchanged")?,
            Mistake::Turned => write!(f, "the picture is turned by half a turn")?,
            Mistake::Inverted => write!(f, "the picture is inverted: 1 must be light, 0 shadow")?,
            Mistake::Shifted([x, y]) => write!(f, "the picture is moved by {x} pixels to the right and {y} down")?,
            Mistake::OtherLight(light) => write!(f, "the picture shows light {light}: try --light {light}")?,
            Mistake::RedAndBlue => write!(f, "red and blue of the picture are exchanged")?,
            Mistake::Encoded => {
                write!(f, "the picture is encoded by the curve of sRGB: its codes must be proportional to light")?
            }
        }
        let percents = [self.wrong_share, self.without_share].map(|share| 100.0 * share);
        write!(f, " (so {:.2} % are wrong, else {:.2} %)", percents[0], percents[1])
    }
}

/// The fewest wrong pixels that are searched for a mistake.
const FEWEST_WRONG: usize = 30;
/// By which factor the wrong share must sink without the mistake: a picture that is wrong otherwise stays as wrong.
const BETTER: f64 = 4.0;
/// Greatest shift that is tried, in pixels along each axis.
const MOST_SHIFT: i32 = 4;

impl Judge<'_> {
    /// Finds the mistake that explains most of what is wrong; `None`: nothing is much better than the picture as it is.
    /// `knows_surfaces`: `covered` of the image is the picture's own.
    ///
    /// # Errors
    ///
    /// Another light that the ray tracer cannot trace.
    pub fn mistake(&self, image: &ShadeImage, knows_surfaces: bool) -> Result<Option<FoundMistake>, truth::Error> {
        let truth = self.plain_truth();
        let (width, height) = (i64::from(image.width), i64::from(image.height));
        if image.shade.len() as i64 != width * height || [image.width, image.height] != [truth.width, truth.height] {
            return Ok(None);
        }
        let at = |x: i64, y: i64| {
            let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
            let index = is_inside.then(|| (y * width + x) as usize)?;
            Some((image.shade[index], !knows_surfaces || image.covered[index]))
        };
        let tally =
            |truth: &Truth, value: &dyn Fn(i64, i64) -> Option<(f32, bool)>| count(truth, knows_surfaces, value);
        let now = tally(truth, &at);
        if !now.is_worth_a_search() {
            return Ok(None);
        }
        let mut tried = vec![
            (Mistake::UpsideDown, tally(truth, &|x, y| at(x, height - 1 - y))),
            (Mistake::Mirrored, tally(truth, &|x, y| at(width - 1 - x, y))),
            (Mistake::Turned, tally(truth, &|x, y| at(width - 1 - x, height - 1 - y))),
            (Mistake::Inverted, tally(truth, &|x, y| at(x, y).map(|(value, covered)| (1.0 - value, covered)))),
        ];
        for [right, down] in shifts() {
            let moved = tally(truth, &|x, y| at(x + i64::from(right), y + i64::from(down)));
            tried.push((Mistake::Shifted([right, down]), moved));
        }
        let mut found = explain(now, &tried);
        if found.is_none() {
            for light in (0..self.scene().lights.len()).filter(|light| *light != self.light()) {
                let other = truth::trace(self.scene(), light, &options())?;
                tried.push((Mistake::OtherLight(light), tally(&other, &at)));
            }
            found = explain(now, &tried);
        }
        Ok(found)
    }
}

/// All shifts that are tried, to the right and down.
pub(super) fn shifts() -> impl Iterator<Item = [i32; 2]> {
    let all = (-MOST_SHIFT..=MOST_SHIFT).flat_map(|y| (-MOST_SHIFT..=MOST_SHIFT).map(move |x| [x, y]));
    all.filter(|shift| *shift != [0, 0])
}

/// The mistake without which a picture would fit best, if it would fit much better than `now`.
pub(super) fn explain(now: Tally, tried: &[(Mistake, Tally)]) -> Option<FoundMistake> {
    let is_much_better = |other: &Tally| BETTER * other.share() <= now.share() && 2 * other.compared >= now.compared;
    let better = tried.iter().filter(|(_, tally)| is_much_better(tally));
    let (mistake, without) = better.min_by(|(_, a), (_, b)| a.share().total_cmp(&b.share()))?;
    Some(FoundMistake { mistake: *mistake, wrong_share: now.share(), without_share: without.share() })
}

/// Pixels that are compared, and those that are wrong.
#[derive(Clone, Copy, Default)]
pub(super) struct Tally {
    compared: usize,
    wrong: usize,
}

impl Tally {
    /// Counts a pixel.
    pub(super) fn add(&mut self, is_wrong: bool) {
        self.compared += 1;
        self.wrong += usize::from(is_wrong);
    }

    pub(super) fn is_worth_a_search(&self) -> bool {
        self.wrong >= FEWEST_WRONG
    }

    fn share(&self) -> f64 {
        self.wrong as f64 / self.compared.max(1) as f64
    }
}

/// Counts pixels that are wrong if the picture has `value` there; `None` lies outside the picture.
fn count(truth: &Truth, knows_surfaces: bool, value: &dyn Fn(i64, i64) -> Option<(f32, bool)>) -> Tally {
    let mut tally = Tally::default();
    let width = truth.width as usize;
    for (index, pixel) in truth.pixels.iter().enumerate() {
        let Some((value, covered)) = value((index % width) as i64, (index / width) as i64) else { continue };
        let is_wrong = match (pixel.answer, covered) {
            (Answer::Lit | Answer::Shadowed, true) if value.is_nan() => continue,
            (Answer::Lit | Answer::Shadowed, true) if !pixel.hit.is_some_and(|hit| hit.faces_light()) => continue,
            (Answer::Lit, true) => !is_lit(value),
            (Answer::Shadowed, true) => is_lit(value),
            (Answer::Lit | Answer::Shadowed, false) => true,
            (Answer::Background, true) if knows_surfaces => true,
            _ => continue,
        };
        tally.add(is_wrong);
    }
    tally
}
