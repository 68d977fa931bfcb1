//! One picture's errors against the truth: false shadow, leak, and how far its shadow edges lie from the true ones.
//!
//! Pixels are compared if both draw them and the ray tracer is certain; the others are counted by reason. A shade below 0.5
//! is shadow. All percentages are of the pixels compared, so that false shadow and leak add up to the total.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

pub use super::band::Band;
use super::band::find_band;
use super::edges::{DistanceField, Pair, connected_pairs};
use crate::frame::ShadeImage;
use crate::truth::{Answer, Pixel, Truth};

pub use super::edges::EdgeDistance;

/// The fewest pixels compared by which a setting is recommended: a tenth of a percent of them is one pixel.
pub const FEWEST_COMPARED: usize = 1000;

/// All errors of one picture.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Metrics {
    /// Band around the true shadow edges by which errors are split.
    pub band: Band,
    /// Errors over all pixels compared.
    pub all: Errors,
    /// Only surfaces whose visible side faces the light: on the others shading leaves no light.
    pub facing: Errors,
    /// Pixels that were not compared.
    pub left_out: NotCompared,
}

/// The errors over some of the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Errors {
    /// Pixels compared.
    pub compared: usize,
    /// Number of these that lie in the band.
    pub compared_in_band: usize,
    /// Shadow where light belongs: acne, and light lost.
    pub false_shadow: ErrorSplit,
    /// Light where none belongs.
    pub leak: ErrorSplit,
    /// Pixels of false shadow.
    pub false_shadow_percent: f64,
    /// Pixels of leak.
    pub leak_percent: f64,
    /// Sum of both.
    pub wrong_percent: f64,
    /// The part of `wrong_percent` outside the band.
    pub wrong_outside_percent: f64,
    /// Root mean square error of the shade against 0 or 1; for filtered shadows.
    pub rmse: f64,
    /// From each rendered shadow edge to the nearest true one: acne shows as edges far from any. `None`: no edges.
    pub rendered_to_true: Option<EdgeDistance>,
    /// From each true shadow edge to the nearest rendered one: lost shadows show here.
    pub true_to_rendered: Option<EdgeDistance>,
}

/// Wrong pixels by place: counts, and percent of all compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ErrorSplit {
    /// Number of wrong pixels in the band.
    pub inside: usize,
    /// Number of wrong pixels beyond the band.
    pub outside: usize,
    /// `inside` in percent.
    pub inside_percent: f64,
    /// `outside` in percent.
    pub outside_percent: f64,
}

/// Pixels not compared, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct NotCompared {
    /// Neither draws anything.
    pub background: usize,
    /// The ray tracer is not certain.
    pub ambiguous: usize,
    /// Outside the light's cone or frustum: unlit in any case.
    pub outside_cone: usize,
    /// The truth shows a surface that lies in the light's cone or frustum, the picture none.
    pub not_drawn: usize,
    /// The picture shows a surface in the light's cone or frustum, the truth none at all.
    pub only_drawn: usize,
}

/// Reason why a picture cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// Picture and truth have different sizes.
    #[error("the picture has {found:?} pixels, the truth {expected:?}")]
    Size { found: [u32; 2], expected: [u32; 2] },
    /// A list has fewer or more values than the picture has pixels.
    #[error("the picture's {what} holds {found} values, not {expected}")]
    Length { what: &'static str, found: usize, expected: usize },
    /// The shade of a drawn pixel is no fraction, or no number.
    #[error("the shade at column {x}, row {y} is {value}, not in [0, 1]")]
    Value { x: u32, y: u32, value: f32 },
    /// The band's width or the map's size makes no sense.
    #[error("a band of {texels} texels of a map of {size:?}: neither may be below zero, nor the map empty")]
    Band { texels: f64, size: [u32; 2] },
}

impl Metrics {
    /// Errors of a picture of which no pixel is compared.
    pub fn none(band: &Band) -> Self {
        let (all, facing) = (Errors::default(), Errors::default());
        Self { band: *band, all, facing, left_out: NotCompared::default() }
    }
}

