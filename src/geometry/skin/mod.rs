//! Skins, the texture coordinates of models: how far tangent bases turn across edges, and the cure, a skin whose pieces are
//! turned and packed again [GDC, "Tangent Space Vector Continuity", "Tangent Continuity Solutions"].
//!
//! A skin is cut into islands (`islands`), which are turned so that t axes agree across edges (`turn`) and packed
//! (`pack`); pictures are sampled anew in their new places (`resample`). `discontinuity` measures before and after.

mod discontinuity;
mod islands;
mod obj_text;
mod pack;
mod raster;
mod repack;
mod resample;
mod turn;

use glam::{DVec2, DVec3};

use super::Mesh;
use super::tangents::{self, LEAST_AREA};
use super::topology;

pub use discontinuity::{CLASS_ENDS, Discontinuity, TurnClass};
pub use obj_text::write_obj;
pub use pack::LARGEST;
pub use raster::Raster;
pub use repack::{RepackOptions, Repacked, repack};

/// Reason why a skin cannot be packed again.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// Texture coordinates so large that the islands need a picture beyond the limit.
    #[error(
        "the islands of the skin need more than {limit}x{limit} texels at their size; --size WxH makes them smaller"
    )]
    TooLarge { limit: u32 },
    /// Gutters alone fill the picture.
    #[error(
        "{width}x{height} texels have no room for {pieces} pieces of the skin with a gutter of {gutter} texels; \
         enlarge --size or lessen --gutter"
    )]
    NoRoom { width: u32, height: u32, pieces: usize, gutter: u32 },
    /// A map of more texels than the skin becomes too large with it.
    #[error(
        "a map of {from} texels a side would have {to} with the skin; a picture has at most {limit}; lessen --size"
    )]
    MapTooLarge { from: u32, to: u64, limit: u32 },
}

/// Derivatives of the place on a triangle by texels, y upwards.
struct Derivatives {
    pub by_s: DVec3,
    pub by_t: DVec3,
    pub is_mirrored: bool,
}

/// A mesh's triangles with their places on the skin.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Width and height in texels.
    pub(super) size: [u32; 2],
    pub(super) triangles: Vec<SkinTriangle>,
}

/// A triangle on the surface and on the skin.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkinTriangle {
    /// Numbers of the corners' places: corners of equal positions share one.
    places: [u32; 3],
    positions: [DVec3; 3],
    normals: [DVec3; 3],
    /// Texels from the skin's top left corner, y downwards.
    texels: [DVec2; 3],
}

impl Skin {
    /// The skin of a mesh whose texture is `size` texels. `None`: it has no texture coordinates.
    pub fn of_mesh(mesh: &Mesh, size: [u32; 2]) -> Option<Self> {
        let [width, height] = size.map(f64::from);
        let texel = |[s, t]: &[f32; 2]| DVec2::new(f64::from(*s) * width, (1.0 - f64::from(*t)) * height);
        Some(Self::of_texels(mesh, size, mesh.texcoords.as_ref()?.iter().map(texel)))
    }

    /// The same from texels of the mesh's vertices, y downwards.
    pub fn of_texels(mesh: &Mesh, size: [u32; 2], texels: impl Iterator<Item = DVec2>) -> Self {
        let texels: Vec<DVec2> = texels.collect();
        let (places, _) = topology::weld(&mesh.positions);
        let vector = |values: &[[f32; 3]], index: u32| DVec3::from_array(values[index as usize].map(f64::from));
        let triangles = mesh.indices.as_chunks::<3>().0.iter().map(|triangle| SkinTriangle {
            places: triangle.map(|index| places[index as usize]),
            positions: triangle.map(|index| vector(&mesh.positions, index)),
            normals: triangle.map(|index| vector(&mesh.normals, index)),
            texels: triangle.map(|index| texels[index as usize]),
        });
        Self { size, triangles: triangles.collect() }
    }

    /// The same triangles elsewhere: `texels` has three corners a triangle.
    fn moved(&self, size: [u32; 2], texels: &[[DVec2; 3]]) -> Self {
        let moved = |(triangle, texels): (&SkinTriangle, &[DVec2; 3])| SkinTriangle { texels: *texels, ..*triangle };
        Self { size, triangles: self.triangles.iter().zip(texels).map(moved).collect() }
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Texels of the three corners of each triangle, from the top left corner, y downwards.
    pub fn texels(&self) -> impl ExactSizeIterator<Item = [DVec2; 3]> {
        self.triangles.iter().map(|triangle| triangle.texels)
    }

    /// All corners in steps of a texel, three a triangle; those beyond an i16 become its least or greatest.
    pub fn in_steps(&self, steps: u32) -> Vec<[i16; 2]> {
        let whole = |texel: DVec2| texel.to_array().map(|value| (f64::from(steps) * value).round() as i16);
        self.triangles.iter().flat_map(|triangle| triangle.texels.map(whole)).collect()
    }

    /// Triangles whose skin is mirrored: seen from outside, it runs the other way around.
    pub fn mirrored(&self) -> usize {
        self.triangles.iter().filter(|triangle| triangle.sense() < 0).count()
    }

    /// Texels a unit of length: the root of the skin's area over the surface's. Zero for a surface without an area.
    pub fn density(&self) -> f64 {
        let texels: f64 = self.triangles.iter().map(|triangle| 0.5 * triangle.doubled_area().abs()).sum();
        let surface: f64 = self.triangles.iter().map(SkinTriangle::surface).sum();
        if surface > 0.0 { (texels / surface).sqrt() } else { 0.0 }
    }

    /// Discontinuities across edges: see [`Discontinuity`].
    pub fn discontinuity(&self) -> Discontinuity {
        discontinuity::measure(self)
    }
}

impl SkinTriangle {
    /// Twice the area on the skin, in texels; positive counter-clockwise with y upwards.
    fn doubled_area(&self) -> f64 {
        let [a, b, c] = self.texels;
        -(b - a).perp_dot(c - a)
    }

    /// Sign of the area on the skin: 1, -1 for a mirrored skin, or 0.
    fn sense(&self) -> i8 {
        let [a, b, c] = self.texels;
        let area = self.doubled_area();
        match area.abs() > LEAST_AREA * (b - a).length() * (c - a).length() {
            true if area > 0.0 => 1,
            true => -1,
            false => 0,
        }
    }

    /// Area on the surface.
    fn surface(&self) -> f64 {
        let [a, b, c] = self.positions;
        0.5 * (b - a).cross(c - a).length()
    }

    /// Derivatives of the place on the surface by texels, y upwards.
    fn derivatives(&self) -> Option<Derivatives> {
        let [a, b, c] = self.positions;
        let (edges, skin) = ([b - a, c - a], self.texels.map(|texel| [texel.x, -texel.y]));
        edges[0].cross(edges[1]).try_normalize()?;
        let area = tangents::skin_area(skin)?;
        let [by_s, by_t] = tangents::derivatives(edges, skin, area);
        Some(Derivatives { by_s, by_t, is_mirrored: area < 0.0 })
    }
}
