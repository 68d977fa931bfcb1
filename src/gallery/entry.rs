//! The entries of the gallery, as `data/gallery/entries.toml` has them.

use serde::Deserialize;

use super::Error;
use super::faults::Fault;
use crate::scene;

/// A failure and its cure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GalleryEntry {
    /// Name in links, files and `--entry`.
    pub id: String,
    pub title: String,
    /// Question of someone who sees the failure.
    pub question: String,
    /// Paragraphs of plain words.
    pub explanation: Vec<String>,
    /// Tag of the document in data/documents.md, without brackets.
    pub document: String,
    /// Section, slide or figure of that document.
    pub section: String,
    /// Technique of the failing light, by its name in scene files.
    pub technique: String,
    /// Path of the scene in the repository.
    pub scene: String,
    /// Overrides of both pictures, as `--set` takes them.
    #[serde(default)]
    pub set: Vec<String>,
    /// Number of the judged light.
    #[serde(default)]
    pub light: usize,
    /// Mistake of the failure that no override makes.
    #[serde(default)]
    pub fault: Option<Fault>,
    pub failure: WrittenSide,
    pub cure: WrittenSide,
    /// Number that tells the failure from the cure.
    pub measure: EntryMeasure,
    /// The failure's number is at least so many times the cure's.
    pub factor: f64,
    /// The failure's number is at least this, in the measure's unit.
    pub least: f64,
    #[serde(default)]
    pub diagram: Option<DiagramKind>,
    /// Figure of `glumbra figures` that shows more.
    #[serde(default)]
    pub figure: Option<String>,
}

/// The failure, or the cure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrittenSide {
    /// Sentence below its picture.
    pub says: String,
    /// Overrides of this picture alone, after those of both.
    #[serde(default)]
    pub set: Vec<String>,
}

/// Number that tells a failure from its cure.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum EntryMeasure {
    /// Percent of the surfaces that face the light: shadow where light belongs.
    FalseShadow,
    /// Percent of these: light where shadow belongs.
    Leak,
    /// Percent of these: both.
    Wrong,
    /// Percent of the pixels whose colour is beyond its bounds.
    Colors,
    /// Root mean square error of colours, in codes of 1/255.
    Rmse,
}

impl EntryMeasure {
    /// The measure in words, as a table's row names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::FalseShadow => "false shadow",
            Self::Leak => "leak",
            Self::Wrong => "wrong",
            Self::Colors => "pixels of a wrong colour",
            Self::Rmse => "root mean square error",
        }
    }

    /// The unit.
    pub fn unit(self) -> &'static str {
        if self == Self::Rmse { "codes of 255" } else { "%" }
    }

    /// Tests whether it compares colours; else it compares the shade.
    pub fn is_of_colors(self) -> bool {
        matches!(self, Self::Colors | Self::Rmse)
    }
}

/// Diagram of an entry.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum DiagramKind {
    /// A shadow map's texels as a stair against the surface [HSM, Figure 3].
    Texels,
    /// The chain of matrices, with the numbers of a point [HSM, Figures 7 and 8].
    Transforms,
    /// A cut through shadow volumes with their counts.
    Volumes,
    /// The light's frustum along its axis.
    Frustum,
    /// The two depths that are compared, in shadow and in the light [HSM, Figure 1].
    Comparison,
    /// A projected picture, a surface and the eye's screen [Segal 1992, Figures 1 and 2].
    Projected,
    /// The same with the mirrored frustum behind the light.
    BackProjection,
    /// Equal steps on the screen, and on a surface [Segal 1992, Figure 2].
    Perspective,
    /// The two depth ranges of the ledge.
    Ledge,
}

/// Every entry, in the page's order.
///
/// # Errors
///
/// A file that was compiled in damaged.
pub fn entries() -> Result<Vec<GalleryEntry>, Error> {
    #[derive(Deserialize)]
    struct File {
        entry: Vec<GalleryEntry>,
    }
    let file: File = toml::from_str(include_str!("../../data/gallery/entries.toml"))?;
    Ok(file.entry)
}

/// The entries of these ids in the page's order; all where there are none.
///
/// # Errors
///
/// An id that no entry has.
pub fn chosen(ids: &[String]) -> Result<Vec<GalleryEntry>, Error> {
    let all = entries()?;
    if let Some(id) = ids.iter().find(|id| all.iter().all(|entry| entry.id != **id)) {
        let hint = scene::suggest(id, all.iter().map(|entry| entry.id.as_str()));
        return Err(Error::Unknown { id: id.clone(), hint });
    }
    Ok(all.into_iter().filter(|entry| ids.is_empty() || ids.contains(&entry.id)).collect())
}

impl GalleryEntry {
    /// Tests whether the two numbers are as far apart as the entry says.
    pub fn is_kept_by(&self, failure: f64, cure: f64) -> bool {
        failure >= self.least && failure >= self.factor * cure
    }
}
