//! Sweeps over the keys of projected light as a report holds them: plain values, written as JSON and read back.

use serde::{Deserialize, Serialize};

use super::spread::Spread;
use crate::judge::colors::ColorErrors;
use crate::report::measure::fit::PowerFit;
use crate::report::numbers::plain;

/// Errors of pictures over the values of one key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightSweep {
    /// Name, e.g. `lens points`; unique among a scene's sweeps.
    pub name: String,
    /// Key that is varied, as `--set` takes it.
    pub key: String,
    /// Document and section.
    pub source: String,
    /// Source of the colours that pictures are compared with, in a sentence.
    pub reference: String,
    /// Expectation by a closed form, in a sentence; empty: there is none.
    pub law: String,
    /// Source of the second colours, in a sentence, where points have errors against them.
    pub second_reference: Option<String>,
    /// Settings that are compared, in the order of their values.
    pub series: Vec<SweepSeries>,
}

/// Pictures that differ in one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepSeries {
    /// Name, for the legend.
    pub name: String,
    /// Pictures in the order of the value.
    pub points: Vec<SweepPoint>,
    /// Fit of the RMSE over the value; `None`: it has fewer than three points, or is no number.
    pub fit: Option<PowerFit>,
    /// Least and greatest exponent by the closed form, if there is one.
    pub expected: Option<[f64; 2]>,
}

/// One picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// Setting in TOML.
    pub setting: String,
    /// Short label, for plots.
    pub label: String,
    /// The value, if it is a number.
    pub count: Option<f64>,
    /// Errors and time, or the reason why there are none.
    pub outcome: PointOutcome,
}

/// Outcome of one picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointOutcome {
    /// It was drawn and compared.
    Measured(PointErrors),
    /// Reason why it could not be drawn or compared.
    Failed(String),
}

/// Errors and time of one picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointErrors {
    /// Errors against [`LightSweep::reference`].
    pub errors: ColorErrors,
    /// Errors against [`LightSweep::second_reference`].
    pub second: Option<ColorErrors>,
    /// Every pass drawn, the maps among them, in milliseconds from the first call to the end of glFinish.
    pub frame: Spread,
}

impl SweepPoint {
    /// The errors, if it was drawn.
    pub fn measured(&self) -> Option<&PointErrors> {
        match &self.outcome {
            PointOutcome::Measured(measured) => Some(measured),
            PointOutcome::Failed(_) => None,
        }
    }
}

impl SweepPoint {
    /// Errors and time in words, or the reason why there are none.
    pub fn numbers(&self) -> String {
        let measured = match &self.outcome {
            PointOutcome::Measured(measured) => measured,
            PointOutcome::Failed(why) => return format!("failed: {why}"),
        };
        let flip = |errors: &ColorErrors| errors.flip.map_or_else(|| String::from("not measured"), plain);
        let second = measured.second.map_or_else(String::new, |second| {
            format!(" (second: {} codes, FLIP {})", plain(second.rmse_codes), flip(&second))
        });
        format!(
            "RMSE {} codes, at most {}, FLIP {}{second}, {} ms",
            plain(measured.errors.rmse_codes),
            plain(measured.errors.most_codes),
            flip(&measured.errors),
            plain(measured.frame.least)
        )
    }
}

impl SweepSeries {
    /// The fit in words, with its verdict on the closed form; `None`: there is none.
    pub fn fit_text(&self) -> Option<String> {
        let PowerFit { exponent, range: [least, greatest], points } = self.fit?;
        let number = |value: f64| format!("{value:.2}");
        let fit = format!(
            "{}: RMSE ∝ count^-{}, 95 % range {} to {}, {points} points",
            self.name,
            number(exponent),
            number(least),
            number(greatest)
        );
        let Some([low, high]) = self.expected else { return Some(fit) };
        let expected = if low == high { plain(low) } else { format!("{} to {}", plain(low), plain(high)) };
        let verdict = if least <= high && greatest >= low { "holds" } else { "does not hold" };
        Some(format!("{fit}; expected {expected}: {verdict}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_is_told_with_its_range_and_its_verdict() {
        let series = |exponent: f64, expected| SweepSeries {
            name: String::from("slices"),
            points: Vec::new(),
            fit: Some(PowerFit { exponent, range: [exponent - 0.1, exponent + 0.1], points: 4 }),
            expected,
        };
        let text = |exponent, expected| series(exponent, expected).fit_text().unwrap();
        assert_eq!(text(0.96, None), "slices: RMSE ∝ count^-0.96, 95 % range 0.86 to 1.06, 4 points");
        assert!(text(0.96, Some([1.0, 1.0])).ends_with("; expected 1: holds"), "{}", text(0.96, Some([1.0, 1.0])));
        assert!(text(0.75, Some([1.0, 1.0])).ends_with("; expected 1: does not hold"));
        assert!(text(1.05, Some([0.5, 1.0])).ends_with("; expected 0.5 to 1: holds"));
        assert!(text(0.3, Some([0.5, 1.0])).ends_with("does not hold"));
    }
}
