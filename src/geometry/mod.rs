//! Meshes on the CPU: loading (OBJ and MTL, MD2, glTF, PLY, STL), primitives, smooth normals, tangent bases, normal maps, skins,
//! shadow volumes. No GL, no scene.

pub mod bump;
mod closed;
mod derived;
mod error;
mod far;
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
#[cfg(feature = "ply")]
mod ply;
mod primitives;
pub mod rays;
pub mod sampled;
mod simplify;
#[cfg(feature = "repack")]
pub mod skin;
#[cfg(feature = "stl")]
mod stl;
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
pub use world::{ModelWorld, Moment, Named, PlacedCamera, PlacedLight, PlacedMesh, PlacedShape};

/// Defines the reader of a kind of file that a cargo feature brings, or refuses it where that is not compiled in.
macro_rules! reader {
    ($name:ident, $feature:literal, $kind:literal, $module:ident, $found:ty $(, $argument:ident: $type:ty)?) => {
        #[doc = concat!("Reads ", $kind, ".")]
        ///
        /// # Errors
        ///
        /// A file that is malformed; any file, where the cargo feature is not compiled in.
        #[cfg(feature = $feature)]
        pub fn $name(path: &std::path::Path $(, $argument: $type)?) -> Result<($found, Vec<Warning>), Error> {
            $module::load(path $(, $argument)?)
        }

        #[doc = concat!("Refuses a file: cargo feature `", $feature, "` is not compiled in.")]
        ///
        /// # Errors
        ///
        /// Always.
        #[cfg(not(feature = $feature))]
        pub fn $name(path: &std::path::Path $(, _: $type)?) -> Result<($found, Vec<Warning>), Error> {
            Err(Error::NotBuilt { path: path.to_owned(), feature: $feature })
        }
    };
}

reader!(
    load_gltf,
    "gltf",
    "a .gltf or .glb file, its buffers and its pictures; `moment`: a time of an animation, absent: as the nodes stand",
    gltf,
    ModelWorld,
    moment: Option<&Moment>
);
reader!(load_ply, "ply", "a PLY file", ply, Mesh);
reader!(load_stl, "stl", "an STL file", stl, Mesh);
