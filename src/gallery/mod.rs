//! `glumbra gallery`: one page that shows failures on purpose, each beside its cure, with the numbers that tell them apart.
//! Entries are data (`data/gallery/entries.toml`): a scene, overrides for the failure and for the cure, words, and the section
//! of a document. Knows scenes, plans, frames, truth and the judge's numbers; no technique by more than a scene's keys, no GL.
//!
//! `entry.rs` reads the entries, `scenes.rs` has their scenes, `draw.rs` draws and measures, `faults.rs` has what no key can
//! do, `choices.rs` compares techniques, `diagrams/` draws from a scene's numbers, `page/` writes HTML.

mod choices;
mod diagrams;
mod draw;
mod entry;
mod faults;
mod page;
mod scenes;

pub use choices::{MeasuredChoice, TechniqueChoice, choices, measure as measure_choice};
pub use draw::{DrawnSide, EntrySide, ShownEntry, show};
pub use entry::{EntryMeasure, GalleryEntry, chosen, entries};
pub use faults::Fault;
pub use page::{PageFacts, to_html};
pub use scenes::find as scene;

use crate::judge::metrics;
use crate::{frame, scene as scenes_of, truth};

/// Reason why the gallery could not be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("the entries that are compiled in cannot be read: {0}")]
    Entries(#[from] toml::de::Error),
    #[error("there is no entry \"{id}\": {hint}")]
    Unknown { id: String, hint: String },
    #[error("entry {id}: its scene {scene} is not compiled in")]
    NoScene { id: String, scene: String },
    #[error("entry {id}: {reason}")]
    Scene { id: String, reason: Box<scenes_of::Error> },
    #[error("entry {id}: {reason}")]
    Frame { id: String, reason: Box<frame::Error> },
    #[error("entry {id}: {reason}")]
    Truth { id: String, reason: truth::Error },
    #[error("entry {id}: {reason}")]
    Judge { id: String, reason: metrics::Error },
    #[error("entry {id}: {reason}")]
    Skin { id: String, reason: crate::geometry::skin::Error },
    #[error("entry {id}: its fault changes nothing in the passes of its scene")]
    NoFault { id: String },
    #[error("entry {id}: no pixel's colour is known, so that there is nothing to compare")]
    NothingKnown { id: String },
    #[error("entry {id}: a picture cannot be encoded: {reason}")]
    Png { id: String, reason: std::io::Error },
    #[error("{folder}: cannot be made: {reason}", folder = .folder.display())]
    Folder { folder: std::path::PathBuf, reason: std::io::Error },
}
