//! What a stress run found. Plain values, as `--json` writes them.

use super::rows::RowSettings;

/// What a row comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Within the technique's bound, and no warning.
    Right,
    /// Within the bound although the plan warns.
    FalseAlarm,
    /// Beyond the bound, and the plan says why.
    Warned,
    /// A clear error in place of a picture.
    Refused,
    /// Beyond the bound, and nothing said.
    SilentlyWrong,
}

impl Verdict {
    pub const ALL: [Self; 5] = [Self::Right, Self::FalseAlarm, Self::Warned, Self::Refused, Self::SilentlyWrong];

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
pub struct Row {
    /// Into the scene's lights.
    pub light: usize,
    #[serde(flatten)]
    pub settings: RowSettings,
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

impl Row {
    /// Not judged yet.
    pub fn new(light: usize, settings: &RowSettings) -> Self {
        let settings = settings.clone();
        Self { light, settings, verdict: Verdict::Right, compared: 0, wrong: 0, beyond: 0, why: String::new() }
    }

    pub fn wrong_percent(&self) -> f64 {
        100.0 * self.wrong as f64 / self.compared.max(1) as f64
    }
}

/// One case with all its rows.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CaseResult {
    pub name: String,
    /// The stiff parameter of a sweep and its value.
    pub sweep: Option<(String, f64)>,
    /// Drawn pixels of which the oracle is certain, in [0, 1], over all lights.
    pub decided: f64,
    pub seconds: f64,
    /// Why the case has no rows: the scene was refused.
    pub refused: Option<String>,
    /// Whether a refusal is what the case expects.
    pub refusal_expected: bool,
    pub rows: Vec<Row>,
}

/// How many rows have each verdict, in the order of [`Verdict::ALL`].
pub fn tally<'a>(rows: impl IntoIterator<Item = &'a Row>) -> [usize; 5] {
    let mut tally = [0; 5];
    for row in rows {
        tally[Verdict::ALL.iter().position(|verdict| *verdict == row.verdict).unwrap_or(0)] += 1;
    }
    tally
}

impl Row {
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
