//! Meshes on the CPU: loading (OBJ and MTL, MD2, glTF), primitives, smooth normals, tangent bases, normal maps, skins, shadow
//! volumes. No GL, no scene.

pub mod bump;
mod derived;
mod error;
#[cfg(feature = "gltf")]
mod gltf;
mod map_options;
mod material;
pub mod md2;
mod mesh;
mod mtl;
mod mtl_maps;
pub mod normal_cube;
pub mod normal_map;
mod normals;
mod obj;
mod primitives;
pub mod rays;
pub mod sampled;
mod simplify;
#[cfg(feature = "repack")]
pub mod skin;
mod tally;
pub mod tangents;
mod text;
mod texture;
pub mod topology;
mod vertex_cache_order;
pub mod volume;
mod wave;
mod world;

pub use bump::{Bump, Gloss};
pub use derived::{Derived, Most};
pub use error::{Error, Warning};
pub use material::{Material, ObjectLinear, Placement};
pub use mesh::{Mesh, MeshTangents, Part};
pub use obj::{CREASE_DEGREES, decode_obj, load_obj};
pub use primitives::{PRIMITIVES, primitive};
pub use text::read_text;
pub(crate) use texture::find_file;
pub use texture::{Texture, decode_texture, load_texture};
pub use wave::Wave;
pub use world::{LightShape, Moment, Named, PlacedCamera, PlacedLight, PlacedMesh, World};

/// Reads a .gltf or .glb file, its buffers and its pictures; `moment`: a time of an animation, absent: as the nodes stand.
///
/// # Errors
///
/// A file that is not whole, that names what it does not have, or that needs an extension that is not read; any file, where
/// cargo feature `gltf` is not compiled in.
#[cfg(feature = "gltf")]
pub fn load_gltf(path: &std::path::Path, moment: Option<&Moment>) -> Result<(World, Vec<Warning>), Error> {
    gltf::load(path, moment)
}

/// Refuses a .gltf or .glb file: cargo feature `gltf` is not compiled in.
///
/// # Errors
///
/// Always.
#[cfg(not(feature = "gltf"))]
pub fn load_gltf(path: &std::path::Path, moment: Option<&Moment>) -> Result<(World, Vec<Warning>), Error> {
    let _ = moment;
    Err(Error::NotBuilt { path: path.to_owned(), feature: "gltf" })
}
