//! Errors between a file's name and a resolved scene. Every message stands alone: it names the file, the line where there
//! is one, and what is expected.

use std::io;
use std::path::PathBuf;

use super::settings::{Origin, SettingsError};
use crate::geometry;

/// Reason why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// The system refused to read the file.
    #[error("{path}: cannot be read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: io::Error },

    /// The path is that of a folder.
    #[error("{path}: is a folder; name a scene (.toml) or a model (.obj, .md2, .gltf, .glb, .ply, .stl)", path = .path.display())]
    Folder { path: PathBuf },

    /// The file is longer than any of its kind.
    #[error("{path}: has {bytes} bytes; a file of its kind may have {limit}", path = .path.display())]
    TooLong { path: PathBuf, bytes: u64, limit: u64 },

    /// The file's name has none of the known endings.
    #[error("{path}: cannot tell what this is: a scene ends in .toml, a model in .obj, .md2, .gltf, .glb, .ply or .stl", path = .path.display())]
    UnknownKind { path: PathBuf },

    /// A byte of the file is not UTF-8.
    #[error("{path}:{line}: is not UTF-8 text", path = .path.display())]
    NotUtf8 { path: PathBuf, line: usize },

    /// The grammar of TOML, or of JSON in a file of instances, with the offending line as written.
    #[error("{origin}: {message}\n  {text}")]
    Syntax { origin: Origin, message: String, text: String },

    /// A wrong value, or an unknown key.
    #[error(transparent)]
    Settings(#[from] SettingsError),

    /// A mesh or texture that the scene names.
    #[error("{origin}: {source}")]
    Asset { origin: Origin, source: geometry::Error },

    /// A model is too small or too large for a scene around it.
    #[error(
        "{path}: is {size:.3e} across; a scene is supplied around models that are {least:e} to {most:e} across: \
         scale it, e.g. --set object.0.scale={scale:e}",
        path = .path.display()
    )]
    Size { path: PathBuf, size: f64, least: f64, most: f64, scale: f64 },

    /// The path of a model is not UTF-8.
    #[error("{path}: is not UTF-8, which a scene's text must be: the file cannot be named in one", path = .path.display())]
    NoText { path: PathBuf },

    /// An error of the model that is loaded in place of a scene.
    #[error(transparent)]
    Model(#[from] geometry::Error),
}
