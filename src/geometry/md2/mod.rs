//! Key-framed models: MD2 files, read and written, and their meshes between two key frames [GDC, "Quake2 Models"].

mod animation;
mod file;
mod model;
mod normals;
mod tangents;

pub use animation::Animation;
pub use file::{Frame, Md2, Triangle, read, text, write};
pub use model::{Model, NormalSource, Pose};
pub use normals::nearest_normal;
pub use tangents::KeyTangents;
