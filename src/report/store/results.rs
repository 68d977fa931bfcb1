//! Contents of a report: plain values that are written as JSON, read back, merged and drawn.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, Serializer};

use super::claim_sweep::ClaimSweep;
use super::claimed::Claimed;
pub use super::spread::Spread;
use super::swept::LightSweep;
use crate::judge::colors::ColorErrors;
use crate::judge::metrics::{FEWEST_COMPARED, Metrics};

/// A whole report, or a part of one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of this layout.
    pub version: u32,
    /// True if every row of the grid is there.
    pub complete: bool,
    /// Machine and driver of all rows.
    pub machine: Machine,
    /// Notes for the reader: what was joined, what went wrong.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Requested scenes, of which [`Self::scenes`] may be a part.
    pub asked_scenes: usize,
    /// Scenes in the requested order.
    pub scenes: Vec<SceneReport>,
}

/// The layout that this crate writes and reads.
pub const VERSION: u32 = 3;

/// Machine and driver that it was measured on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor, as the system names it.
    pub processor: String,
    /// Number of logical cores.
    pub cores: usize,
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VERSION.
    pub gl_version: String,
    /// Way in which the context was made, e.g. `EGL surfaceless`.
    pub backend: String,
    /// Version of glumbra.
    pub glumbra: String,
    /// Rows measured at once; above 1 the times disturb each other.
    pub jobs: usize,
}

/// One scene over the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReport {
    /// Path as text; bytes that are not UTF-8 are replaced.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// The path's bytes in hexadecimal, if it is not UTF-8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path_bytes: Option<String>,
    /// Fingerprint of the scene, the files that it names, the grid, the light and the layout: parts with the same one can be merged.
    pub fingerprint: String,
    /// Index into the scene's lights.
    pub light: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Triangles of all objects, as loaded.
    pub triangles: u64,
    /// Summary of the ray tracer's answer.
    pub truth: TruthSummary,
    /// Reason why no row's shade is compared, if the light casts no shadow by nature.
    pub unshaded: Option<String>,
    /// Source of the colours that pictures are compared with; `None`: colours are not compared.
    pub colors_from: Option<String>,
    /// Parts that the plan leaves out of the scene as written, and the time that this saves.
    #[serde(default)]
    pub saved: Option<Saved>,
    /// Claims of the documents, measured here.
    #[serde(default)]
    pub claims: Vec<Claimed>,
    /// Sweeps that claims rest on.
    #[serde(default)]
    pub claim_sweeps: Vec<ClaimSweep>,
    /// Errors of pictures over the keys of projected light.
    pub sweeps: Vec<LightSweep>,
    /// Rows of the whole grid, of which [`Self::rows`] may be a part.
    pub grid_rows: usize,
    /// Rows by their index in the grid.
    pub rows: Vec<Row>,
}

/// Costs of the scene as written, compared with everything drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// True if both drew the same picture, to the bit. If not, nothing here counts.
    pub same_pixels: bool,
    /// A frame with nothing left out.
    pub whole: Cost,
    /// A frame that keeps what a static scene's first frame drew.
    pub pruned: Cost,
    /// Parts that the second frame leaves out, each with the reason.
    pub left_out: Vec<crate::lights::LeftOut>,
}

/// Cost of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Time of a frame.
    pub frame: Spread,
    /// Bytes of the plan's images.
    pub image_bytes: u64,
    /// Draws of a frame.
    pub draw_calls: usize,
    /// Triangles of a frame.
    pub triangles: u64,
}

/// Summary of the ray tracer's answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruthSummary {
    /// Pixels on which something is drawn.
    pub drawn: usize,
    /// Drawn pixels in the light.
    pub lit: usize,
    /// Drawn pixels in shadow.
    pub shadowed: usize,
    /// Drawn pixels of which the ray tracer is not certain.
    pub ambiguous: usize,
    /// Ambiguous pixels, in percent of `drawn`.
    pub ambiguous_percent: f64,
    /// Time to trace it, in milliseconds, on all cores.
    pub trace_ms: f64,
}

