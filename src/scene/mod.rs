//! From a file to a resolved [`Scene`]: TOML or OBJ in, plain values out. Errors carry file and line, unknown keys
//! are refused. Knows geometry and math; no technique and no GL.

mod model;
mod settings;

pub use model::{Camera, Image, Light, LightKind, LightShape, Object, Scene, Shading};
pub use settings::{Entry, Origin, Reader, Settings, SettingsError, Value, suggest};
