//! Results of a stress run. Plain values, as `--json` writes them.

use super::rows::RowSettings;

/// Verdict of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Right: within the technique's bound, without a warning.
    Right,
    /// Right, within the bound, although the plan warns.
    FalseAlarm,
    /// Beyond the bound, and the plan says why.
    Warned,
    /// A clear error in place of a picture.
    Refused,
    /// Wrong, beyond the bound, without a warning.
    SilentlyWrong,
}

impl Verdict {
    /// All five, from right to silently wrong.
    pub const ALL: [Self; 5] = [Self::Right, Self::FalseAlarm, Self::Warned, Self::Refused, Self::SilentlyWrong];

    /// The verdict in words, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::FalseAlarm => "false alarm",
            Self::Warned => "warned",
            Self::Refused => "refused",
            Self::SilentlyWrong => "silently wrong",
        }
    }
}

/// One light of a case under one setting.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CaseRow {
    /// Index into the scene's lights.
    pub light: usize,
    /// Technique and keys.
    #[serde(flatten)]
    pub settings: RowSettings,
    /// Verdict.
    pub verdict: Verdict,
    /// Pixels compared with the truth.
    pub compared: usize,
    /// Pixels on the wrong side of one half.
    pub wrong: usize,
    /// Wrong pixels that the technique's bound does not account for.
    pub beyond: usize,
    /// The plan's warnings, or the error.
    pub why: String,
}

impl CaseRow {
    /// A row that is not judged yet.
    pub fn new(light: usize, settings: &RowSettings) -> Self {
        let settings = settings.clone();
        Self { light, settings, verdict: Verdict::Right, compared: 0, wrong: 0, beyond: 0, why: String::new() }
    }

    /// Keys that differ from the technique's default, for tables.
    pub fn keys(&self) -> String {
        let keys = if self.settings.keys.is_empty() { "defaults" } else { &self.settings.keys };
        let pictured = if self.settings.pictured { ", in the picture" } else { "" };
        format!("{keys}{pictured}")
    }

    /// Tests whether the picture must not be used, or was not drawn.
    pub fn is_unusable(&self) -> bool {
        matches!(self.verdict, Verdict::FalseAlarm | Verdict::Warned | Verdict::Refused)
    }

    /// Wrong pixels in percent of [`CaseRow::compared`].
    pub fn wrong_percent(&self) -> f64 {
        100.0 * self.wrong as f64 / self.compared.max(1) as f64
    }
}

/// A row as PNG files.
#[derive(Clone, Debug, PartialEq)]
pub struct RowPictures {
    /// Index into [`CaseResult::rows`].
    pub row: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The shade as it was drawn: white lit, black shadowed.
    pub drawn: Vec<u8>,
    /// Picture of the truth.
    pub truth: Vec<u8>,
    /// The truth, with what is wrong in colours.
    pub difference: Vec<u8>,
}

/// One case with all its rows.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CaseResult {
    /// Name of the case, unique in a run.
    pub name: String,
    /// True if it was made from a seed; `false`: a named case.
    pub is_random: bool,
    /// Extreme property of the scene.
    pub why: String,
    /// The stiff parameter of a sweep and its value.
    pub sweep: Option<(String, f64)>,
    /// Drawn pixels of which the ray tracer is certain, in [0, 1], over all lights.
    pub decided: f64,
    /// Time to trace, draw and judge it.
    pub seconds: f64,
    /// Reason why the case has no rows: the scene was refused.
    pub refused: Option<String>,
    /// True if a refusal is what the case expects.
    pub refusal_expected: bool,
    /// Rows of all lights.
    pub rows: Vec<CaseRow>,
    /// Pictures of the worst row of each technique whose rows are not all right, if pictures are requested.
    #[serde(skip)]
    pub pictures: Vec<RowPictures>,
}

impl CaseResult {
    /// Tests whether the case was not drawn although it should have been, or the other way around.
    pub fn is_misjudged(&self) -> bool {
        self.refused.is_some() != self.refusal_expected
    }

    /// Tests whether something is not right.
    pub fn has_news(&self) -> bool {
        self.is_misjudged() || self.rows.iter().any(|row| row.verdict != Verdict::Right)
    }

    /// Tests whether something is wrong without a warning.
    pub fn fails(&self) -> bool {
        self.is_misjudged() || self.rows.iter().any(|row| row.verdict == Verdict::SilentlyWrong)
    }
}

/// Rows of random scenes under default settings.
pub fn random_defaults(results: &[CaseResult]) -> impl Iterator<Item = &CaseRow> {
    let random = results.iter().filter(|result| result.is_random);
    random.flat_map(|result| &result.rows).filter(|row| row.settings.is_default())
}

/// Number of rows with each verdict, in the order of [`Verdict::ALL`].
pub fn tally<'a>(rows: impl IntoIterator<Item = &'a CaseRow>) -> [usize; 5] {
    let mut tally = [0; 5];
    for row in rows {
        tally[Verdict::ALL.iter().position(|verdict| *verdict == row.verdict).unwrap_or(0)] += 1;
    }
    tally
}

impl CaseRow {
    /// Counts warnings of the scene's loader as said.
    pub fn add_warnings(&mut self, warnings: &[String]) {
        if warnings.is_empty() {
            return;
        }
        self.verdict = match self.verdict {
            Verdict::Right => Verdict::FalseAlarm,
            Verdict::SilentlyWrong => Verdict::Warned,
            other => other,
        };
        let said = warnings.join("; ");
        self.why = if self.why.is_empty() { said } else { format!("{said}; {}", self.why) };
    }
}