/// One setting of one technique.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Index in the grid, from 0; row 0 is the scene as written.
    pub index: usize,
    /// Name of the technique, as in a scene file.
    pub technique: String,
    /// `key = value` in TOML, without the technique: all keys of `[light.shadow]`, the scene's own among them.
    pub settings: Vec<(String, String)>,
    /// Texels a side of its map; `None`: its technique draws none.
    pub map_size: Option<u32>,
    /// Measurement, or the reason why there is none.
    pub outcome: Outcome,
}

/// Outcome of one setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Errors and costs.
    Measured(Box<Measured>),
    /// Reason why the row could not be drawn or compared.
    Failed(String),
}

/// Errors and costs of a setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Errors against the truth.
    pub metrics: Metrics,
    /// Errors of the picture's colours, if a light has an image, a beam, a law of distance, a lens or dust, or is a slide
    /// projector.
    pub colors: Option<ColorErrors>,
    /// Every pass drawn, the maps among them, in milliseconds from the first call to the end of glFinish.
    pub frame_redrawn: Spread,
    /// A frame that keeps what a static scene's first frame drew.
    pub frame_kept: Spread,
    /// Cost of each pass, in the order of the plan.
    pub passes: Vec<PassCost>,
    /// Images of the plan: maps, buffers, textures.
    pub image_bytes: u64,
    /// Vertex and index buffers.
    #[serde(default)]
    pub buffer_bytes: u64,
    /// Draws of a frame with everything drawn.
    pub draw_calls: usize,
    /// Triangles of a frame with everything drawn.
    pub triangles: u64,
    /// Hash of the work of its passes: rows with the same one should take the same time. Empty in older reports.
    #[serde(default)]
    pub work: String,
    /// Parts that the plan leaves out, each with the reason.
    pub left_out: Vec<crate::lights::LeftOut>,
    /// The plan's warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// Cost of one pass when it is drawn and waited for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PassCost {
    /// Label of the pass, as `glumbra plan` prints it.
    pub label: String,
    /// Time by the wall clock, to the end of glFinish.
    pub wall: Spread,
    /// GL_TIME_ELAPSED, where the driver counts it.
    pub gpu: Option<Spread>,
    /// Triangles that the pass draws.
    pub triangles: u64,
    /// GL_SAMPLES_PASSED: fragments that passed the depth test.
    pub fragments: Option<u64>,
}

impl Report {
    /// Tests whether every row of every requested scene is there.
    pub fn has_all_rows(&self) -> bool {
        self.scenes.len() == self.asked_scenes && self.scenes.iter().all(|scene| scene.rows.len() == scene.grid_rows)
    }
}

impl Row {
    /// The measurement, if there is one.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Measured(measured) => Some(measured),
            Outcome::Failed(_) => None,
        }
    }

    /// `key = value, …`, without the technique.
    pub fn settings_text(&self) -> String {
        let keys = self.settings.iter().map(|(key, value)| format!("{key} = {value}"));
        keys.collect::<Vec<_>>().join(", ")
    }

    /// `[light.shadow]` as a scene would have it.
    pub fn to_toml(&self) -> String {
        let keys = self.settings.iter().map(|(key, value)| format!("{key} = {value}\n"));
        format!("[light.shadow]\ntechnique = \"{}\"\n{}", self.technique, keys.collect::<String>())
    }
}

/// Replaces bytes that are not UTF-8, which JSON cannot hold: see [`SceneReport::path_bytes`].
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// Value of [`SceneReport::path_bytes`].
pub fn bytes_of(path: &Path) -> Option<String> {
    let hexadecimal = |byte: &u8| format!("{byte:02x}");
    path.to_str().is_none().then(|| path.as_os_str().as_encoded_bytes().iter().map(hexadecimal).collect())
}

impl SceneReport {
    /// The rows that could not be drawn or compared.
    pub fn failed(&self) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.measured().is_none()).collect()
    }
}

impl Measured {
    /// Tests whether enough pixels could be compared to say how wrong it is. Otherwise it is not right, only unjudged.
    pub fn is_judged(&self) -> bool {
        self.metrics.all.compared >= FEWEST_COMPARED
    }

    /// Wrong pixels, in percent of all that were compared.
    pub fn wrong_percent(&self) -> f64 {
        self.metrics.all.wrong_percent
    }
}
