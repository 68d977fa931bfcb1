//! Meshes on the CPU: loading (OBJ and MTL), primitives, smooth normals. No GL, no scene.

mod material;
mod mesh;

pub use material::{Material, ObjectLinear, Texture};
pub use mesh::{Mesh, Part};