/// Compares a picture with the truth. A [`Ruler`] compares several with one truth, and finds that truth's edges once.
///
/// # Errors
///
/// A picture that does not fit the truth; a band that makes no sense.
pub fn compare(truth: &Truth, shade: &ShadeImage, band: &Band) -> Result<Metrics, Error> {
    Ruler::new(truth).compare(shade, band)
}

/// A truth with its shadow edges, which pictures are compared with.
pub struct Ruler<'t> {
    truth: &'t Truth,
    pairs: Vec<Pair>,
    true_edges: Vec<Pair>,
    /// Distances to the true edges, once they are asked for.
    to_true: OnceLock<Option<DistanceField>>,
    /// Pixels of each band that was asked for.
    bands: Mutex<Vec<(Band, Arc<[bool]>)>>,
}

impl<'t> Ruler<'t> {
    /// Finds the edges of `truth`.
    pub fn new(truth: &'t Truth) -> Self {
        let pairs = connected_pairs(truth);
        let true_edges = pairs.iter().filter(|pair| pair.changes_light(truth)).copied().collect();
        Self { truth, pairs, true_edges, to_true: OnceLock::new(), bands: Mutex::default() }
    }

    /// The truth.
    pub fn truth(&self) -> &'t Truth {
        self.truth
    }

    /// All errors of a picture.
    ///
    /// # Errors
    ///
    /// As [`compare`].
    pub fn compare(&self, shade: &ShadeImage, band: &Band) -> Result<Metrics, Error> {
        let metrics = self.count(shade, band)?;
        let truth = self.truth;
        let drawn = self.pairs.iter().filter(|pair| shade.covered[pair.first] && shade.covered[pair.second]);
        let changes = |pair: &&Pair| is_lit(shade.shade[pair.first]) != is_lit(shade.shade[pair.second]);
        let rendered_edges: Vec<Pair> = drawn.filter(changes).copied().collect();
        let size = [truth.width, truth.height];
        let to_true = self.to_true.get_or_init(|| DistanceField::new(size, &self.true_edges)).as_ref();
        let to_rendered = DistanceField::new(size, &rendered_edges);
        let measured = |errors: Errors, takes: &dyn Fn(&Pixel) -> bool| {
            let both = |pair: &&Pair| takes(&truth.pixels[pair.first]) && takes(&truth.pixels[pair.second]);
            let some = |edges: &[Pair]| edges.iter().filter(both).copied().collect::<Vec<_>>();
            Errors {
                rendered_to_true: to_true.and_then(|field| field.of(&some(&rendered_edges))),
                true_to_rendered: to_rendered.as_ref().and_then(|field| field.of(&some(&self.true_edges))),
                ..errors
            }
        };
        let (all, facing) = (measured(metrics.all, &|_| true), measured(metrics.facing, &faces_light));
        Ok(Metrics { all, facing, ..metrics })
    }

    /// The errors of a picture without distances between edges, which cost more than all else.
    ///
    /// # Errors
    ///
    /// As [`compare`].
    pub fn count(&self, shade: &ShadeImage, band: &Band) -> Result<Metrics, Error> {
        let truth = self.truth;
        check(truth, shade, band)?;
        let in_band = self.in_band(band);
        Ok(Metrics {
            band: *band,
            all: count(truth, shade, &in_band, &|_| true),
            facing: count(truth, shade, &in_band, &faces_light),
            left_out: leave_out(truth, shade),
        })
    }

    fn in_band(&self, band: &Band) -> Arc<[bool]> {
        let mut bands = self.bands.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, pixels)) = bands.iter().find(|(known, _)| known == band) {
            return pixels.clone();
        }
        let pixels: Arc<[bool]> = find_band(self.truth, &self.true_edges, band).into();
        bands.push((*band, pixels.clone()));
        pixels
    }
}

fn faces_light(pixel: &Pixel) -> bool {
    pixel.hit.is_some_and(|hit| hit.faces_light())
}

/// Threshold between light and shadow.
pub(super) fn is_lit(shade: f32) -> bool {
    shade >= 0.5
}

/// Tests that a picture has the size of the truth, and a value for each pixel.
pub(super) fn check_size(truth: &Truth, shade: &ShadeImage) -> Result<(), Error> {
    let (found, expected) = ([shade.width, shade.height], [truth.width, truth.height]);
    if found != expected {
        return Err(Error::Size { found, expected });
    }
    let pixels = truth.width as usize * truth.height as usize;
    let lengths = [("truth", truth.pixels.len()), ("shade", shade.shade.len()), ("coverage", shade.covered.len())];
    if let Some(&(what, found)) = lengths.iter().find(|(_, length)| *length != pixels) {
        return Err(Error::Length { what, found, expected: pixels });
    }
    Ok(())
}

fn check(truth: &Truth, shade: &ShadeImage, band: &Band) -> Result<(), Error> {
    check_size(truth, shade)?;
    let covered = shade.shade.iter().zip(&shade.covered);
    let wrong = covered.enumerate().find(|(_, (value, covered))| **covered && !(0.0..=1.0).contains(*value));
    if let Some((index, (&value, _))) = wrong {
        let width = truth.width as usize;
        return Err(Error::Value { x: (index % width) as u32, y: (index / width) as u32, value });
    }
    let is_usable = band.texels >= 0.0 && band.texels.is_finite() && !band.map_size.contains(&0);
    if is_usable { Ok(()) } else { Err(Error::Band { texels: band.texels, size: band.map_size }) }
}

fn count(truth: &Truth, shade: &ShadeImage, in_band: &[bool], takes: &dyn Fn(&Pixel) -> bool) -> Errors {
    let mut errors = Errors::default();
    let mut squares = 0.0;
    for (index, pixel) in truth.pixels.iter().enumerate() {
        let should_be_lit = match pixel.answer {
            Answer::Lit => true,
            Answer::Shadowed => false,
            Answer::Background | Answer::OutsideCone | Answer::Ambiguous(_) => continue,
        };
        if !shade.covered[index] || !takes(pixel) {
            continue;
        }
        let value = shade.shade[index];
        errors.compared += 1;
        errors.compared_in_band += usize::from(in_band[index]);
        squares += (f64::from(value) - f64::from(u8::from(should_be_lit))).powi(2);
        let split = if should_be_lit { &mut errors.false_shadow } else { &mut errors.leak };
        if is_lit(value) != should_be_lit {
            *(if in_band[index] { &mut split.inside } else { &mut split.outside }) += 1;
        }
    }
    finish(errors, squares)
}

/// Fills in what follows from the counts; zeros where nothing was compared.
fn finish(mut errors: Errors, squares: f64) -> Errors {
    let compared = errors.compared.max(1) as f64;
    let percent = |count: usize| 100.0 * count as f64 / compared;
    for split in [&mut errors.false_shadow, &mut errors.leak] {
        split.inside_percent = percent(split.inside);
        split.outside_percent = percent(split.outside);
    }
    let (lost, leak) = (errors.false_shadow, errors.leak);
    errors.false_shadow_percent = percent(lost.inside + lost.outside);
    errors.leak_percent = percent(leak.inside + leak.outside);
    errors.wrong_percent = percent(lost.inside + lost.outside + leak.inside + leak.outside);
    errors.wrong_outside_percent = percent(lost.outside + leak.outside);
    errors.rmse = (squares / compared).sqrt();
    errors
}

fn leave_out(truth: &Truth, shade: &ShadeImage) -> NotCompared {
    let mut left_out = NotCompared::default();
    for (pixel, &covered) in truth.pixels.iter().zip(&shade.covered) {
        let counter = match (pixel.answer, covered) {
            (Answer::Background, false) => &mut left_out.background,
            (Answer::Background, true) => &mut left_out.only_drawn,
            (Answer::Ambiguous(_), _) => &mut left_out.ambiguous,
            // A shade is transparent where no light reaches, whether a surface is there or not.
            (Answer::OutsideCone, _) => &mut left_out.outside_cone,
            (Answer::Lit | Answer::Shadowed, false) => &mut left_out.not_drawn,
            (Answer::Lit | Answer::Shadowed, true) => continue,
        };
        *counter += 1;
    }
    left_out
}

#[cfg(test)]
#[path = "metrics_tests.rs"]
mod tests;
